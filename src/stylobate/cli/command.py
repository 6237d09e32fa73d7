"""Commands: made from a function, groups of options, and the command's own options; parsed by click."""

import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, get_args, get_origin

import click
from click.core import ParameterSource

from stylobate.cli.options import Options
from stylobate.config.options import PARTS, Chosen, Group, Option, as_kind, joined, numbers_in
from stylobate.text import similar
from stylobate.units import has_unit


@dataclass(frozen=True, slots=True, kw_only=True)
class Positional:
    """The positional argument of a command: a file, or several."""

    text: str
    name: str = "source"
    several: bool = False
    required: bool = False
    metavar: str | None = None

    def as_parameter(self) -> click.Argument:
        """Make the argument of the parser."""
        return click.Argument(
            [self.name],
            type=str if self.several else click.Path(path_type=Path),
            nargs=-1 if self.several else 1,
            required=self.required,
            metavar=self.metavar,
            help=self.text,
        )


@dataclass(frozen=True, slots=True)
class Command:
    """A command: its function, which reads the options, its help, and the declarations of its options."""

    function: Callable[[Options], None]
    help: str
    argument: Positional | None
    own: Sequence[Option]
    groups: Sequence[Group]

    def options(self, chosen: Chosen) -> dict[str, Option]:
        """Return the declarations of all options by name, for the chosen kinds."""
        groups = (self.own, *(group.options(chosen) for group in self.groups))
        return {option.name: option for option in joined(groups)}

    def program(self, name: str, arguments: Sequence[str] = ()) -> click.Command:
        """Make the parser of this command for a command line, which may choose user-defined classes.

        Raises
        ------
        ParameterError
            If there is no such class.
        """
        chosen, files = _chosen(arguments)
        declared = self.options(chosen)

        def called(**parsed: Any) -> None:
            source_of = click.get_current_context().get_parameter_source
            texts = {one: None if value == () else value for one, value in parsed.items()}
            values = {one: declared[one].read(text) if one in declared else text for one, text in texts.items()}
            stated = [one for one in declared if source_of(one) is ParameterSource.COMMANDLINE]
            options = Options(
                name,
                values,
                {one: declared[one].written_flag for one in stated},
                declared,
                chosen,
                with_units={one: text for one, text in texts.items() if has_unit(text)},
                files=files,
            )
            self.function(options)

        argument = [] if self.argument is None else [self.argument.as_parameter()]
        params = [*argument, *map(_as_parameter, declared.values())]
        return _Program(name, callback=called, params=params, help=self.help)


def command(
    *own: Option, argument: Positional | str | None = None, groups: Sequence[Group] = ()
) -> Callable[[Callable[[Options], None]], Command]:
    """Make a function a command with its `own` options and the options of the groups; a decorator."""
    made = Positional(text=argument) if isinstance(argument, str) else argument
    return lambda function: Command(function, function.__doc__ or "", made, own, groups)


def _as_parameter(option: Option) -> click.Option:
    """Make the option of the parser; numbers remain texts, which may have a unit."""
    several = get_origin(option.type) is list
    kind = get_args(option.type)[0] if several else option.type
    numbers = numbers_in(kind)
    names = " ".join(["NUMBER"] * numbers) or None
    if numbers:
        kind = str if kind is float else (str,) * numbers
    elif get_origin(kind) is tuple:
        kind = get_args(kind)
    elif kind is Path:
        kind = click.Path(path_type=Path)
    elif kind is int and option.minimum is not None:
        kind = click.IntRange(min=option.minimum)
    callback = option.callback
    return _Panelled(
        [option.written_flag, option.name],
        panel=option.panel,
        type=None if kind is bool else kind,
        is_flag=kind is bool,
        multiple=several,
        default=option.default,
        help=option.help,
        metavar=option.metavar or names,
        hidden=option.hidden,
        callback=None if callback is None else lambda _context, _option, value: callback(value),
    )


def _chosen(arguments: Sequence[str]) -> tuple[Chosen, Mapping[Path, Mapping[str, Any]]]:
    """Find the kinds of model and motion that a command line and its file choose; return the file with its values too.

    Mistakes in the file are ignored here: the reading of the description reports them.
    """
    flags = {f"--{part.flag}": table for table, part in PARTS.items()}
    kinds = {}
    for place, word in enumerate(arguments):
        flag, equals, value = word.partition("=")
        if flag in flags:
            kinds[flags[flag]] = as_kind(value if equals else "".join(arguments[place + 1 : place + 2]))
    source = next((Path(one) for one in arguments if one.endswith(".toml")), None)
    read = {} if source is None else _read(source)
    tables = read.get(source, {}) if source else {}
    described = {part: tables.get(part) for part in PARTS if part not in kinds}
    tags = {part: table.get(PARTS[part].tag) for part, table in described.items() if isinstance(table, Mapping)}
    from_file = Chosen.of(
        {part: kind for part, kind in tags.items() if isinstance(kind, str)}, source.parent if source else Path()
    )
    from_options = Chosen.of(kinds)
    return Chosen({**from_file.kinds, **from_options.kinds}, {**from_file.classes, **from_options.classes}), read


def _read(source: Path) -> Mapping[Path, Mapping[str, Any]]:
    try:
        return {source: tomllib.loads(source.read_text(encoding="utf-8"))}
    except (OSError, ValueError, RecursionError):
        return {}


class _Panelled(click.Option):
    """An option below a heading of the help."""

    def __init__(self, *declarations: Any, panel: str, **settings: Any) -> None:
        super().__init__(*declarations, **settings)
        self.panel = panel


class _Program(click.Command):
    """A parser whose help shows the options under headings; help needs no arguments."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Parse arguments."""
        if "--help" in args:
            print(self.get_help(ctx))
            ctx.exit()
        return super().parse_args(ctx, args)

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the options under their headings; the parser writes the arguments itself."""
        panels: dict[str, list[tuple[str, str]]] = {}
        for option in self.get_params(ctx):
            record = option.get_help_record(ctx)
            if record is not None and not isinstance(option, click.Argument):
                panels.setdefault(getattr(option, "panel", "Options"), []).append(record)
        for heading, records in panels.items():
            with formatter.section(heading):
                formatter.write_dl(records)


def usage_error(error: click.ClickException, program: click.Command | None) -> str:
    """Write one line for a mistake in the options; for an option with several values, the line states these values."""
    if isinstance(error, click.NoSuchOption) and (flags := _similar(error.option_name, program)):
        return f"No such option {error.option_name!r}. Did you mean {' or '.join(map(repr, flags))}?"
    message = error.format_message()
    option = getattr(error, "param", None)
    if option is None:  # an error about too few values names the option alone
        name = getattr(error, "option_name", None)
        option = next((one for one in getattr(program, "params", ()) if name in one.opts), None)
    if option is None or option.nargs in (1, -1):
        return message
    names = option.metavar or ""
    wanted = f"{option.nargs} numbers" if set(names.split()) <= {"NUMBER"} else names
    if "requires" in message:
        return f"{option.opts[0]} must be followed by {wanted}; got fewer"
    return f"{option.opts[0]} must be followed by {wanted}; {wanted.split()[-1]} must be a whole number"


def _similar(flag: str, program: click.Command | None) -> list[str]:
    """Return the option of the most similar name, or the options that an alias means."""
    flags = {_plain(one): one for option in getattr(program, "params", ()) for one in option.opts}
    return [flags[one] for one in similar(_plain(flag), flags)]


def _plain(flag: str) -> str:
    return flag.lstrip("-").replace("-", "_")
