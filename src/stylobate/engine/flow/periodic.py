"""Flow of the equations over a period of the base motion, with its derivatives."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cache
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import BaseMotion
from stylobate.compiler.compiled import Compiled
from stylobate.compiler.programs import Bound, Written
from stylobate.compiler.unit import ArrayArgument
from stylobate.compiler.values import NumberKind
from stylobate.engine import dop853, elementary
from stylobate.engine.ensembles.run_columns import terms_of
from stylobate.engine.expressions import Expression, Recording, recorded
from stylobate.engine.flow import integration
from stylobate.engine.flow.integration import FlowLog, FlowStatus
from stylobate.engine.forcing import common_line
from stylobate.engine.parameters import present_value, with_parameters
from stylobate.equality import ByContent
from stylobate.errors import StylobateError, UnsupportedError
from stylobate.models import Model

_VECTOR = 8
"""Maximum number of floats in a vector of a processor."""


def flow_of(model: type[Model], states: int, numbers: int, *, planar: bool) -> Compiled:
    """Return the flow of a class of models with these numbers of states and parameters, three-dimensional or planar.

    Its first call raises `UnsupportedError` if the equations cannot be differentiated.
    """
    rates = model.planar_rates if planar else model.rates
    if rates is None:
        raise UnsupportedError(f"model {model.name} has no equations of planar motion")
    loses = planar and model.impact_map is not None
    needed = ["impact_map", "from_plane", "tilt_of"] if loses else [] if planar else ["tilt_of"]
    functions: dict[str, Callable[..., Any]] = {"rates": rates, **{name: getattr(model, name) for name in needed}}
    if not planar and model.jacobian is not None:
        functions["jacobian"] = model.jacobian
    return _flow(model, tuple(functions.items()), states, numbers, planar=planar, loses=loses)


@cache
def _flow(
    model: type[Model],
    functions: tuple[tuple[str, Callable[..., Any]], ...],
    states: int,
    numbers: int,
    *,
    planar: bool,
    loses: bool,
) -> Compiled:
    order, accelerations = (2, 2) if planar else (states, 3)
    of_model = dict(functions)

    def jacobian() -> Written | None:
        if "jacobian" in of_model:
            return None
        return Written(_jacobian_source(of_model["rates"], order, accelerations, numbers, planar=planar))

    vector, terms = ArrayArgument((numbers,)), ArrayArgument((None, 1 + 2 * accelerations))
    return Compiled(
        name="flow",
        program=lambda: Bound(
            modules=[integration],
            names={
                "ORDER": order,
                "COLUMNS": columns_of(order),
                "ACCELERATIONS": accelerations,
                "NUMBERS": numbers,
                "PLANAR": planar,
                "LOSES": loses,
            },
            written=jacobian(),
            imported=[dop853, elementary],
        ),
        functions=of_model,
        arguments=(
            ArrayArgument((order, columns_of(order))),
            *[NumberKind.FLOAT] * 3,
            terms,
            vector,
            ArrayArgument((1 + numbers,)),
            terms,
            ArrayArgument((4,)),
            ArrayArgument((5,)),
        ),
        model=model.name,
        description=f"{model.name}, flow in {'plane' if planar else 'space'} with its derivatives",
    )


def columns_of(order: int) -> int:
    """Return the number of columns of state and derivatives in whole vectors."""
    return _VECTOR * math.ceil((order + 2) / _VECTOR)


def _jacobian_source(rates: Callable[..., Any], states: int, accelerations: int, numbers: int, *, planar: bool) -> str:
    """Return the source of `jacobian`, which computes the derivatives of the recorded rates."""
    state = [f"y{j}" for j in range(states)]
    rest = [*(f"a{k}" for k in range(accelerations)), *(f"p{j}" for j in range(numbers))]
    arguments = [*state, *(["side"] if planar else []), *rest]
    record = Recording()
    inputs = {name: record.input(name) for name in arguments}
    results = [record.known(result) for result in recorded(rates, tuple(inputs.values()))]
    variables: list[Expression] = [inputs[name] for name in (*state, *rest)]
    table = record.derivatives(results, variables)
    lines, names = record.source([entry for row in table for entry in row])
    columns = len(variables)
    rows = [f"({', '.join(names[i * columns : (i + 1) * columns])})" for i in range(states)]
    body = "\n".join(f"    {line}" for line in [*lines, f"return {', '.join(rows)}"])
    return f"import math\n\n\ndef jacobian({', '.join(arguments)}):\n{body}\n"


Floats = npt.NDArray[np.float64]

LOST_TILT = 1e-6
"""Tilt [units of c] below which the direction of lean, and with it the orbit, is lost."""

# Samples per period for a base motion that is not a sum of harmonics, and the relative size below which its Fourier
# coefficients must fall by half of the highest order.
_SAMPLES, _LEFT_OUT = 512, 1e-12
_HARMONIC = 1e-9
# Derivatives of the dimensionless numbers with respect to a named parameter: five-point differences with this step,
# relative except for angles. Their accuracy is about 1e-12, because the numbers are closed forms of the parameter.
_STEP = 1e-3
_CENTRAL = {-2.0: 1.0, -1.0: -8.0, 1.0: 8.0, 2.0: -1.0}
_FORWARD = {0.0: -25.0, 1.0: 48.0, 2.0: -36.0, 3.0: 16.0, 4.0: -3.0}
_BACKWARD = {-offset: -weight for offset, weight in _FORWARD.items()}
_ANGLES = ("phase_difference", "rotation", "start_phase")


@dataclass(frozen=True, slots=True, eq=False)
class FlowNumbers(ByContent):
    """Inputs of the flow: the period, the parameters of the model, and the harmonic terms of the base motion [g].

    `terms` has a row for each term: its multiple of the frequency, then coefficients of cosine and sine for each axis.
    """

    period: float
    parameters: Floats
    terms: Floats


@dataclass(frozen=True, slots=True, eq=False)
class Flow(ByContent):
    """Result of the flow: final state, its derivatives with respect to the start and a parameter, and extremes.

    `turns` counts the turns of the tilt vector about the vertical; it is 0 in planar motion.
    """

    status: FlowStatus
    end: Floats
    by_start: Floats
    by_parameter: Floats
    minimum_tilt: float
    peak_tilt: float
    steps: int
    side: float
    turns: float


@dataclass(frozen=True, slots=True, eq=False)
class PeriodicSystem(ByContent):
    """Model under a periodic base motion.

    Parameters
    ----------
    model, motion
        The column and its base motion.
    line
        Unit vector of the vertical plane of the motion; None for three-dimensional motion.
    rtol
        Relative tolerance of the flow; the absolute tolerance is rtol × 0.01 c.
    """

    model: Model
    motion: BaseMotion
    line: tuple[float, float] | None = None
    rtol: float = 1e-12
    numbers: FlowNumbers = field(init=False, repr=False)
    safe_tilt: float = field(init=False, repr=False)
    """Point of no return for any periodic motion, at most a right angle."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "numbers", _numbers(self.model, self.motion, self.line))
        gravity = self.model.column.gravity
        largest, least = self.motion.peak_horizontal(0.0) / gravity, self.motion.vertical_range(0.0)[0] / gravity
        object.__setattr__(self, "safe_tilt", min(self.model.least_safe_tilt(largest, least), 0.5 * math.pi))

    @property
    def order(self) -> int:
        """Number of equations."""
        return 2 if self.planar else len(self.model.state_names)

    @property
    def planar(self) -> bool:
        """Whether the motion is planar."""
        return self.line is not None

    @property
    def scale(self) -> float:
        """Slenderness c, the unit of tilts and their rates."""
        return self.model.column.slenderness

    def changed(self, **values: float) -> Self:
        """Return the system with these parameters of column, model or motion changed; see `with_parameters`."""
        model, motion = with_parameters(self.model, self.motion, **values)
        return replace(self, model=model, motion=motion)

    def value_of(self, name: str) -> float:
        """Return the present value of a parameter that `changed` accepts."""
        return present_value(self.model, self.motion, name)

    def image(self, sense: float) -> Floats:
        """Return the factors, shape (order,), from a state to its opposite, or ones for `sense` +1.

        The opposite state is rotated by half a turn about the vertical: the tilt vector changes its sign, the spin does
        not.
        """
        factors = np.full(self.order, sense)
        if self.model.spin_state is not None and not self.planar:
            factors[self.model.spin_state] = 1.0
        return factors

    def derivative(self, name: str, at: float | None = None) -> FlowNumbers:
        """Return the derivatives of the numbers with respect to `name` at the value `at`; present value by default."""
        value = self.value_of(name) if at is None else at
        step = _STEP * (1.0 if name in _ANGLES or value == 0.0 else abs(value))
        around, weights = self._around(name, value, step)

        def combined(part: Callable[[FlowNumbers], Any]) -> Any:
            return sum(weight * part(numbers) for weight, numbers in zip(weights, around, strict=True)) / (12.0 * step)

        terms = combined(lambda numbers: numbers.terms)
        terms[:, 0] = self.numbers.terms[:, 0]
        return FlowNumbers(
            float(combined(lambda numbers: numbers.period)), combined(lambda numbers: numbers.parameters), terms
        )

    def _around(self, name: str, value: float, step: float) -> tuple[list[FlowNumbers], list[float]]:
        """Return the numbers at values around `value`, or on one side of it at an edge, and the difference weights."""
        *inner, last = (_CENTRAL, _FORWARD, _BACKWARD)
        for rule in inner:
            try:
                return [self.changed(**{name: value + k * step}).numbers for k in rule], list(rule.values())
            except StylobateError:  # at the edge of the valid range, such as no friction or no loss
                continue
        return [self.changed(**{name: value + k * step}).numbers for k in last], list(last.values())

    def carry(
        self,
        state: Floats,
        begin: float,
        end: float,
        *,
        change: FlowNumbers | None = None,
        side: float = 0.0,
        peak_tilt: float | None = None,
    ) -> Flow:
        """Integrate `state` from `begin` to `end`, in turns of the base motion.

        Parameters
        ----------
        state
            Shape (order,), in units of the model; tilt and rate along the line if planar.
        begin, end
            Phases, in turns.
        change
            Derivatives of the numbers with respect to a parameter, see `derivative`.
        side
            Side of the vertical (±1) on which planar motion begins; by default the sign of the tilt, or of its rate.
        peak_tilt
            Tilt at which the integration stops; the point of no return by default.
        """
        order, numbers = self.order, self.numbers
        flow = flow_of(type(self.model), len(self.model.state_names), len(self.model.parameters), planar=self.planar)
        table = np.zeros((order, columns_of(order)))
        table[:, 0] = state
        table[:, 1 : order + 1] = np.eye(order)
        if change is None:
            change = FlowNumbers(0.0, np.zeros_like(numbers.parameters), np.zeros_like(numbers.terms))
        limits = np.array(
            [
                self.rtol,
                0.01 * self.rtol * self.scale,
                max(LOST_TILT * self.scale, self.model.loss_tilt),
                self.safe_tilt if peak_tilt is None else peak_tilt,
            ]
        )
        if self.planar and side == 0.0:
            side = math.copysign(1.0, state[0] if state[0] != 0.0 else state[1])
        record = np.zeros(len(FlowLog))
        record[FlowLog.LEAST_TILT], record[FlowLog.SIDE] = math.inf, side
        status = flow(
            table,
            begin,
            end,
            numbers.period,
            numbers.terms,
            numbers.parameters,
            np.concatenate([[change.period], change.parameters]),
            change.terms,
            limits,
            record,
        )
        return Flow(
            FlowStatus(status),
            table[:, 0].copy(),
            table[:, 1 : order + 1].copy(),
            table[:, order + 1].copy(),
            float(record[FlowLog.LEAST_TILT]),
            float(record[FlowLog.PEAK_TILT]),
            int(record[FlowLog.STEPS]),
            float(record[FlowLog.SIDE]),
            float(record[FlowLog.TURNS]),
        )


def require_periodic(motion: BaseMotion) -> float:
    """Return the period of a base motion [s].

    Raises
    ------
    UnsupportedError
        If the motion has no period, or is not periodic from t = 0.
    """
    period = motion.period
    if period is None:
        raise UnsupportedError(f"periodic orbits need a base motion with a period, got {motion!r}")
    if motion.breaks:
        raise UnsupportedError(
            f"periodic orbits need a base motion that is periodic from t = 0, without ramp or delay; got {motion!r}"
        )
    return period


def _numbers(model: Model, motion: BaseMotion, line: tuple[float, float] | None) -> FlowNumbers:
    period = require_periodic(motion)
    gravity = model.column.gravity
    rows = _harmonic_rows(motion, period)
    if rows is None:
        rows = _sampled_rows(motion, period)
    table = np.array([[multiple, *np.ravel(pairs) / gravity] for multiple, pairs in rows]).reshape(len(rows), 7)
    if line is not None:
        along = line[0] * table[:, 1:3] + line[1] * table[:, 3:5]
        table = np.concatenate([table[:, :1], along, table[:, 5:7]], axis=1)
    return FlowNumbers(period / model.time_scale, np.array(model.parameters, dtype=float), np.ascontiguousarray(table))


def _harmonic_rows(motion: BaseMotion, period: float) -> list[tuple[float, Floats]] | None:
    """Return multiples of the frequency with coefficients of cosine and sine along x, y, z [m/s²], shape (3, 2)."""
    terms = terms_of(motion)
    if terms is None:
        return None
    rows = []
    for term in terms:
        multiple = term.angular_frequency * period / (2.0 * math.pi)
        if abs(multiple - round(multiple)) > _HARMONIC * max(multiple, 1.0):
            return None
        turned = (np.array(term.amplitude) @ [1.0, 1j]) * np.exp(1j * term.phase_at_start)
        rows.append((float(round(multiple)), np.stack([turned.real, -turned.imag], axis=-1)))
    return rows


def _sampled_rows(motion: BaseMotion, period: float) -> list[tuple[float, Floats]]:
    """Return the Fourier series of a base motion that is not a sum of harmonics."""
    time = period * np.arange(_SAMPLES) / _SAMPLES
    series = np.fft.rfft(motion.acceleration(time), axis=0) / _SAMPLES
    size = np.abs(series).max(axis=1)
    if size[_SAMPLES // 4 :].max() > _LEFT_OUT * size.max():
        raise UnsupportedError(
            "periodic orbits need a smooth base motion: the Fourier series of this one is not below 1e-12 of its "
            f"largest term after {_SAMPLES // 4}; got {motion!r}"
        )
    chosen = np.nonzero(size > 1e-16 * size.max())[0]
    chosen = chosen[chosen < _SAMPLES // 4]
    factor = np.where(chosen == 0, 1.0, 2.0)[:, np.newaxis]
    pairs = np.stack([factor * series[chosen].real, -factor * series[chosen].imag], axis=-1)
    return [(float(multiple), pair) for multiple, pair in zip(chosen, pairs, strict=True)]


def plane_of(model: Model, motion: BaseMotion, state: Floats) -> tuple[float, float] | None:
    """Return the line of the vertical plane of state and base motion, or None if they are not in one plane."""
    if model.planar_rates is None:
        return None
    x, y, vx, vy = (float(number) for number in model.tilt_of(*state, *model.parameters))
    return common_line((x, y), (vx, vy), *motion.directions())
