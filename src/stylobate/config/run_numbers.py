"""The numbers of a run, each declared once: fields of configurations, their checks and options follow."""

from collections.abc import Mapping
from functools import cache
from typing import Annotated, Any, Literal, get_type_hints

from stylobate.errors import MOST_NUMBERS, MOST_STEPS, Most, ParameterError, require_whole
from stylobate.quantities import QUARTER_TURN, Parameter, Quantity, parameter_of

Tilt = Annotated[
    tuple[float, float],
    Quantity(unit="rad", text="initial tilt vector", gt=-QUARTER_TURN, lt=QUARTER_TURN, components=2),
]
TiltRate = Annotated[tuple[float, float], Quantity(unit="rad/s", text="initial rate of the tilt vector", components=2)]
Spin = Annotated[float, Quantity(unit="rad/s", text="initial angular velocity about the axis")]
Twist = Annotated[float, Quantity(unit="rad", text="initial angle of rotation about the axis")]
Position = Annotated[tuple[float, float], Quantity(unit="m", text="initial centre of the footprint", components=2)]
Velocity = Annotated[
    tuple[float, float, float], Quantity(unit="m/s", text="initial velocity of the lowest point", components=3)
]
Clearance = Annotated[float, Quantity(unit="m", text="initial height of the lowest point above the base", ge=0.0)]
Duration = Annotated[float, Quantity(unit="s", text="duration of a run", gt=0.0)]
Periods = Annotated[float, Quantity(text="duration of a run in periods of the base motion", gt=0.0)]
Method = Annotated[
    Literal["dop853", "taylor"], Quantity(text="integration method; taylor is faster for columns in steady rolling")
]
FrictionCoefficient = Annotated[
    float,
    Quantity(
        symbol="μ",
        text="friction coefficient of column and base; a model that cannot slip warns where it needs more",
        gt=0.0,
    ),
]
RelativeTolerance = Annotated[float, Quantity(text="relative tolerance", gt=0.0)]
AbsoluteTolerance = Annotated[float, Quantity(unit="rad", text="absolute tolerance of the tilt", gt=0.0)]
TiltLimit = Annotated[float, Quantity(unit="rad", text="tilt at which a run ends", gt=0.0, le=QUARTER_TURN)]
RestEnergy = Annotated[float, Quantity(symbol="ε", text="energy below which a column can come to rest, in c²", ge=0.0)]
MaxSteps = Annotated[
    int, Quantity(text="maximum number of integration steps", ge=1, le=MOST_STEPS.number, note=MOST_STEPS.reason)
]
Samples = Annotated[int, Quantity(text="number of samples kept", ge=2)]
Strobes = Annotated[int, Quantity(text="number of stroboscopic samples kept, one per period", ge=2)]
Confidence = Annotated[float, Quantity(text="confidence level of intervals", gt=0.0, lt=1.0)]


class Start:
    """The initial conditions that all models share."""

    tilt: Tilt = (0.0, 0.0)
    tilt_rate: TiltRate = (0.0, 0.0)
    spin: Spin = 0.0


class Accuracy:
    """Tolerances of a run, and conditions of its end."""

    rtol: RelativeTolerance = 1e-8
    atol: AbsoluteTolerance | None = None
    tilt_limit: TiltLimit | None = None
    rest_energy: RestEnergy | None = None
    max_steps: MaxSteps = 200_000


class OneRun(Accuracy, Start):
    """The numbers of one run."""

    duration: Duration | None
    friction_coefficient: FrictionCoefficient | None = None
    samples: Samples | None = None


class SingleRun(OneRun):
    """The numbers of one run of one model, with the whole initial state."""

    twist: Twist = 0.0
    position: Position = (0.0, 0.0)
    velocity: Velocity = (0.0, 0.0, 0.0)
    clearance: Clearance = 0.0


class SharedByRuns(Accuracy, Start):
    """The numbers that many runs share."""

    duration: Duration | None = None
    periods: Periods | None = None
    method: Method = "dop853"


class Stroboscopic:
    """The numbers by which runs are assigned to attractors."""

    strobes: Strobes | None = None
    confidence: Confidence = 0.95


@cache
def numbers_of(group: type) -> Mapping[str, Parameter]:
    """Read the declared numbers of a group, by name."""
    hints = get_type_hints(group, include_extras=True)
    declared = (parameter_of(name, hint, getattr(group, name, None)) for name, hint in hints.items())
    return {one.name: one for one in declared if one is not None}


@cache
def run_numbers() -> Mapping[str, Parameter]:
    """Return the declared numbers of all runs, by name."""
    groups = (SingleRun, SharedByRuns, Stroboscopic)
    return {name: parameter for group in groups for name, parameter in numbers_of(group).items()}


def problems_of_the_numbers(values: object) -> list[str]:
    """Check the numbers of a run that `values` has as attributes; return one line for each invalid number."""
    problems: list[str] = []
    for name, parameter in run_numbers().items():
        value = getattr(values, name, None)
        if value is None:
            continue
        try:
            _check(parameter, value)
        except ParameterError as error:
            problems.append(str(error))
    return problems


def _check(parameter: Parameter, value: Any) -> None:
    name, quantity = parameter.name, parameter.quantity
    if parameter.whole:
        most = MOST_NUMBERS if quantity.le is None else Most(int(quantity.le), quantity.note)
        require_whole(name, value, least=int(quantity.ge or 0), most=most)
    else:
        parameter.checked(value)
