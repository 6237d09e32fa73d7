"""What a study declares of itself: its description in files, its options, and how its result is shown.

From it follow the description (`study_config`) and the command (`stylobate.cli.study`).
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, get_args, get_origin

from stylobate.config.options import (
    AXES,
    COLUMN,
    COMPUTING,
    EARLY_END,
    MODEL,
    MOTION,
    OUTPUT_OR_STORE,
    RECORD,
    SCALES,
    Group,
    Option,
    run_numbers,
    text_of,
)
from stylobate.errors import ParameterError
from stylobate.quantities import Parameter, parameters_of
from stylobate.results.plain import plain_variables
from stylobate.run_arguments import SharedByRuns

if TYPE_CHECKING:
    import xarray as xr

    from stylobate.results.tables import ResultTable


Complete = Callable[["xr.Dataset", Callable[[], Any], Mapping[str, Any]], "xr.Dataset"]


@dataclass(frozen=True, slots=True)
class Classes:
    """Variables of a result that divide its runs into classes: the code of each run, names and shares of the classes.

    A code is the index of its class. A share can have an interval, in variables that end in `_low` and `_high`.
    """

    codes: str
    names: str
    share: str = "share"


@dataclass(frozen=True, slots=True, kw_only=True)
class Instead:
    """A study that a command computes in place of its own.

    Parameters
    ----------
    key, text
        Key of the table, and option of the command, that ask for this study; and the help of the option.
    place
        Place of its function, such as "stylobate.earthquakes:rocking_spectrum".
    kind
        Kind of its results.
    """

    key: str
    text: str
    place: str
    kind: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Study:
    """The declaration of a study; its own numbers are those that the signature of its function declares.

    Parameters
    ----------
    name
        Name of the command, and of the table of the study in a description.
    source, help
        Help of the positional argument of the command, and of the command.
    table, summary
        Functions that return a result as a table, and the study's own part of it as plain values for JSON.
    axes
        Places of the axes in the table: "x" and "y"; "y?" can be left out.
    scales
        Whether the table has factors of the base motion.
    starts
        Whether only initial conditions vary, on the grid of the axes, or drawn at random.
    early
        Whether runs can end early once they have converged to steady rolling.
    numbers
        A group of further numbers of all runs, such as `Stroboscopic`.
    without
        Arguments of all runs that the study sets itself, each with the reason and the remedy; without a reason, the
        argument is ignored.
    renamed
        Options whose argument has another name: the option by the name of the argument.
    instead
        A study that the command computes in place of this one.
    usual
        Values that a description can leave out.
    model, motion
        Options of the model and of the base motion.
    records
        Whether the base motion can be a record.
    kinds
        Kinds of saved results that the command shows, by default all; the store of such a study has bare runs.
    classes
        Classes of the runs, of which the first that a result has count. A study with classes over the axes x and y
        (`stylobate.studies.GRIDS`) is a job of the laboratory too, and a tab of its page.
    completed
        Function that completes a saved result, such as the bare runs of a store. Its arguments are the result, a
        function that builds its description, and the options of the command.
    arguments
        Function that completes the keyword arguments of the study from the description and the built objects.
    repeated
        Function that completes the values that repeat a saved result, from its provenance.
    """

    name: str
    source: str
    help: str
    table: "Callable[[xr.Dataset], ResultTable]"
    summary: "Callable[[xr.Dataset], dict[str, Any]]"
    axes: tuple[str, ...] = ()
    scales: bool = False
    starts: bool = False
    early: bool = False
    numbers: type | None = None
    without: Mapping[str, str] = field(default_factory=dict)
    renamed: Mapping[str, str] = field(default_factory=dict)
    instead: Instead | None = None
    usual: Mapping[str, Any] = field(default_factory=dict)
    model: Group = MODEL
    motion: Group = MOTION
    records: bool = True
    kinds: tuple[str, ...] = ()
    classes: tuple[Classes, ...] = ()
    completed: Complete = lambda saved, *_: saved
    arguments: Callable[[Any, Any], Mapping[str, Any]] = lambda *_: {}
    repeated: Callable[[Mapping[str, Any], dict[str, Any]], dict[str, Any]] = lambda _, values: values

    @property
    def places(self) -> tuple[str, ...]:
        """The places of the axes."""
        return tuple(place.rstrip("?") for place in self.axes)

    @property
    def groups(self) -> Iterator[Group]:
        """The options that the study shares with others."""
        if self.places:
            yield AXES
        if self.scales:
            yield SCALES
        if self.starts:
            yield RANDOM
        yield run_numbers(SharedByRuns).without(*self.without)
        if self.numbers is not None:
            yield run_numbers(self.numbers)
        if self.early:
            yield EARLY_END
        yield from (COLUMN, self.model, self.motion)
        if self.records:
            yield RECORD
        yield from (COMPUTING, OUTPUT_OR_STORE)


@dataclass(frozen=True, slots=True, kw_only=True)
class Analysis:
    """The declaration of a study that is computed at once: without store, executor and resumption.

    The numbers that the signature of its function declares form a table of its name in descriptions.

    Parameters
    ----------
    name
        Name of the command, and of the table of the study in a description.
    source, help
        Help of the positional argument of the command, and of the command.
    groups
        Options of the command besides those of the study's own numbers.
    renamed
        Options whose argument has another name: the option by the name of the argument.
    numbers
        Group of the numbers at the top of a description, such as `OneRun`.
    arguments
        Function that makes the keyword arguments of the study from the description and the built objects.
    tables, summary
        Functions that return a result as tables, and as plain values for JSON.
    steady
        Whether the case is that of steady rolling: see `SteadyCase`.
    read
        Function that completes the plain values of a description before they are validated.
    problems
        Function that returns a line for each invalid number of a description.
    chosen
        Function that checks the options of the command, and returns arguments that the description leaves open.
    instead
        A study that the command computes in place of this one.
    """

    name: str
    source: str
    help: str
    groups: tuple[Group, ...]
    numbers: type
    arguments: Callable[[Any, Any], Mapping[str, Any]]
    tables: "Callable[[xr.Dataset], Sequence[ResultTable]]"
    summary: "Callable[[xr.Dataset], dict[str, Any]]" = plain_variables
    steady: bool = False
    read: Callable[[Mapping[str, Any]], Mapping[str, Any]] = lambda values: values
    problems: Callable[[Any], Sequence[str]] = lambda _: ()
    chosen: Callable[[Mapping[str, Any]], Mapping[str, Any]] = lambda _: {}
    renamed: Mapping[str, str] = field(default_factory=dict)
    instead: Instead | None = None


RANDOM = Group.of(
    "Initial conditions",
    Option("random", "number of initial conditions to draw in the ranges --over", int),
    Option("seed", "seed of the draw; 0 by default", int),
    Option(
        "over",
        "range of an initial condition that is drawn; repeat it",
        list[tuple[str, str, str]],
        metavar="NAME LOW HIGH",
    ),
)


def study_of(function: Callable[..., Any]) -> Any:
    """Return the declaration of a study, a `Study` or an `Analysis`.

    Raises
    ------
    ParameterError
        If the function is no declared study.
    """
    found = getattr(function, "study", None)
    if not isinstance(found, (Study, Analysis)):
        raise ParameterError(
            f"study: no study with a description (got {function!r}). Name one such as overturning_map."
        )
    return found


def declared_numbers(function: Callable[..., Any]) -> Mapping[str, Parameter]:
    """Return the numbers that a study declares in its signature, by name, such as a tolerance."""
    return parameters_of(function)


def own_options(function: Callable[..., Any]) -> dict[str, Option]:
    """Make the options of the own keys in the table of a study, by key."""
    study = study_of(function)
    own = {
        name: Option(study.renamed.get(name, name), text_of(one), _kind(one), unit=one.quantity.unit)
        for name, one in declared_numbers(function).items()
    }
    other = study.instead
    return own if other is None else own | {other.key: Option(other.key, other.text, bool)}


def several(number: Parameter) -> bool:
    """Return whether an argument takes any number of values."""
    return any(get_origin(kind) is Sequence for kind in (number.annotation, *get_args(number.annotation)))


def _kind(number: Parameter) -> Any:
    return list[float] if several(number) else str if number.annotation is str else int if number.whole else float
