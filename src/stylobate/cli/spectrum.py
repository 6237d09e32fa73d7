"""`stylobate spectrum`: overturning intervals of the amplitude, or rocking spectra, over size or other numbers."""

import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stylobate import config, earthquakes
from stylobate.cli.command import command
from stylobate.cli.options import Options, axis_values, spacing, with_axes
from stylobate.cli.output import model_named, open_study, print_table, provenance_of
from stylobate.cli.study import check_axes, finish, run_study, study_values
from stylobate.config.options import (
    AXES,
    COLUMN,
    COMPUTING,
    MODEL,
    MOTION,
    OUTPUT_OR_STORE,
    RECORD,
    Group,
    Option,
    run_numbers,
)
from stylobate.run_arguments import SharedByRuns
from stylobate.text import plural

if TYPE_CHECKING:
    import xarray as xr

SCALES = Option(
    "scales", "factors of the base motion: first, last, number", tuple[float, float, int], metavar="FROM TO NUMBER"
)
SCALES_SPACING = Option("scales_spacing", "log (by default) or linear", str)
_SPECTRUM = Group.of(
    "Spectrum",
    SCALES,
    SCALES_SPACING,
    Option("rocking", "peak tilts and tilt rates instead", bool),
    Option("width", "relative width to which the ends of intervals are located; 0.001 by default"),
    Option("free_tail", "free vibration time after the base motion; 40/p by default", unit="s"),
)

# Longer tables show only the cases that overturn first, or rock most.
_ROWS, _FIRST = 40, 12


@command(
    argument="TOML description, or a saved spectrum (.nc) to show or repeat",
    groups=(
        AXES,
        _SPECTRUM,
        run_numbers(SharedByRuns).without("periods", "tilt_limit"),
        COLUMN,
        MODEL,
        MOTION,
        RECORD,
        COMPUTING,
        OUTPUT_OR_STORE,
    ),
)
def spectrum(options: Options) -> None:
    """Compute overturning intervals of the amplitude, or rocking spectra.

    A base motion overturns a column at the scales in these intervals; above one of them the column may survive again.
    One or two numbers vary: size, slenderness, damping, angular-frequency of a pulse, rotation … Without --x, the
    result is of one column. With --rocking, the result holds peak tilts and tilt rates over --x. Examples:

    stylobate spectrum --slenderness 0.1 --damping 0.1 --motion one-sine --x angular-frequency 1 9 41
    --scales 0.1 2 40 --figure spectrum.png

    stylobate spectrum --radius 0.5 --height 5 --density 2000 --damping 0.05 --sample-record "el centro 1940"
    --x size 0.2 4 12 --x-spacing log --rocking --output rocking.nc
    """
    result, complete = run_study(
        options, _saved(options["source"]), lambda saved: saved, lambda saved: _prepared(saved, options)
    )
    finish(result, options, _summary, _print, complete=complete)


def _prepared(saved: "xr.Dataset | None", options: Options) -> "tuple[Callable[..., xr.Dataset], config.Setup]":
    kind = earthquakes.config.SpectrumConfig
    more = {} if saved is None else {"rocking": saved.attrs["kind"] == _ROCKING}
    values = with_axes(study_values(saved, options, kind, **more), options, "spectrum")
    values = _with_spectrum(values, options)
    setup = kind.parse(values).build()
    check_axes("spectrum", setup)
    rocking = values["spectrum"].get("rocking")
    return (earthquakes.rocking_spectrum if rocking else earthquakes.overturning_intervals), setup


def _saved(source: Path | None) -> "xr.Dataset | None":
    store = (
        "the store of a spectrum or a sweep, which cannot be shown. Continue it with its options, "
        f"--output {source} and --resume, or save a spectrum as .nc."
    )
    return open_study(source, _KINDS, lacks="spectrum", store=store)


_INTERVALS, _ROCKING = "overturning intervals", "rocking spectrum"
_KINDS = (_INTERVALS, _ROCKING)


def _with_spectrum(values: Mapping[str, Any], options: Options) -> dict[str, Any]:
    """Override the table of a spectrum in the values by its options."""
    table = values.get("spectrum", {})
    if not isinstance(table, Mapping):
        return dict(values)
    table = dict(table)
    if options["scales"] is not None:
        table["scales"] = axis_values(options["scales"])
    table |= spacing(table, "scales", options) | options.pick("rocking", "width")
    if options["free_tail"] is not None:
        table["tail"] = options["free_tail"]
    kept = dict(values)
    if options["duration"] is None and options["free_tail"] is not None:
        kept.pop("duration", None)  # either states the duration
    if options["duration"] is not None and options["free_tail"] is None:
        table.pop("tail", None)
    return {**kept, "spectrum": table}


# Bounds of the ends of intervals.
_ACCURACY = ("width", "scale_step", "resolution")


def _summary(result: "xr.Dataset") -> dict[str, Any]:
    rows = _intervals(result) if result.attrs["kind"] == _INTERVALS else _peaks(result)
    return {
        "kind": result.attrs["kind"],
        "cases": rows,
        **{name: result.attrs[name] for name in _ACCURACY if name in result.attrs},
        "computed": int(result["computed"]),
        "runs": result["outcome"].size,
        "provenance": provenance_of(result),
    }


def _cases(result: "xr.Dataset", name: str) -> list[tuple[dict[str, Any], "xr.Dataset"]]:
    """List the names and values that tell cases apart, and the numbers of each case."""
    dims = [str(dim) for dim in result[name].dims]
    flat = result.stack(case=dims) if dims else result.expand_dims("case")
    cases = [flat.isel(case=place) for place in range(flat.sizes["case"])]
    names = [("motion_name" if dim == "motion" else dim, dim) for dim in dims]
    return [({dim: one[name].item() for name, dim in names}, one) for one in cases]


def _intervals(result: "xr.Dataset") -> list[dict[str, Any]]:
    ends = ("interval_from", "interval_to", "safe_below", "safe_above", "uncertain_below", "uncertain_above")
    return [
        {
            **case,
            "frequency_parameter": one["frequency_parameter"].item(),
            "acceleration_ratio": one["acceleration_ratio"].item(),
            "intervals": [{name: one[name][place].item() for name in ends} for place in range(int(one["intervals"]))],
            "unknown": int(one["unknown"]),
        }
        for case, one in _cases(result, "intervals")
    ]


def _peaks(result: "xr.Dataset") -> list[dict[str, Any]]:
    from stylobate.results.outcomes import outcome_label

    names = ("rocking_period", "peak_tilt_ratio", "peak_rate_ratio")
    rows = []
    for case, one in _cases(result, "peak_tilt_ratio"):
        label = outcome_label(int(one["outcome"]))
        rows.append({**case, **{name: one[name].item() for name in names}, "outcome": label})
    return rows


def _print(result: "xr.Dataset") -> None:
    if result.attrs["kind"] == _INTERVALS:
        _print_intervals(result)
    else:
        _print_peaks(result)


def _print_intervals(result: "xr.Dataset") -> None:
    rows = sorted(_intervals(result), key=_least) if result["intervals"].size > _ROWS else _intervals(result)
    dims = [str(dim) for dim in result["intervals"].dims]
    table = [
        (
            *(_written(row[dim]) for dim in dims),
            "; ".join(map(_interval, row["intervals"])) or "never",
            _written(_least(row) * row["acceleration_ratio"]) if row["intervals"] else "",
        )
        for row in (rows[:_FIRST] if len(rows) > _ROWS else rows)
    ]
    header = (*dims, "overturns at scales", "minimum peak acceleration / (g tan α)")
    title = [f"{plural(len(rows), 'case')}, {model_named(result)}"]
    title += [f"the {_FIRST} that overturn first"] if len(rows) > _ROWS else []
    unknown = int(result["unknown"].sum())
    title += [f"{unknown} of {plural(result['outcome'].size, 'run')} without an answer"] if unknown else []
    print_table("; ".join([*title, result.attrs["resolution"]]), table, header)


def _least(row: Mapping[str, Any]) -> float:
    return min((float(interval["interval_from"]) for interval in row["intervals"]), default=float("inf"))


def _interval(interval: Mapping[str, Any]) -> str:
    sure = "?" if interval["uncertain_below"] or interval["uncertain_above"] else ""
    low = "" if math.isfinite(interval["safe_below"]) else "below "
    high = f"to {interval['interval_to']:.4g}" if math.isfinite(interval["safe_above"]) else "on"
    return f"{low}{interval['interval_from']:.4g} {high}{sure}"


def _print_peaks(result: "xr.Dataset") -> None:
    rows = _peaks(result)
    if len(rows) > _ROWS:
        rows = sorted(rows, key=lambda row: -row["peak_tilt_ratio"] if row["outcome"] != "overturned" else -1e9)[
            :_FIRST
        ]
    dims = [str(dim) for dim in result["peak_tilt_ratio"].dims]
    names = ("rocking_period", "outcome", "peak_tilt_ratio", "peak_rate_ratio")
    table = [tuple(_written(row[name]) for name in (*dims, *names)) for row in rows]
    shown = f"; the {len(rows)} that rock most" if len(rows) < result["outcome"].size else ""
    header = (*dims, "2π/p [s]", "outcome", "peak tilt / α", "peak rate of tilt / p")
    print_table(f"{plural(result['outcome'].size, 'case')}, {model_named(result)}{shown}", table, header)


def _written(value: Any) -> str:
    if isinstance(value, str):
        return value
    return f"{value:.4g}" if math.isfinite(value) else ""
