"""Read the options of every command from their declarations, for the page on the command line."""

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any, get_args, get_origin

from stylobate.cli.command import Command
from stylobate.cli.commands import COMMANDS
from stylobate.config.options import Chosen, Option, written

# Panels whose options many commands share, in the order of the page. Each is a section of the page.
SHARED_PANELS = (
    "Run",
    "Axes",
    "Column",
    "Model",
    "Base motion",
    "Record",
    "Computing",
    "Output",
)

_WORDS = {"Path": "FILE", "str": "TEXT", "int": "INTEGER", "float": "NUMBER"}


@dataclass(frozen=True, slots=True)
class Row:
    """One option as the page shows it: how it is written, which values follow, and its help."""

    flag: str
    values: str
    text: str


def usage(name: str) -> str:
    """Write the usage line of a command.

    >>> usage("map")
    'stylobate map [OPTIONS] [SOURCE]'
    """
    argument = COMMANDS[name].load().argument
    if argument is None:
        return f"stylobate {name} [OPTIONS]"
    written_name = (argument.metavar or argument.name).upper()
    return f"stylobate {name} [OPTIONS] {written_name if argument.required else f'[{written_name}]'}"


def title(name: str) -> str:
    """Return the title of the section of a command: its usage without "[OPTIONS]".

    >>> title("map")
    'stylobate map [SOURCE]'
    """
    return usage(name).replace(" [OPTIONS]", "")


def argument_text(name: str) -> str:
    """Return the help of the argument of a command; empty for a command without one."""
    argument = COMMANDS[name].load().argument
    return "" if argument is None else argument.text


def explanation(name: str) -> tuple[list[str], list[str]]:
    """Return the paragraphs of a command's help, and its examples."""
    text = COMMANDS[name].load().help
    paragraphs = [" ".join(part.split()) for part in text.split("\n\n")]
    paragraphs = [
        one.removesuffix(" Examples:").removesuffix(" Example:") for one in paragraphs
    ]
    paragraphs = [
        one for one in paragraphs if one not in ("Examples:", "Examples --------")
    ]
    paragraphs = [one.removeprefix("Examples -------- ") for one in paragraphs]
    examples = [one for one in paragraphs if one.startswith("stylobate ")]
    return [one for one in paragraphs if one not in examples], examples


def options_of(command: Command) -> list[Option]:
    """List the options of a command, those that help hides left out."""
    return [one for one in command.options(Chosen()).values() if not one.hidden]


def row(option: Option) -> Row:
    """Write one option as the page shows it."""
    return Row(option.flag or f"--{written(option.name)}", _values(option), option.text)


def _values(option: Option) -> str:
    if option.metavar:
        return option.metavar
    if get_origin(option.type) is list:
        return f"{_word(get_args(option.type)[0])} (repeatable)"
    if get_origin(option.type) is tuple:
        return " ".join(_word(one) for one in get_args(option.type))
    return "" if option.type is bool else _word(option.type)


def _word(kind: Any) -> str:
    return _WORDS[kind.__name__]


def shared_options() -> dict[str, list[Row]]:
    """Return the options that two or more commands share with the same help, by panel."""
    found: dict[str, dict[str, Counter[Row]]] = {panel: {} for panel in SHARED_PANELS}
    for entry in COMMANDS.values():
        for option in options_of(entry.load()):
            if option.panel in found:
                found[option.panel].setdefault(option.name, Counter())[row(option)] += 1
    shared = {
        panel: [rows.most_common(1)[0] for rows in named.values()]
        for panel, named in found.items()
    }
    return {
        panel: [one for one, count in rows if count > 1]
        for panel, rows in shared.items()
    }


@dataclass(frozen=True, slots=True)
class Sharing:
    """What a command takes from a shared panel: all of it, all but some options, or some options."""

    panel: str
    taken: tuple[str, ...]
    missing: tuple[str, ...]

    def words(self) -> str:
        """Say in words which options of the panel the command takes; flags stand in backticks.

        >>> Sharing("Output", ("--json",), ("--figure", "--output")).words()
        'only `--json`'
        """
        if not self.missing:
            return ""
        if len(self.missing) <= len(self.taken):
            return f"all but {_flags(self.missing)}"
        return f"only {_flags(self.taken)}"


def _flags(flags: Iterable[str]) -> str:
    return ", ".join(f"`{flag}`" for flag in flags)


def split(name: str) -> tuple[list[Row], list[Sharing]]:
    """Return the options of a command that no other one shares, and what it takes from the shared panels."""
    shared = shared_options()
    options = options_of(COMMANDS[name].load())
    own = [row(one) for one in options if row(one) not in shared.get(one.panel, [])]
    return own, list(_sharings(options, shared))


def _sharings(options: list[Option], shared: dict[str, list[Row]]) -> Iterator[Sharing]:
    for panel, rows in shared.items():
        flags = [one.flag for one in rows]
        taken = tuple(
            row(one).flag for one in options if one.panel == panel and row(one) in rows
        )
        if taken:
            yield Sharing(
                panel, taken, tuple(flag for flag in flags if flag not in taken)
            )
