"""Base motions and their combinations: sums, copies, and one of several by number."""

import math
from abc import abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from stylobate.base_motions.base import (
    ACCELERATION,
    VELOCITY,
    Angle,
    Chosen,
    Components,
    Delay,
    Factor,
    MotionContract,
    OffsetAcceleration,
    VerticalFactor,
)
from stylobate.errors import ParameterError
from stylobate.quantities import parameters_of

# Frequencies share a period if their ratio is n/d to this relative accuracy, with d up to the limit.
_RATIO_TOLERANCE = 1e-12
_LARGEST_DENOMINATOR = 64


class BaseMotion(MotionContract):
    """Motion of the base from t = 0 on, in SI units, along x, y (horizontal) and z (up).

    Motions combine: `first + second`, `2.0 * motion`, `motion.rotated(angle)`, `motion.scaled(factor, vertical=0.0)`,
    `motion.delayed(delay)`, `motion.offset(offset_x)`. Motions are immutable; each combination is a new motion.

    Notes
    -----
    For developers: a custom motion implements `derivative`, `peak_horizontal`, `vertical_range` and
    `directions`; `duration`, `period`, `highest_frequency`, `mean_frequency`, `breaks` and `degree` have defaults.
    """

    __slots__ = ()

    def made_by(self) -> tuple[Callable[..., "BaseMotion"], Mapping[str, Any]]:
        """Return the constructor of this motion and its arguments: by default its class and its declared numbers.

        An override applies to its class only, not to subclasses.
        """
        return type(self), {name: getattr(self, name) for name in parameters_of(type(self))}

    def _call(self) -> tuple[Callable[..., Any], Mapping[str, Any]]:
        if "made_by" in vars(type(self)):  # a subclass is another motion
            make, arguments = self.made_by()
            if make is not type(self):
                return make, arguments
        return super()._call()

    def scaled(self, factor: Factor, *, vertical: VerticalFactor | None = None) -> "Scaled":
        """Scale this motion by `factor`; the vertical component by `vertical`, if given."""
        return Scaled(motion=self, factor=factor, vertical=factor if vertical is None else vertical)

    def rotated(self, angle: Angle) -> "Rotated":
        """Rotate this motion by `angle` [rad] about the vertical, anticlockwise seen from above."""
        return Rotated(motion=self, angle=angle)

    def delayed(self, delay: Delay) -> "Delayed":
        """Delay this motion by `delay` [s]; the base does not accelerate before."""
        return Delayed(motion=self, delay=delay)

    def offset(self, offset_x: OffsetAcceleration = 0.0, offset_y: OffsetAcceleration = 0.0) -> "Offset":
        """Add a constant horizontal acceleration [m/s²], such as g sin δ of a base that is out of level by δ."""
        return Offset(motion=self, offset_x=offset_x, offset_y=offset_y)

    def __add__(self, other: object) -> "Sum":
        if not isinstance(other, BaseMotion):
            return NotImplemented
        return Sum(motions=(self, other))

    def __mul__(self, factor: float) -> "Scaled":
        return self.scaled(factor)

    __rmul__ = __mul__


@dataclass(frozen=True, slots=True, kw_only=True)
class Sum(BaseMotion):
    """Sum of `motions`; without motions, a base at rest."""

    motions: tuple[BaseMotion, ...] = ()

    @classmethod
    def at_rest(cls) -> Self:
        """Create a base at rest: the sum of no motions."""
        return cls()

    def made_by(self) -> tuple[Callable[..., BaseMotion], Mapping[str, Any]]:
        """Return the constructor: the sum of the motions, or a base at rest."""
        return (Sum, {"motions": self.motions}) if self.motions else (Sum.at_rest, {})

    def validate(self) -> None:
        """Raise ParameterError unless all `motions` are base motions."""
        object.__setattr__(self, "motions", tuple(self.motions))
        for motion in self.motions:
            require_motion("motions", motion)

    def derivative(self, time: npt.ArrayLike, order: int) -> Components:
        """Sum the displacements (`order` 0), velocities (1) or accelerations (2)."""
        t = np.asarray(time, dtype=float)
        x, y, z = np.zeros_like(t), np.zeros_like(t), np.zeros_like(t)
        for motion in self.motions:
            dx, dy, dz = motion.derivative(t, order)
            x, y, z = x + dx, y + dy, z + dz
        return x, y, z

    def peak_horizontal(self, since: float = 0.0) -> float:
        """Sum the bounds of the parts [m/s²]: at least sup |a_h|, and above it if the peaks do not coincide."""
        return math.fsum(motion.peak_horizontal(since) for motion in self.motions)

    def vertical_range(self, since: float = 0.0) -> tuple[float, float]:
        """Sum the bounds of the parts [m/s²]."""
        ranges = [motion.vertical_range(since) for motion in self.motions]
        return math.fsum(low for low, _ in ranges), math.fsum(high for _, high in ranges)

    def directions(self) -> tuple[tuple[float, float], ...]:
        """Return the directions of all the parts [m/s²]."""
        return tuple(vector for motion in self.motions for vector in motion.directions())

    @property
    def duration(self) -> float:
        """The longest duration of a part [s]; 0 for none."""
        return max((motion.duration for motion in self.motions), default=0.0)

    @property
    def period(self) -> float | None:
        """The least common period of the parts [s], if their frequencies are in a simple ratio."""
        periods = [motion.period for motion in self.motions if motion.duration > 0.0]
        if not periods or periods[0] is None:
            return None
        common = periods[0]
        for period in periods[1:]:
            if period is None:
                return None
            ratio = Fraction(common / period).limit_denominator(_LARGEST_DENOMINATOR)
            if ratio == 0 or abs(common / period / float(ratio) - 1.0) > _RATIO_TOLERANCE:
                return None
            common *= ratio.denominator
        return common

    @property
    def highest_frequency(self) -> float:
        """The highest angular frequency of a part [rad/s]."""
        return max((motion.highest_frequency for motion in self.motions), default=0.0)

    @property
    def mean_frequency(self) -> float:
        """The highest mean frequency of a part [rad/s]."""
        return max((motion.mean_frequency for motion in self.motions), default=0.0)

    @property
    def breaks(self) -> tuple[float, ...]:
        """The breaks of all the parts [s]."""
        return tuple(sorted({time for motion in self.motions for time in motion.breaks}))

    @property
    def degree(self) -> int | None:
        """The highest degree of a part; 0 for none."""
        degrees = [motion.degree for motion in self.motions]
        return None if None in degrees else max((degree or 0 for degree in degrees), default=0)


class Following(BaseMotion):
    """A motion with all properties of another motion, except those that a subclass changes."""

    __slots__ = ()

    @property
    @abstractmethod
    def followed(self) -> BaseMotion:
        """The other motion."""

    def derivative(self, time: npt.ArrayLike, order: int) -> Components:
        """Return the displacement (`order` 0), velocity (1) or acceleration (2) of the motion."""
        return self.followed.derivative(time, order)

    def peak_horizontal(self, since: float = 0.0) -> float:
        """Return the bound of the motion [m/s²]."""
        return self.followed.peak_horizontal(since)

    def vertical_range(self, since: float = 0.0) -> tuple[float, float]:
        """Return the bounds of the motion [m/s²]."""
        return self.followed.vertical_range(since)

    def directions(self) -> tuple[tuple[float, float], ...]:
        """Return the directions of the motion [m/s²]."""
        return self.followed.directions()

    @property
    def duration(self) -> float:
        """The duration of the motion [s]."""
        return self.followed.duration

    @property
    def period(self) -> float | None:
        """The period of the motion [s]."""
        return self.followed.period

    @property
    def highest_frequency(self) -> float:
        """The highest angular frequency of the motion [rad/s]."""
        return self.followed.highest_frequency

    @property
    def mean_frequency(self) -> float:
        """The mean angular frequency of the motion [rad/s]."""
        return self.followed.mean_frequency

    @property
    def breaks(self) -> tuple[float, ...]:
        """The breaks of the motion [s]."""
        return self.followed.breaks

    @property
    def degree(self) -> int | None:
        """The degree of the motion."""
        return self.followed.degree


@dataclass(frozen=True, slots=True, kw_only=True)
class Transformed(Following):
    """A copy of `motion` with all its properties, except those that a subclass changes."""

    motion: BaseMotion

    def validate(self) -> None:
        """Raise ParameterError unless `motion` is a base motion."""
        require_motion("motion", self.motion)

    @property
    def followed(self) -> BaseMotion:
        """The original motion."""
        return self.motion

    def changed(self, x: Any, y: Any, z: Any) -> tuple[Any, Any, Any]:
        """Transform a vector of the motion to the copy: floats, complex amplitudes or arrays."""
        return x, y, z

    def derivative(self, time: npt.ArrayLike, order: int) -> Components:
        """Return the changed displacement (`order` 0), velocity (1) or acceleration (2)."""
        return self.changed(*self.motion.derivative(time, order))

    def directions(self) -> tuple[tuple[float, float], ...]:
        """Return the changed directions of the motion [m/s²]."""
        return tuple(self.changed(x, y, 0.0)[:2] for x, y in self.motion.directions())


@dataclass(frozen=True, slots=True, kw_only=True)
class Scaled(Transformed):
    """The base motion `motion`, scaled horizontally by `factor` and vertically by `vertical`."""

    factor: Factor
    vertical: VerticalFactor

    def made_by(self) -> tuple[Callable[..., BaseMotion], Mapping[str, Any]]:
        """Return the constructor: `BaseMotion.scaled`, with its arguments."""
        return BaseMotion.scaled, {"motion": self.motion, "factor": self.factor, "vertical": self.vertical}

    def changed(self, x: Any, y: Any, z: Any) -> tuple[Any, Any, Any]:
        """Return the scaled vector."""
        return self.factor * x, self.factor * y, self.vertical * z

    def peak_horizontal(self, since: float = 0.0) -> float:
        """Return |factor| times the bound of the motion [m/s²]."""
        return abs(self.factor) * self.motion.peak_horizontal(since)

    def vertical_range(self, since: float = 0.0) -> tuple[float, float]:
        """Return the scaled bounds, in order [m/s²]."""
        low, high = (self.vertical * bound for bound in self.motion.vertical_range(since))
        return min(low, high), max(low, high)


@dataclass(frozen=True, slots=True, kw_only=True)
class Rotated(Transformed):
    """The base motion `motion`, rotated by `angle` [rad] about the vertical."""

    angle: Angle

    def made_by(self) -> tuple[Callable[..., BaseMotion], Mapping[str, Any]]:
        """Return the constructor: `BaseMotion.rotated`, with its arguments."""
        return BaseMotion.rotated, {"motion": self.motion, "angle": self.angle}

    def changed(self, x: Any, y: Any, z: Any) -> tuple[Any, Any, Any]:
        """Return the rotated vector."""
        cos, sin = math.cos(self.angle), math.sin(self.angle)
        return cos * x - sin * y, sin * x + cos * y, z


@dataclass(frozen=True, slots=True, kw_only=True)
class Delayed(Transformed):
    """The base motion `motion`, delayed by `delay` [s]; a negative delay skips its first part."""

    delay: Delay

    def made_by(self) -> tuple[Callable[..., BaseMotion], Mapping[str, Any]]:
        """Return the constructor: `BaseMotion.delayed`, with its arguments."""
        return BaseMotion.delayed, {"motion": self.motion, "delay": self.delay}

    def derivative(self, time: npt.ArrayLike, order: int) -> Components:
        """Return the delayed displacement (`order` 0), velocity (1) or acceleration (2)."""
        t = np.asarray(time, dtype=float) - self.delay
        if self.delay <= 0.0:
            return self.motion.derivative(t, order)
        running = np.maximum(t, 0.0)
        values = self.motion.derivative(running, order)
        if order == ACCELERATION:
            x, y, z = (np.where(t < 0.0, 0.0, value) for value in values)
        elif order == VELOCITY:
            x, y, z = values
        else:
            initial = self.motion.derivative(0.0, VELOCITY)
            x, y, z = (value + rate * (t - running) for value, rate in zip(values, initial, strict=True))
        return x, y, z

    def peak_horizontal(self, since: float = 0.0) -> float:
        """Return the bound of the motion from the delayed time on [m/s²]."""
        return self.motion.peak_horizontal(max(0.0, since - self.delay))

    def vertical_range(self, since: float = 0.0) -> tuple[float, float]:
        """Return the bounds of the motion from the delayed time on [m/s²], including 0 before the start."""
        low, high = self.motion.vertical_range(max(0.0, since - self.delay))
        return (min(low, 0.0), max(high, 0.0)) if since < self.delay else (low, high)

    @property
    def duration(self) -> float:
        """The duration of the motion plus the delay [s]; 0 for a base that never moves."""
        return max(0.0, self.motion.duration + self.delay) if self.motion.duration > 0.0 else 0.0

    @property
    def breaks(self) -> tuple[float, ...]:
        """The onset and the delayed breaks of the motion [s]."""
        onset = (self.delay,) if self.delay > 0.0 else ()
        return onset + tuple(time + self.delay for time in self.motion.breaks if time + self.delay > 0.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Offset(Transformed):
    """The base motion `motion` and a constant horizontal acceleration [m/s²] from t = 0 on, without end.

    In the frame of a base that is out of level by a small angle δ, gravity has the horizontal component g sin δ: the
    column moves as on a level base with this acceleration. A record whose instrument has a zero offset has it too.
    `duration` remains that of the motion.
    """

    offset_x: OffsetAcceleration
    offset_y: OffsetAcceleration

    def made_by(self) -> tuple[Callable[..., BaseMotion], Mapping[str, Any]]:
        """Return the constructor: `BaseMotion.offset`, with its arguments."""
        return BaseMotion.offset, {"motion": self.motion, "offset_x": self.offset_x, "offset_y": self.offset_y}

    def derivative(self, time: npt.ArrayLike, order: int) -> Components:
        """Return displacement (`order` 0), velocity (1) or acceleration (2); the base starts at rest at the origin."""
        t = np.asarray(time, dtype=float)
        x, y, z = self.motion.derivative(t, order)
        share = (0.5 * t * t, t, np.ones_like(t))[order]
        return x + self.offset_x * share, y + self.offset_y * share, z

    def peak_horizontal(self, since: float = 0.0) -> float:
        """Return the bound of the motion plus the constant acceleration [m/s²]."""
        return self.motion.peak_horizontal(since) + math.hypot(self.offset_x, self.offset_y)

    def directions(self) -> tuple[tuple[float, float], ...]:
        """Return the directions of the motion and of the constant acceleration [m/s²]."""
        return (*self.motion.directions(), (self.offset_x, self.offset_y))


BASE_AT_REST = Sum()
"""A base at rest."""


def require_motion(name: str, motion: object) -> None:
    """Raise ParameterError unless `motion` is a base motion."""
    if not isinstance(motion, BaseMotion):
        message = f"{name} must be a base motion such as Harmonic.circular(...), got {motion!r}"
        raise ParameterError(message)


@dataclass(frozen=True, slots=True, kw_only=True)
class OneOf(Following):
    """One of several base motions: number `chosen` of `motions`, from 0; ensembles vary it as `motion`.

    Parameters
    ----------
    motions
        Base motions, at least one.
    chosen
        Number of the motion.

    Raises
    ------
    ParameterError
        If `motions` is empty or has no motion with this number.

    Examples
    --------
    >>> import stylobate as sb
    >>> weak, strong = (sb.Pulse.one_sine(acceleration=a, angular_frequency=3.0) for a in (1.0, 5.0))
    >>> model = sb.Slender(sb.Column.solid(radius=0.2, height=2.0, density=2700.0))
    >>> shaken = sb.OneOf(motions=(weak, strong))
    >>> sb.with_parameters(model, shaken, motion=1)[1].peak_horizontal()
    5.0
    """

    motions: tuple[BaseMotion, ...]
    chosen: Chosen = 0

    def validate(self) -> None:
        """Raise ParameterError unless a motion with the number `chosen` exists."""
        object.__setattr__(self, "motions", tuple(self.motions))
        for motion in self.motions:
            require_motion("motions", motion)
        count, number = len(self.motions), self.chosen
        if not (0 <= number < count and float(number).is_integer()):
            message = f"motion must be a whole number from 0 to {count - 1}, of {count} motions; got {number!r}"
            raise ParameterError(message)
        object.__setattr__(self, "chosen", int(number))

    def made_by(self) -> tuple[Callable[..., BaseMotion], Mapping[str, Any]]:
        """Return the constructor: the selection by number, with its arguments."""
        return OneOf, {"motions": self.motions, "chosen": self.chosen}

    def choose(self, number: float) -> Self:
        """Choose the motion with another `number`."""
        return replace(self, chosen=number)  # type: ignore[arg-type]  # checked at construction

    @property
    def followed(self) -> BaseMotion:
        """The chosen motion."""
        return self.motions[self.chosen]


def members_of(motion: BaseMotion) -> tuple[BaseMotion, ...]:
    """Return all motions that `motion` selects from, transformed like `motion`; only `motion` without selection."""
    if isinstance(motion, OneOf):
        return motion.motions
    if isinstance(motion, Transformed):
        return tuple(replace(motion, motion=member) for member in members_of(motion.motion))
    return (motion,)


def number_of(motion: BaseMotion) -> int:
    """Return the index of `motion` in `members_of`."""
    if isinstance(motion, OneOf):
        return motion.chosen
    return number_of(motion.motion) if isinstance(motion, Transformed) else 0


def with_choice(motion: BaseMotion, number: float) -> BaseMotion | None:
    """Return `motion` with another `number` chosen, or None if it is not one of several."""
    if isinstance(motion, OneOf):
        return motion.choose(number)
    if not isinstance(motion, Transformed):
        return None
    inner = with_choice(motion.motion, number)
    return None if inner is None else replace(motion, motion=inner)
