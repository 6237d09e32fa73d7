"""Fragility curves as Datasets."""

from dataclasses import dataclass

import numpy as np
import xarray as xr
from scipy.special import ndtr

from stylobate.earthquakes.fragility.observations import LIMIT_STATE, Floats, Observations
from stylobate.earthquakes.fragility.probit import FitStatus
from stylobate.errors import require_positive
from stylobate.records import HorizontalComponent
from stylobate.results.outcomes import flag_attributes

CURVE_POINTS = 121
# Half-width of a curve without data, in dispersions.
_REACH = 3.5


@dataclass(frozen=True, slots=True, kw_only=True)
class Curve:
    """The fragility of one limit state.

    Parameters
    ----------
    numbers
        Numbers by the names of the variables.
    covariance
        Covariance of (ln median, ln dispersion).
    shares
        Probabilities along the curve, by the names of the variables.
    """

    numbers: dict[str, float]
    covariance: Floats
    shares: dict[str, Floats]


def lognormal_fragility(
    median: float,
    dispersion: float,
    *,
    name: str = "given",
    units: str = "1",
    component: str | HorizontalComponent | None = None,
) -> xr.Dataset:
    """Build a fragility from a known median and dispersion, without data or intervals.

    Parameters
    ----------
    median
        Intensity at which the limit state is reached with probability 1/2, in `units`.
    dispersion
        Standard deviation β of the logarithm of the capacity.
    name, units
        Name of the limit state, and unit of the intensity.
    component
        Definition of the horizontal component of the intensity, such as "RotD50"; None if it has none.

    Returns
    -------
    xarray.Dataset
        Of kind "fragility": `median`, `dispersion` and the curve.

    Raises
    ------
    ParameterError
        If a number is not positive, or the component is unknown.

    Examples
    --------
    >>> lognormal_fragility(3.0, 0.4)["median"].item()
    3.0
    """
    m, beta = require_positive("median", median), require_positive("dispersion", dispersion)
    x = m * np.exp(np.linspace(-_REACH * beta, _REACH * beta, CURVE_POINTS))
    definition = {} if component is None else {"component": HorizontalComponent.named(component).value}
    about = {"units": units, "long_name": ", ".join(["intensity", *definition.values()]), **definition}
    return xr.Dataset(
        {
            "median": (LIMIT_STATE, [m], {**about, "long_name": f"median {about['long_name']}"}),
            "dispersion": (LIMIT_STATE, [beta], {"units": "1", "long_name": "dispersion"}),
            "status": (LIMIT_STATE, [int(FitStatus.FITTED)], _status_attributes()),
            "probability": ((LIMIT_STATE, "curve"), ndtr(np.log(x / m) / beta)[np.newaxis], _PROBABILITY),
        },
        coords={LIMIT_STATE: [name], "curve_intensity": ("curve", x, about)},
        attrs={"kind": "fragility", "intervals": "none"},
    )


_PROBABILITY = {"units": "1", "long_name": "probability of reaching the limit state"}


def _status_attributes() -> dict[str, object]:
    return flag_attributes("status of the fit", [status.name for status in FitStatus], dtype=np.int64)


def curves_table(seen: Observations, x: Floats, curves: list[Curve]) -> xr.Dataset:
    """Collect the fits of all limit states, and their curves at intensities `x`."""
    about: dict[str, object] = {
        name: seen.attributes[name] for name in ("units", "component") if name in seen.attributes
    }
    names = {
        "median": {**about, "long_name": f"median {seen.attributes['long_name']}"},
        "median_low": {**about, "long_name": "lower end of the interval of the median"},
        "median_high": {**about, "long_name": "upper end of the interval of the median"},
        "dispersion": {"units": "1", "long_name": "dispersion"},
        "dispersion_low": {"units": "1", "long_name": "lower end of the interval of the dispersion"},
        "dispersion_high": {"units": "1", "long_name": "upper end of the interval of the dispersion"},
        "status": _status_attributes(),
        "log_likelihood": {"units": "1", "long_name": "log-likelihood"},
        "runs": {"units": "1", "long_name": "runs decided for the limit state"},
        "runs_reached": {"units": "1", "long_name": "runs that reached it"},
        "runs_not_known": {"units": "1", "long_name": "undecided runs"},
        "largest_safe": {**about, "long_name": "largest intensity that did not reach it"},
        "least_reached": {**about, "long_name": "smallest intensity that reached it"},
        "resamples_without_fit": {"units": "1", "long_name": "resamples without a fit"},
    }
    shares = {
        "probability": _PROBABILITY,
        "probability_low": {"units": "1", "long_name": "lower end of the interval of the probability"},
        "probability_high": {"units": "1", "long_name": "upper end of the interval of the probability"},
    }
    parameters = ["log median", "log dispersion"]
    return xr.Dataset(
        {
            **{name: (LIMIT_STATE, [one.numbers[name] for one in curves], attrs) for name, attrs in names.items()},
            "covariance": (
                (LIMIT_STATE, "parameter", "other_parameter"),
                np.array([one.covariance for one in curves]),
                {"units": "1", "long_name": "covariance of the logarithms of median and dispersion"},
            ),
            **{
                name: ((LIMIT_STATE, "curve"), np.array([one.shares[name] for one in curves]), attrs)
                for name, attrs in shares.items()
            },
        },
        coords={
            LIMIT_STATE: list(seen.names),
            "parameter": parameters,
            "other_parameter": parameters,
            "curve_intensity": ("curve", x, seen.attributes),
        },
    )
