"""Run of a vibratory machine: run-up from rest through its resonance, steady vibration, and run-down to rest."""

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Annotated, Any, ClassVar

import numpy as np
import numpy.typing as npt

from stylobate.base_motions.base import ACCELERATION, DISPLACEMENT, Components
from stylobate.base_motions.combined import BaseMotion
from stylobate.base_motions.numbers import Direction, Frequency, RiseOfPath, StartPhase, Stroke
from stylobate.quantities import Quantity

Floats = npt.NDArray[np.float64]

RunUp = Annotated[float, Quantity(unit="s", text="time of the run-up", gt=0.0)]
RunDown = Annotated[float, Quantity(unit="s", text="time of the run-down", gt=0.0)]
Steady = Annotated[float, Quantity(unit="s", text="time of steady vibration", ge=0.0)]
Resonance = Annotated[float, Quantity(unit="Hz", text="resonance of the machine on its springs; 0 for none", ge=0.0)]
ResonanceDamping = Annotated[
    float, Quantity(text="damping ratio of the machine", ge=0.005, le=1.0, note="since the peak is sampled")
]

# Samples of the envelope, and the margin of its bound over their maximum.
_SAMPLES, _MARGIN = 8193, 1.01


@dataclass(frozen=True, slots=True, kw_only=True)
class MachineRun(BaseMotion):
    """A vibratory machine with an unbalance drive: run-up from rest, work at its frequency, run-down to rest.

    The path is a line, as of `Harmonic.stroke`. During run-up and run-down the frequency changes along half a cosine
    wave, and the stroke follows the response of the machine on its springs to its unbalance: it grows where the
    frequency passes the resonance. After the run-down the base stands still: the track has stopped.

    Parameters
    ----------
    stroke
        Stroke from peak to peak at the working frequency [m].
    frequency
        Working frequency [Hz].
    angle
        Angle of the line above the horizontal [rad].
    direction
        Azimuth towards which the line rises [rad].
    run_up, steady, run_down
        Durations of run-up, steady vibration and run-down [s].
    resonance
        Natural frequency f_n of the machine on its springs [Hz]. 0 keeps the stroke constant, as of a crank drive.
    resonance_damping
        Damping ratio ζ of this oscillation.
    start_phase
        Phase of the unbalance at t = 0 [rad].

    Notes
    -----
    With Φ̇ = 2πf the displacement along the line is

        ½ stroke Re[g(f) e^{iΦ}],    g = h(f)/h(frequency),    h(f) = f²/(f_n² − f² + 2iζ f_n f).

    This is the steady response at the present frequency. A machine that passes its resonance, f_n (1 ± ζ), in fewer
    than about 1/ζ cycles reaches a smaller peak, and its free oscillation after the passage is left out. Velocity and
    acceleration are the exact derivatives of this displacement.

    Raises
    ------
    ParameterError
        If a number is out of range.

    Examples
    --------
    >>> run = MachineRun(stroke=0.001, frequency=50.0, angle=0.4, run_up=2.0, steady=1.0, run_down=4.0, resonance=8.0)
    >>> run.duration, run.drive_frequency([0.0, 1.0, 2.5]).round(6).tolist()
    (7.0, [0.0, 25.0, 50.0])
    >>> print(run.velocity(7.5))
    [0. 0. 0.]
    """

    ends: ClassVar[bool] = True

    stroke: Stroke
    frequency: Frequency
    angle: RiseOfPath = 0.0
    direction: Direction = 0.0
    run_up: RunUp
    steady: Steady = 0.0
    run_down: RunDown
    resonance: Resonance = 0.0
    resonance_damping: ResonanceDamping = 0.05
    start_phase: StartPhase = 0.0

    def drive_frequency(self, time: npt.ArrayLike) -> Floats:
        """Compute the frequency of the drive at `time` [Hz]."""
        return self._turning(np.asarray(time, dtype=float))[1] / (2.0 * math.pi)

    def derivative(self, time: npt.ArrayLike, order: int) -> Components:
        """Return the displacement (`order` 0), velocity (1) or acceleration (2) along x, y and z."""
        t = np.asarray(time, dtype=float)
        phase = self._turning(t)[0]
        along = 0.5 * self.stroke * np.real(self._envelopes(t)[order] * np.exp(1j * phase))
        if order != DISPLACEMENT:
            along = np.where((t >= 0.0) & (t < self.duration), along, 0.0)
        level, up = math.cos(self.angle), math.sin(self.angle)
        return level * math.cos(self.direction) * along, level * math.sin(self.direction) * along, up * along

    def peak_horizontal(self, since: float = 0.0) -> float:
        """Return a bound of |a_h| from `since` on [m/s²]."""
        return abs(math.cos(self.angle)) * self._peak(since)

    def vertical_range(self, since: float = 0.0) -> tuple[float, float]:
        """Return bounds of a_z from `since` on [m/s²]."""
        largest = abs(math.sin(self.angle)) * self._peak(since)
        return -largest, largest

    def directions(self) -> tuple[tuple[float, float], ...]:
        """Return the peak acceleration along the line [m/s²]."""
        largest = self.peak_horizontal()
        return ((largest * math.cos(self.direction), largest * math.sin(self.direction)),)

    @property
    def duration(self) -> float:
        """Time at which the machine stands still [s]."""
        return self.run_up + self.steady + self.run_down

    @property
    def highest_frequency(self) -> float:
        """The working frequency [rad/s]."""
        return 2.0 * math.pi * self.frequency

    @property
    def breaks(self) -> tuple[float, ...]:
        """Ends of run-up, steady vibration and run-down [s]."""
        return tuple(dict.fromkeys((self.run_up, self.run_up + self.steady, self.duration)))

    def _turning(self, t: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        """Return the phase Φ of the drive, Φ̇, Φ̈ and its derivative."""
        full, up, down = 2.0 * math.pi * self.frequency, self.run_up, self.run_down
        works = up + self.steady
        rising, falling = np.clip(t, 0.0, up), np.clip(t - works, 0.0, down)
        a, b = math.pi * rising / up, math.pi * falling / down
        # ω = ½Ω(1 − cos a) up and ½Ω(1 + cos b) down.
        phase = 0.5 * full * (rising - up / math.pi * np.sin(a)) + full * np.clip(t - up, 0.0, self.steady)
        phase = phase + 0.5 * full * (falling + down / math.pi * np.sin(b)) + self.start_phase
        rate = np.where(t < works, 0.5 * full * (1.0 - np.cos(a)), 0.5 * full * (1.0 + np.cos(b)))
        ups, downs = (t >= 0.0) & (t < up), (t >= works) & (t < self.duration)
        change = (
            0.5
            * full
            * (np.where(ups, math.pi / up * np.sin(a), 0.0) - np.where(downs, math.pi / down * np.sin(b), 0.0))
        )
        second = (
            0.5
            * full
            * (
                np.where(ups, (math.pi / up) ** 2 * np.cos(a), 0.0)
                - np.where(downs, (math.pi / down) ** 2 * np.cos(b), 0.0)
            )
        )
        return phase, rate, change, second

    def _envelopes(self, t: Floats) -> tuple[Any, Any, Any]:
        """Return the factors of e^{iΦ} in displacement, velocity and acceleration along the line, per half stroke."""
        _, w, change, second = self._turning(t)
        g, first, curved = self._gain(w)
        velocity = first * change + 1j * w * g
        acceleration = curved * change**2 + first * second + 2j * w * change * first + (1j * change - w * w) * g
        return g, velocity, acceleration

    def _gain(self, w: Floats) -> tuple[Any, Any, Any]:
        """Return g = h(ω)/h(Ω) with its first and second derivative over ω."""
        if self.resonance == 0.0:
            one = np.ones_like(w, dtype=complex)
            return one, np.zeros_like(one), np.zeros_like(one)
        natural = 2.0 * math.pi * self.resonance

        def parts(rate: Floats) -> tuple[Any, Any]:
            below = natural**2 - rate**2 + 2j * self.resonance_damping * natural * rate
            return below, -2.0 * rate + 2j * self.resonance_damping * natural

        below, slope = parts(w)
        cross = 2.0 * w * below - w**2 * slope
        first = cross / below**2
        curved = (2.0 * below + 2.0 * w**2) / below**2 - 2.0 * slope * cross / below**3
        full = np.asarray(2.0 * math.pi * self.frequency)
        working = full**2 / parts(full)[0]
        return w**2 / below / working, first / working, curved / working

    def _peak(self, since: float) -> float:
        """Return a bound of the acceleration along the line from a time on [m/s²]."""
        if since >= self.duration:
            return 0.0
        return float(_later_peaks(self)[int(max(since, 0.0) / self.duration * (_SAMPLES - 1))])


@lru_cache(maxsize=16)
def _later_peaks(motion: MachineRun) -> Floats:
    """Return a bound of the acceleration from each of many times to the end [m/s²]: tables ask for it at each piece."""
    times = np.linspace(0.0, motion.duration, _SAMPLES)
    envelope = np.abs(motion._envelopes(times)[ACCELERATION])  # noqa: SLF001  a cache is no method
    return np.asarray(_MARGIN * 0.5 * motion.stroke * np.maximum.accumulate(envelope[::-1])[::-1])
