"""Ranking of an inventory as a table: on a terminal, as plain values, and in CSV files, workbooks and GeoPackages."""

import json
import math
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from stylobate.earthquakes.fragility.observations import LIMIT_STATE
from stylobate.earthquakes.inventories.geopackages import geopackage_writer
from stylobate.earthquakes.inventories.ranking import MATTERS
from stylobate.errors import FileError, ParameterError
from stylobate.files import csv_text, write_whole, write_workbook, written_aside
from stylobate.parameter_quantities import quantity_of
from stylobate.results.tables import ResultTable
from stylobate.text import headings_in_words, plural

ENDINGS = (".csv", ".xlsx", ".gpkg")
"""Endings of the files of a ranking."""

_SHOWN = 20
_OVERTURNED = "overturned"
_ENDS = ("", "_low", "_high", "_least", "_most")
_SHARES = ("sliding_share", "undecided_share", "slip_share")
_OF_SCALE = ("tilt_median", "tilt_84", "friction_demand_median", "friction_demand_84", *_SHARES)


def export_inventory(found: xr.Dataset, path: str | Path) -> Path:
    """Write the ranking of an inventory, and return the path.

    Parameters
    ----------
    found
        From `inventory`.
    path
        The ending chooses the format: `.csv`; `.xlsx`, a workbook with a second sheet of the settings; `.gpkg`, a
        GeoPackage with the geometries of the objects.

    Raises
    ------
    ParameterError
        If the ending is unknown, or a GeoPackage is asked for objects without geometry.
    UnsupportedError
        If the package is missing that writes workbooks or GeoPackages.
    FileError
        If the file cannot be written.
    """
    target = Path(path)
    _require_inventory(found)
    if target.suffix not in ENDINGS:
        raise ParameterError(f"path: must end with {', '.join(ENDINGS)} (got {str(path)!r}). Rename it.")
    header, rows = ranking_rows(found)
    if target.suffix == ".csv":
        return write_whole(target, csv_text(header, rows))
    if target.suffix == ".xlsx":
        setting = json.loads(str(found.attrs["provenance"]))
        lines = [["setting", "value"], *([name, _text(value)] for name, value in setting["inventory"].items())]
        lines += [[f"records of {name or 'the site'}", len(site["records"])] for name, site in setting["sites"].items()]
        return write_workbook(
            target, {"ranking": [header, *rows], "settings": [*lines, ["version", setting["version"]]]}
        )
    return _write_geopackage(found, target, header, rows)


def _require_inventory(found: object) -> None:
    if not isinstance(found, xr.Dataset) or found.attrs.get("kind") != "inventory":
        raise ParameterError(f"found: must come from inventory (got {type(found).__name__}). Pass its result.")


def _text(value: Any) -> Any:
    return value if isinstance(value, (int, float, str)) else json.dumps(value)


def ranking_rows(found: xr.Dataset) -> tuple[list[str], list[list[Any]]]:
    """Return the header and rows of the table of a ranking: numbers in SI units, and the carried cells as they were.

    Numbers of the limit state and scale of the ranking stand first; an empty cell stands for a withheld number.
    """
    state, scale = str(found.attrs["limit_state"]), as_recorded(found)
    columns: dict[str, Iterable[Any]] = {
        "rank": [rank or "" for rank in found["rank"].to_numpy().tolist()],
        "name": found["object"].to_numpy().tolist(),
        "site": found["site"].to_numpy().tolist(),
    }
    if "annual_rate" in found:
        columns |= {
            f"annual rate of {state}{_in_words(end)} [1/a]": found[f"{'annual_rate' if not end else f'rate{end}'}"]
            .sel({LIMIT_STATE: state})
            .to_numpy()
            .tolist()
            for end in _ENDS
        }
    several = found.sizes["scale"] > 1
    own = found.isel(scale=scale)
    suffix = f" at scale {float(own['scale']):g}" if several else ""
    columns |= {
        f"probability of {state}{_in_words(end)}{suffix}": own[f"probability{end}"]
        .sel({LIMIT_STATE: state})
        .to_numpy()
        .tolist()
        for end in _ENDS
    }
    others = [str(name) for name in found[LIMIT_STATE].to_numpy() if name != state]
    columns |= {
        f"probability of {name}{suffix}": own["probability"].sel({LIMIT_STATE: name}).to_numpy().tolist()
        for name in others
    }
    columns |= {f"{name.replace('_', ' ')}{suffix}": own[name].to_numpy().tolist() for name in _OF_SCALE}
    columns["runs"] = found["runs"].to_numpy().tolist()
    columns["note"] = notes_of(found)
    provenance = json.loads(str(found.attrs["provenance"]))
    inputs = dict.fromkeys(
        name for one in provenance["objects"].values() for name in (*one["column"], *one["model"]) if name != "kind"
    )
    stated = [provenance["objects"][name] for name in columns["name"]]
    for name in inputs:
        unit = quantity_of(name).unit
        numbers = ({**one["column"], **one["model"]}.get(name, "") for one in stated)
        columns[f"{name} [{unit}]" if unit else name] = list(numbers)
    columns["friction_coefficient"] = found["friction_coefficient"].to_numpy().tolist()
    if "carried" in found:
        for name in found["column"].to_numpy().tolist():
            free = name if name not in columns else f"{name} (table)"
            columns[free] = found["carried"].sel(column=name).to_numpy().tolist()
    rows = [[_cell(value) for value in row] for row in zip(*columns.values(), strict=True)]
    return list(columns), rows


def as_recorded(found: xr.Dataset) -> int:
    """Return the index of the scale nearest to 1, at which objects are ranked by probability."""
    return int(np.argmin(np.abs(np.log(found["scale"].to_numpy()))))


def _in_words(end: str) -> str:
    words = {"": "", "_low": ", lower end", "_high": ", upper end", "_least": ", lower bound", "_most": ", upper bound"}
    return words[end]


def _cell(value: Any) -> Any:
    """Return a number as a cell: nothing for NaN, a word for infinity."""
    if isinstance(value, float) and math.isnan(value):
        return ""
    return _OVERTURNED if value == math.inf else value


def notes_of(found: xr.Dataset) -> list[str]:
    """Return a note on each object: why its number is withheld, that some runs would slip, or an estimated inertia."""
    names = ("rank", "slenderness", "friction_coefficient", *_SHARES)
    own = found.isel(scale=as_recorded(found))
    notes = map(_note, *(own[name].to_numpy().tolist() for name in names))
    objects = json.loads(str(found.attrs["provenance"]))["objects"]
    estimated = [objects[name].get("estimated", "") for name in found["object"].to_numpy().tolist()]
    return ["; ".join(filter(None, both)) for both in zip(notes, estimated, strict=True)]


def _note(rank: int, c: float, friction: float, sliding: float, undecided: float, slip: float) -> str:
    parts = [] if rank else ["withheld"]
    if sliding > 0.0:
        share = (
            "slides before it rocks" if sliding == 1.0 else f"slides before it rocks in {100.0 * sliding:.2g} % of runs"
        )
        parts.append(f"{share}: µ = {friction:.3g}, r/h = {c:.3g}")
    if undecided > 0.0:
        parts.append(f"{100.0 * undecided:.2g} % of runs undecided")
    if slip > sliding:
        parts.append(f"{100.0 * slip:.2g} % of runs need more friction")
    return "; ".join(parts)


def _write_geopackage(found: xr.Dataset, target: Path, header: list[str], rows: list[list[Any]]) -> Path:
    raw = geopackage_writer(target)
    if "geometry" not in found:
        raise ParameterError(f"path: the objects have no geometry (got {str(target)!r}). Write a .csv or .xlsx.")
    geometry = np.array([bytes.fromhex(one) for one in found["geometry"].to_numpy().tolist()], dtype=object)
    fields = [_field(values) for values in zip(*rows, strict=True)]
    try:
        with written_aside(target) as beside:
            raw.write(
                beside,
                geometry=geometry,
                field_data=fields,
                fields=np.array(header, dtype=object),
                geometry_type="Unknown",
                crs=found["geometry"].attrs["crs"] or None,
                driver="GPKG",
                layer="ranking",
            )
    except FileError:
        raise
    except Exception as error:  # GDAL raises errors of many kinds
        raise FileError(f"cannot write {target}: {error}. Write a .csv or .xlsx.") from error
    return target


def _field(values: Iterable[Any]) -> Any:
    """Return a field of a GeoPackage: numbers, NaN for empty cells and infinite for overturned, or words."""
    cells, special = list(values), {"": math.nan, _OVERTURNED: math.inf}
    numbers = [special.get(one) if isinstance(one, str) else one for one in cells]
    if None in numbers or not any(one != "" for one in cells):
        return np.array([str(one) for one in cells], dtype=object)
    return np.array(numbers)


def _ties_in_words(found: xr.Dataset) -> str:
    """Return a line on the largest number of objects that share a rank; empty without a shared rank."""
    ranks = found["rank"].to_numpy()
    shared, counts = np.unique(ranks[ranks > 0], return_counts=True)
    if not (counts > 1).any():
        return ""
    most = int(np.argmax(counts))
    return (
        f"{counts[most]} objects share rank {shared[most]}: these records do not separate them; use more records, or "
        "compare their smallest overturning scales by stylobate assess"
    )


def table_of_ranking(found: xr.Dataset) -> ResultTable:
    """Make a table of the first objects of a ranking, with remarks, for a terminal."""
    state, scale = str(found.attrs["limit_state"]), as_recorded(found)
    percent = f"{100.0 * float(found.attrs['confidence']):g} %"
    by_rate = found.attrs["ranked_by"] == "annual_rate"
    interval = f"{percent} interval"
    header = ["rank", "object", "site", *(["per year", interval] if by_rate else [])]
    header += ["probability", interval, "median peak tilt/α_c", "84 % quantile", "note"]
    shown = found.isel(object=slice(_SHOWN), scale=scale).sel({LIMIT_STATE: state})
    notes = notes_of(found.isel(object=slice(_SHOWN)))
    rows = [_line(shown.isel(object=place), notes[place], by_rate=by_rate) for place in range(shown.sizes["object"])]
    if not any(str(site) for site in found["site"].to_numpy()):
        header.remove("site")
        rows = [[*row[:2], *row[3:]] for row in rows]
    total, withheld = found.sizes["object"], int((found["rank"] == 0).sum())
    runs = int(found["runs"].sum())
    title = f"{plural(total, 'object')}, {plural(runs, 'run')}, {found.attrs['model']}; {state}"
    title += f" at scale {float(shown['scale']):g}"
    remarks = [f"{percent} intervals over records"]
    if withheld:
        remarks.append(
            f"{plural(withheld, 'object')} without rank: runs that are not known change the probability by more than "
            f"{MATTERS:g}"
        )
    if tied := _ties_in_words(found):
        remarks.append(tied)
    if read_as := headings_in_words(json.loads(str(found.attrs["provenance"]))["inventory"].get("headings", {})):
        remarks.append(read_as)
    if "carried" in found:
        remarks.append(f"columns carried through: {', '.join(found['column'].to_numpy().tolist())}")
    if total > _SHOWN:
        remarks.append(f"the first {_SHOWN} of {total} objects are shown")
    return ResultTable(title, header, rows, remarks)


def _line(one: xr.Dataset, note: str, *, by_rate: bool) -> list[str]:
    cells = [str(int(one["rank"]) or "–"), str(one["object"].item()), str(one["site"].item())]
    if by_rate:
        rate, low, high = (float(one[name]) for name in ("annual_rate", "rate_low", "rate_high"))
        cells += [f"{rate:.1e}" if math.isfinite(rate) else "withheld", f"{low:.1e} to {high:.1e}"]
    probability, low, high = (float(one[f"probability{end}"]) for end in _ENDS[:3])
    cells += [f"{probability:.3g}" if math.isfinite(probability) else "withheld", f"{low:.2g} to {high:.2g}"]
    for name in ("tilt_median", "tilt_84"):
        tilt = float(one[name])
        cells.append(_OVERTURNED if math.isinf(tilt) else "" if math.isnan(tilt) else f"{tilt:.2g}")
    return [*cells, note]


def plain_ranking(found: xr.Dataset) -> dict[str, Any]:
    """Convert a ranking to plain values for JSON."""
    header, rows = ranking_rows(found)
    return {
        "kind": "inventory",
        "limit_state": found.attrs["limit_state"],
        "ranked_by": found.attrs["ranked_by"],
        "confidence": float(found.attrs["confidence"]),
        "objects": [dict(zip(header, row, strict=True)) for row in rows],
        "provenance": json.loads(str(found.attrs["provenance"])),
    }
