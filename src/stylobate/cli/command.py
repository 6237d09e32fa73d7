"""Commands: made from a function, groups of options, and the command's own options."""

import inspect
import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, get_args, get_origin

import typer
import typer.core

from stylobate.cli.declarations import Group, Option, as_kind, written
from stylobate.cli.options import Options
from stylobate.cli.own_classes import Chosen
from stylobate.cli.parts import PARTS, joined
from stylobate.units import has_unit


@dataclass(frozen=True, slots=True, kw_only=True)
class Argument:
    """The positional argument of a command: one or several files."""

    text: str
    name: str = "source"
    type: Any = Path
    required: bool = False
    metavar: str | None = None

    def as_parameter(self) -> inspect.Parameter:
        """Make the parameter of a function from which typer reads this argument."""
        declared = typer.Argument(help=self.text, show_default=False, metavar=self.metavar)
        kind, default = inspect.Parameter.KEYWORD_ONLY, inspect.Parameter.empty if self.required else None
        wanted: Any = self.type if self.required else self.type | None
        return inspect.Parameter(self.name, kind, default=default, annotation=Annotated[wanted, declared])


@dataclass(frozen=True, slots=True)
class Command:
    """A command: its function, which reads the options, and the declarations of the options."""

    function: Callable[[Options], None]
    argument: Argument | None
    own: Sequence[Option]
    groups: Sequence[Group]

    def options(self, chosen: Chosen) -> dict[str, Option]:
        """Return the declarations of all options by name, for the chosen kinds."""
        groups = (self.own, *(group.options(chosen) for group in self.groups))
        return {option.name: option for option in joined(groups)}

    def program(self, name: str, arguments: Sequence[str] = ()) -> Any:
        """Make the parser of this command for a command line, which may choose user-defined classes.

        Raises
        ------
        ParameterError
            If there is no such class.
        """
        chosen = self._chosen(arguments)
        declared = self.options(chosen)

        def called(context: typer.Context, **texts: Any) -> None:
            values = {one: declared[one].read(text) if one in declared else text for one, text in texts.items()}
            stated = {one: text for one, text in texts.items() if has_unit(text)}
            self.function(Options.of(context, name, values, declared, chosen, stated))

        context = inspect.Parameter("context", inspect.Parameter.POSITIONAL_OR_KEYWORD, annotation=typer.Context)
        argument = [] if self.argument is None else [self.argument.as_parameter()]
        parameters = [context, *argument, *(option.as_parameter() for option in declared.values())]
        called.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]  # what typer reads
        called.__doc__ = self.function.__doc__
        app = typer.Typer(add_completion=False, rich_markup_mode=None)
        app.command(name, cls=_WithPanels)(called)
        made: Any = typer.main.get_command(app)
        for one in made.params:
            _convert_if_stated(one)
        return made

    def _chosen(self, arguments: Sequence[str]) -> Chosen:
        """Find which kinds of model and motion a command line and its file choose."""
        options = self.options(Chosen()).values()
        parts = {one.name: one.part for one in options if one.number == "kind"}
        stated, files = _split(arguments, {one.flag or f"--{written(one.name)}": one for one in options})
        kinds = {part: stated[name] for name, part in parts.items() if name in stated}
        source = next((Path(one) for one in files if one.endswith(".toml")), None)
        tables = {} if source is None else _tables(source)
        described = {part: tables[part] for part in parts.values() if part in tables and part not in kinds}
        from_file = Chosen.of(described, source.parent if source else Path())
        from_options = Chosen.of({part: as_kind(kind) for part, kind in kinds.items()})
        return Chosen({**from_file.kinds, **from_options.kinds}, {**from_file.classes, **from_options.classes})


def command(
    *own: Option, argument: Argument | str | None = None, groups: Sequence[Group] = ()
) -> Callable[[Callable[[Options], None]], Command]:
    """Make a function a command with its `own` options and the options of the groups; a decorator."""
    made = Argument(text=argument) if isinstance(argument, str) else argument
    return lambda function: Command(function, made, own, groups)


def _split(arguments: Sequence[str], options: Mapping[str, Option]) -> tuple[dict[str, str], list[str]]:
    """Split a command line into the last value of each option, by name, and the arguments that are no options."""
    stated, others, rest = dict[str, str](), list[str](), list(arguments)
    while rest:
        flag, equals, value = rest.pop(0).partition("=")
        option = options.get(flag)
        if option is None:
            others += [] if flag.startswith("--") else [f"{flag}{equals}{value}"]
            continue
        count = 0 if equals or option.type is bool else _count(option.type)
        if count:
            value = " ".join(rest[:count])
            del rest[:count]
        stated[option.name] = value
    return stated, others


def _count(kind: Any) -> int:
    return len(get_args(kind)) if get_origin(kind) is tuple else 1


def _tables(source: Path) -> dict[str, str]:
    """Read the kinds of model and motion in a file; ignore mistakes, which the full reading of the file reports."""
    try:
        values = tomllib.loads(source.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return {}
    tables = {part: values.get(part) for part in PARTS}
    kinds = {part: table.get("kind") for part, table in tables.items() if isinstance(table, dict)}
    return {part: kind for part, kind in kinds.items() if isinstance(kind, str)}


def _convert_if_stated(option: Any) -> None:
    """Leave out the conversion of an option that is not stated: converters of all options take 15 ms to make."""
    process = option.process_value
    if option.required or option.multiple or option.nargs < 0 or option.callback is not None:
        return
    option.process_value = lambda ctx, value: None if value is None else process(ctx, value)


class _WithPanels(typer.core.TyperCommand):
    """A command whose help shows the options under headings."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Parse arguments; help needs none of them."""
        if "--help" in args:
            print(self.get_help(ctx))
            ctx.exit()
        return super().parse_args(ctx, args)

    def format_options(self, ctx: Any, formatter: Any) -> None:
        """Write the options under their headings."""
        panels: dict[str, list[tuple[str, str]]] = {}
        for option in self.get_params(ctx):
            record = option.get_help_record(ctx)
            if record is not None:
                heading = getattr(option, "rich_help_panel", None) or (
                    "Arguments" if option.param_type_name == "argument" else "Options"
                )
                panels.setdefault(heading, []).append(record)
        for heading, records in panels.items():
            with formatter.section(heading):
                formatter.write_dl(records)
