"""A family of periodic orbits over one parameter: its points, and its continuation by arclength."""

import logging
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from functools import cached_property

import numpy as np
import numpy.typing as npt

from stylobate.engine.flow.integration import FlowStatus
from stylobate.engine.flow.periodic import PeriodicSystem
from stylobate.equality import ByContent
from stylobate.errors import (
    Named,
    ParameterError,
    StylobateError,
    require_not_negative,
    require_positive,
    require_whole,
)
from stylobate.orbits.shooting import Shots, shots

Floats = npt.NDArray[np.float64]
Complexes = npt.NDArray[np.complex128]

_CLOSE, _MOST_STEPS = 1e-11, 12


@dataclass(frozen=True, slots=True, eq=False)
class Family(ByContent):
    """Periodic orbits of one system and one length over the parameter `name`.

    The vector u of a point has the states in units of c, and the parameter in units of `span`, the width of its range.
    """

    system: PeriodicSystem
    periods: int
    name: str
    span: float
    sense: float = 1.0

    @property
    def covered(self) -> float:
        """Periods over which shooting integrates: half of them with `sense` −1, for orbits with the inversion only."""
        return 0.5 * self.periods if self.sense < 0.0 else float(self.periods)

    def at(self, value: float) -> PeriodicSystem:
        """Return the system with this value of the parameter."""
        return self.system.changed(**{self.name: value})

    def units(self, count: int) -> Floats:
        """Return the units of u for `count` states."""
        return np.append(np.full(count, self.system.scale * np.sqrt(count)), self.span)


@dataclass(frozen=True, eq=False)
class Point(ByContent):
    """A periodic orbit of a family."""

    family: Family
    value: float
    chain: Shots

    @property
    def u(self) -> Floats:
        """Vector u of the point, in the units of the family."""
        states = self.chain.states.ravel()
        return np.asarray(np.append(states, self.value) / self.family.units(states.size))

    @cached_property
    def jacobian(self) -> Floats:
        """Derivative of the residual by u, one row fewer than columns."""
        units = self.family.units(self.chain.states.size)
        return np.column_stack([self.chain.matrix, self.chain.by_parameter]) * units

    @cached_property
    def tangent(self) -> Floats:
        """Unit vector along the family; `along` chooses its sense."""
        return np.asarray(np.linalg.svd(self.jacobian)[2][-1])

    def along(self, direction: Floats) -> Floats:
        """Return the tangent that points the same way as `direction`."""
        return self.tangent if self.tangent @ direction >= 0.0 else -self.tangent

    @cached_property
    def map_derivative(self) -> Floats:
        """Derivative of the map that has the first state as a fixed point."""
        return self.chain.map_derivative

    @cached_property
    def map_multipliers(self) -> Complexes:
        """Eigenvalues of the map's derivative, the largest first; for a half orbit the squares are multipliers."""
        found = np.linalg.eigvals(self.map_derivative).astype(complex)
        return found[np.argsort(-np.abs(found), kind="stable")]

    @property
    def multipliers(self) -> Complexes:
        """Floquet multipliers, the largest first."""
        return self.map_multipliers**2 if self.family.sense < 0.0 else self.map_multipliers


def corrected(family: Family, u: Floats, normal: Floats) -> tuple[Point, int] | FlowStatus:
    """Return the point of the family in the plane through `u` across `normal`, and the number of Newton steps.

    Returns
    -------
    tuple or Status
        LOST if the orbit reaches the vertical, GONE if it leaves for good, FAILED if no point was reached.
    """
    order = family.system.order
    arcs = (u.size - 1) // order
    units = family.units(u.size - 1)
    here = u
    for steps in range(1, _MOST_STEPS + 1):
        try:
            value = float(here[-1] * units[-1])
            system, change = family.at(value), family.system.derivative(family.name, value)
        except StylobateError:  # the parameter has left its range
            return FlowStatus.FAILED
        states = (here[:-1] * units[:-1]).reshape(arcs, order)
        chain = shots(system, states, family.covered, sense=family.sense, change=change)
        if chain.status is not FlowStatus.DONE:
            return chain.status
        point = Point(family, value, chain)
        # The distance from the plane is zero after the first steps.
        matrix = np.vstack([point.jacobian, normal])
        residual = np.append(chain.residual.ravel(), normal @ (here - u))
        try:
            step = np.linalg.solve(matrix, -residual)
        except np.linalg.LinAlgError:
            return FlowStatus.FAILED
        if not np.all(np.isfinite(step)) or np.abs(step).max() > 1.0:
            return FlowStatus.FAILED
        if np.abs(step).max() < _CLOSE * max(float(np.abs(here).max()), 1e-3):
            return point, steps
        here = here + step
    return FlowStatus.FAILED


def on_family(family: Family, states: Floats, value: float) -> Point | FlowStatus:
    """Return the point at this value of the parameter, from states near it."""
    u = np.append(states.ravel(), value) / family.units(states.size)
    normal = np.zeros(u.size)
    normal[-1] = 1.0
    found = corrected(family, u, normal)
    return found if isinstance(found, FlowStatus) else found[0]


_log = logging.getLogger("stylobate")

_EASY, _HARD = 4, 7
_LONGER, _SHORTER = 1.5, 0.5
# Minimum cosine of the angle between the tangents at the ends of a step.
_STRAIGHT = 0.97
# Maximum distance of the corrected from the predicted point, as a fraction of the step: twice the deviation of a family
# whose tangent turns by the maximum angle.
ASTRAY = 0.5
# The family is closed when it returns within this distance of its first point [steps].
_CLOSED = 0.75


class BranchEnd(Named, Enum):
    """Reason why a branch ends."""

    BOUND = "the parameter reached its bound"
    LOST = "the orbit comes within 1e-6 c of the vertical"
    GONE = "the orbit leaves for tilts from which no motion returns"
    CLOSED = "the family is closed"
    STEPS = "the maximum number of points is reached"
    SHORT = "the steps became too short"
    BEGUN = "the continuation began here"
    RESONANCE = "the pair of multipliers meets on the real axis"
    INTERRUPTED = "Ctrl-C stopped the continuation"
    MERGED = "the orbit regains the symmetry that its branch had broken"


@dataclass(frozen=True, slots=True, kw_only=True)
class StepControl:
    """Set the steps of a continuation.

    Parameters
    ----------
    first, least, largest
        First, minimum and maximum length of a step, in units of c for states and of the width of the bounds for the
        parameter.
    most
        Maximum number of points.

    Raises
    ------
    ParameterError
        If a length is not positive, `most` is not a positive whole number, or `least` exceeds another length.
    """

    first: float = 5e-3
    least: float = 1e-7
    largest: float = 0.02
    most: int = 2000

    def __post_init__(self) -> None:
        for name in ("first", "least", "largest"):
            require_positive(name, getattr(self, name))
        require_whole("most", self.most, least=1)
        for name in ("first", "largest"):
            if self.least > getattr(self, name):
                raise ParameterError(f"least must not be above {name}, {getattr(self, name)!r}; got {self.least!r}")


@dataclass(frozen=True, slots=True)
class Stretch:
    """Points of a family in their order, the direction of the family at each point, and the reason of its end."""

    points: tuple[Point, ...]
    directions: tuple[Floats, ...]
    end: BranchEnd


def trace(
    start: Point,
    direction: Floats,
    bounds: tuple[float, float],
    control: StepControl,
    seen: Callable[[Point], None] | None = None,
) -> Stretch:
    """Follow a family from `start` in the sense of `direction` until it ends, or until Ctrl-C."""
    passed = [(start, start.along(direction))]
    end = BranchEnd.STEPS
    broken = _asymmetry(start)
    try:
        for item in _points(start, direction, bounds, control):
            if isinstance(item, BranchEnd):
                end = item
                break
            point, _ = item
            before, broken = broken, _asymmetry(point)
            if float(before @ broken) < 0.0:
                end = BranchEnd.MERGED
                break
            passed.append(item)
            _log.info("%d orbits of a branch, at %s = %.4g", len(passed), point.family.name, point.value)
            if seen is not None:
                seen(point)
    except KeyboardInterrupt:
        end = BranchEnd.INTERRUPTED
    points, directions = zip(*passed, strict=True)
    return Stretch(points, directions, end)


def _points(
    start: Point, direction: Floats, bounds: tuple[float, float], control: StepControl
) -> Iterator[tuple[Point, Floats] | BranchEnd]:
    point, sense, length = start, start.along(direction), min(control.first, control.largest)
    low, high = bounds
    if start.value >= high if sense[-1] > 0.0 else start.value <= low:
        yield BranchEnd.BOUND
        return
    for made in range(control.most):
        made_step = _step(point, sense, length, bounds, control.least)
        if isinstance(made_step, BranchEnd):
            yield made_step
            return
        following, after, length, steps = made_step
        yield following, after
        if following.value in bounds:
            yield BranchEnd.BOUND
            return
        near = np.linalg.norm(following.u - start.u) < _CLOSED * length
        if made >= _FEW and near and after @ start.along(direction) > 0.0:
            yield BranchEnd.CLOSED
            return
        point, sense = following, after
        if steps <= _EASY:
            length = min(_LONGER * length, control.largest)
        elif steps >= _HARD:
            length *= _SHORTER


def _step(
    point: Point, sense: Floats, length: float, bounds: tuple[float, float], least: float
) -> tuple[Point, Floats, float, int] | BranchEnd:
    """Return the point after a step of `length` or shorter, its tangent, the length and the number of Newton steps.

    The last point lies on the bound of the parameter.
    """
    family = point.family
    while True:
        guess = point.u + length * sense
        found = corrected(family, guess, sense)
        # A point farther away may lie on another family.
        if not isinstance(found, FlowStatus) and np.linalg.norm(found[0].u - guess) > ASTRAY * length:
            found = FlowStatus.FAILED
        # Between orbits with different turns about the vertical lies an orbit through the vertical.
        if not isinstance(found, FlowStatus) and abs(found[0].chain.turns - point.chain.turns) > _SAME_TURNS:
            found = FlowStatus.LOST
        value = guess[-1] * family.span if isinstance(found, FlowStatus) else found[0].value
        if not bounds[0] <= value <= bounds[1]:  # beyond the bound there may be no orbit
            last = _at_bound(family, point, sense, bounds[0] if value < bounds[0] else bounds[1])
            if last is not None and last.along(sense) @ sense > _STRAIGHT:
                return last, last.along(sense), length, 0
        elif not isinstance(found, FlowStatus):
            after = found[0].along(sense)
            if after @ sense >= _STRAIGHT or length <= _BENT * least:
                return found[0], after, length, found[1]
        length *= _SHORTER
        if length < least:
            return _why(found) if isinstance(found, FlowStatus) else BranchEnd.SHORT


_SAME_TURNS = 0.25
# A step this short [minimum length] is accepted even if the family bends more than allowed.
_BENT = 10.0
_FEW = 10


def _asymmetry(point: Point) -> Floats:
    """Return the deviation of an orbit from the half-period inversion; zero for a family with the inversion.

    On a branch from a pitchfork the deviation changes sign at the pitchfork: beyond it lie the symmetry-related orbits.
    """
    family, state = point.family, point.chain.states[0]
    if family.sense < 0.0:
        return np.zeros(state.size)
    flow = family.at(point.value).carry(state, 0.0, 0.5 * family.periods)
    return np.asarray(state - family.system.image(-1.0) * flow.end)


def _at_bound(family: Family, point: Point, sense: Floats, bound: float) -> Point | None:
    """Return the point at the bound of the parameter, beyond `point`."""
    missing = bound / family.span - point.u[-1]
    guess = point.u + sense * missing / sense[-1]
    normal = np.zeros_like(sense)
    normal[-1] = 1.0
    found = corrected(family, guess, normal)
    if not isinstance(found, FlowStatus) and np.linalg.norm(found[0].u - guess) > ASTRAY * np.linalg.norm(
        guess - point.u
    ):
        return None
    # The value is the bound itself, without rounding by the scaling.
    return None if isinstance(found, FlowStatus) else replace(found[0], value=bound)


def _why(status: FlowStatus) -> BranchEnd:
    return {FlowStatus.LOST: BranchEnd.LOST, FlowStatus.GONE: BranchEnd.GONE}.get(status, BranchEnd.SHORT)


def control_of(control: StepControl | None) -> StepControl:
    """Return the control of the steps; the default control for None."""
    if control is None:
        return StepControl()
    if not isinstance(control, StepControl):
        raise ParameterError(f"control must be a StepControl(...) or None, got {control!r}")
    return control


def require_followed(parameter: str) -> None:
    """Raise ParameterError if `parameter` does not change orbits."""
    if parameter == "delay":
        raise ParameterError(
            "parameter must be a number that changes the orbit, got 'delay': a delay shifts the base motion in time, "
            "and each orbit with it"
        )


def enclosing(system: PeriodicSystem, bounds: Sequence[float], parameter: str, value: float) -> tuple[float, float]:
    """Return the bounds, or raise ParameterError unless they are two valid numbers that enclose `value`."""
    try:
        low, high = (float(bound) for bound in bounds)
    except (TypeError, ValueError):
        low = high = math.nan
    if not (-math.inf < low <= value <= high < math.inf and low < high):
        raise ParameterError(
            f"bounds must be two numbers that enclose the present {parameter} {value!r}, got {bounds!r}"
        )
    for bound in (low, high):
        try:
            # A negative acceleration is the same motion at another phase.
            if parameter == "acceleration":
                require_not_negative(parameter, bound)
            system.changed(**{parameter: bound})
        except ParameterError as error:
            raise ParameterError(f"bounds: {error}") from None
    return low, high
