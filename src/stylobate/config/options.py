"""Options: the description of a case as words of a command line, declared once, in groups that commands share.

Columns, models and base motions have an option for their kind, and one for each of their declared numbers.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any, get_args, get_origin

from stylobate.errors import FileError, ParameterError
from stylobate.files import file_of
from stylobate.kinds import loaded
from stylobate.quantities import Parameter, parameters_of
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
        count = numbers_in(self.type)
        texts = value if count else value[1:3] if self.type is _AXIS else ()
        if not all(map(is_number, texts)):
            wanted = f"{count} numbers" if count else self.metavar
            raise ParameterError(f"{self.written_flag} must be followed by {wanted}; one of them is not a number")
        return tuple(map(self._number, value)) if count else value

    def _number(self, text: Any) -> Any:
        if text in self.words or not isinstance(text, str):
            return text
        try:
            return read(text, self.unit)
        except UnitError as error:
            problem = f"must be a number or {listed(self.words)}, got {text!r}" if self.words else str(error)
            raise ParameterError(f"{self.written_flag} {problem}") from None


def numbers_in(kind: Any) -> int:
    """Count the numbers that an option takes, all in its unit; 0 for an option that takes other values too."""
    parts = get_args(kind) if get_origin(kind) is tuple else (kind,)
    return len(parts) if set(parts) == {float} else 0


@dataclass(frozen=True, slots=True)
class Chosen:
    """The kinds that a command line and its file choose.

    Parameters
    ----------
    kinds
        Kinds by part, "model" or "motion"; a part without a chosen kind is missing.
    classes
        User-defined classes among these kinds, by part.
    """

    kinds: Mapping[str, str] = field(default_factory=dict)
    classes: Mapping[str, Any] = field(default_factory=dict)

    @classmethod
    def of(cls, kinds: Mapping[str, str], folder: Path = Path()) -> "Chosen":
        """Load user-defined classes among these kinds, such as "mine.py:Tethered"; paths are relative to `folder`.

        Raises
        ------
        ParameterError
            If a file has no such class.
        """
        if not any(":" in kind for kind in kinds.values()):
            return cls(kinds)
        from stylobate.base_motions.declared import MOTIONS
        from stylobate.kinds import with_places
        from stylobate.models.declared import MODELS

        registries = {"model": MODELS, "motion": MOTIONS}
        placed = {part: with_places({"kind": kind}, folder)["kind"] for part, kind in kinds.items()}
        return cls(placed, {part: registries[part][kind] for part, kind in placed.items() if ":" in kind})


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


def run_numbers(group: type, panel: str = "Run") -> Group:
    """Make the options of a group of declared numbers, such as `stylobate.run_arguments.SingleRun`."""

    def made(_: Chosen) -> Iterable[Option]:
        from stylobate.run_arguments import numbers_of

        for name, parameter in numbers_of(group).items():
            unit = parameter.quantity.unit
            yield Option(name, text_of(parameter), type_of(parameter), panel=panel, unit=unit)

    return Group(made)


def type_of(parameter: Parameter) -> Any:
    """Determine the type of the values of an option from its declaration."""
    if parameter.quantity.components > 1:
        return tuple[(float,) * parameter.quantity.components]  # type: ignore[misc]
    if parameter.annotation is str or any(isinstance(choice, str) for choice in parameter.choices):
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
        numbers = default if isinstance(default, tuple) else (default,)
        text += f"; {listed([one if isinstance(one, str) else f'{one:g}' for one in numbers], 'and')} by default"
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
        if not file_of(path).is_file():
            raise FileError(f"cannot read {path}: No such file or directory")
    return paths


AXES = Group.of(
    "Axes",
    Option("x", "values along x: name, first, last, number", _AXIS, metavar="NAME FROM TO NUMBER"),
    Option("y", "values along y: name, first, last, number", _AXIS, metavar="NAME FROM TO NUMBER"),
    Option("x_spacing", "linear (by default) or log", str),
    Option("y_spacing", "linear (by default) or log", str),
)
SCALES = Group.of(
    "Axes",
    Option(
        "scales",
        "factors of the base motion: first, last, number",
        tuple[float, float, int],
        metavar="FROM TO NUMBER",
    ),
    Option("scales_spacing", "log (by default) or linear", str),
)
UNITS = Option("units", "unit of files that do not state it: g, m/s2 or cm/s2", str)
STEP = Option("step", "time step of files that do not state it", unit="s")
EARLY_END = Group.of(
    "Run",
    Option("end_converged", "end converged runs early: circular motion, 300 periods or more", bool),
)
RESPONSE = Option("response", "StationXML that converts counts of waveform files to accelerations", str)
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
    "response": RESPONSE,
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
OUTPUT = Group.of(
    "Output", FIGURE, Option("output", "save the result as netCDF (.nc), or as a table (.csv, .xlsx)", Path), JSON
)
OUTPUT_OR_STORE = Group.of(
    "Output",
    FIGURE,
    Option(
        "output", "save the result as netCDF (.nc), in a store (.zarr) for --resume, or as a table (.csv, .xlsx)", Path
    ),
    JSON,
)


# Two numbers of these names share one option: the model uses the option if it has the number, otherwise the run.
_OF_MODEL_OR_RUN = ("friction_coefficient",)
# --velocity is the initial velocity of the column.
_RENAMED = {("motion", "velocity"): "pulse_velocity"}


@dataclass(frozen=True, slots=True)
class Part:
    """A part of a configuration that has kinds.

    Parameters
    ----------
    table
        Name of the table in a file, such as "column".
    tag
        The key in this table that chooses the kind.
    flag
        The option that chooses the kind, without hyphens.
    noun
        Name of the part in messages.
    place
        Module and name of the registry of classes or constructors; imported on first use.
    """

    table: str
    tag: str
    flag: str
    noun: str
    place: str

    @property
    def kinds(self) -> tuple[str, ...]:
        """All kinds that the package has."""
        return tuple(loaded(self.place))

    def makers(self) -> dict[str, Callable[..., Any]]:
        """Return the class or constructor of each kind that has declared numbers and options for them."""
        others = kinds_in_files()
        return {kind: make for kind, make in loaded(self.place).items() if kind not in others and parameters_of(make)}


_MOTIONS = "stylobate.base_motions.declared"


def _motions_by(function: str) -> tuple[str, ...]:
    kinds: tuple[str, ...] = loaded(f"{_MOTIONS}:{function}")()
    return kinds


kinds_in_files = partial(_motions_by, "composite_kinds")
"""Returns the kinds of base motion that combine others: no options state their numbers."""

PARTS = {
    "column": Part("column", "shape", "shape", "column shape", "stylobate.column.shapes:SHAPES_WITH_OPTIONS"),
    "model": Part("model", "kind", "model", "model", "stylobate.models.declared:MODELS"),
    "motion": Part("motion", "kind", "motion", "base motion", f"{_MOTIONS}:MOTIONS"),
}


def part_group(
    part: Part,
    panel: str,
    *,
    kinds: Callable[[], tuple[str, ...]] | None = None,
    left_out: tuple[str, ...] = (),
    default: str = "",
) -> Group:
    """Make the options of a part: one for the kind, and one for each number.

    Parameters
    ----------
    part
        The part.
    panel
        Heading of the help.
    kinds
        Function that returns the kinds of a command; by default all kinds except `left_out`.
    default
        Text after the kinds in the help.
    """

    def made(chosen: Chosen) -> Iterable[Option]:
        makers, in_files = part.makers(), kinds_in_files()
        if part.table in chosen.classes:
            makers[chosen.kinds[part.table]] = chosen.classes[part.table]
        known = part.kinds if kinds is None else kinds()
        offered = tuple(kind for kind in known if kind not in (*in_files, *left_out))
        others = f"; in a file also {listed(in_files)}" if part.table == "motion" and kinds is None else ""
        text = f"{listed(offered)}{default}{others}"
        yield Option(part.flag, text, str, panel=panel, part=part.table, number=part.tag, kinds=offered)
        shown = {*offered, *chosen.kinds.values()}
        declared = {kind: parameters_of(make) for kind, make in makers.items()}
        for number in dict.fromkeys(name for numbers in declared.values() for name in numbers):
            having = {kind: numbers[number] for kind, numbers in declared.items() if number in numbers}
            if shown & having.keys():
                some = tuple(kind for kind in having if kind in shown)
                only = some if len(some) <= MAX_NAMED_KINDS and len(some) < len(shown & makers.keys()) else ()
                yield _option(part, number, having, chosen.kinds.get(part.table, ""), panel, only)

    return Group(made)


def _option(
    part: Part, number: str, having: Mapping[str, Parameter], chosen: str, panel: str, only: tuple[str, ...]
) -> Option:
    """Make the option of a number of some kinds, from the declaration of the `chosen` kind, if any."""
    parameter = having.get(chosen) or next(iter(having.values()))
    types = {type_of(one) for one in having.values() if one.quantity.components == parameter.quantity.components}
    return Option(
        _RENAMED.get((part.table, number), number),
        text_of(parameter, only),
        types.pop() if len(types) == 1 else float,
        panel=panel,
        part=part.table,
        number=number,
        kinds=tuple(having),
        unit=parameter.quantity.unit,
        words=tuple(parameter.quantity.by_word),
    )


COLUMN = part_group(PARTS["column"], "Column", default="; by default the shape that the other numbers imply")
_WOBBLING = " (wobbling by default), or FILE.py:CLASS"
MODEL = part_group(PARTS["model"], "Model", default=_WOBBLING)
MODEL_OF_STEADY_ROLLING = part_group(PARTS["model"], "Model", default=" (slender by default), or FILE.py:CLASS")
MODEL_WITHOUT_SLIDING = part_group(PARTS["model"], "Model", left_out=("sliding",), default=_WOBBLING)
SLIDING = part_group(PARTS["model"], "Model", kinds=lambda: ("sliding",))
MOTION = part_group(PARTS["motion"], "Base motion", default=" (rest by default), or FILE.py:CLASS")
MOTION_WITHOUT_RECORDS = part_group(
    PARTS["motion"], "Base motion", default=" (rest by default), or FILE.py:CLASS", left_out=("record",)
)
HORIZONTAL_MOTION = part_group(
    PARTS["motion"], "Base motion", kinds=partial(_motions_by, "kinds_by_acceleration")
).without("angular_frequency", "start_phase", "ramp")


def joined(groups: Iterable[Iterable[Option]]) -> list[Option]:
    """Join the options of groups; a number with the name of another option gets its part as a prefix."""
    result: dict[str, Option] = {}
    for option in (one for group in groups for one in group):
        name = option.name
        if name in result and name in _OF_MODEL_OR_RUN:
            result[name] = replace(result[name], part=option.part, number=option.number, kinds=option.kinds)
        elif name in result:
            result[f"{option.part}_{name}"] = replace(option, name=f"{option.part}_{name}")
        else:
            result[name] = option
    return list(result.values())
