"""Intervals of intensity in which a column survives, reaches a limit state, and survives again, by record.

Overturning is not monotonic: a column may survive a stronger motion. See Zhang and Makris, "Rocking response
of free-standing blocks under cycloidal pulses", J. Eng. Mech. 127 (2001).
"""

from typing import TypeAlias

import numpy as np
import xarray as xr

from stylobate.earthquakes.fragility.observations import Data, Floats, Integers, Observations
from stylobate.errors import ParameterError


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
