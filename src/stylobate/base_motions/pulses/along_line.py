"""Base motion along one line with a waveform and a start time."""

import math
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from stylobate.base_motions.base import ACCELERATION, DISPLACEMENT, VELOCITY, Components, along_azimuth
from stylobate.base_motions.combined import BaseMotion
from stylobate.base_motions.numbers import Direction, Start, VerticalRatio
from stylobate.base_motions.pulses.waveform import Waveform
from stylobate.errors import ParameterError


@dataclass(frozen=True, slots=True, kw_only=True)
class AlongLine(BaseMotion):
    """Base class of `Pulse`, without its named constructors."""

    ends: ClassVar[bool] = True

    waveform: Waveform
    direction: Direction = 0.0
    start: Start = 0.0
    vertical: VerticalRatio = 0.0
    _turning_points: tuple[tuple[float, float], ...] = field(init=False, repr=False, compare=False)

    def validate(self) -> None:
        """Raise ParameterError unless `waveform` is a Waveform; find its turning points."""
        if not isinstance(self.waveform, Waveform):
            message = f"waveform must be a Waveform such as Ricker(...), got {self.waveform!r}"
            raise ParameterError(message)
        object.__setattr__(self, "_turning_points", self.waveform.turning_points())

    def derivative(self, time: npt.ArrayLike, order: int) -> Components:
        """Return the displacement (`order` 0), velocity (1) or acceleration (2) along x, y and z."""
        t = np.asarray(time, dtype=float)
        length = self.waveform.duration
        running = np.clip(t - self.start, 0.0, length)
        along = self.waveform.derivative(running, order)
        if order == ACCELERATION:
            along = np.where((t >= self.start) & (t < self.duration), along, 0.0)
        elif order == DISPLACEMENT:
            left = float(self.waveform.derivative(np.array(length), VELOCITY))
            along = along + left * np.maximum(t - self.start - length, 0.0)
        return math.cos(self.direction) * along, math.sin(self.direction) * along, self.vertical * along

    def peak_horizontal(self, since: float = 0.0) -> float:
        """Return sup |a_h| from `since` on [m/s²]: exact, or above it by the margin of the waveform."""
        return max(map(abs, self._range(since)))

    def vertical_range(self, since: float = 0.0) -> tuple[float, float]:
        """Return inf a_z and sup a_z from `since` on [m/s²], 0 included."""
        low, high = (self.vertical * bound for bound in self._range(since))
        return min(low, high), max(low, high)

    def directions(self) -> tuple[tuple[float, float], ...]:
        """Return the peak acceleration along the line [m/s²]."""
        return along_azimuth(self.direction, self.peak_horizontal())

    @property
    def duration(self) -> float:
        """End of the pulse [s]; the base then moves uniformly or rests."""
        return self.start + self.waveform.duration

    @property
    def highest_frequency(self) -> float:
        """Highest angular frequency of the waveform [rad/s]."""
        return self.waveform.highest_frequency

    @property
    def breaks(self) -> tuple[float, ...]:
        """Start, unless zero, and end [s]."""
        return (self.start, self.duration) if self.start > 0.0 else (self.duration,)

    def _range(self, since: float) -> tuple[float, float]:
        """Return inf and sup of the acceleration along the line from `since` on, and 0 [m/s²]."""
        if since >= self.duration:
            return 0.0, 0.0
        length = self.waveform.duration
        begun = min(max(since - self.start, 0.0), length)
        ends = self.waveform.derivative(np.array([begun, length]), ACCELERATION).tolist()
        values = (*ends, *(value for time, value in self._turning_points if time >= begun))
        margin = self.waveform.margin
        return min(0.0, min(values) - margin), max(0.0, max(values) + margin)
