"""The numbers of a base motion that rules of practice use: peaks and elastic spectra."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from typing import Self

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import BaseMotion, Record
from stylobate.base_motions.base import ACCELERATION, VELOCITY
from stylobate.errors import ParameterError, require_not_negative, require_positive

Floats = npt.NDArray[np.float64]

PERIODS: Floats = np.geomspace(0.05, 10.0, 41)
"""Natural periods of the spectra [s]; between them pseudo-velocities are interpolated in log(period)."""

# Values per period of an oscillator, or of the highest frequency of a base motion that is no record.
_PER_PERIOD = 60


@dataclass(frozen=True, slots=True, kw_only=True)
class Shaking:
    """The numbers of a base motion that the rules use.

    Parameters
    ----------
    peak_acceleration
        Peak of the horizontal acceleration vector [m/s²].
    peak_velocity
        Peak of the horizontal velocity vector [m/s].
    peak_vertical
        Peak vertical acceleration [m/s²].
    spectrum
        Function of the damping ratio that returns the horizontal pseudo-acceleration [m/s²] at `PERIODS`.

    Raises
    ------
    ParameterError
        If a peak is negative or not finite.
    """

    peak_acceleration: float
    peak_velocity: float
    spectrum: Callable[[float], Floats]
    peak_vertical: float = 0.0

    def __post_init__(self) -> None:
        for name, unit in (("peak_acceleration", "m/s²"), ("peak_velocity", "m/s"), ("peak_vertical", "m/s²")):
            object.__setattr__(self, name, require_not_negative(name, getattr(self, name), unit))

    @classmethod
    def of(cls, motion: BaseMotion) -> Self:
        """Measure a base motion that ends.

        Peaks and spectra are those of the maximum over all horizontal directions (RotD100), because a round column
        has no preferred direction. A base motion that is no record is sampled.

        Raises
        ------
        ParameterError
            If `motion` is no base motion, or never ends.
        """
        from stylobate.records.intensities import HorizontalComponent, horizontal_peak, peak_acceleration

        record = record_of(motion)
        vector = HorizontalComponent.ROTD100
        return cls(
            peak_acceleration=horizontal_peak(record, ACCELERATION, vector),
            peak_velocity=horizontal_peak(record, VELOCITY, vector),
            peak_vertical=float(peak_acceleration(record)[2]),
            spectrum=cache(lambda damping: _spectrum(record, damping)),
        )

    def scaled(self, factor: float) -> Self:
        """Return the numbers of the same motion times a positive `factor`."""
        factor, own = require_positive("factor", factor), self.spectrum
        return replace(
            self,
            peak_acceleration=factor * self.peak_acceleration,
            peak_velocity=factor * self.peak_velocity,
            peak_vertical=factor * self.peak_vertical,
            spectrum=lambda damping: factor * own(damping),
        )

    def at(self, period: float | Floats, damping: float) -> Floats:
        """Return the pseudo-acceleration [m/s²] at a `period` [s] or several.

        Below the first of `PERIODS` it runs to the peak acceleration at zero, linearly in the period. Above the last it
        decreases as period⁻², as for a constant displacement.
        """
        values, first, last = self.spectrum(damping), PERIODS[0], PERIODS[-1]
        period = np.asarray(period, dtype=float)
        between = np.clip(period, first, last)
        inside = np.interp(np.log(between), np.log(PERIODS), PERIODS * values) / between
        stiff = self.peak_acceleration + (values[0] - self.peak_acceleration) * period / first
        with np.errstate(divide="ignore", invalid="ignore"):
            soft = values[-1] * (last / period) ** 2
        return np.asarray(np.where(period < first, stiff, np.where(period > last, soft, inside)))


def record_of(motion: BaseMotion, per_period: int = _PER_PERIOD) -> Record:
    """Return a base motion that ends as a record: itself, or sampled.

    Parameters
    ----------
    motion
        The base motion.
    per_period
        Samples per period of the highest frequency of a base motion that is no record. The accelerations are linear
        between samples, which is (2π/`per_period`)²/8 of the peak off at most.

    Raises
    ------
    ParameterError
        If `motion` is no base motion, or never ends.
    """
    if not isinstance(motion, BaseMotion):
        raise ParameterError(f"motion: must be a base motion (got {motion!r}). Pass a record or a pulse.")
    if not 0.0 < motion.duration < math.inf:
        raise ParameterError(f"motion: must end after t = 0 (got {motion!r}). Pass a record or a pulse.")
    if isinstance(motion, Record):
        return motion
    number = math.ceil(per_period * motion.duration * max(motion.highest_frequency, 1.0) / (2.0 * math.pi)) + 1
    times = np.linspace(0.0, motion.duration, max(number, per_period))
    return Record(samples=motion.acceleration(times), step=float(times[1]))


def _spectrum(record: Record, damping: float) -> Floats:
    """Return the peak of the horizontal vector of pseudo-accelerations at `PERIODS`, at most 0.2 % low."""
    from stylobate.base_motions.oscillator import oscillator_response

    own, peaks = record.step * np.arange(len(record.samples)), []
    for period in PERIODS:
        step = record.step / math.ceil(_PER_PERIOD * record.step / period)
        times = step * np.arange(math.floor((own[-1] + period) / step) + 1)  # a period of free vibration
        horizontal = np.stack([np.interp(times, own, record.samples[:, axis], right=0.0) for axis in (0, 1)], axis=-1)
        displacement, _ = oscillator_response(horizontal, step, float(period), damping)
        peaks.append((2.0 * math.pi / period) ** 2 * np.hypot(*displacement.T).max())
    return np.array(peaks)
