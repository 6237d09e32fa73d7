"""Overturning intervals of the scale, from their edges."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any, get_args, get_type_hints

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.earthquakes.spectra.cases import Cases
from stylobate.earthquakes.spectra.edges import Edges, Ends, Integers


# Of each field the type and, as an attribute of the result, the long name.
@dataclass(frozen=True, slots=True)
class _Band:
    band_from: Annotated[float, "least scale of the band that overturned"]
    band_to: Annotated[float, "largest scale of the band that overturned"]
    safe_below: Annotated[float, "largest scale below the band that did not overturn"] = np.nan
    safe_above: Annotated[float, "least scale above the band that did not overturn"] = np.nan
    open_below: Annotated[bool, "the band may begin lower: it reaches the first scale, or an undecided run"] = False
    open_above: Annotated[bool, "the band may go on: it reaches the last scale, or an undecided run"] = False
    undecided_below: Annotated[bool, "the next run below the band is undecided"] = False
    undecided_above: Annotated[bool, "the next run above the band is undecided"] = False
    uncertain_below: Annotated[bool, "a run at its lower edge is uncertain or undecided"] = False
    uncertain_above: Annotated[bool, "a run at its upper edge is uncertain or undecided"] = False


@dataclass(frozen=True, slots=True)
class _Stretch:
    undecided_from: Annotated[float, "largest decided scale below undecided runs, or the first scale"]
    undecided_to: Annotated[float, "least decided scale above undecided runs, or the last scale"]


def band_table(cases: Cases, scan: Ends, edges: Edges) -> xr.Dataset:
    """Return the bands of each case, and what is undecided between and beyond them.

    Returns
    -------
    xarray.Dataset
        Over the axes and `band`, NaN beyond the last: the bands. Over the axes and `stretch`: `undecided_from` and
        `undecided_to`. Over the axes: how many bands, `reversals` and undecided runs there are, and `decided_to`.
    """
    own = [np.flatnonzero((edges.case == case) & ~edges.turns) for case in range(cases.count)]
    bands = [_bands_of(scan[case], edges, chosen) for case, chosen in enumerate(own)]
    stretches = [_stretches_of(scan[case], edges, chosen) for case, chosen in enumerate(own)]
    dims = tuple(cases.axes)
    counts = {
        "bands": ([len(row) for row in bands], "bands that overturn"),
        "reversals": (
            np.bincount(edges.case[edges.turns], minlength=cases.count),
            "changes of direction within the bands, without a safe gap as wide as an edge",
        ),
        "unknown": (np.count_nonzero(~scan.decided, axis=1), "undecided runs of the scan"),
    }
    table: dict[str, xr.Variable] = {}
    for dim, kind, rows in (("band", _Band, bands), ("stretch", _Stretch, stretches)):
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


def _column(rows: Sequence[Sequence[_Band]] | Sequence[Sequence[_Stretch]], name: str, of: type) -> Any:
    values: npt.NDArray[Any] = np.full(
        (len(rows), max(1, *(len(row) for row in rows))), False if of is bool else np.nan, dtype=of
    )
    for case, row in enumerate(rows):
        values[case, : len(row)] = [getattr(one, name) for one in row]
    return values


def _bands_of(scan: Ends, edges: Edges, own: Integers) -> list[_Band]:
    """Return the bands of one case, of which the edges are its `own`: each ends where decided runs end."""
    bands: list[_Band] = []
    begun: dict[str, Any] = {}
    if scan.state[0] == 1:
        begun = {"band_from": float(scan.scale[0]), "open_below": True}
    for edge in own:
        low, high = edges.low[edge], edges.high[edge]
        unsure = bool(low.uncertain | high.uncertain)
        if low.state == 1:
            outside = _outside("above", high, unsure=unsure)
            bands.append(_Band(**begun, band_to=float(low.scale), **outside))
        if high.state == 1:
            begun = {"band_from": float(high.scale), **_outside("below", low, unsure=unsure)}
    if scan.state[-1] == 1:
        bands.append(_Band(**begun, band_to=float(scan.scale[-1]), open_above=True))
    return bands


def _outside(side: str, run: Ends, *, unsure: bool) -> dict[str, Any]:
    """Return what stands on this side of a band: a run that did not overturn, or an undecided one."""
    if run.decided:
        return {f"safe_{side}": float(run.scale), f"uncertain_{side}": unsure}
    return {f"open_{side}": True, f"undecided_{side}": True, f"uncertain_{side}": True}


def _stretches_of(scan: Ends, edges: Edges, own: Integers) -> list[_Stretch]:
    """Return where one case is undecided, from a decided run, or an end of the scan, to the next."""
    begins = [edge for edge in own if edges.high.state[edge] < 0]
    ends = [edge for edge in own if edges.low.state[edge] < 0]
    first = [] if scan.decided[0] else [float(scan.scale[0])]
    last = [] if scan.decided[-1] else [float(scan.scale[-1])]
    starts = first + [float(edges.low.scale[edge]) for edge in begins]
    stops = [float(edges.high.scale[edge]) for edge in ends] + last
    return [_Stretch(*pair) for pair in zip(starts, stops, strict=True)]
