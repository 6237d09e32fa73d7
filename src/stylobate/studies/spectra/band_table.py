"""Bands of overturning scales, told from their edges."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from stylobate.studies.spectra.cases import Cases
from stylobate.studies.spectra.edges import Edges, Ends, Flags, Integers
from stylobate.studies.sweeps.quantities import Floats

_ATTRIBUTES: Mapping[str, Mapping[str, str]] = {
    "band_from": {"units": "1", "long_name": "least scale of the band that overturned"},
    "band_to": {"units": "1", "long_name": "largest scale of the band that overturned"},
    "safe_below": {"units": "1", "long_name": "largest scale below the band that did not overturn"},
    "safe_above": {"units": "1", "long_name": "least scale above the band that did not overturn"},
    "open_below": {"long_name": "the band may begin below the first scale"},
    "open_above": {"long_name": "the band may go on above the last scale"},
    "uncertain_below": {"long_name": "a run at its lower edge is uncertain, or one between them tells nothing"},
    "uncertain_above": {"long_name": "a run at its upper edge is uncertain, or one between them tells nothing"},
}


@dataclass(frozen=True, slots=True)
class _Band:
    band_from: float
    band_to: float
    safe_below: float = np.nan
    safe_above: float = np.nan
    open_below: bool = False
    open_above: bool = False
    uncertain_below: bool = False
    uncertain_above: bool = False


def band_table(cases: Cases, scan: Ends, edges: Edges) -> xr.Dataset:
    """Return the bands of each case over the axes and `band`, NaN beyond the last; and how many there are."""
    bands = [
        _bands_of(scan[case], edges, np.flatnonzero((edges.case == case) & ~edges.turns)) for case in range(cases.count)
    ]
    dims = tuple(cases.axes)
    counts = {
        "bands": ([len(row) for row in bands], "bands that overturn"),
        "reversals": (
            np.bincount(edges.case[edges.turns], minlength=cases.count),
            "changes of direction within the bands, without a safe gap as wide as an edge",
        ),
        "unknown": (np.count_nonzero(scan.state < 0, axis=1), "runs of the scan that tell nothing"),
    }
    most = max(1, *(len(row) for row in bands))
    table = {
        name: xr.Variable((*dims, "band"), cases.over_axes(_column(bands, name, most)), dict(attributes))
        for name, attributes in _ATTRIBUTES.items()
    }
    for name, (count, long_name) in counts.items():
        attributes = {"units": "1", "long_name": long_name}
        table[name] = xr.Variable(dims, cases.over_axes(np.array(count, dtype=np.int64)), attributes)
    return xr.Dataset(table)


def _column(bands: Sequence[Sequence[_Band]], name: str, most: int) -> Floats | Flags:
    is_flag = "units" not in _ATTRIBUTES[name]
    values = np.full((len(bands), most), fill_value=False if is_flag else np.nan, dtype=bool if is_flag else float)
    for case, row in enumerate(bands):
        values[case, : len(row)] = [getattr(band, name) for band in row]
    return values


def _bands_of(scan: Ends, edges: Edges, own: Integers) -> list[_Band]:
    """Return the bands of one case, of which the edges are its `own`."""
    known = scan[scan.state >= 0]
    if not known.scale.size:
        return []
    bands: list[_Band] = []
    begun: dict[str, float | bool] | None = None
    if known.state[0] == 1:
        begun = {"band_from": float(known.scale[0]), "open_below": True}
    unsure = edges.low.uncertain | edges.high.uncertain | edges.stuck
    for edge in own:
        low, high = float(edges.low.scale[edge]), float(edges.high.scale[edge])
        if begun is None:
            begun = {"band_from": high, "safe_below": low, "uncertain_below": bool(unsure[edge])}
        else:
            bands.append(_Band(**begun, band_to=low, safe_above=high, uncertain_above=bool(unsure[edge])))  # type: ignore[arg-type]
            begun = None
    if begun is not None:
        bands.append(_Band(**begun, band_to=float(known.scale[-1]), open_above=True))  # type: ignore[arg-type]
    return bands
