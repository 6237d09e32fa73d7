"""Interface of a base motion: acceleration over time, and properties for integrators and criteria."""

import math
from abc import ABC, abstractmethod
from inspect import isfunction
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from stylobate.base_motions.numbers import Duration, HighestFrequency, PeakHorizontal, Period
from stylobate.errors import ParameterError, as_numbers
from stylobate.quantities import Declared

DISPLACEMENT, VELOCITY, ACCELERATION = range(3)
"""Orders of the time derivative of the displacement."""

Components = tuple[npt.NDArray[np.float64], npt.NDArray[np.float64], npt.NDArray[np.float64]]


def along_azimuth(azimuth: float, size: float) -> tuple[tuple[float, float], ...]:
    """Return the one horizontal vector of this size that spans a motion along a line."""
    return ((size * math.cos(azimuth), size * math.sin(azimuth)),)


class MotionContract(Declared, ABC):
    """The properties of a base motion from t = 0 on, in SI units, along x, y (horizontal) and z (up)."""

    __slots__ = ()

    ends: ClassVar[bool] = False
    """Whether all motions of the class end, so that a run under them needs no duration."""

    responds: ClassVar[bool] = False
    """Whether response curves can be computed for motions of the class: harmonic motions that can be horizontal."""

    def __init_subclass__(cls, **options: Any) -> None:
        """Reject fields that would replace a method or have a method as default."""
        super().__init_subclass__(**options)
        for name in vars(cls).get("__annotations__", {}):
            if isfunction(getattr(super(cls, cls), name, None)):
                message = f"{name}: a method of every base motion (got a field of {cls.__name__}). Call the field peak."
                raise ParameterError(message)

    @abstractmethod
    def derivative(self, time: npt.ArrayLike, order: int) -> Components:
        """Return the displacement (`order` 0), velocity (1) or acceleration (2) along x, y and z.

        Parameters
        ----------
        time
            Times of any shape [s].
        order
            DISPLACEMENT (0) [m], VELOCITY (1) [m/s] or ACCELERATION (2) [m/s²].

        Returns
        -------
        tuple
            Three arrays of the shape of `time`.
        """

    @abstractmethod
    def peak_horizontal(self, since: float = 0.0) -> PeakHorizontal:
        """Return sup |a_h| from the time `since` [s] on, or a bound above it [m/s²]."""

    @abstractmethod
    def vertical_range(self, since: float = 0.0) -> tuple[float, float]:
        """Return inf a_z and sup a_z from the time `since` [s] on, or bounds outside them [m/s²]."""

    @abstractmethod
    def directions(self) -> tuple[tuple[float, float], ...]:
        """Return horizontal vectors that span all horizontal accelerations of this motion [m/s²].

        Parallel vectors (or none) mean a motion along one straight line, which allows planar rocking.
        """

    @property
    def duration(self) -> Duration:
        """Time after which the base stands still [s]; infinite for a motion that never ends."""
        return math.inf

    @property
    def period(self) -> Period | None:
        """Common period of the steady motion [s]; None without period."""
        return None

    @property
    def highest_frequency(self) -> HighestFrequency:
        """Highest angular frequency in the acceleration [rad/s]; 0 if the acceleration is constant between its breaks.

        Uplift is searched on 64 samples per period of this frequency, and no step exceeds half of this period. A custom
        motion with varying acceleration must define it; runs reject a motion that varies faster.
        """
        return 0.0

    @property
    def mean_frequency(self) -> float:
        """Mean angular frequency of the peaks of the acceleration [rad/s]; by default the highest frequency.

        It estimates the duration of the push after uplift, and with it the energy below which a column counts as at
        rest.
        """
        return self.highest_frequency

    @property
    def breaks(self) -> tuple[float, ...]:
        """Times at which the acceleration is not smooth [s], increasing; integrators stop there."""
        return ()

    @property
    def degree(self) -> int | None:
        """Degree of the acceleration as a polynomial between its breaks; None if it is no polynomial.

        A motion that is linear between breaks, such as a record, is tabulated exactly.
        """
        return None

    def acceleration(self, time: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return the base acceleration at `time` [s], shape (..., 3) [m/s²]."""
        return np.stack(self.derivative(as_numbers("time", time, "s"), ACCELERATION), axis=-1)

    def velocity(self, time: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return the base velocity at `time` [s], shape (..., 3) [m/s]."""
        return np.stack(self.derivative(as_numbers("time", time, "s"), VELOCITY), axis=-1)

    def displacement(self, time: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return the base displacement at `time` [s], shape (..., 3) [m]."""
        return np.stack(self.derivative(as_numbers("time", time, "s"), DISPLACEMENT), axis=-1)
