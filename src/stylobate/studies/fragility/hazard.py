"""Hazard: how often in a year an intensity is exceeded at a site."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from stylobate.errors import ParameterError
from stylobate.studies.fragility.observations import Floats

_LEAST = 2


@dataclass(frozen=True, slots=True, kw_only=True)
class HazardCurve:
    """Annual rates of exceedance, a power law between successive points: straight lines on logarithmic axes.

    Parameters
    ----------
    intensity
        Two or more, positive, increasing.
    rate
        Mean annual rate λ [1/a] at which each is exceeded, positive, nowhere increasing.
    units, quantity
        Of the intensity, as on axes: "m s-2", "peak ground acceleration".

    Raises
    ------
    ParameterError
        If the points are no such curve.

    Examples
    --------
    >>> HazardCurve(intensity=[1.0, 4.0], rate=[1e-2, 1e-4], units="m s-2").at(2.0).round(9).tolist()
    0.001
    """

    intensity: npt.ArrayLike
    rate: npt.ArrayLike
    units: str = "1"
    quantity: str = "intensity"

    def __post_init__(self) -> None:
        x, rate = (_points(name, value) for name, value in (("intensity", self.intensity), ("rate", self.rate)))
        if x.shape != rate.shape:
            message = f"rate must have one number for each intensity, got {rate.size} for {x.size}"
            raise ParameterError(message)
        if np.any(np.diff(x) <= 0.0):
            message = f"intensity must increase, got {x[1:][np.diff(x) <= 0.0][0]!s} after a value no less"
            raise ParameterError(message)
        if np.any(np.diff(rate) > 0.0):
            message = (
                f"rate must not increase with intensity, got {rate[1:][np.diff(rate) > 0.0][0]!s} after a lesser one"
            )
            raise ParameterError(message)
        # A value of its own, whatever becomes of the arrays that it was made from.
        object.__setattr__(self, "intensity", tuple(x.tolist()))
        object.__setattr__(self, "rate", tuple(rate.tolist()))

    @property
    def log_intensity(self) -> Floats:
        """Logarithms of the intensities."""
        return np.asarray(np.log(np.asarray(self.intensity, dtype=float)))

    @property
    def log_rate(self) -> Floats:
        """Logarithms of the rates."""
        return np.asarray(np.log(np.asarray(self.rate, dtype=float)))

    @property
    def slopes(self) -> Floats:
        """Exponents k of λ ~ x^−k between successive points."""
        return np.asarray(-np.diff(self.log_rate) / np.diff(self.log_intensity))

    def at(self, intensity: npt.ArrayLike) -> Floats:
        """Return the rates at which these intensities are exceeded; NaN beyond the ends of the curve."""
        u = np.log(np.asarray(intensity, dtype=float))
        rate = np.exp(np.interp(u, self.log_intensity, self.log_rate, left=np.nan, right=np.nan))
        return np.asarray(rate)


def _points(name: str, value: npt.ArrayLike) -> Floats:
    given = np.asarray(value)
    if given.dtype.kind not in "iuf" or given.ndim != 1 or given.size < _LEAST:
        message = f"{name} must be a list of two or more numbers, got {value!r}"
        raise ParameterError(message)
    array = given.astype(np.float64)
    bad = array[~(np.isfinite(array) & (array > 0.0))]
    if bad.size:
        message = f"{name} must be positive and finite, got {bad[0]!s}; leave such points out"
        raise ParameterError(message)
    return array
