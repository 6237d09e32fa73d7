"""Pseudo-arclength continuation of a family of periodic orbits."""

import logging
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np

from stylobate.engine.flow.integration import Status
from stylobate.errors import Named, ParameterError, require_positive, require_whole
from stylobate.orbits.arclength import Family, Floats, Point, corrected

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


class End(Named, Enum):
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
                message = f"least must not be above {name}, {getattr(self, name)!r}; got {self.least!r}"
                raise ParameterError(message)


@dataclass(frozen=True, slots=True)
class Stretch:
    """Points of a family in their order, the direction of the family at each point, and the reason of its end."""

    points: tuple[Point, ...]
    directions: tuple[Floats, ...]
    end: End


def trace(
    start: Point,
    direction: Floats,
    bounds: tuple[float, float],
    control: StepControl,
    seen: Callable[[Point], None] | None = None,
) -> Stretch:
    """Follow a family from `start` in the sense of `direction` until it ends, or until Ctrl-C."""
    passed = [(start, start.along(direction))]
    end = End.STEPS
    broken = _asymmetry(start)
    try:
        for item in _points(start, direction, bounds, control):
            if isinstance(item, End):
                end = item
                break
            point, _ = item
            before, broken = broken, _asymmetry(point)
            if float(before @ broken) < 0.0:
                end = End.MERGED
                break
            passed.append(item)
            _log.info("%d orbits of a branch, at %s = %.4g", len(passed), point.family.name, point.value)
            if seen is not None:
                seen(point)
    except KeyboardInterrupt:
        end = End.INTERRUPTED
    points, directions = zip(*passed, strict=True)
    return Stretch(points, directions, end)


def _points(
    start: Point, direction: Floats, bounds: tuple[float, float], control: StepControl
) -> Iterator[tuple[Point, Floats] | End]:
    point, sense, length = start, start.along(direction), min(control.first, control.largest)
    low, high = bounds
    if start.value >= high if sense[-1] > 0.0 else start.value <= low:
        yield End.BOUND
        return
    for made in range(control.most):
        made_step = _step(point, sense, length, bounds, control.least)
        if isinstance(made_step, End):
            yield made_step
            return
        following, after, length, steps = made_step
        yield following, after
        if following.value in bounds:
            yield End.BOUND
            return
        near = np.linalg.norm(following.u - start.u) < _CLOSED * length
        if made >= _FEW and near and after @ start.along(direction) > 0.0:
            yield End.CLOSED
            return
        point, sense = following, after
        if steps <= _EASY:
            length = min(_LONGER * length, control.largest)
        elif steps >= _HARD:
            length *= _SHORTER


def _step(
    point: Point, sense: Floats, length: float, bounds: tuple[float, float], least: float
) -> tuple[Point, Floats, float, int] | End:
    """Return the point after a step of `length` or shorter, its tangent, the length and the number of Newton steps.

    The last point lies on the bound of the parameter.
    """
    family = point.family
    while True:
        guess = point.u + length * sense
        found = corrected(family, guess, sense)
        # A point farther away may lie on another family.
        if not isinstance(found, Status) and np.linalg.norm(found[0].u - guess) > ASTRAY * length:
            found = Status.FAILED
        # Between orbits with different turns about the vertical lies an orbit through the vertical.
        if not isinstance(found, Status) and abs(found[0].chain.turns - point.chain.turns) > _SAME_TURNS:
            found = Status.LOST
        value = guess[-1] * family.span if isinstance(found, Status) else found[0].value
        if not bounds[0] <= value <= bounds[1]:  # beyond the bound there may be no orbit
            last = _at_bound(family, point, sense, bounds[0] if value < bounds[0] else bounds[1])
            if last is not None and last.along(sense) @ sense > _STRAIGHT:
                return last, last.along(sense), length, 0
        elif not isinstance(found, Status):
            after = found[0].along(sense)
            if after @ sense >= _STRAIGHT or length <= _BENT * least:
                return found[0], after, length, found[1]
        length *= _SHORTER
        if length < least:
            return _why(found) if isinstance(found, Status) else End.SHORT


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
    if not isinstance(found, Status) and np.linalg.norm(found[0].u - guess) > ASTRAY * np.linalg.norm(guess - point.u):
        return None
    # The value is the bound itself, without rounding by the scaling.
    return None if isinstance(found, Status) else replace(found[0], value=bound)


def _why(status: Status) -> End:
    return {Status.LOST: End.LOST, Status.GONE: End.GONE}.get(status, End.SHORT)
