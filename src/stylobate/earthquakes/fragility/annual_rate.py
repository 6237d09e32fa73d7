"""Hazard curves of a site, and annual rates of limit states from fragility and hazard.

    rate = ∫ P(x) |dλ(x)|                                                                               (1)

with P = Φ((u − μ)/β), u = ln x. For the power law λ = λ_a exp(−k(u − a)), integration by parts gives

    ∫_a^b P |dλ| = P(a)λ(a) − P(b)λ(b) + λ_a exp(k(a − μ) + k²β²/2) [Φ((u − μ)/β + kβ)]_a^b             (2)

and over the whole axis λ(median) exp(k²β²/2): Cornell, Jalayer, Hamburger and Foutch, "Probabilistic basis for 2000 SAC
Federal Emergency Management Agency steel moment frame guidelines", J. Struct. Eng. 128 (2002).
"""

import logging
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
import numpy.typing as npt
import xarray as xr
from scipy.special import log_ndtr, ndtr

from stylobate.cards import CardSection, Row, card
from stylobate.earthquakes.fragility.observations import LIMIT_STATE, Floats
from stylobate.errors import ParameterError, require_positive, require_whole
from stylobate.records.intensities import HorizontalComponent
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
            raise ParameterError(f"probability must have one number for each intensity, got {p.size} for {x.size}")
        bad = p[~((p >= 0.0) & (p <= 1.0))]
        if bad.size:
            raise ParameterError(f"probability must be between 0 and 1, got {bad[0]!s}; divide percentages by 100")
        inside = (p > 0.0) & (p < 1.0)
        rate = -np.log1p(-p[inside]) / time
        origin = f"probabilities of exceedance in {time:g} years, taken as those of a Poisson process"
        return cls(intensity=x[inside], rate=rate, **{"origin": origin, **more})

    def __post_init__(self) -> None:
        x, rate = (_points(name, value) for name, value in (("intensity", self.intensity), ("rate", self.rate)))
        if x.shape != rate.shape:
            raise ParameterError(f"rate must have one number for each intensity, got {rate.size} for {x.size}")
        order = np.argsort(x)
        x, rate = x[order], rate[order]
        if np.any(twice := np.diff(x) == 0.0):
            raise ParameterError(f"intensity must hold different values, got {x[1:][twice][0]!s} twice")
        if np.any(rises := np.diff(rate) > 0.0):
            at = int(np.argmax(rises))
            raise ParameterError(
                f"rate must not increase with intensity, got {rate[at + 1]!s} at {x[at + 1]!s} after {rate[at]!s} at "
                f"{x[at]!s}"
            )
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
        return card("Hazard curve", [CardSection("", rows)])

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
        raise ParameterError(f"{name} must be positive and finite, got {bad[0]!s}; leave such points out")
    return array


def _numbers(name: str, value: npt.ArrayLike) -> Floats:
    given = np.asarray(value)
    if given.dtype.kind not in "iuf" or given.ndim != 1 or given.size < _LEAST:
        raise ParameterError(f"{name} must be a list of two or more numbers, got {value!r}")
    return given.astype(np.float64)


_log = logging.getLogger("stylobate")

# Fraction of the rate beyond the hazard curve above which a warning is logged.
_MUCH_BEYOND = 0.1
# Fraction above which the rate is an unsupported extrapolation and is withheld.
_MOSTLY_BEYOND = 0.5
_NEARLY_ALL = 0.995
_UNITS = {"m s-2": " m/s²", "m s-1": " m/s"}


def annual_rate(fragility: xr.Dataset, hazard: HazardCurve, *, years: float = 50.0, bins: int = 40) -> xr.Dataset:
    """Compute the annual rate at which each limit state is reached, and the contribution of each intensity.

    Parameters
    ----------
    fragility
        From `fit_fragility` or `lognormal_fragility`, in the intensity of the hazard.
    hazard
        Annual rates of exceedance, for the same definition of the horizontal component.
    years
        Time for which the probability of one or more failures is stated, for a Poisson process.
    bins
        Number of intervals of the intensity, of one ratio, in which contributions are summed.

    Returns
    -------
    xarray.Dataset
        Of kind "annual rate". Over `limit_state`: `annual_rate` [1/a], the curve continued beyond its ends with the
        slopes it has there; `rate_within` the curve; `rate_below` and `rate_above`, the two continuations; `rate_low`
        and `rate_high`, bounds, see the notes; `share_beyond` of the rate, a warning is logged above a tenth;
        `withheld_reason`, why tables and figures withhold the rate if more than half lies beyond, else empty;
        `probability` in `years` years, 1 − exp(−rate·years). NaN for limit states without a fit. Over `bin` within the
        curve: `contribution` [1/a], `bin_from`, `bin_to`, `bin_intensity`. Also the curve, over `point`.

    Raises
    ------
    ParameterError
        If `fragility` is no fragility, its unit or horizontal component differs from the hazard, or a number is out
        of range.

    Notes
    -----
    Beyond the upper end the intensities are not known, their rate λ_n is: between P(x_n)λ_n and λ_n, whatever the
    curve does. Below the lower end it is 0 or more, and at most `rate_below` if the curve is concave on logarithmic
    axes, as hazard curves are; that is infinite where a steep curve is continued too far. Median and dispersion are
    treated as known.

    Examples
    --------
    >>> from stylobate.earthquakes import lognormal_fragility
    >>> hazard = HazardCurve(intensity=[0.1, 10.0], rate=[1e-1, 1e-5])
    >>> found = annual_rate(lognormal_fragility(3.0, 0.4), hazard)
    >>> print(f"{found['annual_rate'].item():.4e} {1e-3 / 3.0**2 * np.exp(0.5 * (2.0 * 0.4) ** 2):.4e}")
    1.5301e-04 1.5301e-04
    """
    _require_fragility(fragility, hazard)
    time = require_positive("years", years, "a")
    count = require_whole("bins", bins, least=1)
    if LIMIT_STATE not in fragility.dims:  # one was selected
        fragility = fragility.expand_dims(LIMIT_STATE)
    parts = [
        _parts(float(m), float(beta), hazard, count)
        for m, beta in zip(fragility["median"].to_numpy(), fragility["dispersion"].to_numpy(), strict=True)
    ]
    within, below, above, low, high = (np.array([one[k] for one in parts]) for k in range(5))
    rate = within + below + above
    # The continuation of a steep curve may be infinite; its share is then 1.
    share = 1.0 - np.divide(within, rate, out=np.full(rate.shape, np.nan), where=rate > 0.0)
    names = [str(name) for name in fragility[LIMIT_STATE].to_numpy()]
    for name, one in zip(names, share, strict=True):
        if one > _MUCH_BEYOND:
            _log.warning("%.0f %% of the annual rate of %r lies beyond the hazard curve; extend it", 100.0 * one, name)
    withheld_reason = [_withheld_reason(*one, hazard) for one in zip(share, below, above, strict=True)]
    edges = _edges(hazard, count)
    component = {} if hazard.component is None else {"component": str(hazard.component)}
    about = {"units": hazard.units, "long_name": ", ".join([hazard.quantity, *component.values()]), **component}
    per_year = {"units": "a-1"}
    return xr.Dataset(
        {
            "annual_rate": (LIMIT_STATE, rate, {**per_year, "long_name": "annual rate"}),
            "rate_within": (LIMIT_STATE, within, {**per_year, "long_name": "from within the hazard curve"}),
            "rate_below": (LIMIT_STATE, below, {**per_year, "long_name": "from below it, continued"}),
            "rate_above": (LIMIT_STATE, above, {**per_year, "long_name": "from above it, continued"}),
            "rate_low": (LIMIT_STATE, low, {**per_year, "long_name": "lower bound of the annual rate"}),
            "rate_high": (LIMIT_STATE, high, {**per_year, "long_name": "upper bound of the annual rate"}),
            "share_beyond": (LIMIT_STATE, share, {"units": "1", "long_name": "share from beyond the hazard curve"}),
            "withheld_reason": (LIMIT_STATE, withheld_reason, {"long_name": "why the annual rate is withheld"}),
            "probability": (
                LIMIT_STATE,
                -np.expm1(-rate * time),
                {"units": "1", "long_name": f"probability in {time:g} years"},
            ),
            "contribution": (
                (LIMIT_STATE, "bin"),
                np.array([one[5] for one in parts]),
                {**per_year, "long_name": "contribution to the annual rate"},
            ),
            "bin_from": ("bin", edges[:-1], about),
            "bin_to": ("bin", edges[1:], about),
            "hazard_rate": ("point", np.exp(hazard.log_rate), {**per_year, "long_name": "annual rate of exceedance"}),
            "median": (LIMIT_STATE, fragility["median"].to_numpy(), fragility["median"].attrs),
            "dispersion": (LIMIT_STATE, fragility["dispersion"].to_numpy(), fragility["dispersion"].attrs),
        },
        coords={
            LIMIT_STATE: names,
            "bin_intensity": ("bin", np.sqrt(edges[:-1] * edges[1:]), about),
            "hazard_intensity": ("point", np.exp(hazard.log_intensity), about),
        },
        attrs={"kind": "annual rate", "years": time, "hazard_origin": hazard.origin},
    )


def _withheld_reason(share: float, below: float, above: float, hazard: HazardCurve) -> str:
    """Return the reason for withholding a rate; empty if the rate is stated or has no fit."""
    if not share > _MOSTLY_BEYOND:
        return ""
    ends = np.exp(hazard.log_intensity)
    which = f"begins at {ends[0]:.3g}" if below > above else f"ends at {ends[-1]:.3g}"
    percent = "all" if share > _NEARLY_ALL else f"{100.0 * share:.0f} %"
    return f"the hazard curve {which}{_UNITS.get(hazard.units, '')}, and {percent} of the rate lies beyond"


def _parts(
    median: float, beta: float, hazard: HazardCurve, count: int
) -> tuple[float, float, float, float, float, Floats]:
    """Return the rate within, below and above the curve, its bounds, and the contributions of the bins."""
    if not (np.isfinite(median) and np.isfinite(beta)):
        return np.nan, np.nan, np.nan, np.nan, np.nan, np.full(count, np.nan)
    mu, u, slopes = float(np.log(median)), hazard.log_intensity, hazard.slopes
    edges = np.log(_edges(hazard, count))
    cuts = np.union1d(u, edges)
    pieces = np.clip(np.searchsorted(u, 0.5 * (cuts[1:] + cuts[:-1])) - 1, 0, slopes.size - 1)
    anchors = hazard.log_rate[pieces] - slopes[pieces] * (cuts[:-1] - u[pieces])
    rates = _piece(cuts[:-1], cuts[1:], anchors, slopes[pieces], mu, beta)
    places = np.clip(np.searchsorted(edges, 0.5 * (cuts[1:] + cuts[:-1])) - 1, 0, count - 1)
    contribution = np.bincount(places, weights=rates, minlength=count).astype(float)
    below = float(_piece_below(u[0], hazard.log_rate[0], slopes[0], mu, beta))
    last = float(np.exp(hazard.log_rate[-1]))
    at_end = float(ndtr((u[-1] - mu) / beta)) * last
    # A curve with a level end never falls to 0, so only λ_n is known.
    above = float(_piece(u[-1:], np.array([np.inf]), hazard.log_rate[-1:], slopes[-1:], mu, beta)[0])
    above = float(np.clip(above, at_end, last)) if slopes[-1] > 0.0 else last
    within = float(contribution.sum())
    return within, below, above, within + at_end, within + below + last, contribution


def _piece(a: Floats, b: Floats, log_rate: Floats, k: Floats, mu: float, beta: float) -> Floats:
    """Compute (2), with ln λ(a); b may be infinite."""
    start = ndtr((a - mu) / beta) * np.exp(log_rate)
    fall = np.where(k > 0.0, k * (b - a), 0.0) if np.all(np.isfinite(b)) else np.full(a.shape, np.inf)
    end = ndtr((b - mu) / beta) * np.exp(log_rate - fall)
    log_scale = log_rate + k * (a - mu) + 0.5 * (k * beta) ** 2
    middle = np.exp(log_scale + _log_difference((a - mu) / beta + k * beta, (b - mu) / beta + k * beta))
    # Rounding may give slightly negative values.
    return np.asarray(np.where(k > 0.0, np.maximum(start - end + middle, 0.0), 0.0))


def _piece_below(b: float, log_rate: float, k: float, mu: float, beta: float) -> float:
    """Compute (2) from 0 to exp(b), with ln λ(b); P(x)λ(x) vanishes at 0."""
    log_middle = log_rate + k * (b - mu) + 0.5 * (k * beta) ** 2 + float(log_ndtr((b - mu) / beta + k * beta))
    with np.errstate(over="ignore"):
        middle = float(np.exp(log_middle))
    return max(middle - float(ndtr((b - mu) / beta)) * float(np.exp(log_rate)), 0.0)


def _log_difference(low: Floats, high: Floats) -> Floats:
    """Compute ln(Φ(high) − Φ(low)) in the tail without cancellation."""
    mirrored = low > 0.0
    near = log_ndtr(np.where(mirrored, -low, high))
    far = log_ndtr(np.where(mirrored, -high, low))
    with np.errstate(divide="ignore"):
        return np.asarray(near + np.log1p(-np.exp(far - near)))


def _edges(hazard: HazardCurve, count: int) -> Floats:
    u = hazard.log_intensity
    return np.asarray(np.exp(np.linspace(u[0], u[-1], count + 1)))


def _require_fragility(fragility: xr.Dataset, hazard: HazardCurve) -> None:
    if not isinstance(fragility, xr.Dataset) or fragility.attrs.get("kind") != "fragility":
        raise ParameterError(
            f"fragility must come from fit_fragility or lognormal_fragility, got {type(fragility).__name__}"
        )
    if not isinstance(hazard, HazardCurve):
        raise ParameterError(f"hazard must be a HazardCurve, got {type(hazard).__name__}")
    require_same_unit(fragility["median"].attrs.get("units", "1"), hazard)
    require_same_component(fragility["median"].attrs.get("component"), hazard.component)


def require_same_unit(unit: str, hazard: HazardCurve) -> None:
    """Raise ParameterError unless fragility and hazard have one unit."""
    if unit != hazard.units:
        raise ParameterError(
            f"hazard must have the unit of the fragility, {unit!r}, got {hazard.units!r}; convert one of them"
        )


def require_same_component(fragility: str | None, hazard: str | HorizontalComponent | None) -> None:
    """Raise ParameterError unless fragility and hazard use the same definition of the horizontal component, or none."""
    own, other = (None if one is None else HorizontalComponent.named(one).value for one in (fragility, hazard))
    if own == other:
        return
    if other is None:
        message = (
            f"hazard: horizontal component not stated, but the fragility uses {own!r}. State the one of the hazard's "
            "ground-motion models, such as component = 'RotD50' (--hazard-component RotD50)."
        )
    elif own is None:
        message = (
            f"fragility: horizontal component not stated, but the hazard uses {other!r}. State it with component, or "
            "as the attribute of that name of the intensities."
        )
    else:
        message = (
            f"hazard: horizontal component {other!r}, but the fragility uses {own!r}. Fit the fragility with component "
            f"= {other!r}, or use a hazard curve of {own!r}."
        )
    raise ParameterError(message)
