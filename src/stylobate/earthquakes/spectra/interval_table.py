"""Overturning intervals of the scale, from their edges."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any, get_args, get_type_hints

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.earthquakes.spectra.cases import Cases
from stylobate.earthquakes.spectra.edges import Edges, Ends, Integers


# Each annotation has the type of a field and its long name, an attribute of the result.
@dataclass(frozen=True, slots=True)
class _Interval:
    interval_from: Annotated[float, "smallest scale of the interval that overturned"]
    interval_to: Annotated[float, "largest scale of the interval that overturned"]
    safe_below: Annotated[float, "largest scale below the interval that did not overturn"] = np.nan
    safe_above: Annotated[float, "smallest scale above the interval that did not overturn"] = np.nan
    open_below: Annotated[bool, "the interval may begin lower: it reaches the first scale or an undecided run"] = False
    open_above: Annotated[bool, "the interval may end higher: it reaches the last scale or an undecided run"] = False
    undecided_below: Annotated[bool, "the next run below the interval is undecided"] = False
    undecided_above: Annotated[bool, "the next run above the interval is undecided"] = False
    uncertain_below: Annotated[bool, "a run at the lower edge is numerically uncertain or undecided"] = False
    uncertain_above: Annotated[bool, "a run at the upper edge is numerically uncertain or undecided"] = False


@dataclass(frozen=True, slots=True)
class _Stretch:
    undecided_from: Annotated[float, "largest decided scale below undecided runs, or the first scale"]
    undecided_to: Annotated[float, "smallest decided scale above undecided runs, or the last scale"]


def interval_table(cases: Cases, scan: Ends, edges: Edges) -> xr.Dataset:
    """Tabulate the overturning intervals and undecided stretches of each case.

    Returns
    -------
    xarray.Dataset
        Over the axes and `interval`, NaN beyond the last: the intervals. Over the axes and `stretch`: `undecided_from`
        and `undecided_to`. Over the axes: the numbers of intervals, `reversals` and undecided runs, and `decided_to`.
    """
    own = [np.flatnonzero((edges.case == case) & ~edges.turns) for case in range(cases.count)]
    intervals = [_intervals_of(scan[case], edges, chosen) for case, chosen in enumerate(own)]
    stretches = [_stretches_of(scan[case], edges, chosen) for case, chosen in enumerate(own)]
    dims = tuple(cases.axes)
    counts = {
        "intervals": ([len(row) for row in intervals], "overturning intervals"),
        "reversals": (
            np.bincount(edges.case[edges.turns], minlength=cases.count),
            "changes of direction within the intervals, without a safe gap as wide as an edge",
        ),
        "unknown": (np.count_nonzero(~scan.decided, axis=1), "undecided runs of the scan"),
    }
    table: dict[str, xr.Variable] = {}
    for dim, kind, rows in (("interval", _Interval, intervals), ("stretch", _Stretch, stretches)):
        for name, declared in get_type_hints(kind, include_extras=True).items():
            of, long_name = get_args(declared)
            attributes = {"long_name": long_name} if of is bool else {"units": "1", "long_name": long_name}
            table[name] = xr.Variable((*dims, dim), cases.over_axes(_column(rows, name, of)), attributes)
    for name, (count, long_name) in counts.items():
        attributes = {"units": "1", "long_name": long_name}
        table[name] = xr.Variable(dims, cases.over_axes(np.array(count, dtype=np.int64)), attributes)
    first = [row[0].undecided_from if row else float(scan.scale[case, -1]) for case, row in enumerate(stretches)]
    decided = np.where(scan.decided[:, 0], first, np.nan)
    about = {"units": "1", "long_name": "largest scale up to which every run was decided"}
    table["decided_to"] = xr.Variable(dims, cases.over_axes(decided), about)
    return xr.Dataset(table)


def _column(rows: Sequence[Sequence[_Interval]] | Sequence[Sequence[_Stretch]], name: str, of: type) -> Any:
    values: npt.NDArray[Any] = np.full(
        (len(rows), max(1, *(len(row) for row in rows))), False if of is bool else np.nan, dtype=of
    )
    for case, row in enumerate(rows):
        values[case, : len(row)] = [getattr(one, name) for one in row]
    return values


def _intervals_of(scan: Ends, edges: Edges, own: Integers) -> list[_Interval]:
    """Return the overturning intervals of one case from its `own` edges; an interval ends at an undecided run."""
    intervals: list[_Interval] = []
    begun: dict[str, Any] = {}
    if scan.state[0] == 1:
        begun = {"interval_from": float(scan.scale[0]), "open_below": True}
    for edge in own:
        low, high = edges.low[edge], edges.high[edge]
        unsure = bool(low.uncertain | high.uncertain)
        if low.state == 1:
            outside = _outside("above", high, unsure=unsure)
            intervals.append(_Interval(**begun, interval_to=float(low.scale), **outside))
        if high.state == 1:
            begun = {"interval_from": float(high.scale), **_outside("below", low, unsure=unsure)}
    if scan.state[-1] == 1:
        intervals.append(_Interval(**begun, interval_to=float(scan.scale[-1]), open_above=True))
    return intervals


def _outside(side: str, run: Ends, *, unsure: bool) -> dict[str, Any]:
    """Return the fields for the run on one side of an interval: it survived, or it is undecided."""
    if run.decided:
        return {f"safe_{side}": float(run.scale), f"uncertain_{side}": unsure}
    return {f"open_{side}": True, f"undecided_{side}": True, f"uncertain_{side}": True}


def _stretches_of(scan: Ends, edges: Edges, own: Integers) -> list[_Stretch]:
    """Return the undecided stretches of one case, each between decided runs or ends of the scan."""
    begins = [edge for edge in own if edges.high.state[edge] < 0]
    ends = [edge for edge in own if edges.low.state[edge] < 0]
    first = [] if scan.decided[0] else [float(scan.scale[0])]
    last = [] if scan.decided[-1] else [float(scan.scale[-1])]
    starts = first + [float(edges.low.scale[edge]) for edge in begins]
    stops = [float(edges.high.scale[edge]) for edge in ends] + last
    return [_Stretch(*pair) for pair in zip(starts, stops, strict=True)]
