"""How well intensity measures predict a limit state: dispersion, likelihood, and what a second measure adds."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr
from scipy.optimize import minimize
from scipy.special import log_ndtr
from scipy.stats import chi2

from stylobate.earthquakes.fragility.likelihood import FitStatus, fit_probit
from stylobate.errors import ParameterError

Floats = npt.NDArray[np.float64]
Bools = npt.NDArray[np.bool_]

# A fit of two measures whose log-likelihood is above this separates the runs: there is no maximum.
_SEPARATES = -1e-3


def compare_intensities(
    measures: xr.Dataset | Mapping[str, npt.ArrayLike],
    reached: xr.DataArray | npt.ArrayLike,
    *,
    record: npt.ArrayLike | None = None,
) -> xr.Dataset:
    """Compare intensity measures by how well each predicts which runs or tests reach a limit state.

    Each measure x is fitted by P = Φ(ln(x/m)/β), as in a fragility, and each pair by P = Φ(ln(x yᵉ/m)/β).

    Parameters
    ----------
    measures
        Values above zero of each measure, from `stylobate.records.intensity_table`, or arrays of shape (n,) by name.
    reached
        1 where a run reached the limit state, 0 where not, −1 if it is not known; with the dimensions of `measures`, or
        an array of shape (n,).
    record
        Name of the base motion of each run, shape (n,): runs with one name differ only in scale. By default the
        dimension `record` of `reached`.

    Returns
    -------
    xarray.Dataset
        Of kind "intensity comparison". Over `measure`: `status` (a FitStatus), `median` m, `dispersion` β, and
        `log_likelihood`, by which measures are ranked, since β depends on how fast a measure grows; `reversed`, the
        number of records under which a run reached the limit state at a lower value than one that did not. Over
        `measure` and `other`: `pair_log_likelihood`; `pair_exponent` e; `pair_dispersion` β; and `p_value`, the
        probability of as large an effect if `other` added nothing. Attributes: `runs`, `runs_reached`, `records`, and
        `unknown`, the log-likelihood of the constant probability.

    Raises
    ------
    ParameterError
        If shapes differ, a value is not above zero, or all runs end alike.

    Notes
    -----
    *Efficiency* (N. Shome and others, Earthquake Spectra 14, 1998) is a large likelihood here: little is left to chance
    once the measure is known. A measure is *sufficient* (N. Luco and C. A. Cornell, Earthquake Spectra 23, 2007) if no
    other measure adds to it, that is, if p is not small. p is that of a Wald test whose variance lets runs of one
    record depend on each other (K.-Y. Liang and S. L. Zeger, Biometrika 73, 1986); it needs some tens of records. Fits
    cannot show runs that are `reversed`.

    Examples
    --------
    >>> import numpy as np
    >>> pgv = np.geomspace(0.1, 2.0, 40)
    >>> noise = np.exp(0.8 * np.cos(7.0 * np.arange(40)))
    >>> fell = pgv * np.exp(0.3 * np.sin(5.0 * np.arange(40))) > 0.5
    >>> found = compare_intensities({"pgv": pgv, "pga": 9.0 * pgv * noise}, fell)
    >>> found["log_likelihood"].round(1).values.tolist()
    [-4.9, -11.4]
    """
    names, values, hit, labels = _flat(measures, reached, record)
    u = np.log(values)
    hits = hit[np.newaxis].astype(np.float64)
    single = [fit_probit(one, hits, 1.0 - hits) for one in u]
    share = hit.mean()
    unknown = float(hit.size * (share * np.log(share) + (1.0 - share) * np.log1p(-share)))
    # the likeliest fit that does not fall is constant
    falls = np.array([one.status[0] == FitStatus.NOT_INCREASING for one in single])
    alone = np.where(falls, unknown, [one.log_likelihood[0] for one in single])
    with np.errstate(divide="ignore", invalid="ignore"):
        median = np.array([np.exp(-one.intercept[0] / one.slope[0]) for one in single])
        dispersion = np.array([1.0 / one.slope[0] for one in single])
    rows: tuple[Any, ...] = ("measure", "other")
    return xr.Dataset(
        {
            "status": ("measure", [FitStatus(int(one.status[0])).name for one in single]),
            "median": ("measure", median, {"long_name": "median"}),
            "dispersion": ("measure", dispersion, {"units": "1", "long_name": "dispersion"}),
            "log_likelihood": ("measure", alone, {"units": "1", "long_name": "log-likelihood"}),
            "reversed": ("measure", [_reversed(one, hit, labels) for one in values], {"units": "1"}),
            **{name: (rows, table, {"units": "1"}) for name, table in _pairs(u, hit, labels).items()},
        },
        coords={"measure": names, "other": names},
        attrs={
            "kind": "intensity comparison",
            "runs": hit.size,
            "runs_reached": int(hit.sum()),
            "records": len(set(labels)),
            "unknown": unknown,
        },
    )


def _flat(
    measures: xr.Dataset | Mapping[str, npt.ArrayLike], reached: Any, record: npt.ArrayLike | None
) -> tuple[list[str], Floats, Bools, list[object]]:
    """Return names, values of shape (measures, n), hits and labels of the records, shape (n,), of the known runs."""
    if not measures:
        raise ParameterError("measures: must have one measure or more (got none). Use records.intensity_table.")
    names = [str(name) for name in measures]
    columns: dict[str, Any] = {str(name): values for name, values in measures.items()}
    if isinstance(measures, xr.Dataset) and isinstance(reached, xr.DataArray):
        joined = xr.broadcast(reached.reset_coords(drop=True), *columns.values())
        if joined[0].size != reached.size:
            raise ParameterError(f"reached: must have the dimensions of measures (got {dict(reached.sizes)}).")
        if record is None and "record" in reached.dims:
            record = xr.broadcast(xr.DataArray(np.arange(reached.sizes["record"]), dims="record"), joined[0])[0]
            record = record.transpose(*joined[0].dims)
        state, *given = (one.to_numpy().ravel() for one in joined)
    else:
        state, given = np.ravel(np.asarray(reached)), [np.ravel(np.asarray(one)) for one in columns.values()]
    values = [np.asarray(one, dtype=float) for one in given]
    labels = np.arange(state.size) if record is None else np.ravel(np.asarray(record))
    for name, one in zip([*names, "record"], [*values, labels], strict=True):
        if one.shape != state.shape:
            raise ParameterError(f"{name}: must have one value for each of {state.size} runs (got {one.size}).")
    known = state.astype(int) >= 0
    for name, one in zip(names, values, strict=True):
        if not np.all(np.isfinite(one[known]) & (one[known] > 0.0)):
            raise ParameterError(f"{name}: must be finite and above 0 in each run. Leave other runs out.")
    hit = state[known].astype(bool)
    if hit.all() or not hit.any():
        raise ParameterError("reached: must have runs that reached the limit state and runs that did not.")
    return names, np.array([one[known] for one in values]), hit, labels[known].tolist()


def _reversed(values: Floats, hit: Bools, labels: list[object]) -> int:
    """Count the labels under which a run reached the limit state at a lower value than one that did not."""
    least: dict[object, float] = {}
    most: dict[object, float] = {}
    for value, reached, label in zip(values.tolist(), hit.tolist(), labels, strict=True):
        if reached:
            least[label] = min(value, least.get(label, value))
        else:
            most[label] = max(value, most.get(label, value))
    return sum(least[label] < most[label] for label in least.keys() & most.keys())


def _pairs(u: Floats, hit: Bools, labels: list[object]) -> dict[str, Floats]:
    """Return the fits of all pairs, shape (measures, measures), NaN on the diagonal and where there is no maximum."""
    count = len(u)
    likelihood, exponent, dispersion, p_value = (np.full((count, count), np.nan) for _ in range(4))
    record = np.unique(np.array([str(label) for label in labels]), return_inverse=True)[1]
    for one in range(count):
        for other in range(one):
            slopes, errors, likelihood[one, other] = _fitted(u[[one, other]], hit, record)
            likelihood[other, one] = likelihood[one, other]
            if likelihood[one, other] > _SEPARATES:
                continue
            p = chi2.sf((slopes / errors) ** 2, df=1)
            for row, column, a, b in ((one, other, 0, 1), (other, one, 1, 0)):
                exponent[row, column], dispersion[row, column] = slopes[b] / slopes[a], 1.0 / slopes[a]
                p_value[row, column] = p[b]
    return {
        "pair_log_likelihood": likelihood,
        "pair_exponent": exponent,
        "pair_dispersion": dispersion,
        "p_value": p_value,
    }


def _fitted(u: Floats, hit: Bools, record: npt.NDArray[np.int_]) -> tuple[Floats, Floats, float]:
    """Return slopes of a probit regression on two measures, their standard errors, and the log-likelihood."""
    middle, width = u.mean(axis=1, keepdims=True), u.std(axis=1, keepdims=True)
    width = np.where(width > 0.0, width, 1.0)
    design = np.vstack([np.ones(u.shape[1]), (u - middle) / width])
    sign = np.where(hit, 1.0, -1.0)

    def shares(theta: Floats) -> tuple[Floats, Floats, Floats]:
        eta = sign * (theta @ design)
        log_share = log_ndtr(eta)
        return eta, log_share, np.exp(-0.5 * eta**2 - 0.5 * np.log(2.0 * np.pi) - log_share)

    def unlikely(theta: Floats) -> tuple[float, Floats]:
        _, log_share, ratio = shares(theta)
        return -float(log_share.sum()), -(design @ (sign * ratio))

    found = minimize(unlikely, np.zeros(3), jac=True, method="BFGS", options={"gtol": 1e-8})
    eta, _, ratio = shares(found.x)
    bread = np.linalg.pinv((design * (ratio * (ratio + eta))) @ design.T)
    groups = record.max() + 1
    score = np.array([np.bincount(record, row, minlength=groups) for row in design * (sign * ratio)])
    variance = groups / max(groups - 1, 1) * bread @ (score @ score.T) @ bread
    errors = np.sqrt(np.maximum(np.diag(variance), 0.0))[1:]  # rounded below zero if the measures separate the runs
    return found.x[1:] / width[:, 0], errors / width[:, 0], -float(found.fun)
