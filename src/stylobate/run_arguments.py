"""The arguments of a run, each declared once: type, unit, bounds, meaning and default.

`simulate`, `simulate_ensemble`, sweeps, studies, descriptions, options and the laboratory take them from here: a new
argument is a line here, and the law where it acts.
"""

import inspect
from collections.abc import Callable, Container, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, wraps
from textwrap import wrap
from typing import Annotated, Any, Literal, ParamSpec, TypedDict, TypeVar, cast, get_args, get_type_hints

from stylobate.errors import MOST_STEPS, ParameterError, refuse_unknown_arguments
from stylobate.quantities import QUARTER_TURN, Parameter, Quantity, parameter_of
from stylobate.results import OutcomeRules
from stylobate.results.known_orbits import KnownOrbits

_P = ParamSpec("_P")
_T = TypeVar("_T")

RTOL_RANGE = (1e-13, 1e-2)
"""Range of relative tolerances: the rounding of a step, and the largest one with two digits."""


FREE_TAIL = 20.0
"""Default free-vibration time in 1/`column.frequency_parameter`; deviations grow by up to e²⁰ meanwhile."""


def duration_with_tail(motion_duration: float, frequency_parameter: float) -> float:
    """Compute the default duration of a run under a base motion that ends [s]: the motion and a tail of 20/p."""
    return motion_duration + FREE_TAIL / frequency_parameter


@dataclass(frozen=True, slots=True)
class Argument:
    """Default of an argument, and its meaning in sentences; without a default the argument is required.

    An argument that ends runs, such as a limit of the tilt, leaves it open whether they overturn.
    """

    default: Any = inspect.Parameter.empty
    says: str = ""
    ends_runs: bool = False


class InitialConditions(TypedDict, total=False):
    """The initial conditions that all models share."""

    tilt: Annotated[
        Sequence[float],
        Quantity(unit="rad", text="initial tilt vector", gt=-QUARTER_TURN, lt=QUARTER_TURN, components=2),
        Argument(
            (0.0, 0.0), "Initial tilt vector [rad]: it points to where the column leans; its length is the tilt angle."
        ),
    ]
    tilt_rate: Annotated[
        Sequence[float],
        Quantity(unit="rad/s", text="initial rate of the tilt vector", components=2),
        Argument((0.0, 0.0), "Initial rate of the tilt vector [rad/s]."),
    ]
    spin: Annotated[
        float,
        Quantity(unit="rad/s", text="initial angular velocity about the axis"),
        Argument(0.0, "Initial angular velocity about the axis [rad/s], for models that have it."),
    ]


class FreeStart(TypedDict, total=False):
    """The initial conditions of models that have more of them."""

    twist: Annotated[
        float,
        Quantity(unit="rad", text="initial angle of rotation about the axis"),
        Argument(0.0, "Initial angle of rotation about the axis [rad], for models that have it."),
    ]
    position: Annotated[
        Sequence[float],
        Quantity(unit="m", text="initial centre of the footprint", components=2),
        Argument(
            (0.0, 0.0),
            "Initial centre of the footprint circle in the frame of the base [m], for models that have it.",
        ),
    ]
    velocity: Annotated[
        Sequence[float],
        Quantity(unit="m/s", text="initial velocity of the lowest point", components=3),
        Argument(
            (0.0, 0.0, 0.0),
            "Initial velocity of the lowest point of the column relative to the plane [m/s], for models that can slip "
            "and fly.",
        ),
    ]
    clearance: Annotated[
        float,
        Quantity(unit="m", text="initial height of the lowest point above the base", ge=0.0),
        Argument(0.0, "Initial height of the lowest point above the plane [m], for models that can slip and fly."),
    ]


class Accuracy(TypedDict, total=False):
    """Tolerances of a run, and conditions of its end."""

    rtol: Annotated[
        float,
        Quantity(text="relative tolerance", ge=RTOL_RANGE[0], le=RTOL_RANGE[1]),
        Argument(1e-8, "Relative local error tolerance of the integrator."),
    ]
    atol: Annotated[
        float | None,
        Quantity(unit="rad", text="absolute tolerance of the tilt", gt=0.0),
        Argument(None, "Absolute local error tolerance of the tilt [rad]; 0.01 rtol c by default."),
    ]
    tilt_limit: Annotated[
        float | None,
        Quantity(unit="rad", text="tilt at which a run ends", gt=0.0, le=QUARTER_TURN),
        Argument(None, "Tilt that ends the run [rad]; none by default.", ends_runs=True),
    ]
    rest_energy: Annotated[
        float | None,
        Quantity(symbol="ε", text="energy below which a column can come to rest, in c²", ge=0.0),
        Argument(
            None,
            "Rest energy ε: with damping, a column whose energy is below ε c² comes to rest if the base motion holds "
            "it down. The default is the smaller of 1e-4 and 0.015/ν², where ν is the mean dimensionless frequency of "
            "the base motion. If the base motion can uplift the column again, the default is at most a hundredth of "
            "the energy after uplift, but not below 1e-8, or 1e-5 under a record or a brief motion.",
        ),
    ]
    max_steps: Annotated[
        int,
        Quantity(text="maximum number of integration steps", ge=1, le=MOST_STEPS.number, note=MOST_STEPS.reason),
        Argument(
            200_000,
            "Maximum number of integration steps; a longer run ends as FAILED. The log warns if more steps are "
            "expected.",
        ),
    ]
    rules: Annotated[
        OutcomeRules | None,
        Argument(None, "Thresholds that classify a motion as rolling, rocking or modulated."),
    ]


_DURATION = Quantity(unit="s", text="duration of a run", gt=0.0)
Samples = Annotated[int | None, Quantity(text="number of samples kept", ge=2)]
Method = Annotated[
    Literal["dop853", "taylor"],
    Quantity(text="integration method; taylor is faster for slender models that roll"),
]


class OneRun(InitialConditions, Accuracy, total=False):
    """The arguments of one run with any model."""

    duration: Annotated[
        float | None,
        _DURATION,
        Argument(
            None,
            "Duration of the run [s]. Under a base motion that ends, such as a record, a pulse or a sine sweep, the "
            "default is the duration of the motion and a free-vibration tail of 20/`column.frequency_parameter`. Under "
            "a periodic motion that does not end, a run without `duration` goes on until its outcome is decided, for "
            "at most 2000 periods.",
        ),
    ]
    friction_coefficient: Annotated[
        float | None,
        Quantity(
            symbol="μ",
            text="friction coefficient of column and base; a model that cannot slip warns where it needs more",
            gt=0.0,
        ),
        Argument(
            None,
            "Friction coefficient of the contact; the result warns if the run needs more friction. Models that can "
            "slip have a number of their own.",
        ),
    ]
    samples: Annotated[Samples, Argument(None, "Number of samples in `data`; by default enough to draw every swing.")]


class SingleRun(OneRun, FreeStart, total=False):
    """The arguments of `simulate` besides model, motion and events."""

    recheck: Annotated[
        bool,
        Argument(
            default=True,
            says="Repeat a run in doubt with a hundredth of the rest energy and ten times the tolerance. A run is in "
            "doubt if the column was uplifted again after rest and then overturned or tilted beyond half of its "
            "tipping angle, came back from 0.95 of its tipping angle or more, or overturned after 40/ω0 or more. If "
            "the repeated run overturns and the first one does not, or the reverse, the result is `uncertain`, and "
            "has a warning. A run that passed the vertical more than 40 times without a steady motion is repeated "
            "too; a peak tilt that changes by a tenth has a warning.",
        ),
    ]


class EnsembleOptions(Accuracy, total=False):
    """The arguments that all runs of an ensemble share, besides their start."""

    method: Annotated[
        Method,
        Argument(
            "dop853",
            'Integration of three-dimensional motion: "dop853" as in `simulate`, or "taylor", Taylor series of order '
            '16. Columns in steady rolling take less than half of the steps with "taylor". Runs that pass near the '
            'vertical, as in most maps, and all runs at finite tilt are faster with "dop853".',
        ),
    ]
    samples: Annotated[
        Samples,
        Argument(None, "Number of samples of each history, at equal times over the run; no histories by default."),
    ]
    strobes: Annotated[
        int,
        Quantity(text="number of stroboscopic samples kept, one per period", ge=0),
        Argument(
            0,
            "Number of stroboscopic samples kept, the last ones: states at which the base motion has phase zero (Ωt + "
            "start_phase a whole number of turns), one per period.",
        ),
    ]
    demands: Annotated[
        bool,
        Argument(
            default=False,
            says="Whether to compute the contact demand too; steps then take about a quarter longer.",
        ),
    ]
    recheck: Annotated[
        bool,
        Argument(
            default=False,
            says="Whether to repeat runs in doubt as `simulate` does, and to mark runs with another outcome as "
            "`uncertain`. One in six runs under earthquakes is in doubt; in three dimensions the repetition takes "
            "about as long as all runs.",
        ),
    ]


class OfEnsemble(EnsembleOptions, total=False):
    """The arguments of `simulate_ensemble` besides those that differ between the runs."""

    known_orbits: Annotated[
        KnownOrbits | None,
        Argument(
            (),
            "Stable periodic orbits to which runs may converge, each a `KnownOrbit`. A run ends early, as ROLLING or "
            "ROCKING, if its distance from such an orbit falls as the multiplier of the orbit requires; the run would "
            'then repeat at its full duration. Planar runs are not compared with orbits. See "Converged runs" on the '
            "page on ensembles.",
        ),
    ]


class RunOptions(InitialConditions, OfEnsemble, total=False):
    """Arguments of `simulate_ensemble` that all runs of a sweep share."""

    end_converged: Annotated[
        bool,
        Argument(
            default=False,
            says="Whether runs that have converged to steady rolling in closed form end early.",
        ),
    ]


class SharedByRuns(InitialConditions, Accuracy, total=False):
    """The numbers in the description of many runs."""

    duration: Annotated[float | None, _DURATION, Argument(None)]
    periods: Annotated[
        float | None, Quantity(text="duration of a run in periods of the base motion", gt=0.0), Argument(None)
    ]
    method: Annotated[Method, Argument("dop853")]


class Stroboscopic(TypedDict, total=False):
    """The numbers by which described runs are assigned to attractors."""

    strobes: Annotated[
        int | None, Quantity(text="number of stroboscopic samples kept, one per period", ge=2), Argument(None)
    ]
    confidence: Annotated[float, Quantity(text="confidence level of intervals", gt=0.0, lt=1.0), Argument(0.95)]


@dataclass(frozen=True, slots=True)
class Declaration:
    """What is declared of an argument: its type, default, meaning, and its number if it is one."""

    name: str
    kind: Any
    default: Any
    says: str
    number: Parameter | None
    ends_runs: bool

    def checked(self, value: Any) -> Any:
        """Check a value and return it in its type; None where it is allowed.

        Raises
        ------
        ParameterError
            If the value is out of range or has another type.
        """
        if self.number is not None:
            return self.number.checked(value)
        if self.kind is bool:
            return bool(value)
        if OutcomeRules in get_args(self.kind) and not isinstance(value, OutcomeRules | None):
            raise ParameterError(f"{self.name} must be OutcomeRules(...) or None, got {value!r}")
        return value


@cache
def arguments_of(group: Any) -> Mapping[str, Declaration]:
    """Return the arguments of a group, by name."""
    found = {}
    for name, hint in get_type_hints(group, include_extras=True).items():
        stated = next(one for one in hint.__metadata__ if isinstance(one, Argument))
        number = parameter_of(name, hint, stated.default)
        found[name] = Declaration(name, hint.__origin__, stated.default, stated.says, number, stated.ends_runs)
    return found


@cache
def numbers_of(group: Any) -> Mapping[str, Parameter]:
    """Return the declared numbers of a group, by name."""
    return {name: one.number for name, one in arguments_of(group).items() if one.number is not None}


@cache
def run_numbers() -> Mapping[str, Parameter]:
    """Return the declared numbers of all runs, by name."""
    groups = (SingleRun, SharedByRuns, Stroboscopic)
    return {name: parameter for group in groups for name, parameter in numbers_of(group).items()}


def defaults_of(group: Any) -> dict[str, Any]:
    """Return the defaults of a group, by name."""
    return {name: one.default for name, one in arguments_of(group).items()}


def checked_options(given: Mapping[str, Any]) -> EnsembleOptions:
    """Check the options of an ensemble among the arguments `given`, and add the defaults of the others.

    Without rules the options have the usual ones; without samples they have 0.

    Raises
    ------
    ParameterError
        If an option is out of range.
    """
    found = {name: one.checked(given.get(name, one.default)) for name, one in arguments_of(EnsembleOptions).items()}
    return cast(
        "EnsembleOptions", {**found, "rules": found["rules"] or OutcomeRules(), "samples": found["samples"] or 0}
    )


def takes(group: Any, *, described: Sequence[Any] = ()) -> Callable[[Callable[_P, _T]], Callable[_P, _T]]:
    """Let a function take the arguments of a group as keywords: with their defaults, names and meanings; a decorator.

    The function has `**run: Unpack[group]`, and a line `**run` in the parameters of its docstring, in whose place the
    arguments are `described`: those of these groups, by default all. It gets every argument of the group; an argument
    that the function declares itself replaces that of the group.
    """

    def decorated(function: Callable[_P, _T]) -> Callable[_P, _T]:
        signature = inspect.signature(function)
        own = {name: one for name, one in signature.parameters.items() if one.kind is not one.VAR_KEYWORD}
        taken = {name: one for name, one in arguments_of(group).items() if name not in own}
        defaults = {name: one.default for name, one in taken.items()}

        @wraps(function)
        def call(*arguments: _P.args, **named: _P.kwargs) -> _T:
            refuse_unknown_arguments(call, named)
            return function(*arguments, **{**defaults, **named})

        keyword = inspect.Parameter.KEYWORD_ONLY
        added = [
            inspect.Parameter(name, keyword, default=one.default, annotation=one.kind) for name, one in taken.items()
        ]
        parts = sorted([*own.values(), *added], key=lambda one: one.kind)
        call.__signature__ = signature.replace(parameters=parts)  # type: ignore[attr-defined]
        lines = "".join(_described(one, left_out=own) for one in described or (group,))
        call.__doc__ = (function.__doc__ or "").replace("    **run\n", lines)
        return call

    return decorated


def _described(group: Any, left_out: Container[str] = ()) -> str:
    """Write the arguments of a group as lines of a docstring; an argument without a meaning of its own is left out."""
    stated = (one for one in arguments_of(group).values() if one.says and one.name not in left_out)
    said = ((one.name, wrap(one.says, 112)) for one in stated)
    return "".join(f"    {name}\n" + "".join(f"        {line}\n" for line in lines) for name, lines in said)


for _group in (Accuracy, RunOptions):
    _group.__doc__ = f"{_group.__doc__}\n\n    Parameters\n    ----------\n{_described(_group)}"
