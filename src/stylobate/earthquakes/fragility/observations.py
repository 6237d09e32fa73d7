"""Data of a fragility: limit states of runs, the runs as flat arrays, and the intervals that reached a state.

Overturning is not monotonic: a column may survive a stronger motion. See Zhang and Makris, "Rocking response
of free-standing blocks under cycloidal pulses", J. Eng. Mech. 127 (2001).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from typing import Any, Self, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.errors import Outcome, ParameterError, require_positive
from stylobate.results.outcomes import NOT_COMPUTED, flag_attributes
from stylobate.studies.maps.integrity import UNRESOLVED

Floats: TypeAlias = npt.NDArray[np.float64]
Integers: TypeAlias = npt.NDArray[np.int64]
Data: TypeAlias = npt.ArrayLike | xr.DataArray

NOT_KNOWN = -1
"""Code of an undecided run."""

LIMIT_STATE = "limit_state"


class Counting(Enum):
    """How runs above the first that reached the limit state count, if the column survives there."""

    AS_COMPUTED = "as computed"
    """Each run as computed."""
    FIRST = "first"
    """Every run above the first that reached it counts as reached."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Observations:
    """Runs as flat arrays.

    Parameters
    ----------
    intensity
        Intensity of each run, shape (runs,), positive.
    reached
        Shape (limit states, runs): 1 reached, 0 not, NOT_KNOWN.
    record
        Number of the record of each run, from 0, shape (runs,); None if records are not named.
    series
        Number of the combination of record and property sample of each run.
    records
        Names of the records, by number.
    names
        Names of the limit states.
    attributes
        Unit and long name of the intensity.
    """

    intensity: Floats
    reached: Integers
    record: Integers | None
    series: Integers | None
    records: tuple[str, ...]
    names: tuple[str, ...]
    attributes: dict[str, Any]

    @classmethod
    def of(cls, intensity: Data, reached: Data, record: Data | None, property_sample: Data | None = None) -> Self:
        """Flatten arrays that broadcast by the names of their dimensions, or have equal shapes.

        Raises
        ------
        ParameterError
            If shapes differ, an intensity is not positive, or `reached` has values other than booleans, 0, 1 and −1.
        """
        states = _labelled("reached", reached, ())
        if LIMIT_STATE not in states.dims:
            name = str(states[LIMIT_STATE].item()) if LIMIT_STATE in states.coords else "reached"
            states = states.drop_vars(LIMIT_STATE, errors="ignore").expand_dims({LIMIT_STATE: [name]})
        dims = tuple(str(dim) for dim in states.dims if dim != LIMIT_STATE)
        shaped = states.isel({LIMIT_STATE: 0}, drop=True)
        levels = _labelled("intensity", intensity, dims, shaped.shape)
        given = [_named(states, "record", record), _named(states, "property_sample", property_sample)]
        named = [None if one is None else _labelled(*one, dims, shaped.shape) for one in given]
        try:
            parts = xr.broadcast(shaped, levels, *(one for one in named if one is not None))
            states = states.broadcast_like(parts[0]).transpose(LIMIT_STATE, *parts[0].dims)
        except ValueError as error:
            raise ParameterError(
                f"intensity, reached and record must have one shape or share named dimensions: {error}"
            ) from None
        values = parts[1].to_numpy().ravel()
        known, number = (None, None) if named[0] is None else _numbered(parts[2])
        series = number
        if number is not None and named[1] is not None:
            samples, sample = _numbered(parts[3])
            series = number * samples.size + sample
        return cls(
            intensity=_positive(values),
            reached=_codes(states.to_numpy().reshape(states.sizes[LIMIT_STATE], -1)),
            record=number,
            series=None if series is None else np.unique(series, return_inverse=True)[1],
            records=() if known is None else tuple(str(one) for one in known),
            names=tuple(str(name) for name in states[LIMIT_STATE].to_numpy()),
            attributes={"long_name": "intensity", "units": "1", **levels.attrs},
        )

    def counted(self, counting: Counting) -> Self:
        """Count the runs above the first reached one of each series by the rule `counting`.

        Raises
        ------
        ParameterError
            If records are required but not named.
        """
        if counting is Counting.AS_COMPUTED:
            return self
        if self.series is None:
            raise ParameterError(
                "counting must be Counting.AS_COMPUTED if no record is named, got Counting.FIRST; give record"
            )
        reached = self.reached.copy()
        for state in reached:
            for one in range(self.series.max() + 1):
                runs = self.series == one
                first = np.min(self.intensity, where=runs & (state == 1), initial=np.inf)
                state[runs & (self.intensity >= first)] = 1
        return replace(self, reached=reached)

    def non_monotone(self) -> Integers:
        """Count the records that survive above an intensity that reached each limit state."""
        if self.record is None or self.series is None:
            return np.full(len(self.names), NOT_KNOWN, dtype=np.int64)
        found = []
        for state in self.reached:
            all_series = [self.series == one for one in range(self.series.max() + 1)]
            back = [int(self.record[runs][0]) for runs in all_series if self._falls_back(state, runs)]
            found.append(len(set(back)))
        return np.array(found, dtype=np.int64)

    def _falls_back(self, state: Integers, runs: npt.NDArray[np.bool_]) -> bool:
        first = np.min(self.intensity, where=runs & (state == 1), initial=np.inf)
        return bool(np.any(runs & (state == 0) & (self.intensity > first)))


def _labelled(name: str, values: Data, dims: tuple[str, ...], shape: tuple[int, ...] = ()) -> xr.DataArray:
    if isinstance(values, xr.DataArray):
        return values
    array = np.asarray(values)
    if not dims:
        return xr.DataArray(array, dims=[f"run_{place}" if place else "run" for place in range(array.ndim)])
    if array.shape != shape:
        raise ParameterError(
            f"{name} must have the shape of reached, {shape}, or named dimensions; got shape {array.shape}"
        )
    return xr.DataArray(array, dims=dims)


def _named(reached: xr.DataArray, name: str, values: Data | None) -> tuple[str, Data] | None:
    """Return the given names, or those of the dimension or coordinate of `reached`; None without either."""
    if values is not None:
        return name, values
    if name in reached.coords:
        return name, reached[name]
    return (name, xr.DataArray(np.arange(reached.sizes[name]), dims=name)) if name in reached.dims else None


def _numbered(values: xr.DataArray) -> tuple[npt.NDArray[Any], Integers]:
    """Return the unique values, and the index of each run's value among them."""
    known, number = np.unique(values.to_numpy().ravel(), return_inverse=True)
    return known, number.astype(np.int64)


def _positive(given: npt.NDArray[Any]) -> Floats:
    if given.size and given.dtype.kind not in "iuf":
        raise ParameterError(f"intensity must hold real numbers, got {given[0]!r}")
    values = given.astype(np.float64)
    if not values.size:
        raise ParameterError("intensity must hold at least one run, got none")
    bad = values[~(np.isfinite(values) & (values > 0.0))]
    if bad.size:
        raise ParameterError(
            f"intensity must be positive and finite, got {float(bad[0])!r}; leave out runs without base motion"
        )
    return values


def _codes(values: npt.NDArray[Any]) -> Integers:
    bad = values[~np.isin(values, (NOT_KNOWN, 0, 1))]
    if bad.size:
        raise ParameterError(f"reached must hold True or False (or 1, 0, and -1 for not known), got {bad.flat[0]!r}")
    return np.asarray(values, dtype=np.int64)


def limit_states(
    runs: xr.Dataset,
    *,
    slenderness: npt.ArrayLike | xr.DataArray | None = None,
    tilt_ratios: Sequence[float] = (1e-3, 0.1, 0.5, 1.0),
    exceeded: Mapping[str, xr.DataArray] | None = None,
) -> xr.DataArray:
    """Find the limit states that each run reached: peak tilts in fractions of α_c = arctan c, and overturning.

    The tipping angle α_c is the tilt at which the centre of mass stands above the contact point. The smallest default
    tilt, 0.001 α_c, separates columns that rock from those that stand. It is not uplift: an upright column lifts if
    |a_h| > c (g + a_z), and may then tilt less.

    Parameters
    ----------
    runs
        Runs with `outcome` and `peak_tilt` [rad], such as from `simulate_ensemble`, `overturning_map` or a sweep.
    slenderness
        c of each run; by default the coordinate `slenderness` of `runs`.
    tilt_ratios
        Peak tilts over α_c, positive. A run that starts at a larger tilt has reached it from the start.
    exceeded
        Further limit states by name: whether each run exceeded them by its peak tilt. They follow the others.

    Returns
    -------
    xarray.DataArray
        Over `limit_state` and the dimensions of `runs`: 1 reached, 0 not, −1 not known. A run that overturned has
        reached all limit states. A run that failed, lifted off or stopped at a tilt limit has reached the limit states
        below its peak tilt; the others are undecided. A run that was not computed is undecided. A run that is
        STILL_MOVING did not overturn by its end and counts as SURVIVED.

    Raises
    ------
    ParameterError
        If `runs` lack a variable, the slenderness is not known, or a ratio is not positive.

    Examples
    --------
    >>> import xarray as xr
    >>> from stylobate import Outcome
    >>> codes = [Outcome.AT_REST, Outcome.SURVIVED, Outcome.OVERTURNED]
    >>> runs = xr.Dataset({"outcome": ("run", codes), "peak_tilt": ("run", [0.0, 0.06, 0.09])})
    >>> states = limit_states(runs, slenderness=0.1)
    >>> print(states.sel(limit_state="tilt 0.5 α").values, states.sel(limit_state="overturning").values)
    [0 1 1] [0 0 1]
    """
    for name in ("outcome", "peak_tilt"):
        if name not in runs:
            raise ParameterError(
                f"runs must hold the variable {name}, got {', '.join(map(str, runs.data_vars)) or 'none'}"
            )
    critical = np.arctan(_slenderness(runs, slenderness))
    codes, tilt = runs["outcome"], runs["peak_tilt"]
    fallen = codes == Outcome.OVERTURNED
    decided = ~codes.isin([NOT_COMPUTED, *UNRESOLVED])
    limits = {
        f"tilt {require_positive(f'tilt_ratios[{place}]', ratio):g} α": ratio for place, ratio in enumerate(tilt_ratios)
    }
    further = dict(exceeded or {})
    by_tilt = [fallen | (tilt > ratio * critical) for ratio in limits.values()]
    computed = codes != NOT_COMPUTED
    ways = [*by_tilt, fallen, *(fallen | one for one in further.values())]
    unreached = xr.zeros_like(codes, dtype=np.int8).where(decided, np.int8(NOT_KNOWN))
    states = [unreached.where(~(reached & computed), np.int8(1)) for reached in ways]
    names = xr.DataArray([*limits, "overturning", *further], dims=LIMIT_STATE, name=LIMIT_STATE)
    joined: xr.DataArray = xr.concat(states, dim=names).rename("reached")
    joined.attrs = {}
    return joined.assign_attrs(
        flag_attributes("limit state reached", ["NOT_KNOWN", "NOT_REACHED", "REACHED"], first=NOT_KNOWN)
    )


def _slenderness(runs: xr.Dataset, given: npt.ArrayLike | xr.DataArray | None) -> xr.DataArray:
    if given is None:
        if "slenderness" not in runs.coords:
            raise ParameterError("slenderness must be given if runs have no coordinate of that name, got None")
        return runs["slenderness"]
    if isinstance(given, xr.DataArray):
        values = given
    else:
        array = np.asarray(given, dtype=float)
        if array.ndim and array.shape != runs["outcome"].shape:
            raise ParameterError(
                f"slenderness must be a number or have the shape of runs, {runs['outcome'].shape}; got {array.shape}"
            )
        values = xr.DataArray(array, dims=runs["outcome"].dims if array.ndim else ())
    numbers = values.to_numpy()
    bad = numbers[~(np.isfinite(numbers) & (numbers > 0.0))]
    if bad.size:
        require_positive("slenderness", bad.flat[0])
    return values


def reached_intervals(scale: Data, reached: Data, *, record: Data | None = None) -> xr.Dataset:
    """Find the intervals of successive scales with the same verdict for each record, and whether it is monotonic.

    Intervals are as fine as the scales: changes between two scales are not seen.

    Parameters
    ----------
    scale
        Scale or intensity of each run, positive.
    reached
        Whether each run reached the limit state, as in `fit_fragility`; one limit state. Undecided runs are left out.
    record
        The record of each run; by default the dimension or coordinate `record` of `reached`, or one record.

    Returns
    -------
    xarray.Dataset
        Of kind "reached intervals". Over `record`: `monotone`, False if it survives above a scale that reached it;
        `first_reached` [as scale], NaN if none did; `last_safe`, NaN if none was; `safe_again`, the number of surviving
        intervals above the first reached; `runs`. Over `interval`, by record and scale: `interval_record`,
        `interval_reached`, `interval_from` and `interval_to`, the first and last scale computed in it, and
        `interval_runs`. Attribute `non_monotone_share` of the records.

    Raises
    ------
    ParameterError
        As `fit_fragility`; if `reached` has several limit states; or if two runs of a record at one scale disagree.

    Examples
    --------
    >>> found = reached_intervals([1.0, 2.0, 3.0, 4.0], [False, True, False, True])
    >>> found["monotone"].item(), found["interval_from"].values.tolist(), found["interval_reached"].values.tolist()
    (False, [1.0, 2.0, 3.0, 4.0], [False, True, False, True])
    """
    seen = Observations.of(scale, reached, record)
    if len(seen.names) > 1:
        raise ParameterError(f"reached must have one limit state, got {', '.join(seen.names)}; choose one with .sel")
    groups = np.zeros(seen.intensity.size, dtype=np.int64) if seen.record is None else seen.record
    state = seen.reached[0]
    names = seen.records or ("all",)
    groups_of_runs = [(groups == place) & (state >= 0) for place in range(len(names))]
    parts = [
        _intervals_of(seen.intensity[runs], state[runs], name) for runs, name in zip(groups_of_runs, names, strict=True)
    ]
    flat = [(place, *interval) for place, part in enumerate(parts) for interval in part]
    return _dataset(seen, names, parts, flat)


# Reached, first scale, last scale, number of runs.
Interval: TypeAlias = tuple[bool, float, float, int]


def _intervals_of(scale: Floats, state: Integers, name: str) -> list[Interval]:
    x, where = np.unique(scale, return_inverse=True)
    runs = np.bincount(where, minlength=x.size)
    hits = np.bincount(where, weights=state, minlength=x.size)
    torn = np.flatnonzero((hits > 0.0) & (hits < runs))
    if torn.size:
        raise ParameterError(
            f"reached must agree between runs of one record at one scale, got both at {float(x[torn[0]])!r} "
            f"of record {name}; compute intervals for each property sample separately"
        )
    if not x.size:
        return []
    edges = np.flatnonzero(np.diff(hits > 0.0)) + 1
    parts = np.split(np.arange(x.size), edges)
    return [(bool(hits[p[0]] > 0.0), float(x[p[0]]), float(x[p[-1]]), int(runs[p].sum())) for p in parts]


def _dataset(
    seen: Observations,
    names: tuple[str, ...],
    parts: list[list[Interval]],
    flat: list[tuple[int, bool, float, float, int]],
) -> xr.Dataset:
    first = [min((low for hit, low, _, _ in part if hit), default=np.nan) for part in parts]
    safe = [max((high for hit, _, high, _ in part if not hit), default=np.nan) for part in parts]
    again = [sum(not hit for hit, _, _, _ in part[1:]) for part in parts]
    columns = [np.array(column) for column in zip(*flat, strict=True)] or [np.zeros(0)] * 5
    unit = {"units": seen.attributes["units"]}
    return xr.Dataset(
        {
            "monotone": ("record", np.array(again) == 0, {"long_name": "no survival above a scale that reached it"}),
            "first_reached": ("record", first, {**unit, "long_name": "smallest scale that reached it"}),
            "last_safe": ("record", safe, {**unit, "long_name": "largest surviving scale"}),
            "safe_again": (
                "record",
                again,
                {"units": "1", "long_name": "surviving intervals above the first reached"},
            ),
            "runs": (
                "record",
                [sum(interval[3] for interval in part) for part in parts],
                {"units": "1", "long_name": "runs"},
            ),
            "interval_record": ("interval", columns[0].astype(np.int64), {"long_name": "index of the record"}),
            "interval_reached": ("interval", columns[1].astype(bool), {"long_name": "reached the limit state"}),
            "interval_from": ("interval", columns[2].astype(float), {**seen.attributes}),
            "interval_to": ("interval", columns[3].astype(float), {**seen.attributes}),
            "interval_runs": ("interval", columns[4].astype(np.int64), {"units": "1", "long_name": "runs"}),
        },
        coords={"record": list(names)},
        attrs={
            "kind": "reached intervals",
            "limit_state": seen.names[0],
            "non_monotone_share": float(np.mean(np.array(again) > 0)),
        },
    )
