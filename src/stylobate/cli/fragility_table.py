"""Output of `stylobate fragility`: a table of fits, or the same as JSON."""

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from stylobate.cli.output import model_named, print_table, provenance_of
from stylobate.results.damping_yardstick import yardstick_text
from stylobate.results.few_records import few_records
from stylobate.results.tables import number_of_runs
from stylobate.text import plural

if TYPE_CHECKING:
    import xarray as xr


def summary(
    runs: "xr.Dataset", fits: "xr.Dataset", parts: "xr.Dataset | None", rates: "xr.Dataset | None"
) -> dict[str, Any]:
    """Convert runs, fits, parts of the dispersion and annual rates to plain values for JSON."""
    return {
        "kind": "fragility",
        "intensity": {
            "name": runs.attrs["intensity"],
            "component": fits["median"].attrs.get("component"),
            "units": fits["median"].attrs.get("units", "1"),
        },
        "records": [str(name) for name in runs["record"].to_numpy().ravel()],
        "scales": runs["scale"].to_numpy().tolist(),
        "limit_states": [_row(fits, rates, place) for place in range(fits.sizes["limit_state"])],
        "housner_damping": [
            {"amplitude": amplitude, "damping": damping}
            for amplitude, damping in zip(fits.attrs["housner_amplitudes"], fits.attrs["housner_damping"], strict=True)
        ],
        "dispersion_parts": None if parts is None else {name: float(parts[name]) for name in _PARTS},
        "intervals": fits.attrs["intervals"],
        "confidence": fits.attrs["confidence"],
        "counting": fits.attrs["counting"],
        "computed": int(runs["computed"]),
        "runs": runs["outcome"].size,
        "provenance": provenance_of(runs),
    }


_ENDS = ("", "_low", "_high")
_PARTS = [
    f"{name}_dispersion{end}" for name in ("total", "record", "property", "joint") for end in _ENDS
]  # as from dispersion_parts


_OF_RATES = ("annual_rate", "rate_low", "rate_high", "probability", "share_beyond")


def _row(fits: "xr.Dataset", rates: "xr.Dataset | None", place: int) -> dict[str, Any]:
    """Return the numbers of one limit state."""
    one = fits.isel(limit_state=place)
    row: dict[str, Any] = {"name": str(one["limit_state"].item())}
    row |= {f"{name}{end}": float(one[f"{name}{end}"]) for name in ("median", "dispersion") for end in _ENDS}
    meanings = str(fits["status"].attrs["flag_meanings"]).split()
    row["status"] = meanings[int(one["status"])].lower().replace("_", " ")
    row |= {name: int(one[name]) for name in ("runs", "runs_reached", "runs_not_known", "non_monotone_records")}
    if rates is not None:
        rate = rates.isel(limit_state=place)
        row |= {name: float(rate[name]) for name in _OF_RATES}
        row["rate_withheld"] = str(rate["withheld_reason"].item())
        if row["rate_withheld"]:
            row |= dict.fromkeys(("annual_rate", "probability"), math.nan)
    return row


def print_fits(runs: "xr.Dataset", fits: "xr.Dataset", parts: "xr.Dataset | None", rates: "xr.Dataset | None") -> None:
    """Print a row for each limit state, and remarks on the table."""
    unit = _UNITS.get(str(fits["median"].attrs.get("units")), "")
    header = ["limit state", f"median{unit}", "dispersion", "reached", "not monotonic"]
    if rates is not None:
        header += ["per year", f"in {rates.attrs['years']:g} years"]
    rows = [_row(fits, rates, place) for place in range(fits.sizes["limit_state"])]
    over = " × ".join(plural(runs.sizes[dim], str(dim).replace("_", " ")) for dim in runs["outcome"].dims)
    title = f"{number_of_runs(runs, f': {over}')}; {model_named(runs)}; over the {runs.attrs['intensity']}"
    print_table(title, [_cells(row) for row in rows], header)
    percent = f"{100.0 * float(fits.attrs['confidence']):g} %"
    print(f"{percent} intervals: {fits.attrs['intervals']}; runs counted {fits.attrs['counting']}")
    print(f"damping: Housner's impacts lose as {yardstick_text(fits.attrs['housner_damping'])}")
    worst, records = int(fits["non_monotone_records"].max()), runs["record"].size
    if few := few_records(records):
        print(few)
    if worst > 0:
        print(f"not monotonic: {worst} of {records} records survive at a scale above one that reached a limit state")
    if parts is not None:
        print(describe_parts(parts))
    if rates is not None:
        for line in (*_of_hazard(rates), *_remarks_on_rates(rows)):
            print(line)


_UNITS = {"m s-2": " [m/s²]", "m s-1": " [m/s]"}


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
    """Write the annual rate and the probability; a rate may be withheld."""
    if row["rate_withheld"]:
        return ["withheld", "withheld"]
    if not math.isfinite(row["annual_rate"]):
        return ["", ""]
    return [f"{row['annual_rate']:.2e}", _percent(row["probability"])]


def _percent(probability: float) -> str:
    """Return a probability in percent with two digits, and "> 99.9 %" near certainty.

    >>> _percent(0.036), _percent(0.5), _percent(0.9999), _percent(1.0)
    ('3.6 %', '50 %', '> 99.9 %', '> 99.9 %')
    """
    if probability > _NEARLY_CERTAIN:
        return "> 99.9 %"
    return f"{100.0 * probability:.2g} %" if probability < _MANY else f"{100.0 * probability:.1f} %"


_MANY, _NEARLY_CERTAIN = 0.95, 0.999


def _of_hazard(rates: "xr.Dataset") -> list[str]:
    """Describe the intensity of the hazard curve, and the origin of its rates."""
    origin = str(rates.attrs["hazard_origin"])
    return [f"hazard: {rates['hazard_intensity'].attrs['long_name']}" + (f"; rates from {origin}" if origin else "")]


def _remarks_on_rates(rows: Sequence[Mapping[str, Any]]) -> list[str]:
    """Describe the fraction of the annual rates beyond the hazard curve, and the reasons for withheld rates."""
    shares = [row["share_beyond"] for row in rows if math.isfinite(row["annual_rate"])]
    lines = [f"annual rates: up to {100.0 * max(shares):.0f} % from beyond the hazard curve"] if shares else []
    for row in rows:
        if why := row["rate_withheld"]:
            bounds = f"it is between {row['rate_low']:.1e} and {row['rate_high']:.1e} per year"
            lines.append(f"annual rate of {row['name']!r}: withheld: {why}; {bounds}")
    return lines


def _short(value: float) -> str:
    return f"{value:.3g}"


def describe_parts(parts: "xr.Dataset") -> str:
    """Describe in a line the parts of the dispersion due to records and to properties."""
    what = "dispersion of the minimum scales that overturn"
    if not math.isfinite(float(parts["total_dispersion"])):
        reasons = {
            "reached_at_once": "overturn at the first scale",
            "never_reached": "at none",
            "not_known": "undecided",
        }
        counts = [f"{parts.attrs[name]} {reason}" for name, reason in reasons.items() if parts.attrs[name]]
        return f"{what}: unknown: of {parts['log_capacity'].size} series {', '.join(counts)}"
    hidden = float(parts.attrs["resolution"])  # by the steps between scales
    names = {
        "record": "from record to record",
        "property": "from properties",
        "joint": "from a property in one record only",
    }
    described = []
    for name, words in names.items():
        value, low, high = (float(parts[f"{name}_dispersion{end}"]) for end in _ENDS)
        seen, high = (_short(value), high) if value > 0.0 else ("none seen", max(high, hidden))
        described.append(f"{seen} {words} ({_short(low)} to {_short(high)})")
    return f"{what}: {', '.join(described)}"
