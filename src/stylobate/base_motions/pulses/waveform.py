"""Interface of a waveform: acceleration of a pulse along its line, with integrals and extremes."""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from stylobate.quantities import Declared

Floats = npt.NDArray[np.float64]

# Cells per shortest period in the search of turning points, and bisections of a cell with a turning point.
_CELLS_PER_PERIOD = 1024
_HALVINGS = 60


class Waveform(Declared, ABC):
    """An acceleration along a line from the time 0 to `duration`, with its integrals and extremes.

    Notes
    -----
    For developers: a custom waveform is a frozen dataclass that implements `duration`, `highest_frequency`,
    `derivative` and `turning_points`. Pulse(waveform=…) then converts it to a base motion.
    """

    __slots__ = ()

    constructor: ClassVar[str] = ""
    """The constructor of `Pulse` with the parameters of this waveform; empty for a custom waveform."""

    @property
    @abstractmethod
    def duration(self) -> float:
        """Duration of the waveform [s]."""

    @property
    @abstractmethod
    def highest_frequency(self) -> float:
        """Highest angular frequency in the acceleration [rad/s]."""

    @abstractmethod
    def derivative(self, time: Floats, order: int) -> Floats:
        """Compute the displacement (`order` 0) [m], velocity (1) [m/s] or acceleration (2) [m/s²].

        Parameters
        ----------
        time
            Times from 0 to `duration` [s].
        order
            0, 1 or 2. Displacement and velocity begin with 0; the acceleration at `duration` is the last one.
        """

    @abstractmethod
    def turning_points(self) -> tuple[tuple[float, float], ...]:
        """Return time [s] and acceleration [m/s²] of the extremes between start and end, in order."""

    @property
    def margin(self) -> float:
        """Maximum excess of the acceleration over its values at `turning_points` and the ends [m/s²]."""
        return 0.0


def found_turning_points(
    acceleration: Callable[[Floats], Floats], slope: Callable[[Floats], Floats], duration: float, frequency: float
) -> tuple[tuple[float, float], ...]:
    """Find time and acceleration at sign changes of the `slope`, by bisection of 1024 cells per shortest period.

    Two turning points in one cell are missed; see `unseen`.
    """
    edges = np.linspace(0.0, duration, _cells(duration, frequency) + 1)
    rising = slope(edges) > 0.0
    turns = np.flatnonzero(rising[1:] != rising[:-1])
    low, high = edges[turns], edges[turns + 1]
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        before = (slope(middle) > 0.0) == rising[turns]
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    times = 0.5 * (low + high)
    return tuple(zip(times.tolist(), acceleration(times).tolist(), strict=True))


def unseen(third: float, duration: float, frequency: float) -> float:
    """Return the maximum excess of two turning points in a cell of width h over its ends: h³/12 sup |d³a/dt³|.

    Between the turning points t1 and t2 the slope is bounded by ½(t − t1)(t2 − t) times `third` = sup |d³a/dt³|, since
    it vanishes at both.
    """
    return third * (duration / _cells(duration, frequency)) ** 3 / 12.0


def _cells(duration: float, frequency: float) -> int:
    return math.ceil(_CELLS_PER_PERIOD * frequency * duration / (2.0 * math.pi))
