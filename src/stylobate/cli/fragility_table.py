"""What `stylobate fragility` tells of its runs: a table of fits, or the same as JSON."""

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from stylobate.cli.output import print_table
from stylobate.cli.saved import model_named, provenance_of
from stylobate.results.few_records import few_records
from stylobate.text import plural

if TYPE_CHECKING:
    import xarray as xr


def summary(
    found: "xr.Dataset", fits: "xr.Dataset", parts: "xr.Dataset | None", rates: "xr.Dataset | None"
) -> dict[str, Any]:
    """Return runs, fits, parts of the dispersion and annual rates as plain values, for JSON."""
    return {
        "kind": "fragility",
        "intensity": {
            "name": found.attrs["intensity"],
            "component": fits["median"].attrs.get("component"),
            "units": fits["median"].attrs.get("units", "1"),
        },
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


_OF_RATES = ("annual_rate", "rate_low", "rate_high", "probability", "share_beyond")


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
        row |= {name: float(told[name]) for name in _OF_RATES}
        row["rate_withheld"] = str(told["withheld_reason"].item())
        if row["rate_withheld"]:
            row |= dict.fromkeys(("annual_rate", "probability"), math.nan)
    return row


def print_fits(found: "xr.Dataset", fits: "xr.Dataset", parts: "xr.Dataset | None", rates: "xr.Dataset | None") -> None:
    """Print a row for each limit state, and what must be known to read them."""
    unit = _UNITS.get(str(fits["median"].attrs.get("units")), "")
    header = ["limit state", f"median{unit}", "dispersion", "reached", "not monotone"]
    if rates is not None:
        header += ["a year", f"in {rates.attrs['years']:g} years"]
    told = [_row(fits, rates, place) for place in range(fits.sizes["limit_state"])]
    title = f"{_runs(found)}; {model_named(found)}; over the {found.attrs['intensity']}"
    print_table(title, [_cells(row) for row in told], header)
    percent = f"{100.0 * float(fits.attrs['confidence']):g} %"
    print(f"{percent} intervals: {fits.attrs['intervals']}; runs counted {fits.attrs['counting']}")
    worst, records = int(fits["non_monotone_records"].max()), found["record"].size
    if few := few_records(records):
        print(few)
    if worst > 0:
        print(f"not monotone: {worst} of {records} records are safe again at a higher scale than one that is not")
    if parts is not None:
        print(told_parts(parts))
    if rates is not None:
        for line in (*_of_hazard(rates), *_told_rates(told)):
            print(line)


_UNITS = {"m s-2": " [m/s²]", "m s-1": " [m/s]"}


def _runs(found: "xr.Dataset") -> str:
    done, total = int(found["computed"]), found["outcome"].size
    over = " × ".join(plural(found.sizes[dim], str(dim).replace("_", " ")) for dim in found["outcome"].dims)
    return f"{plural(total, 'run')}: {over}" + (f", {done} of them done" if done < total else "")


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
        cells += _rate_cells(row)
    return cells


def _rate_cells(row: Mapping[str, Any]) -> list[str]:
    """Return the annual rate and the probability, if they are told."""
    if row["rate_withheld"]:
        return ["not told", "not told"]
    if not math.isfinite(row["annual_rate"]):
        return ["", ""]
    return [f"{row['annual_rate']:.2e}", _percent(row["probability"])]


def _percent(probability: float) -> str:
    """Return a probability in percent, of two digits; one near certainty is no certainty.

    >>> _percent(0.036), _percent(0.5), _percent(0.9999), _percent(1.0)
    ('3.6 %', '50 %', '> 99.9 %', '> 99.9 %')
    """
    if probability > _NEARLY_CERTAIN:
        return "> 99.9 %"
    return f"{100.0 * probability:.2g} %" if probability < _MANY else f"{100.0 * probability:.1f} %"


_MANY, _NEARLY_CERTAIN = 0.95, 0.999


def _of_hazard(rates: "xr.Dataset") -> list[str]:
    """Return what the hazard curve is of, and where its rates come from."""
    origin = str(rates.attrs["hazard_origin"])
    return [f"hazard: {rates['hazard_intensity'].attrs['long_name']}" + (f"; rates from {origin}" if origin else "")]


def _told_rates(rows: Sequence[Mapping[str, Any]]) -> list[str]:
    """Return what must be known of the annual rates: how much of them no hazard curve tells."""
    shares = [row["share_beyond"] for row in rows if math.isfinite(row["annual_rate"])]
    lines = [f"annual rates: up to {100.0 * max(shares):.0f} % from beyond the hazard curve"] if shares else []
    for row in rows:
        if why := row["rate_withheld"]:
            bounds = f"it is between {row['rate_low']:.1e} and {row['rate_high']:.1e} a year"
            lines.append(f"annual rate of {row['name']!r}: not told, for {why}; {bounds}")
    return lines


def _short(value: float) -> str:
    return f"{value:.3g}"


def told_parts(parts: "xr.Dataset") -> str:
    """Return in a line what of the dispersion is of records and of properties; what is 0 was not seen."""
    what = "dispersion of the least scales that overturn"
    if not math.isfinite(float(parts["total_dispersion"])):
        reasons = {
            "reached_at_once": "overturn at the first scale",
            "never_reached": "at none",
            "not_known": "do not tell",
        }
        counts = [f"{parts.attrs[name]} {reason}" for name, reason in reasons.items() if parts.attrs[name]]
        return f"{what}: not told, for of {parts['log_capacity'].size} series {', '.join(counts)}"
    hidden = float(parts.attrs["resolution"])  # by the steps between scales
    names = {
        "record": "from record to record",
        "property": "from properties",
        "joint": "of what a property does in one record only",
    }
    told = []
    for name, words in names.items():
        value, low, high = (float(parts[f"{name}_dispersion{end}"]) for end in _ENDS)
        seen, high = (_short(value), high) if value > 0.0 else ("none seen", max(high, hidden))
        told.append(f"{seen} {words} ({_short(low)} to {_short(high)})")
    return f"{what}: {', '.join(told)}"
