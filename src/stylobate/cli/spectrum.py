"""`stylobate spectrum`: which amplitudes overturn columns of many sizes, or how far they rock."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from stylobate import earthquakes
from stylobate.cli import options as opt
from stylobate.cli.given import Given
from stylobate.cli.many_runs import check_axes, check_outputs, computed, end, is_to_compute, write
from stylobate.cli.output import STORE, print_json, print_table
from stylobate.cli.saved import axes_of, model_named, open_saved, provenance_of
from stylobate.cli.source import read_source
from stylobate.errors import FileError
from stylobate.text import plural

if TYPE_CHECKING:
    import xarray as xr

Source = Annotated[
    Path | None,
    typer.Argument(help="TOML description, or a saved spectrum (.nc) to show or repeat", show_default=False),
]


def _option(text: str, metavar: str | None = None) -> Any:
    return typer.Option(help=text, rich_help_panel="Spectrum", show_default=False, metavar=metavar)


ScaleRange = Annotated[
    tuple[float, float, int] | None, _option("factors of the base motion: from, to, how many", "FROM TO NUMBER")
]
ScalesSpacing = Annotated[str | None, _option("log (by default) or linear")]
Rocking = Annotated[
    bool | None,
    typer.Option("--rocking", help="peak tilts and rates instead", rich_help_panel="Spectrum", show_default=False),
]
Width = Annotated[float | None, _option("relative width to which edges of bands are told [default: 0.001]")]
FreeTail = Annotated[float | None, _option("how long to follow after the base motion [s]; by default 40/p")]

# Tables longer than this show the cases that overturn first, or rock most, only.
_ROWS, _FIRST = 40, 12


@opt.with_waveforms
def spectrum(
    context: typer.Context,
    source: Source = None,
    x: opt.X = None,
    y: opt.Y = None,
    x_spacing: opt.XSpacing = None,
    y_spacing: opt.YSpacing = None,
    scales: ScaleRange = None,
    scales_spacing: ScalesSpacing = None,
    rocking: Rocking = None,
    width: Width = None,
    free_tail: FreeTail = None,
    tilt: opt.Tilt = None,
    tilt_rate: opt.TiltRate = None,
    spin: opt.Spin = None,
    duration: opt.Duration = None,
    method: opt.Method = None,
    rtol: opt.Rtol = None,
    rest_energy: opt.RestEnergy = None,
    max_steps: opt.MaxSteps = None,
    shape: opt.Shape = None,
    radius: opt.Radius = None,
    height: opt.Height = None,
    density: opt.Density = None,
    inner_radius: opt.InnerRadius = None,
    top_radius: opt.TopRadius = None,
    slenderness: opt.Slenderness = None,
    gravity: opt.Gravity = None,
    model: opt.Model = None,
    damping: opt.Damping = None,
    spin_damping: opt.SpinDamping = None,
    rolling_resistance: opt.RollingResistance = None,
    restitution: opt.Restitution = None,
    constraint: opt.Constraint = None,
    passage_tilt: opt.PassageTilt = None,
    friction_coefficient: opt.FrictionCoefficient = None,
    static_friction_coefficient: opt.StaticFriction = None,
    patch: opt.Patch = None,
    incline: opt.Incline = None,
    incline_direction: opt.InclineDirection = None,
    motion: opt.Motion = None,
    acceleration: opt.Acceleration = None,
    angular_frequency: opt.AngularFrequency = None,
    frequency: opt.Frequency = None,
    amplitude: opt.Amplitude = None,
    phase: opt.Phase = None,
    direction: opt.Direction = None,
    angle: opt.Angle = None,
    sense: opt.Sense = None,
    stroke: opt.Stroke = None,
    diameter: opt.Diameter = None,
    rpm: opt.Rpm = None,
    start_phase: opt.StartPhase = None,
    ramp: opt.Ramp = None,
    record: opt.RecordFiles = None,
    record_direction: opt.RecordDirections = None,
    single: opt.Single = None,
    sample_record: opt.SampleRecord = None,
    units: opt.Units = None,
    step: opt.TimeStep = None,
    scale: opt.Scale = None,
    rotation: opt.Rotation = None,
    tail: opt.Tail = None,
    resume: opt.Resume = False,
    executor: opt.Executor = None,
    threads: opt.ThreadCount = None,
    figure: opt.Figure = None,
    output: opt.OutputOrStore = None,
    as_json: opt.Json = False,
) -> None:
    """Tell all amplitudes at which a pulse or a record overturns columns; above some they may be safe again.

    Over one quantity or two: size, slenderness, damping, angular-frequency of a pulse (one-sine, half-sine,
    one-cosine, ricker …), rotation … Without --x, of one column; --rocking: peak tilts and rates over --x. Examples:

    stylobate spectrum --slenderness 0.1 --damping 0.1 --motion one-sine --x angular-frequency 1 9 41
    --scales 0.1 2 40 --figure spectrum.png

    stylobate spectrum --radius 0.5 --height 5 --density 2000 --damping 0.05 --sample-record "el centro 1940"
    --x size 0.2 4 12 --x-spacing log --rocking --output rocking.nc
    """
    given, complete = Given.of(context), True
    check_outputs(given)
    saved = _saved(source)
    if not is_to_compute(saved, given):
        assert saved is not None
        found = saved
    else:
        described = read_source(source) if saved is None else _description(saved)
        kind = earthquakes.config.SpectrumConfig
        values = opt.overlay_axes(opt.overlay(described, given, kind.model_fields), given, "spectrum")
        description = kind.parse(_overlay(values, given))
        setup = description.build()

        check_axes("spectrum", setup)
        study = earthquakes.rocking_spectrum if description.spectrum.rocking else earthquakes.overturning_bands
        found, complete = computed(study, setup, given, "spectrum")
    write(found, given)
    if as_json:
        print_json(_summary(found))
    else:
        _print(found)
    end(found, given, complete=complete)


def _saved(source: Path | None) -> "xr.Dataset | None":
    if source is not None and source.suffix == STORE:
        message = (
            f"{source} is the store of a spectrum or a sweep: it goes on with the options that began it, "
            f"--output {source} and --resume; a spectrum to show is saved as .nc"
        )
        raise FileError(message)
    saved = open_saved(source)
    if saved is not None and saved.attrs["kind"] not in _KINDS:
        message = f"{source} holds a {saved.attrs['kind']}, and no spectrum"
        raise FileError(message)
    return saved


_BANDS, _ROCKING = "overturning bands", "rocking spectrum"
_KINDS = (_BANDS, _ROCKING)


def _description(saved: "xr.Dataset") -> dict[str, Any]:

    provenance, rocking = provenance_of(saved), saved.attrs["kind"] == _ROCKING
    return earthquakes.config.SpectrumConfig.of_saved(provenance, axes_of(saved), rocking=rocking).values()


def _overlay(values: Mapping[str, Any], given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the values with the options of a spectrum in its table."""
    table = values.get("spectrum", {})
    if not isinstance(table, Mapping):
        return dict(values)
    table = dict(table)
    if given["scales"] is not None:
        first, last, number = given["scales"]
        table["scales"] = {"from": first, "to": last, "number": number}
    table |= opt.overlay_spacing(table, "scales", given)
    names = {"rocking": "rocking", "width": "width", "free_tail": "tail"}
    table |= {name: given[option] for option, name in names.items() if given[option] is not None}
    kept = dict(values)
    if given["duration"] is None and given["free_tail"] is not None:
        kept.pop("duration", None)  # how long is said in one way
    if given["duration"] is not None and given["free_tail"] is None:
        table.pop("tail", None)
    return {**kept, "spectrum": table}


def _summary(found: "xr.Dataset") -> dict[str, Any]:
    rows = _bands(found) if found.attrs["kind"] == _BANDS else _peaks(found)
    told = ("width", "scale_step", "resolution")
    return {
        "kind": found.attrs["kind"],
        "cases": rows,
        **{name: found.attrs[name] for name in told if name in found.attrs},
        "computed": int(found["computed"]),
        "runs": found["outcome"].size,
        "provenance": provenance_of(found),
    }


def _cases(found: "xr.Dataset", name: str) -> list[tuple[dict[str, Any], "xr.Dataset"]]:
    """Return what tells each case from others, and what is known of it."""
    dims = [str(dim) for dim in found[name].dims]
    flat = found.stack(case=dims) if dims else found.expand_dims("case")
    cases = [flat.isel(case=place) for place in range(flat.sizes["case"])]
    names = [("motion_name" if dim == "motion" else dim, dim) for dim in dims]
    return [({dim: one[told].item() for told, dim in names}, one) for one in cases]


def _bands(found: "xr.Dataset") -> list[dict[str, Any]]:
    ends = ("band_from", "band_to", "safe_below", "safe_above", "uncertain_below", "uncertain_above")
    return [
        {
            **case,
            "frequency_parameter": one["frequency_parameter"].item(),
            "acceleration_ratio": one["acceleration_ratio"].item(),
            "bands": [{name: one[name][place].item() for name in ends} for place in range(int(one["bands"]))],
            "unknown": int(one["unknown"]),
        }
        for case, one in _cases(found, "bands")
    ]


def _peaks(found: "xr.Dataset") -> list[dict[str, Any]]:
    from stylobate.results.outcomes import outcome_label  # noqa: PLC0415

    names = ("rocking_period", "peak_tilt_ratio", "peak_rate_ratio")
    rows = []
    for case, one in _cases(found, "peak_tilt_ratio"):
        rows.append(
            {**case, **{name: one[name].item() for name in names}, "outcome": outcome_label(int(one["outcome"]))}
        )
    return rows


def _print(found: "xr.Dataset") -> None:
    if found.attrs["kind"] == _BANDS:
        _print_bands(found)
    else:
        _print_peaks(found)


def _print_bands(found: "xr.Dataset") -> None:
    rows = sorted(_bands(found), key=_least) if found["bands"].size > _ROWS else _bands(found)
    dims = [str(dim) for dim in found["bands"].dims]
    table = [
        (
            *(_written(row[dim]) for dim in dims),
            "; ".join(map(_band, row["bands"])) or "never",
            _written(_least(row) * row["acceleration_ratio"]) if row["bands"] else "",
        )
        for row in (rows[:_FIRST] if len(rows) > _ROWS else rows)
    ]
    header = (*dims, "overturns at scales", "least peak acceleration / (g tan α)")
    told = [f"{plural(len(rows), 'case')}, {model_named(found)}"]
    told += [f"the {_FIRST} that overturn first"] if len(rows) > _ROWS else []
    unknown = int(found["unknown"].sum())
    told += [f"{unknown} of {plural(found['outcome'].size, 'run')} without an answer"] if unknown else []
    print_table("; ".join([*told, found.attrs["resolution"]]), table, header)


def _least(row: Mapping[str, Any]) -> float:
    return min((float(band["band_from"]) for band in row["bands"]), default=float("inf"))


def _band(band: Mapping[str, Any]) -> str:
    sure = "?" if band["uncertain_below"] or band["uncertain_above"] else ""
    low = "" if math.isfinite(band["safe_below"]) else "below "
    high = f"to {band['band_to']:.4g}" if math.isfinite(band["safe_above"]) else "on"
    return f"{low}{band['band_from']:.4g} {high}{sure}"


def _print_peaks(found: "xr.Dataset") -> None:
    rows = _peaks(found)
    if len(rows) > _ROWS:
        rows = sorted(rows, key=lambda row: -row["peak_tilt_ratio"] if row["outcome"] != "overturned" else -1e9)[
            :_FIRST
        ]
    dims = [str(dim) for dim in found["peak_tilt_ratio"].dims]
    names = ("rocking_period", "outcome", "peak_tilt_ratio", "peak_rate_ratio")
    table = [tuple(_written(row[name]) for name in (*dims, *names)) for row in rows]
    shown = f"; the {len(rows)} that rock most" if len(rows) < found["outcome"].size else ""
    header = (*dims, "2π/p [s]", "outcome", "peak tilt / α", "peak rate of tilt / p")
    print_table(f"{plural(found['outcome'].size, 'case')}, {model_named(found)}{shown}", table, header)


def _written(value: Any) -> str:
    if isinstance(value, str):
        return value
    return f"{value:.4g}" if math.isfinite(value) else ""
