"""Base motion of a run in the units of the model: forcing, thresholds of rest, and checks."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import BaseMotion
from stylobate.base_motions.base import ACCELERATION
from stylobate.base_motions.combined import Following, Sum, Transformed
from stylobate.engine.tolerances import PARALLEL_ULP, SAMPLES_PER_PERIOD
from stylobate.errors import SMALLEST, ParameterError
from stylobate.models import Model

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Forcing:
    """Base motion in the units of a model."""

    motion: BaseMotion
    time_scale: float
    gravity: float

    @classmethod
    def of(cls, model: Model, motion: BaseMotion) -> "Forcing":
        """Return `motion` in the units of `model`."""
        return cls(motion, model.time_scale, model.column.gravity)

    def along(self, tau: Floats) -> Floats:
        """Return ax, ay, az [g], shape (3, n), at dimensionless times."""
        return np.stack(self.motion.derivative(tau * self.time_scale, ACCELERATION)) / self.gravity

    @property
    def highest_frequency(self) -> float:
        """Highest dimensionless frequency; 0 for a base at rest."""
        return self.motion.highest_frequency * self.time_scale

    def stops(self, end: float) -> tuple[float, ...]:
        """Return the times up to `end` at which an integration must stop: breaks of the acceleration, and `end`."""
        breaks = (time / self.time_scale for time in self.motion.breaks)
        return (*(tau for tau in breaks if 0.0 < tau < end), end)


def common_line(*vectors: tuple[float, float]) -> tuple[float, float] | None:
    """Return the unit vector parallel to all `vectors` to 8 ulp, or None; zero vectors are parallel to any line."""
    longest = max(vectors, key=lambda vector: math.hypot(*vector), default=(0.0, 0.0))
    length = math.hypot(*longest)
    if length == 0.0:
        return None
    ux, uy = longest[0] / length, longest[1] / length
    for x, y in vectors:
        if abs(ux * y - uy * x) > PARALLEL_ULP * np.finfo(float).eps * math.hypot(x, y):
            return None
    return ux, uy


# The energy of steady rolling at frequency ν is 1.5 c²/ν²; rest begins below a hundredth of it at most.
_REST_ENERGY, _REST_ENERGY_ROLLING = 1e-4, 0.015
# If the base motion can uplift the column again, rest begins below a hundredth of the energy after uplift. The lower
# bounds are the second number, which limits the number of swings to integrate, and the third number for sampled
# motions and for motions shorter than the last number of mean periods, in which small swings cannot grow.
_UPLIFT_SHARE, _LEAST_REST_ENERGY, _LEAST_IF_BRIEF, _BRIEF = 0.01, 1e-8, 1e-5, 100.0

# Initial conditions nearer to rest than this, tilt and rate in units of c, are rounding errors of rest.
_ROUNDED_REST = 1e-14


def without_dust(tilt: Floats) -> Floats:
    """Return initial tilts [rad] with zero for components whose squares would underflow."""
    return np.where(np.abs(tilt) < SMALLEST, 0.0, tilt)


def is_rest(tilt: Sequence[Any], tilt_rate: Sequence[Any], slenderness: Any, time_scale: Any) -> Any:
    """Return whether these initial conditions along x and y [rad], [rad/s] are at rest up to rounding."""
    size = np.hypot(tilt[0], tilt[1])
    speed = np.hypot(tilt_rate[0], tilt_rate[1]) * time_scale
    return np.maximum(size, speed) <= _ROUNDED_REST * slenderness


def least_rest_energy(motion: BaseMotion) -> float:
    """Return the minimum ε for a column that `motion` may uplift again."""
    sampled = motion.degree is not None and motion.degree <= 1
    brief = motion.duration * motion.mean_frequency < _BRIEF * 2.0 * math.pi
    return _LEAST_IF_BRIEF if sampled or brief else _LEAST_REST_ENERGY


def usual_rest_energy(
    frequency: npt.ArrayLike,
    largest: npt.ArrayLike,
    minimum_vertical: npt.ArrayLike,
    capacity: npt.ArrayLike,
    *,
    least: npt.ArrayLike,
) -> Floats:
    """Return the default rest energy ε; all arguments have the same shape.

    Parameters
    ----------
    frequency
        Mean dimensionless frequency of the base motion; 0 for a base at rest.
    largest, minimum_vertical
        sup |a_h| and inf a_z [g].
    capacity
        Maximum |a_h|/(1 + a_z) under which the column stands still.
    least
        Lower bound, see `least_rest_energy`.
    """
    energy = rest_energy_for_good(frequency)
    uplifted = uplift_energy(frequency, largest, minimum_vertical, capacity)
    finest = np.maximum(least, _UPLIFT_SHARE * uplifted)
    return np.where(np.isnan(uplifted), energy, np.minimum(energy, finest))


def rest_energy_for_good(frequency: npt.ArrayLike) -> Floats:
    """Return the default ε if uplift is not possible, at this mean dimensionless frequency."""
    with np.errstate(divide="ignore"):
        return np.asarray(np.minimum(_REST_ENERGY, _REST_ENERGY_ROLLING / np.asarray(frequency, dtype=float) ** 2))


def coarse(
    rest_energy: npt.ArrayLike,
    frequency: npt.ArrayLike,
    largest: npt.ArrayLike,
    minimum_vertical: npt.ArrayLike,
    capacity: npt.ArrayLike,
) -> npt.NDArray[np.bool_]:
    """Return whether `rest_energy` is above a hundredth of the energy of a column after uplift."""
    uplifted = uplift_energy(frequency, largest, minimum_vertical, capacity)
    return ~np.isnan(uplifted) & (_UPLIFT_SHARE * uplifted < np.asarray(rest_energy, dtype=float))


def uplift_energy(
    frequency: npt.ArrayLike, largest: npt.ArrayLike, minimum_vertical: npt.ArrayLike, capacity: npt.ArrayLike
) -> Floats:
    """Return the energy [c²] of a column that a harmonic peak has uplifted; NaN if the peak cannot uplift it.

    With |a_h| = c(1 + δ) at the peak the excess lasts 2√(2δ)/ν and leaves the speed (4/3)√2 c δ^{3/2}/ν.
    """
    weight = 1.0 + np.asarray(minimum_vertical, dtype=float)
    with np.errstate(divide="ignore", invalid="ignore"):
        excess = np.asarray(largest) / (np.asarray(capacity) * weight) - 1.0
        energy = 16.0 / 9.0 * (excess * excess * excess) / np.square(frequency)
    return np.where(weight <= 0.0, np.inf, np.where(excess > 0.0, energy, np.nan))


# Number of samples of each motion, and of a motion that a user has defined.
_SAMPLES, _SAMPLES_OF_OWN = 257, 1025
_COMPONENTS = 3

# Relative tolerances of bounds, directions and durations, and of periods.
_ROUNDING, _REPEATS = 1e-9, 1e-6
# Rounding error of the difference of two phases, in units of the error of one phase.
_PHASES_APART = 4.0

# The search for uplift uses parabolas through three samples. This is the error allowed to them, as a fraction of the
# peak acceleration; the error is 6e-5 at the true frequency, and this value at a seventh of it.
_MISSED = 0.02
_MOST_PAIRS, _POINTS = 4000, 4096


def check_motion(motion: BaseMotion, duration: float) -> None:
    """Raise ParameterError if `motion` contradicts its declarations in a run of `duration` [s].

    All motions are checked for finite accelerations within their bound. Motions that a user has defined, also inside a
    sum or a copy, are checked for directions, vertical range, duration, period, highest frequency and breaks too.
    Errors between samples are not detected.
    """
    check_kinds(motion)
    time = np.linspace(0.0, duration, _SAMPLES)
    _check_bound("motion", motion, time)
    for own in own_motions(motion):
        _check_own(own, duration)


def check_kinds(motion: BaseMotion) -> None:
    """Raise ParameterError unless each member of a user-defined motion returns the right number of numbers."""
    for own in own_motions(motion):
        for name, (get, convert, wanted) in _KINDS.items():
            value = get(own)
            try:
                convert(value)
            except (TypeError, ValueError):
                raise ParameterError(
                    f"{type(own).__name__}.{name}: not of the right kind (got {value!r}). Return {wanted}."
                ) from None


def _vectors(value: Any, count: int | None, size: int) -> None:
    """Raise ValueError or TypeError unless `value` holds `count` vectors (any number for None) of this size."""
    found = [np.array(vector, dtype=float).shape for vector in value]
    if any(shape != (size,) for shape in found) or count not in (None, len(found)):
        raise ValueError


_Kind = tuple[Callable[[BaseMotion], Any], Callable[[Any], object], str]
_KINDS: dict[str, _Kind] = {
    "derivative": (
        lambda motion: motion.derivative(np.array([0.0, 1.0]), ACCELERATION),
        lambda value: _vectors(value, _COMPONENTS, 2),
        "three arrays of the shape of time",
    ),
    "peak_horizontal": (lambda motion: motion.peak_horizontal(0.0), float, "a number, in m/s²"),
    "vertical_range": (
        lambda motion: motion.vertical_range(0.0),
        lambda value: _vectors([value], 1, 2),
        "two numbers, in m/s²",
    ),
    "directions": (
        lambda motion: motion.directions(),
        lambda value: _vectors(value, None, 2),
        "vectors of two numbers",
    ),
    "highest_frequency": (lambda motion: motion.highest_frequency, float, "a number, in rad/s"),
    "duration": (lambda motion: motion.duration, float, "a number, in s"),
    "period": (
        lambda motion: motion.period,
        lambda value: value is None or float(value),
        "a number, in s, or None",
    ),
    "breaks": (lambda motion: motion.breaks, lambda value: list(map(float, value)), "numbers, in s"),
}


def own_motions(motion: BaseMotion) -> Iterator[BaseMotion]:
    """Yield the user-defined motions in `motion`."""
    if not _is_of_the_package(motion) or not _is_of_the_package(getattr(motion, "waveform", motion)):
        yield motion
    elif isinstance(motion, Sum):
        for part in motion.motions:
            yield from own_motions(part)
    elif isinstance(motion, (Following, Transformed)):
        yield from own_motions(motion.followed)


def _is_of_the_package(part: object) -> bool:
    return type(part).__module__.split(".")[0] == "stylobate"


def _check_bound(name: str, motion: BaseMotion, time: Floats) -> Floats:
    """Return the accelerations, shape (3, n), or raise ParameterError unless they are finite and within the bound."""
    parts = motion.derivative(time, ACCELERATION)
    if len(parts) != _COMPONENTS or any(np.shape(part) != time.shape for part in parts):
        raise ParameterError(f"{name}.derivative must return three arrays of the shape of time, got {parts!r}")
    found = np.stack(parts)
    broken = ~np.isfinite(found).all(axis=0)
    if broken.any():
        raise ParameterError(
            f"{name} must have a finite acceleration, got {parts[0][broken][0]!r} at t = {time[broken][0]!r} s"
        )
    largest, bound = float(np.hypot(found[0], found[1]).max()), motion.peak_horizontal(0.0)
    # Large phases of two components have different rounding errors.
    frequency = motion.highest_frequency if math.isfinite(motion.highest_frequency) else 0.0
    unresolved = _PHASES_APART * np.finfo(float).eps * frequency * float(time[-1])
    if not largest <= bound * (1.0 + _ROUNDING + unresolved):
        raise ParameterError(
            f"{name}.peak_horizontal must bound |a_h|, got {bound!r} m/s² although |a_h| reaches {largest!r}"
        )
    return found


def _check_own(motion: BaseMotion, duration: float) -> None:
    name = type(motion).__name__
    time = np.linspace(0.0, duration, _SAMPLES_OF_OWN)
    found = _check_bound(name, motion, time)
    problem = (
        _problem_of_bounds(motion, time, found)
        or _problem_of_directions(motion, time, found)
        or _problem_of_duration(motion, time, found)
        or _problem_of_period(motion, duration)
        or _problem_of_resolution(motion, duration)
    )
    if problem:
        raise ParameterError(f"{name}.{problem}")


def _problem_of_bounds(motion: BaseMotion, time: Floats, found: Floats) -> str:
    size = np.hypot(found[0], found[1])
    for begin in (0, time.size // 3, 2 * time.size // 3):
        since, least, largest = float(time[begin]), found[2, begin:].min(), found[2, begin:].max()
        low, high = motion.vertical_range(since)
        room = _ROUNDING * max(abs(low), abs(high))
        if not low - room <= least <= largest <= high + room:
            return (
                f"vertical_range: does not bound a_z from t = {since:.4g} s on (got {low:.4g} to {high:.4g} m/s², "
                f"a_z goes from {least:.4g} to {largest:.4g}). Return bounds outside these."
            )
        bound = motion.peak_horizontal(since)
        if not size[begin:].max() <= bound * (1.0 + _ROUNDING):
            return (
                f"peak_horizontal: does not bound |a_h| from t = {since:.4g} s on (got {bound:.4g} m/s², "
                f"|a_h| reaches {size[begin:].max():.4g}). Return a bound above that."
            )
    return ""


def _problem_of_directions(motion: BaseMotion, time: Floats, found: Floats) -> str:
    vectors = motion.directions()
    line = common_line(*vectors)
    moving = any(math.hypot(*vector) > 0.0 for vector in vectors)
    if line is None and moving:
        return ""  # two directions span the plane
    ux, uy = line or (0.0, 0.0)
    across = np.hypot(found[0], found[1]) if line is None else np.abs(ux * found[1] - uy * found[0])
    worst = int(np.argmax(across))
    if across[worst] <= _ROUNDING * max(motion.peak_horizontal(0.0), float(np.abs(found[:2]).max())):
        return ""
    along = f"a line along ({ux:.4g}, {uy:.4g})" if moving else "no horizontal motion"
    return (
        f"directions: means {along} (got {vectors!r}), but the base accelerates by {across[worst]:.4g} m/s² across it "
        f"at t = {time[worst]:.4g} s. Return vectors that span every horizontal acceleration."
    )


def _problem_of_duration(motion: BaseMotion, time: Floats, found: Floats) -> str:
    late = time > motion.duration * (1.0 + _ROUNDING)
    if not late.any() or not np.any(found[:, late]):
        return ""
    when = float(time[late][np.abs(found[:, late]).max(axis=0) > 0.0][-1])
    return (
        f"duration: the base still accelerates after it (got {motion.duration:.4g} s, moves at t = {when:.4g} s). "
        "Return the time after which the acceleration is zero."
    )


def _problem_of_period(motion: BaseMotion, duration: float) -> str:
    period = motion.period
    if period is None or motion.duration < math.inf:
        return ""
    if not 0.0 < period < math.inf:
        return f"period: must be positive (got {period!r} s). Return the common period, or None."
    # After the start, such as a ramp, is over.
    begin = max(duration, *motion.breaks, 0.0) if motion.breaks else duration
    time = begin + period * np.linspace(0.0, 1.0, _SAMPLES)
    now, later = (np.stack(motion.derivative(t, ACCELERATION)) for t in (time, time + period))
    off = float(np.abs(later - now).max())
    if off <= _REPEATS * max(float(np.abs(now).max()), motion.peak_horizontal(0.0)):
        return ""
    return (
        f"period: the acceleration does not repeat after it (got {period:.6g} s, differs by {off:.4g} m/s²). Return "
        "the common period, or None."
    )


def _problem_of_resolution(motion: BaseMotion, duration: float) -> str:
    """Return a problem if parabolas through the samples of the search for uplift miss the acceleration."""
    frequency = motion.highest_frequency
    if not 0.0 <= frequency < math.inf:
        return f"highest_frequency: must be zero or positive (got {frequency!r} rad/s). Return it in rad/s."
    starts, lengths = _pairs_of_steps(motion, min(duration, motion.duration))
    if not starts.size:
        return ""
    half = max(4, _POINTS // (2 * starts.size))
    # The ends are excluded, because they may lie on the other side of a break.
    share = np.clip(np.linspace(0.0, 1.0, 2 * half + 1), _ROUNDING, 1.0 - _ROUNDING)
    time = starts[:, np.newaxis] + lengths[:, np.newaxis] * share
    found = np.stack(motion.derivative(time.ravel(), ACCELERATION)).reshape(_COMPONENTS, *time.shape)
    s = 2.0 * share
    first, middle, last = found[..., :1], found[..., half : half + 1], found[..., -1:]
    parabola = 0.5 * (s - 1.0) * (s - 2.0) * first + s * (2.0 - s) * middle + 0.5 * s * (s - 1.0) * last
    missed = np.abs(found - parabola).max(axis=(0, 2))
    largest = float(np.abs(found).max())
    worst = int(np.argmax(missed))
    if missed[worst] <= _MISSED * largest:
        return ""
    jump = _jump(motion, time[worst], found[:, worst])
    if jump is not None:
        return (
            f"breaks: the acceleration jumps by {jump[1]:.4g} m/s² at t = {jump[0]:.6g} s, which is not among them "
            f"(got {len(motion.breaks)} breaks). Add that time."
        )
    fastest = float((np.abs(np.diff(found, axis=2)) / np.diff(time)).max()) / largest
    return (
        f"highest_frequency: the acceleration changes faster (got {frequency:.4g} rad/s, changes like a sine of "
        f"{fastest:.2g} rad/s or more). Return the highest angular frequency in the acceleration."
    )


def _pairs_of_steps(motion: BaseMotion, end: float) -> tuple[Floats, Floats]:
    """Return starts and lengths of (some) pairs of sampling steps between breaks, as in the search for uplift."""
    stops = [0.0, *sorted(time for time in motion.breaks if 0.0 < time < end), end]
    pieces = np.array([(a, b) for a, b in pairwise(stops) if b > a]).reshape(-1, 2)
    pieces = pieces[_spread(len(pieces))]
    frequency, most = motion.highest_frequency, max(1, _MOST_PAIRS // max(1, len(pieces)))
    starts, lengths = [np.empty(0)], [np.empty(0)]
    for a, b in pieces.tolist():
        count = max(1, math.ceil((b - a) * frequency * SAMPLES_PER_PERIOD / (4.0 * math.pi)))
        length = (b - a) / count
        chosen = _spread(count, most)
        starts.append(a + length * chosen)
        lengths.append(np.full(chosen.size, length))
    return np.concatenate(starts), np.concatenate(lengths)


def _spread(count: int, most: int = _MOST_PAIRS) -> npt.NDArray[np.intp]:
    """Return the numbers below `count`, or `most` of them evenly spaced."""
    return np.arange(count) if count <= most else np.linspace(0, count - 1, most).astype(np.intp)


def _jump(motion: BaseMotion, time: Floats, found: Floats) -> tuple[float, float] | None:
    """Return time and size of a jump of the acceleration between these times, or None if it only changes fast."""
    first: float | None = None
    for _ in range(4):
        change = np.abs(np.diff(found, axis=1)).max(axis=0)
        place = int(np.argmax(change))
        size = float(change[place])
        first = size if first is None else first
        if size < 0.5 * first:
            return None
        time = np.linspace(time[place], time[place + 1], 65)
        found = np.stack(motion.derivative(time, ACCELERATION))
    return float(time[32]), size
