"""Dispersion of capacities split into record-to-record dispersion and dispersion of uncertain properties.

The capacity of a column under a record is the smallest scale that reaches the limit state. Its logarithm is

    ln C = μ + r(record) + p(property sample) + e                                                        (1)

with independent r, p, e of variances β_RR², β_P², β_E²; the total dispersion is β² = β_RR² + β_P² + β_E². The variances
equate the mean squares to their expectations: the analysis of variance of a two-way layout without replication, Searle,
Casella and McCulloch, "Variance Components" (1992), chapter 4. The residual e combines the interaction of properties
with records and the step between scales: a capacity between two scales of ratio exp(d) is set to their geometric mean,
and Sheppard's correction d²/12 is subtracted from β_E².
"""

from dataclasses import dataclass
from enum import Enum

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.earthquakes.fragility.observations import NOT_KNOWN, Floats
from stylobate.errors import ParameterError, require_whole
from stylobate.results.random_numbers import Rng, generator_of
from stylobate.studies.proportions import require_confidence

_DIMS = ("record", "property_sample", "scale")
_LEAST = 2
# Variances are differences of mean squares; below this fraction of the mean squares a variance is rounding error.
_ROUNDING = 1e-12


class SampleDesign(Enum):
    """Whether all records share the property samples."""

    CROSSED = "crossed"
    """All records share the property samples."""
    NESTED = "nested"
    """Each record has its own property samples; β_P² then includes β_E²."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MeanSquares:
    """Mean squares of an analysis of variance, with their degrees of freedom.

    Parameters
    ----------
    values, freedom
        Values for records, property samples and residual; NaN for property samples if they are nested.
    records, samples
        Numbers of records and property samples.
    step
        Sheppard's correction, the mean of d²/12.
    """

    values: Floats
    freedom: Floats
    records: int
    samples: int
    step: float

    def variances(self, values: Floats) -> Floats:
        """Compute β_RR², β_P², β_E² from mean squares of shape (…, 3); they may be negative."""
        record, sample, rest = np.moveaxis(values, -1, 0)
        if np.isnan(self.freedom[1]):
            return np.stack([(record - rest) / self.samples, rest - self.step, np.zeros_like(rest)], axis=-1)
        return np.stack([(record - rest) / self.samples, (sample - rest) / self.records, rest - self.step], axis=-1)

    def estimate(self) -> Floats:
        """Estimate the variances; those that are negative or rounding errors become 0."""
        found = self.variances(self.values)
        largest = self.values[~np.isnan(self.freedom)].max()
        return np.where(found <= _ROUNDING * largest, 0.0, found)

    def drawn(self, count: int, rng: np.random.Generator) -> Floats:
        """Draw variances that are compatible with the mean squares and their χ² distributions.

        Generalised pivots: Weerahandi, "Generalized confidence intervals", J. Am. Stat. Assoc. 88 (1993).
        """
        freedom = np.where(np.isnan(self.freedom), 1.0, self.freedom)
        chi_square = rng.chisquare(freedom, size=(count, 3))
        return np.maximum(self.variances(self.values * freedom / chi_square), 0.0)


def dispersion_parts(
    scale: npt.ArrayLike | xr.DataArray,
    reached: xr.DataArray,
    *,
    samples: SampleDesign = SampleDesign.CROSSED,
    confidence: float = 0.95,
    resamples: int = 10_000,
    rng: Rng,
) -> xr.Dataset:
    """Separate the dispersion of capacities from record to record and from uncertain properties.

    Parameters
    ----------
    scale
        Intensities, positive, increasing along the dimension `scale`: as many as that has, or a DataArray over some of
        the dimensions of `reached`.
    reached
        1, 0 or −1 for not known, over the dimensions `record`, `property_sample` and `scale`, of one limit state.
    samples
        Whether all records share the property samples.
    confidence
        Confidence level of the intervals.
    resamples, rng
        How many mean squares are drawn for the intervals, and the seed or numpy.random.Generator. The draws are those
        of normal r, p, e.

    Returns
    -------
    xarray.Dataset
        Of kind "dispersion parts": `median`, the geometric mean of the capacities; `total_dispersion`,
        `record_dispersion` β_RR, `property_dispersion` β_P, `joint_dispersion` β_E, each with `_low` and `_high`; an
        estimate whose variance is not positive is 0. Over `record` and `property_sample` `log_capacity`; over each of
        them `median_of_record`, `median_of_sample` and the `dispersion_of_record`, `dispersion_of_sample` of the
        capacities in it. Attributes `non_monotone_share` of the series that survive above their capacity,
        `never_reached` and `reached_at_once`, numbers of series whose capacity is beyond the scales, or not known;
        `resolution`, the dispersion that the steps between scales hide, d/√12: an estimate of 0 means that none was
        detected above it. If a capacity is beyond the scales, it and all dispersions are NaN: give more scales.

    Raises
    ------
    ParameterError
        If dimensions are missing, there are fewer than two records or property samples, or scales do not increase.
    """
    level = require_confidence(confidence)
    count = require_whole("resamples", resamples, least=1)
    state, x = _series(reached, scale)
    capacity, step = _capacities(state, np.log(x))
    squares = _mean_squares(capacity, step, samples)
    estimate = squares.estimate()
    draws = squares.drawn(count, generator_of(rng))
    tail = 0.5 - 0.5 * level
    ends = np.quantile(_with_total(draws), [tail, 1.0 - tail], axis=0)
    labels = {dim: reached[dim].to_numpy() if dim in reached.coords else np.arange(reached.sizes[dim]) for dim in _DIMS}
    unit = scale.attrs.get("units", "1") if isinstance(scale, xr.DataArray) else "1"
    return xr.Dataset(
        {
            "median": ((), np.exp(capacity.mean()), {"units": unit, "long_name": "geometric mean of the capacities"}),
            **_with_ends(_with_total(estimate), ends),
            "log_capacity": (_DIMS[:2], capacity, {"long_name": f"logarithm of the capacity in {unit}"}),
            "median_of_record": ("record", np.exp(capacity.mean(axis=1)), {"units": unit}),
            "dispersion_of_record": ("record", capacity.std(axis=1, ddof=1), {"units": "1"}),
            "median_of_sample": ("property_sample", np.exp(capacity.mean(axis=0)), {"units": unit}),
            "dispersion_of_sample": ("property_sample", capacity.std(axis=0, ddof=1), {"units": "1"}),
        },
        coords={dim: labels[dim] for dim in _DIMS[:2]},
        attrs={
            "kind": "dispersion parts",
            "samples": samples.value,
            "confidence": level,
            "resamples": count,
            "resolution": float(np.sqrt(squares.step)),
            **_flags(state),
        },
    )


_NAMES = {
    "total_dispersion": "dispersion of the capacities",
    "record_dispersion": "record-to-record dispersion",
    "property_dispersion": "dispersion from property sample to property sample",
    "joint_dispersion": "dispersion of record and property sample together",
}


def _with_total(variances: Floats) -> Floats:
    """Compute the total dispersion and its three components."""
    return np.asarray(np.sqrt(np.concatenate([variances.sum(axis=-1, keepdims=True), variances], axis=-1)))


def _with_ends(values: Floats, ends: Floats) -> dict[str, tuple[tuple[()], float, dict[str, str]]]:
    variables: dict[str, tuple[tuple[()], float, dict[str, str]]] = {}
    for place, (name, about) in enumerate(_NAMES.items()):
        variables[name] = ((), float(values[place]), {"units": "1", "long_name": about})
        for end, side in zip(ends, ("low", "high"), strict=True):
            variables[f"{name}_{side}"] = (
                (),
                float(end[place]),
                {"units": "1", "long_name": f"{about}, {side} end of the interval"},
            )
    return variables


def _series(reached: xr.DataArray, scale: npt.ArrayLike | xr.DataArray) -> tuple[npt.NDArray[np.int64], Floats]:
    """Return states and scales, both of shape (record, property sample, scale)."""
    if not isinstance(reached, xr.DataArray) or set(reached.dims) != set(_DIMS):
        got = reached.dims if isinstance(reached, xr.DataArray) else type(reached).__name__
        raise ParameterError(
            f"reached must be a DataArray over {', '.join(_DIMS)}, got {got}; choose one limit state with .sel"
        )
    for dim in _DIMS[:2]:
        if reached.sizes[dim] < _LEAST:
            raise ParameterError(f"reached must have two or more along {dim}, got {reached.sizes[dim]}")
    states = reached.transpose(*_DIMS)
    try:
        named = scale if isinstance(scale, xr.DataArray) else xr.DataArray(np.asarray(scale, float), dims="scale")
        x = np.asarray(named.broadcast_like(states).transpose(*_DIMS).to_numpy(), dtype=float)
    except ValueError as error:
        raise ParameterError(
            f"scale must have as many numbers as reached along scale, {reached.sizes['scale']}: {error}"
        ) from None
    if x.shape != states.shape or not np.all(np.isfinite(x) & (x > 0.0)) or np.any(np.diff(x, axis=-1) <= 0.0):
        raise ParameterError(
            f"scale must be positive and increase along the dimension scale, got {np.asarray(scale)!r}"
        )
    codes = states.to_numpy()
    bad = codes[~np.isin(codes, (NOT_KNOWN, 0, 1))]
    if bad.size:
        raise ParameterError(f"reached must hold True or False (or 1, 0, and -1 for not known), got {bad.flat[0]!r}")
    return codes.astype(np.int64), x


def _capacities(state: npt.NDArray[np.int64], u: Floats) -> tuple[Floats, Floats]:
    """Return ln C and the step d around it; NaN if C is beyond the scales or a run below it is undecided."""
    first = np.argmax(state == 1, axis=-1)[..., np.newaxis]
    known = (state == 1).any(axis=-1) & (first[..., 0] > 0) & ~_unknown_below(state)
    high = np.take_along_axis(u, first, axis=-1)[..., 0]
    low = np.take_along_axis(u, np.maximum(first - 1, 0), axis=-1)[..., 0]
    return np.where(known, 0.5 * (low + high), np.nan), np.where(known, high - low, np.nan)


def _unknown_below(state: npt.NDArray[np.int64]) -> npt.NDArray[np.bool_]:
    """Return whether a run at or below the first that reached the limit state is undecided."""
    before = np.cumsum(state == 1, axis=-1) == 0
    return np.asarray(np.any(before & (state == NOT_KNOWN), axis=-1))


def _mean_squares(capacity: Floats, step: Floats, samples: SampleDesign) -> MeanSquares:
    records, count = capacity.shape
    of_record = count * capacity.mean(axis=1).var(ddof=1)
    within = float(np.mean(step**2) / 12.0)
    if samples is SampleDesign.NESTED:
        values = np.array([of_record, 1.0, capacity.var(axis=1, ddof=1).mean()])
        freedom = np.array([records - 1.0, np.nan, records * (count - 1.0)])
        return MeanSquares(values=values, freedom=freedom, records=records, samples=count, step=within)
    of_sample = records * capacity.mean(axis=0).var(ddof=1)
    left = capacity - capacity.mean(axis=1, keepdims=True) - capacity.mean(axis=0) + capacity.mean()
    free = (records - 1.0) * (count - 1.0)
    return MeanSquares(
        values=np.array([of_record, of_sample, float(np.sum(left**2)) / free]),
        freedom=np.array([records - 1.0, count - 1.0, free]),
        records=records,
        samples=count,
        step=within,
    )


def _flags(state: npt.NDArray[np.int64]) -> dict[str, float]:
    ever = (state == 1).any(axis=-1)
    passed = np.cumsum(state == 1, axis=-1) > 0
    again = np.any(passed & (state == 0), axis=-1)
    return {
        "non_monotone_share": float(again.mean()),
        "never_reached": int(np.count_nonzero(~ever)),
        "reached_at_once": int(np.count_nonzero(state[..., 0] == 1)),
        "not_known": int(np.count_nonzero(_unknown_below(state) & ever)),
    }
