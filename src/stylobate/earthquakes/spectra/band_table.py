"""Overturning intervals of the scale, from their edges."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from stylobate.earthquakes.spectra.cases import Cases
from stylobate.earthquakes.spectra.edges import Edges, Ends, Integers

_ATTRIBUTES: Mapping[str, Mapping[str, str]] = {
    "band_from": {"units": "1", "long_name": "least scale of the band that overturned"},
    "band_to": {"units": "1", "long_name": "largest scale of the band that overturned"},
    "safe_below": {"units": "1", "long_name": "largest scale below the band that did not overturn"},
    "safe_above": {"units": "1", "long_name": "least scale above the band that did not overturn"},
    "open_below": {"long_name": "the band may begin lower: it reaches the first scale, or an undecided run"},
    "open_above": {"long_name": "the band may go on: it reaches the last scale, or an undecided run"},
    "undecided_below": {"long_name": "the next run below the band is undecided"},
    "undecided_above": {"long_name": "the next run above the band is undecided"},
    "uncertain_below": {"long_name": "a run at its lower edge is uncertain or undecided"},
    "uncertain_above": {"long_name": "a run at its upper edge is uncertain or undecided"},
}
_OF_STRETCHES: Mapping[str, Mapping[str, str]] = {
    "undecided_from": {"units": "1", "long_name": "largest decided scale below undecided runs, or the first scale"},
    "undecided_to": {"units": "1", "long_name": "least decided scale above undecided runs, or the last scale"},
}


@dataclass(frozen=True, slots=True)
class _Band:
    band_from: float
    band_to: float
    safe_below: float = np.nan
    safe_above: float = np.nan
    open_below: bool = False
    open_above: bool = False
    undecided_below: bool = False
    undecided_above: bool = False
    uncertain_below: bool = False
    uncertain_above: bool = False


@dataclass(frozen=True, slots=True)
class _Stretch:
    undecided_from: float
    undecided_to: float


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
    for dim, rows, described in (("band", bands, _ATTRIBUTES), ("stretch", stretches, _OF_STRETCHES)):
        for name, attributes in described.items():
            table[name] = xr.Variable((*dims, dim), cases.over_axes(_column(rows, name, attributes)), dict(attributes))
    for name, (count, long_name) in counts.items():
        attributes = {"units": "1", "long_name": long_name}
        table[name] = xr.Variable(dims, cases.over_axes(np.array(count, dtype=np.int64)), attributes)
    first = [row[0].undecided_from if row else float(scan.scale[case, -1]) for case, row in enumerate(stretches)]
    decided = np.where(scan.decided[:, 0], first, np.nan)
    about = {"units": "1", "long_name": "largest scale up to which every run was decided"}
    table["decided_to"] = xr.Variable(dims, cases.over_axes(decided), about)
    return xr.Dataset(table)


def _column(rows: Sequence[Sequence[_Band]] | Sequence[Sequence[_Stretch]], name: str, about: Mapping[str, str]) -> Any:
    is_flag = "units" not in about
    shape = (len(rows), max(1, *(len(row) for row in rows)))
    values = np.full(shape, fill_value=False if is_flag else np.nan, dtype=bool if is_flag else float)
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
