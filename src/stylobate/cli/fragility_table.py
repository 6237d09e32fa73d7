"""What `stylobate fragility` tells of its runs: a table of fits, or the same as JSON."""

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from stylobate.cli.output import print_table
from stylobate.cli.saved import model_named, provenance_of

if TYPE_CHECKING:
    import xarray as xr


def summary(
    found: "xr.Dataset", fits: "xr.Dataset", parts: "xr.Dataset | None", rates: "xr.Dataset | None"
) -> dict[str, Any]:
    """Return runs, fits, parts of the dispersion and annual rates as plain values, for JSON."""
    return {
        "kind": "fragility",
        "intensity": {"name": found.attrs["intensity"], "units": fits["median"].attrs.get("units", "1")},
        "records": [str(name) for name in found["record"].to_numpy().ravel()],
        "scales": found["scale"].to_numpy().tolist(),
        "limit_states": [_row(fits, rates, place) for place in range(fits.sizes["limit_state"])],
        "dispersion_parts": None if parts is None else {name: float(parts[name]) for name in _PARTS},
        "intervals": fits.attrs["intervals"],
        "confidence": fits.attrs["confidence"],
        "counting": fits.attrs["counting"],
        "computed": int(found["computed"]),
        "runs": found["outcome"].size,
        "provenance": provenance_of(found),
    }


_ENDS = ("", "_low", "_high")
_PARTS = [
    f"{name}_dispersion{end}" for name in ("total", "record", "property", "joint") for end in _ENDS
]  # as from dispersion_parts


def _row(fits: "xr.Dataset", rates: "xr.Dataset | None", place: int) -> dict[str, Any]:
    """Return what is told of one limit state."""
    one = fits.isel(limit_state=place)
    row: dict[str, Any] = {"name": str(one["limit_state"].item())}
    row |= {f"{name}{end}": float(one[f"{name}{end}"]) for name in ("median", "dispersion") for end in _ENDS}
    meanings = str(fits["status"].attrs["flag_meanings"]).split()
    row["status"] = meanings[int(one["status"])].lower().replace("_", " ")
    row |= {name: int(one[name]) for name in ("runs", "runs_reached", "runs_not_known", "non_monotone_records")}
    if rates is not None:
        told = rates.isel(limit_state=place)
        row |= {name: float(told[name]) for name in ("annual_rate", "rate_low", "rate_high", "probability")}
    return row


def print_fits(found: "xr.Dataset", fits: "xr.Dataset", parts: "xr.Dataset | None", rates: "xr.Dataset | None") -> None:
    """Print a row for each limit state, and what must be known to read them."""
    unit = _UNITS.get(str(fits["median"].attrs.get("units")), "")
    header = ["limit state", f"median{unit}", "dispersion", "reached", "not monotone"]
    if rates is not None:
        header += ["a year", f"in {rates.attrs['years']:g} years"]
    rows = [_cells(_row(fits, rates, place)) for place in range(fits.sizes["limit_state"])]
    print_table(f"{_runs(found)}; {model_named(found)}; over the {found.attrs['intensity']}", rows, header)
    percent = f"{100.0 * float(fits.attrs['confidence']):g} %"
    print(f"{percent} intervals: {fits.attrs['intervals']}; runs counted {fits.attrs['counting']}")
    worst, records = int(fits["non_monotone_records"].max()), found["record"].size
    if records < _FEW:
        print(f"{records} records: with fewer than {_FEW} the intervals of the dispersion are too narrow")
    if worst > 0:
        print(f"not monotone: {worst} of {records} records are safe again at a higher scale than one that is not")
    if parts is not None:
        print(_told_parts(parts))
    if rates is not None:
        beyond = 100.0 * float(rates["share_beyond"].max())
        print(f"annual rates: up to {beyond:.0f} % from beyond the hazard curve")


# With fewer records the measured coverage of the intervals of the dispersion is well below what they claim.
_FEW = 20
_UNITS = {"m s-2": " [m/s²]", "m s-1": " [m/s]"}


def _runs(found: "xr.Dataset") -> str:
    done, total = int(found["computed"]), found["outcome"].size
    over = " × ".join(f"{found.sizes[dim]} {str(dim).replace('_', ' ')}s" for dim in found["outcome"].dims)
    return f"{total} runs: {over}" + (f", {done} of them done" if done < total else "")


def _cells(row: Mapping[str, Any]) -> list[str]:
    fitted = row["status"] == "fitted"
    median, dispersion = (
        f"{_short(row[f'{name}_low'])} to {_short(row[f'{name}_high'])}" for name in ("median", "dispersion")
    )
    unknown = f", {row['runs_not_known']} not known" if row["runs_not_known"] else ""
    cells = [
        row["name"],
        f"{_short(row['median'])}, {median}" if fitted else f"{row['status']}: {median}",
        f"{_short(row['dispersion'])}, {dispersion}" if fitted else "",
        f"{row['runs_reached']} of {row['runs']}{unknown}",
        f"{row['non_monotone_records']}" if row["non_monotone_records"] > 0 else "",
    ]
    if "annual_rate" in row:
        told = math.isfinite(row["annual_rate"])
        cells += [f"{row['annual_rate']:.2e}", f"{100.0 * row['probability']:.2g} %"] if told else ["", ""]
    return cells


def _short(value: float) -> str:
    return f"{value:.3g}"


def _told_parts(parts: "xr.Dataset") -> str:
    what = "dispersion of the least scales that overturn"
    if not math.isfinite(float(parts["total_dispersion"])):
        reasons = {
            "reached_at_once": "overturn at the first scale",
            "never_reached": "at none",
            "not_known": "do not tell",
        }
        counts = [f"{parts.attrs[name]} {reason}" for name, reason in reasons.items() if parts.attrs[name]]
        return f"{what}: not told, for of {parts['log_capacity'].size} series {', '.join(counts)}"
    names = {
        "record": "from record to record",
        "property": "from properties",
        "joint": "of what a property does in one record only",
    }
    told = []
    for name, words in names.items():
        value, low, high = (_short(float(parts[f"{name}_dispersion{end}"])) for end in _ENDS)
        told.append(f"{value} {words} ({low} to {high})")
    return f"{what}: {', '.join(told)}"
