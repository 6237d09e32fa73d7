"""Declarations of the options of commands: each once, in groups that commands share."""

import inspect
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, replace
from pathlib import Path
from typing import Annotated, Any, get_args, get_origin

import typer

from stylobate.cli.own_classes import Chosen
from stylobate.errors import FileError, ParameterError
from stylobate.quantities import Parameter
from stylobate.units import UnitError, is_number, read

MAX_NAMED_KINDS = 3
"""Maximum number of kinds that a help text or a remedy lists."""


_AXIS = tuple[str, str, str, int]
"""Name, first, last and number of values, whose unit depends on the name."""
_NUMBERS = list[float]


@dataclass(frozen=True, slots=True)
class Option:
    """One option.

    Parameters
    ----------
    name
        Name in Python; the flag is derived from the name unless `flag` is given.
    text
        Help text.
    type
        Type of one value; a tuple for several values, a list for an option that may be repeated, bool for a switch.
    panel
        Heading of the option in the help.
    part, number
        The table of a configuration, such as "motion", and the name in this table; empty for other options.
    kinds
        The kinds of this part that have the number, as in files.
    unit
        Unit of a number, which may have a suffix of the same dimension on the command line; added to the help text.
    words
        Words that the option accepts in place of a number.
    """

    name: str
    text: str = ""
    type: Any = float
    _: KW_ONLY
    flag: str = ""
    panel: str = "Options"
    default: Any = None
    metavar: str | None = None
    minimum: int | None = None
    callback: Callable[[Any], Any] | None = None
    hidden: bool = False
    part: str = ""
    number: str = ""
    kinds: tuple[str, ...] = ()
    unit: str = ""
    words: tuple[str, ...] = ()

    @property
    def written_flag(self) -> str:
        """The option as on a command line."""
        return self.flag or f"--{written(self.name)}"

    @property
    def help(self) -> str:
        """The text with the unit."""
        head, semicolon, rest = self.text.partition(";")
        return f"{head} [{self.unit}]{semicolon}{rest}" if self.unit else self.text

    def as_parameter(self) -> inspect.Parameter:
        """Make the parameter of a function from which typer reads this option; numbers remain texts."""
        kind, numbers = self.type, _numbers_in(self.type)
        if kind == _NUMBERS:
            kind = list[str]
        elif numbers:
            kind = str if kind is float else tuple[(str,) * numbers]  # type: ignore[misc]
        declared = typer.Option(
            self.written_flag,
            help=self.help,
            rich_help_panel=self.panel,
            show_default=False,
            metavar=self.metavar or " ".join(["NUMBER"] * (numbers or self.type == _NUMBERS)) or None,
            min=self.minimum,
            callback=self.callback,
            hidden=self.hidden,
        )
        annotation = kind if self.default is not None else kind | None
        return inspect.Parameter(
            self.name, inspect.Parameter.KEYWORD_ONLY, default=self.default, annotation=Annotated[annotation, declared]
        )

    def read(self, value: Any) -> Any:
        """Convert the texts of numbers to numbers in the declared unit; other values are unchanged.

        Raises
        ------
        ParameterError
            If a text is no number, or its unit is unknown or has another dimension.
        """
        if value is None or self.type is float:
            return None if value is None else self._number(value)
        if self.type == _NUMBERS:
            return [self._number(one) for one in value]
        count = _numbers_in(self.type)
        texts = value if count else value[1:3] if self.type is _AXIS else ()
        if not all(map(is_number, texts)):
            wanted = f"{count} numbers" if count else self.metavar
            message = f"{self.written_flag} must be followed by {wanted}; one of them is not a number"
            raise ParameterError(message)
        return tuple(map(self._number, value)) if count else value

    def _number(self, text: Any) -> Any:
        if text in self.words or not isinstance(text, str):
            return text
        try:
            return read(text, self.unit)
        except UnitError as error:
            problem = f"must be a number or {listed(self.words)}, got {text!r}" if self.words else str(error)
            message = f"{self.written_flag} {problem}"
            raise ParameterError(message) from None


def _numbers_in(kind: Any) -> int:
    """Count the numbers that an option takes, all in its unit; 0 for an option that takes other values too."""
    parts = get_args(kind) if get_origin(kind) is tuple else (kind,)
    return len(parts) if set(parts) == {float} else 0


@dataclass(frozen=True, slots=True)
class Group:
    """Options that several commands share; they are made when one of these commands is chosen."""

    make: Callable[[Chosen], Iterable[Option]]
    left_out: tuple[str, ...] = ()
    only: tuple[str, ...] = ()

    @classmethod
    def of(cls, panel: str, *options: Option) -> "Group":
        """Make a group of these options below one heading."""
        return cls(lambda _: [replace(option, panel=panel) for option in options])

    def without(self, *names: str) -> "Group":
        """Return this group without the options of these names."""
        return replace(self, left_out=(*self.left_out, *names))

    def reduced_to(self, *names: str) -> "Group":
        """Return the options of these names in this group."""
        return replace(self, only=names)

    def options(self, chosen: Chosen) -> list[Option]:
        """List the options, with those of the chosen kinds."""
        kept = [one for one in self.make(chosen) if one.name not in self.left_out]
        return [one for one in kept if not self.only or one.name in self.only]


def run_numbers(group: type) -> Group:
    """Make the options of the declared numbers of a run, such as `stylobate.run_arguments.SingleRun`."""

    def made(_: Chosen) -> Iterable[Option]:
        from stylobate.run_arguments import numbers_of  # noqa: PLC0415  heavy imports wait

        for name, parameter in numbers_of(group).items():
            unit = parameter.quantity.unit
            yield Option(name, text_of(parameter), type_of(parameter), panel="Run", unit=unit)

    return Group(made)


def type_of(parameter: Parameter) -> Any:
    """Determine the type of the values of an option from its declaration."""
    if parameter.quantity.components > 1:
        return tuple[(float,) * parameter.quantity.components]  # type: ignore[misc]
    if any(isinstance(choice, str) for choice in parameter.choices):
        return str
    return int if parameter.whole else float


def text_of(parameter: Parameter, kinds: Sequence[str] = ()) -> str:
    """Describe an option from its declaration: text, choices, default, and the `kinds` that have it."""
    quantity, default = parameter.quantity, parameter.default
    text = " ".join(part for part in (quantity.text, quantity.symbol) if part)
    words = [written(choice) for choice in parameter.choices if isinstance(choice, str)]
    if words:
        text += f": {listed(words)}"
    if quantity.by_word:
        text += f", or {listed(tuple(quantity.by_word))}"
    if kinds:
        text += f"; only for {listed(kinds, 'and')}"
    if not (parameter.required or default is None or default in (0.0, (0.0,) * quantity.components)):
        text += f"; {written(default) if isinstance(default, str) else f'{default:g}'} by default"
    return text


def written(name: str) -> str:
    """Write the name of an option or a kind as on the command line; leave user-defined classes unchanged.

    >>> written("half_sine"), written("my_models.py:Tethered")
    ('half-sine', 'my_models.py:Tethered')
    """
    return name if ":" in name else name.replace("_", "-")


def as_kind(name: str) -> str:
    """Write the name of a kind as in files."""
    return name if ":" in name else name.replace("-", "_")


def listed(names: Sequence[str], word: str = "or") -> str:
    """List names in words.

    >>> listed(["rolling", "half_sine", "sum"])
    'rolling, half-sine or sum'
    """
    shown = [written(name) for name in names]
    return f" {word} ".join(part for part in (", ".join(shown[:-1]), shown[-1]) if part)


def readable(paths: list[Path] | None) -> list[Path] | None:
    """Raise FileError at once for a file that is missing: the code that reads it takes seconds to import."""
    for path in paths or ():
        if not path.is_file():
            message = f"cannot read {path}: No such file or directory"
            raise FileError(message)
    return paths


AXES = Group.of(
    "Axes",
    Option("x", "values along x: name, first, last, number", _AXIS, metavar="NAME FROM TO NUMBER"),
    Option("y", "values along y: name, first, last, number", _AXIS, metavar="NAME FROM TO NUMBER"),
    Option("x_spacing", "linear (by default) or log", str),
    Option("y_spacing", "linear (by default) or log", str),
)
UNITS = Option("units", "unit of files that do not state it: g, m/s2 or cm/s2", str)
STEP = Option("step", "time step of files that do not state it", unit="s")
EARLY_END = Group.of(
    "Run",
    Option("end_converged", "end a run early once it has converged to steady rolling; circular motion only", bool),
)
ONE_COMPONENT = Option("one_component", "accept records of one component without a warning", bool)
SAMPLE = 'record that comes with the package: "el centro 1940", or "el centro 1940 corrected"'

_RECORD_OPTIONS: Mapping[str, Option] = {
    "path": Option(
        "record",
        "file of a record; repeat it for each component of the same event, whatever its name",
        list[Path],
        callback=readable,
    ),
    "directions": Option(
        "record_direction",
        "direction of a component, once for each --record, in their order: an azimuth, up, N10E, L",
        list[str],
    ),
    "one_component": ONE_COMPONENT,
    "sample": Option("sample_record", SAMPLE, str),
    "units": UNITS,
    "step": STEP,
    "scale": Option("scale", "factor of a record"),
    "rotation": Option("rotation", "rotation of a record about the vertical", unit="rad"),
    "tail": Option("tail", "free vibration time after a record", unit="s"),
}
RECORD = Group.of(
    "Record",
    *(replace(one, part="motion", number=number, kinds=("record",)) for number, one in _RECORD_OPTIONS.items()),
)
COMPUTING = Group.of(
    "Computing",
    Option("resume", "continue the store of --output", bool, default=False),
    Option("executor", "threads (by default), dask:// (workers here) or dask://host:port?wait=seconds", str),
    Option("threads", "number of threads; all cores by default", int),
)
FIGURE = Option("figure", "draw into this file (.png, .pdf, .svg, or .html to zoom and hover)", Path)
JSON = Option("as_json", "print JSON instead of a table", bool, flag="--json", default=False)
OUTPUT = Group.of("Output", FIGURE, Option("output", "save the result as netCDF (.nc)", Path), JSON)
OUTPUT_OR_STORE = Group.of(
    "Output",
    FIGURE,
    Option("output", "save the result as netCDF (.nc), or in a store (.zarr) for --resume", Path),
    JSON,
)
