"""Harmonic base motion: elliptic, circular, straight, vertical or oblique."""

import cmath
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Annotated, Any, ClassVar, Self

import numpy as np
import numpy.typing as npt

from stylobate.base_motions.base import (
    ACCELERATION,
    VELOCITY,
    Acceleration,
    Amplitudes,
    AngularFrequency,
    Components,
    Direction,
    Frequency,
    Phase,
    Phases,
    Ramp,
    Rise,
    RiseOfPath,
    Sense,
    StartPhase,
    Stroke,
    question_path,
)
from stylobate.base_motions.combined import BaseMotion, Rotated, Scaled
from stylobate.quantities import Quantity, Stated, checked_arguments, stating

# Below this |z| the series of the integrals of exp is more accurate than their closed form.
_SERIES_RADIUS = 0.5
_SERIES_TERMS = 18

_ROUNDING = 8.0 * float(np.finfo(float).eps)


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Harmonic(BaseMotion):
    """Harmonic base acceleration a_i cos(Ωt + start_phase + φ_i) along x, y and z, with an optional ramp.

    Named constructors specify it by acceleration (`circular`, `straight`, `elliptic`, `vertical`, `oblique`) or by the
    path of the base (`displacement_amplitude`, `stroke`, `orbit`). A motion keeps the numbers of its constructor:
    descriptions state them, and maps and ensembles vary them, such as `stroke`, `frequency` and `angle`.

    Parameters
    ----------
    amplitude
        Acceleration amplitudes along x, y and z [m/s²].
    phase
        Phases φ of the three components [rad].
    angular_frequency
        Ω [rad/s].
    start_phase
        Phase of the whole motion at t = 0 [rad]. With 0 a harmonic motion starts at its peak.
    ramp
        Time in which the amplitude grows from 0 to its full value as ½(1 − cos(πt/ramp)) [s]; 0 for none.

    Attributes
    ----------
    stated
        The named constructor with its arguments; None for a motion by amplitudes and phases.

    Notes
    -----
    Velocity and displacement follow the steady motion, without drift.

    Raises
    ------
    ParameterError
        If a number is not finite or the frequency is not positive.

    Examples
    --------
    >>> motion = Harmonic.circular(acceleration=0.65, angular_frequency=1.8)
    >>> motion.acceleration(0.0).round(12)
    array([0.65, 0.  , 0.  ])
    >>> Harmonic.orbit(diameter=0.02, rpm=300.0).peak_horizontal()  # 0.01 m (10π rad/s)²
    9.869604401089358
    >>> Harmonic.stroke(stroke=0.0012, frequency=50.0, angle=0.4)
    Harmonic.stroke(stroke=0.0012 m, frequency=50 Hz, angle=0.4 rad)
    """

    responds: ClassVar[bool] = True

    amplitude: Annotated[
        tuple[float, float, float], Quantity(unit="m/s²", text="amplitudes along the axes", components=3)
    ]
    phase: Annotated[
        tuple[float, float, float], Quantity(unit="rad", text="phases of the components", components=3)
    ] = (0.0, 0.0, 0.0)
    angular_frequency: AngularFrequency
    start_phase: StartPhase = 0.0
    ramp: Ramp = 0.0
    stated: Stated | None = field(default=None, init=False, compare=False)

    def made_by(self) -> tuple[Callable[..., BaseMotion], Mapping[str, Any]]:
        """Return the named constructor that made this motion, or else the class, with its arguments."""
        if self.stated is None:
            return BaseMotion.made_by(self)
        return getattr(type(self), self.stated.constructor), self.stated.arguments

    @classmethod
    @checked_arguments
    def elliptic(
        cls,
        *,
        amplitude: Annotated[Sequence[float], Quantity(unit="m/s²", text="amplitudes along the axes", components=2)],
        phase: Phase,
        angular_frequency: AngularFrequency,
        start_phase: StartPhase = 0.0,
        ramp: Ramp = 0.0,
    ) -> Self:
        """Create an elliptic motion: amplitudes (a1, a2) [m/s²], `phase` φ2 of axis 2 relative to axis 1."""
        a1, a2 = amplitude
        return cls(
            amplitude=(a1, a2, 0.0),
            phase=(0.0, phase, 0.0),
            angular_frequency=angular_frequency,
            start_phase=start_phase,
            ramp=ramp,
        )

    @classmethod
    @checked_arguments
    def circular(
        cls,
        *,
        acceleration: Acceleration,
        angular_frequency: AngularFrequency,
        sense: Sense = 1,
        start_phase: StartPhase = 0.0,
        ramp: Ramp = 0.0,
    ) -> Self:
        """Create a circular motion with constant `acceleration` [m/s²]; `sense` +1 anticlockwise, −1 clockwise."""
        return cls.elliptic(
            amplitude=(acceleration, acceleration),
            phase=-sense * math.pi / 2.0,
            angular_frequency=angular_frequency,
            start_phase=start_phase,
            ramp=ramp,
        )

    @classmethod
    @checked_arguments
    def straight(
        cls,
        *,
        acceleration: Acceleration,
        angular_frequency: AngularFrequency,
        direction: Direction = 0.0,
        start_phase: StartPhase = 0.0,
        ramp: Ramp = 0.0,
    ) -> Self:
        """Create a motion along a horizontal line at `direction` [rad] from x, amplitude `acceleration` [m/s²]."""
        return cls.elliptic(
            amplitude=(acceleration * math.cos(direction), acceleration * math.sin(direction)),
            phase=0.0,
            angular_frequency=angular_frequency,
            start_phase=start_phase,
            ramp=ramp,
        )

    @classmethod
    @stating(responds=False)
    @checked_arguments
    def vertical(
        cls,
        *,
        acceleration: Acceleration,
        angular_frequency: AngularFrequency,
        start_phase: StartPhase = 0.0,
        ramp: Ramp = 0.0,
    ) -> Self:
        """Create a vertical motion of amplitude `acceleration` [m/s²]; add it to a horizontal motion with `+`."""
        return cls(
            amplitude=(0.0, 0.0, acceleration),
            angular_frequency=angular_frequency,
            start_phase=start_phase,
            ramp=ramp,
        )

    @classmethod
    @stating(responds=False)
    @checked_arguments
    def oblique(
        cls,
        *,
        acceleration: Acceleration,
        angular_frequency: AngularFrequency,
        angle: Rise,
        direction: Direction = 0.0,
        start_phase: StartPhase = 0.0,
        ramp: Ramp = 0.0,
    ) -> Self:
        """Create a motion along a line that rises at `angle` [rad] towards `direction` [rad], as of a conveyor.

        As in all studies `acceleration` is the horizontal amplitude [m/s²]; the vertical amplitude is tan(angle) times
        as large.
        """
        return cls(
            amplitude=(
                acceleration * math.cos(direction),
                acceleration * math.sin(direction),
                acceleration * math.tan(angle),
            ),
            angular_frequency=angular_frequency,
            start_phase=start_phase,
            ramp=ramp,
        )

    @classmethod
    @checked_arguments
    def displacement_amplitude(
        cls,
        *,
        amplitude: Amplitudes,
        phase: Phases = (0.0, 0.0, 0.0),
        angular_frequency: AngularFrequency,
        start_phase: StartPhase = 0.0,
        ramp: Ramp = 0.0,
    ) -> Self:
        """Create a motion with the displacement d_i cos(Ωt + start_phase + φ_i), d = `amplitude` (x, y, z) [m]."""
        question_path("amplitude", max(map(abs, amplitude)), 1.0, angular_frequency)
        return cls._along_path(
            *amplitude, phase=phase, angular_frequency=angular_frequency, start_phase=start_phase, ramp=ramp
        )

    @classmethod
    def _along_path(
        cls,
        x: float,
        y: float,
        z: float,
        *,
        angular_frequency: float,
        start_phase: float,
        ramp: float,
        phase: Sequence[float] = (0.0, 0.0, 0.0),
    ) -> Self:
        square = angular_frequency**2
        a, b, c = phase
        return cls(
            amplitude=(-square * x, -square * y, -square * z),
            phase=(a, b, c),
            angular_frequency=angular_frequency,
            start_phase=start_phase,
            ramp=ramp,
        )

    @classmethod
    @checked_arguments
    def stroke(
        cls,
        *,
        stroke: Stroke,
        frequency: Frequency,
        angle: RiseOfPath = 0.0,
        direction: Direction = 0.0,
        start_phase: StartPhase = 0.0,
        ramp: Ramp = 0.0,
    ) -> Self:
        """Create a straight motion from its `stroke` from peak to peak [m] and its `frequency` [Hz].

        The line rises at `angle` [rad] above the horizontal, as of a conveyor, towards `direction` [rad]. The stroke is
        measured along the line.
        """
        half = stroke / 2.0
        horizontal = half * math.cos(angle)
        question_path("stroke", stroke, 0.5, 2.0 * math.pi * frequency)
        return cls._along_path(
            horizontal * math.cos(direction),
            horizontal * math.sin(direction),
            half * math.sin(angle),
            angular_frequency=2.0 * math.pi * frequency,
            start_phase=start_phase,
            ramp=ramp,
        )

    @classmethod
    @checked_arguments
    def orbit(
        cls,
        *,
        diameter: Annotated[float, Quantity(unit="m", text="diameter of the circle", gt=0.0)],
        rpm: Annotated[float, Quantity(unit="1/min", text="turns per minute", gt=0.0)],
        sense: Sense = 1,
        start_phase: StartPhase = 0.0,
        ramp: Ramp = 0.0,
    ) -> Self:
        """Create a circular motion from the path `diameter` [m] and turns per minute, as of an orbital shaker."""
        radius = diameter / 2.0
        question_path("diameter", diameter, 0.5, 2.0 * math.pi * rpm / 60.0)
        return cls._along_path(
            radius,
            radius,
            0.0,
            phase=(0.0, -sense * math.pi / 2.0, 0.0),
            angular_frequency=2.0 * math.pi * rpm / 60.0,
            start_phase=start_phase,
            ramp=ramp,
        )

    def derivative(self, time: npt.ArrayLike, order: int) -> Components:
        """Compute the displacement (`order` 0), velocity (1) or acceleration (2) along x, y and z."""
        t = np.asarray(time, dtype=float)
        frequency = self.angular_frequency
        gain = (-1.0, 1.0, 1.0)[order] / frequency ** (ACCELERATION - order)
        angle = frequency * t + (self.start_phase - (math.pi / 2.0 if order == VELOCITY else 0.0))
        (ax, ay, az), (fx, fy, fz) = self.amplitude, self.phase
        x = gain * ax * np.cos(angle + fx)
        y = gain * ay * np.cos(angle + fy)
        z = gain * az * np.cos(angle + fz) if az != 0.0 else 0.0 * angle
        if self.ramp > 0.0 and np.any(t < self.ramp):
            early = t < self.ramp
            x = np.where(early, self._ramped(t, order, ax, fx), x)
            y = np.where(early, self._ramped(t, order, ay, fy), y)
            z = np.where(early, self._ramped(t, order, az, fz), z)
        return x, y, z

    def peak_horizontal(self, since: float = 0.0) -> float:
        """Compute sup |a_h| = |p| + |q| [m/s²], where p and q are the circular components of the ellipse."""
        del since
        (ax, ay, _), (fx, fy, _) = self.amplitude, self.phase
        x, x_aside, y, y_aside = ax * math.cos(fx), ax * math.sin(fx), ay * math.cos(fy), ay * math.sin(fy)
        p, q = math.hypot(x - y_aside, x_aside + y), math.hypot(x + y_aside, y - x_aside)
        return 0.5 * p + 0.5 * q

    def vertical_range(self, since: float = 0.0) -> tuple[float, float]:
        """Return the minimum and maximum vertical acceleration [m/s²]."""
        del since
        largest = abs(self.amplitude[2])
        return -largest, largest

    def directions(self) -> tuple[tuple[float, float], ...]:
        """Return the two horizontal vectors that multiply cos Ωt and sin Ωt [m/s²]."""
        (ax, ay, _), (fx, fy, _) = self.amplitude, self.phase
        return (
            (ax * _exact(math.cos(fx)), ay * _exact(math.cos(fy))),
            (ax * _exact(math.sin(fx)), ay * _exact(math.sin(fy))),
        )

    @property
    def period(self) -> float:
        """2π/Ω [s]."""
        return 2.0 * math.pi / self.angular_frequency

    @property
    def highest_frequency(self) -> float:
        """Ω [rad/s]; the ramp ends at `breaks`."""
        return self.angular_frequency

    @property
    def breaks(self) -> tuple[float, ...]:
        """The end of the ramp [s]."""
        return (self.ramp,) if self.ramp > 0.0 else ()

    def _ramped(self, t: npt.NDArray[np.float64], order: int, a: float, phase: float) -> npt.NDArray[np.float64]:
        if order == ACCELERATION:
            full = a * np.cos(self.angular_frequency * t + self.start_phase + phase)
            return np.asarray(0.5 * (1.0 - np.cos(math.pi * t / self.ramp)) * full)
        # ½(1 − cos νt) cos(Ωt + φ) is a sum of three harmonics, each integrated back from the end of the ramp, where
        # the steady motion begins.
        end, s = self.ramp, np.minimum(t, self.ramp) - self.ramp
        slow = math.pi / end
        angle = self.angular_frequency * end + self.start_phase + phase
        total = np.zeros_like(s)
        for weight, rate, shift in ((0.5, 0.0, 0.0), (-0.25, slow, math.pi), (-0.25, -slow, -math.pi)):
            w = self.angular_frequency + rate
            total += (
                weight
                * a
                * np.real(cmath.exp(1j * (angle + shift)) * _integral_of_exp(1j * w * s, ACCELERATION - order))
            )
        frequency = self.angular_frequency
        velocity = a * math.sin(angle) / frequency
        if order == VELOCITY:
            return velocity + s * total
        return -a * math.cos(angle) / frequency**2 + velocity * s + s**2 * total


def _integral_of_exp(z: npt.NDArray[np.complexfloating], times: int) -> npt.NDArray[np.complexfloating]:
    """Return eᶻ, (eᶻ − 1)/z or (eᶻ − 1 − z)/z²: exp integrated 0, 1 or 2 times from 0, over zⁿ."""
    if times == 0:
        return np.asarray(np.exp(z))
    series = np.zeros_like(z)
    for n in range(_SERIES_TERMS, -1, -1):
        series = series * z + 1.0 / math.factorial(n + times)
    small = np.abs(z) < _SERIES_RADIUS
    safe = np.where(small, 1.0, z)
    closed = np.expm1(safe) / safe if times == 1 else (np.expm1(safe) - safe) / safe**2
    return np.asarray(np.where(small, series, closed))


def _exact(ratio: float) -> float:
    """Return a sine or cosine, 0 if it differs from 0 only by rounding of the angle."""
    return 0.0 if abs(ratio) < _ROUNDING else ratio


def as_harmonic(motion: BaseMotion) -> Harmonic | None:
    """Convert a scaled or rotated harmonic motion to one Harmonic; None for other motions."""
    if type(motion) is Harmonic:
        return motion
    if not isinstance(motion, (Scaled, Rotated)) or type(motion) not in (Scaled, Rotated):
        return None
    inner = as_harmonic(motion.motion)
    if inner is None:
        return None
    if isinstance(motion, Scaled) and motion.factor > 0.0 and motion.vertical > 0.0:  # without rounding of the phases
        return replace(inner, amplitude=motion.changed(*inner.amplitude))
    vector = motion.changed(*(cmath.rect(a, phase) for a, phase in zip(inner.amplitude, inner.phase, strict=True)))
    (x, y, z), (first, second, third) = map(abs, vector), map(cmath.phase, vector)
    return replace(inner, amplitude=(x, y, z), phase=(first, second, third))
