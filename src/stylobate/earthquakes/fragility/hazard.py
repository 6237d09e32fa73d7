"""Hazard curve of a site: annual rates of exceedance of an intensity."""

from dataclasses import dataclass
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from stylobate.cards import Row, Section, card
from stylobate.earthquakes.fragility.observations import Floats
from stylobate.errors import ParameterError, require_positive
from stylobate.records import HorizontalComponent
from stylobate.text import four_digits, unit_in_text

_LEAST = 2


@dataclass(frozen=True, slots=True, kw_only=True)
class HazardCurve:
    """Annual rates of exceedance, a power law between successive points: straight lines on logarithmic axes.

    Parameters
    ----------
    intensity
        Two or more intensities, positive and different; they are stored in increasing order.
    rate
        Mean annual rate λ [1/a] at which each is exceeded, positive, nowhere increasing with intensity.
    units, quantity
        Unit and name of the intensity, as on axes: "m s-2", "peak ground acceleration".
    component
        Definition of the horizontal component of the intensity, such as "RotD50"; None if it has none.
    origin
        Origin of the rates, in words.

    Raises
    ------
    ParameterError
        If the points do not form a hazard curve.

    Examples
    --------
    >>> HazardCurve(intensity=[1.0, 4.0], rate=[1e-2, 1e-4], units="m s-2").at(2.0).round(9).tolist()
    0.001
    """

    intensity: npt.ArrayLike
    rate: npt.ArrayLike
    units: str = "1"
    quantity: str = "intensity"
    component: str | HorizontalComponent | None = None
    origin: str = ""

    @classmethod
    def of_probabilities(
        cls, intensity: npt.ArrayLike, probability: npt.ArrayLike, *, investigation_time: float, **more: Any
    ) -> Self:
        """Convert probabilities of exceedance within an investigation time [a] to a curve of annual rates.

        Occurrences are treated as a Poisson process: rate = −ln(1 − probability)/investigation time.

        Parameters
        ----------
        intensity, probability
            Intensities, and the probabilities that each is exceeded, between 0 and 1. A probability of exactly 0 or 1
            determines no rate: such points are left out.
        investigation_time
            The time of the probabilities [a], often 50.
        **more
            Other fields of the curve: units, quantity, component, origin.

        Raises
        ------
        ParameterError
            If a probability or the time is out of range, or the points are no curve.

        Examples
        --------
        >>> curve = HazardCurve.of_probabilities([0.1, 0.4], [0.5, 0.1], investigation_time=50.0)
        >>> print(np.round(curve.rate, 5))
        [0.01386 0.00211]
        """
        x, p = _numbers("intensity", intensity), _numbers("probability", probability)
        time = require_positive("investigation_time", investigation_time, "a")
        if x.shape != p.shape:
            message = f"probability must have one number for each intensity, got {p.size} for {x.size}"
            raise ParameterError(message)
        bad = p[~((p >= 0.0) & (p <= 1.0))]
        if bad.size:
            message = f"probability must be between 0 and 1, got {bad[0]!s}; divide percentages by 100"
            raise ParameterError(message)
        inside = (p > 0.0) & (p < 1.0)
        rate = -np.log1p(-p[inside]) / time
        origin = f"probabilities of exceedance in {time:g} years, taken as those of a Poisson process"
        return cls(intensity=x[inside], rate=rate, **{"origin": origin, **more})

    def __post_init__(self) -> None:
        x, rate = (_points(name, value) for name, value in (("intensity", self.intensity), ("rate", self.rate)))
        if x.shape != rate.shape:
            message = f"rate must have one number for each intensity, got {rate.size} for {x.size}"
            raise ParameterError(message)
        order = np.argsort(x)
        x, rate = x[order], rate[order]
        if np.any(twice := np.diff(x) == 0.0):
            message = f"intensity must hold different values, got {x[1:][twice][0]!s} twice"
            raise ParameterError(message)
        if np.any(rises := np.diff(rate) > 0.0):
            at = int(np.argmax(rises))
            message = (
                f"rate must not increase with intensity, got {rate[at + 1]!s} at {x[at + 1]!s} after {rate[at]!s} at "
                f"{x[at]!s}"
            )
            raise ParameterError(message)
        if self.component is not None:
            object.__setattr__(self, "component", HorizontalComponent.named(self.component).value)
        # Tuples are independent of later changes of the arrays.
        object.__setattr__(self, "intensity", tuple(x.tolist()))
        object.__setattr__(self, "rate", tuple(rate.tolist()))

    def _repr_html_(self) -> str:
        """Render the card that notebooks show."""
        x, rate = np.asarray(self.intensity), np.asarray(self.rate)
        unit = unit_in_text(self.units)
        rows = [
            Row(self.quantity, f"{four_digits(x[0])} to {four_digits(x[-1])} {unit}".rstrip()),
            Row("annual rate of exceedance", f"{four_digits(rate[0])} to {four_digits(rate[-1])} 1/a"),
            Row("points", str(x.size)),
        ]
        rows += [Row(name, str(getattr(self, name))) for name in ("component", "origin") if getattr(self, name)]
        return card("Hazard curve", [Section("", rows)])

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
        """Interpolate the rates of exceedance of these intensities; NaN beyond the ends of the curve."""
        u = np.log(np.asarray(intensity, dtype=float))
        rate = np.exp(np.interp(u, self.log_intensity, self.log_rate, left=np.nan, right=np.nan))
        return np.asarray(rate)


def _points(name: str, value: npt.ArrayLike) -> Floats:
    array = _numbers(name, value)
    bad = array[~(np.isfinite(array) & (array > 0.0))]
    if bad.size:
        message = f"{name} must be positive and finite, got {bad[0]!s}; leave such points out"
        raise ParameterError(message)
    return array


def _numbers(name: str, value: npt.ArrayLike) -> Floats:
    given = np.asarray(value)
    if given.dtype.kind not in "iuf" or given.ndim != 1 or given.size < _LEAST:
        message = f"{name} must be a list of two or more numbers, got {value!r}"
        raise ParameterError(message)
    return given.astype(np.float64)
