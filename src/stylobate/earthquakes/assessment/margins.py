"""Margins of one column: overturning intervals, the first slip, and the runs under the governing record."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from stylobate.base_motions import BaseMotion, OneOf
from stylobate.column import Column
from stylobate.earthquakes.assessment.inputs import CENTRAL, NO_VERTICAL, Inputs, Parts
from stylobate.earthquakes.fragility.displacement_limits import Response
from stylobate.earthquakes.fragility.observations import LIMIT_STATE, NOT_KNOWN, limit_states
from stylobate.earthquakes.incremental import tilt_ratios, without_vertical
from stylobate.earthquakes.spectrum_study import overturning_intervals
from stylobate.earthquakes.study_inputs import tail_of
from stylobate.engine import simulate_ensemble
from stylobate.errors import Outcome
from stylobate.models import Model
from stylobate.progress import Report
from stylobate.results.outcomes import outcome_attributes
from stylobate.studies.maps.uncertainty_exponent import overturned_or_not
from stylobate.studies.sweeps import Executor
from stylobate.studies.sweeps.designs import Floats

_FINE_SCALES = 2000
"""Scales over the range of the scan that are run below the smallest overturning scale."""

_INTERVAL = ("interval_from", "interval_to", "safe_below", "safe_above")
_FLAGS = ("open_below", "open_above", "undecided_below", "undecided_above")
_STRETCH = ("undecided_from", "undecided_to")
_COUNTS = ("intervals", "unknown", "decided_to")
_RUNS = ("outcome", "peak_tilt", "friction_demand")


def margins_of(inputs: Inputs, column: str, parts: Parts, *, contact: bool, executor: Executor | None) -> xr.Dataset:
    """Compute the overturning intervals of a column.

    Returns
    -------
    xarray.Dataset
        Over `case` (the levels of dissipation; the central level without the vertical component; the levels with the
        other contact law) and `record`:
        `least_overturning`, the smallest overturning scale, NaN if none; `largest_below`, the largest surviving scale
        below it, NaN if none; `least_lasting`, the smallest scale at which an interval begins that is wider than the
        uncertainty of its ends; `intervals`, their number; `unknown`, the number of undecided runs of the scan;
        `decided_to`, the largest scale up to which every run was decided; `stands_again`, whether the column survived a
        scale above an overturning one; `standing_slip`, the smallest scale at which it slides before it rocks, NaN if
        it rocks first. Over `interval` and `stretch` all variables of `overturning_intervals`. Over `margin_scale` too:
        `outcome`, `tilt_ratio`; for the central case over `limit_state`: `reached`. The contact demand, NaN without
        `contact`: over `margin_scale` too `friction_demand`, standing and moving; `friction_to_margin`, the largest
        demand below the smallest overturning scale, or at any scale if there is none; `least_slipping`, the smallest
        scale that needs more than the stated friction, NaN if none does. Over `scale` too: `band_share`, the share of
        overturning scales among the 41 within 10 % of a stated one; `in_band`, whether any scale there overturned it,
        also one between the 41.
    """
    cases = list(inputs.cases)
    found = of_one_width([_intervals(inputs, column, case, parts, contact, executor) for case in cases])
    joined: xr.Dataset = xr.concat(found, dim=xr.Variable("case", cases), data_vars="all", join="override")
    body = inputs.columns[column][CENTRAL].column
    scanned = joined[["outcome", "peak_tilt"]].sel(case=CENTRAL)
    nearby = [one for one in inputs.limits.get(column, ()) if one.kind is Response.NEIGHBOURS]
    exceeded = {one.name: one.of_tilt(scanned["peak_tilt"], [body], "column") for one in nearby}
    reached = limit_states(scanned, slenderness=body.slenderness, exceeded=exceeded)
    if inputs.limit_names:  # slip is not known without slip, nor are the limits of other columns
        own = [str(name) for name in reached[LIMIT_STATE].to_numpy() if name not in exceeded]
        reached = reached.reindex({LIMIT_STATE: [*own, *inputs.limit_names]}, fill_value=np.int8(NOT_KNOWN))
    reached = reached.transpose("record", LIMIT_STATE, "margin_scale")
    labelled = joined.drop_vars("peak_tilt").assign(
        tilt_ratio=tilt_ratios(joined, body.slenderness),
        reached=reached.drop_vars("case"),
        standing_slip=standing_slip(inputs, column, cases),
    )
    labelled = labelled.assign(band_share=_band_shares(inputs, labelled), in_band=_in_band(inputs, labelled))
    return labelled.assign(demands_to_margin(labelled, inputs.friction[column]))


def _band_shares(inputs: Inputs, margins: xr.Dataset) -> xr.DataArray:
    """Return the fraction of the decided scales within 10 % of each stated scale that overturn the column."""
    state = margins["outcome"].copy(data=overturned_or_not(margins))
    near = [state.isel(margin_scale=inputs.around(scale)) for scale in inputs.scales.tolist()]
    shares = [((one == 1).sum("margin_scale") / (one >= 0).sum("margin_scale")) for one in near]
    about = {"units": "1", "long_name": "share of overturning scales within 10 % of the stated scale"}
    joined: xr.DataArray = xr.concat(shares, dim=xr.Variable("scale", inputs.scales))
    return joined.assign_attrs(about)


def _in_band(inputs: Inputs, margins: xr.Dataset) -> xr.DataArray:
    """Return whether an overturning interval lies or begins within 10 % of each stated scale, as 0 or 1."""
    ends = [inputs.margin_scales[inputs.around(scale)[[0, -1]]] for scale in inputs.scales.tolist()]
    low, high = (xr.DataArray(one, coords={"scale": inputs.scales}) for one in np.array(ends).T)
    overlaps = (margins["interval_from"] <= high) & (margins["interval_to"] >= low)
    found = overlaps.any("interval").astype(np.int8)
    return found.assign_attrs(long_name="whether a scale within 10 % of the stated scale overturned it")


def of_one_width(margins: list[xr.Dataset]) -> list[xr.Dataset]:
    """Pad margins with NaN to equal numbers of intervals and undecided stretches."""
    for dim in ("interval", "stretch"):
        widest = max(one.sizes[dim] for one in margins)
        margins = [one.pad({dim: (0, widest - one.sizes[dim])}) if one.sizes[dim] < widest else one for one in margins]
    return margins


def states_at_scales(margins: xr.Dataset, scales: xr.DataArray) -> xr.DataArray:
    """Return the states of the scan at the stated scales: 1 overturned, 0 not, negative undecided."""
    state = margins["outcome"].copy(data=overturned_or_not(margins))
    stated = [state.sel(margin_scale=scale, method="nearest").drop_vars("margin_scale") for scale in scales.to_numpy()]
    joined: xr.DataArray = xr.concat(stated, dim=scales)
    return joined


def demands_to_margin(margins: xr.Dataset, stated: float) -> dict[str, xr.DataArray]:
    """Compute the friction needed up to the margin, and the smallest scale at which it exceeds the `stated` one."""
    need, scale = margins["friction_demand"], margins["margin_scale"]
    least = margins["least_overturning"]
    one = {"units": "1"}
    first = scale.where(need > stated).min("margin_scale")
    root = margins["standing_slip"].where(margins["standing_slip"] <= scale[-1])
    first = first.where(~(root < first.fillna(np.inf)), root)
    return {
        "friction_to_margin": need.where(~(scale >= least))
        .max("margin_scale")
        .assign_attrs(**one, long_name="largest friction needed below the smallest overturning scale"),
        "least_slipping": first.assign_attrs(
            **one, long_name="smallest scale that needs more than the stated friction"
        ),
    }


def margin_runs(inputs: Inputs) -> int:
    """Return the minimum number of runs for the margins of one column."""
    return len(inputs.cases) * _scan_runs(inputs)


def _scan_runs(inputs: Inputs) -> int:
    return len(inputs.records) * inputs.margin_scales.size


def _intervals(
    inputs: Inputs, column: str, case: str, parts: Parts, contact: bool, executor: Executor | None
) -> xr.Dataset:
    model = inputs.model_of(column, case)
    motions = [without_vertical(one) if case == NO_VERTICAL else one for one in inputs.records.values()]

    def compute(progress: Report) -> xr.Dataset:
        found = _found(inputs, model, motions, contact, executor, progress)
        return _table_of_margins(found, list(inputs.records), inputs.width)

    identity = {
        **inputs.identity(column, model),
        "vertical": case != NO_VERTICAL,
        "scales": inputs.margin_scales.tolist(),
        "width": inputs.width,
        "fine scales": _FINE_SCALES,
        "contact": contact,
    }
    return parts.get(f"{column}: margins, {case}", _scan_runs(inputs), identity, compute)


def _found(
    inputs: Inputs,
    model: Model,
    motions: list[BaseMotion],
    contact: bool,
    executor: Executor | None,
    progress: Report,
) -> xr.Dataset:
    options = inputs.options.copy()
    options["demands"] = contact
    return overturning_intervals(
        model,
        OneOf(motions=tuple(motions)),
        over={"motion": np.arange(len(motions))},
        scales=inputs.margin_scales,
        width=inputs.width,
        fine_scales=_FINE_SCALES,
        tail=tail_of(model.column, inputs.tail),
        executor=executor,
        progress=progress,
        **options,
    )


def _table_of_margins(found: xr.Dataset, names: list[str], width: float) -> xr.Dataset:
    plain = found.rename(motion="record", scale="margin_scale")
    plain = plain.drop_vars([name for name in plain.coords if name != "margin_scale"]).assign_coords(record=names)
    demand = plain.get("peak_friction_demand", xr.full_like(plain["peak_tilt"], np.nan))
    about = {"units": "1", "long_name": "peak friction force over normal force"}
    plain = plain.assign(friction_demand=demand.assign_attrs(about))
    kept = plain[[*_INTERVAL, *_FLAGS, *_STRETCH, *_COUNTS, *_RUNS]].transpose("record", ...)
    flags = {name: kept[name].astype(float) for name in (*_FLAGS, "intervals", "unknown")}
    first = kept.isel(interval=0)
    lasting = kept["interval_to"] > kept["interval_from"] * (1.0 + width)
    stood = kept["outcome"].copy(data=overturned_or_not(kept) == 0)
    higher = (stood & (kept["margin_scale"] > first["interval_from"])).any("margin_scale")
    again = kept["safe_above"].notnull().any("interval") | higher
    return (
        kept.assign(flags)
        .assign(
            least_overturning=first["interval_from"].assign_attrs(units="1", long_name="smallest overturning scale"),
            least_lasting=kept["interval_from"]
            .where(lasting)
            .min("interval")
            .assign_attrs(units="1", long_name="smallest scale at which an interval wider than its edges begins"),
            largest_below=first["safe_below"].assign_attrs(
                units="1", long_name="largest surviving scale below the smallest overturning scale"
            ),
            stands_again=again.astype(float).assign_attrs(long_name="survived a scale above an overturning scale"),
        )
        .assign_attrs(resolution=found.attrs["resolution"], provenance=found.attrs["provenance"])
    )


# Samples in the shortest period of a motion that is not linear between its breaks: sup |a| is 5e-4 low at most.
_SAMPLES = 100


def least_slip_scale(motion: BaseMotion, friction: float, column: Column) -> float:
    """Compute the smallest scale of `motion` at which a standing `column` exceeds the `friction`; infinite if none.

    The smallest scale s with s |a_h| > μ (g + s a_z) is s = μ g / max(|a_h| − μ a_z).
    """
    horizontal, vertical = _accelerations(motion)
    strongest = float((horizontal - friction * vertical).max())
    return friction * column.gravity / strongest if strongest > 0.0 else math.inf


def _accelerations(motion: BaseMotion) -> tuple[Floats, Floats]:
    """Return |a_h| and a_z [m/s²] at the breaks of a motion; densely if it is not linear between them."""
    end = motion.duration
    times = np.unique([0.0, *(time for time in motion.breaks if 0.0 < time < end), end])
    if motion.degree is None or motion.degree > 1:
        count = math.ceil(_SAMPLES * (1.0 + end * motion.highest_frequency / (2.0 * math.pi)))
        times = np.union1d(times, np.linspace(0.0, end, count))
    x, y, z = motion.acceleration(times).T
    return np.hypot(x, y), z


def standing_slip(inputs: Inputs, column: str, cases: list[str]) -> xr.DataArray:
    """Compute `least_slip_scale` of one column over `case` and `record`; NaN if it rocks before it slides."""
    body, friction = inputs.columns[column][CENTRAL].column, inputs.friction[column]
    slides = column in inputs.sliding_first
    values = [
        [
            least_slip_scale(without_vertical(one) if case == NO_VERTICAL else one, friction, body)
            if slides
            else math.nan
            for one in inputs.records.values()
        ]
        for case in cases
    ]
    about = {"units": "1", "long_name": "smallest scale at which it slides before it rocks"}
    return xr.DataArray(values, dims=("case", "record"), attrs=about)


_STATED, _STANDS, _OVERTURNS = "stated", "stands", "overturns"
"""The runs under a governing record: at the stated scale nearest to 1; the last survival below the margin, and the
first overturning."""

_HISTORY_SAMPLES = 2001
_OF_RUNS = ("strobes", "demands", "samples")
_DEMANDS = {
    "peak_friction_demand": "friction_demand",
    "peak_pivoting_demand": "pivoting_demand",
    "minimum_normal_force": "minimum_normal_force",
}


def governing_record(verdicts: xr.Dataset, margins: xr.Dataset, scale: int) -> str:
    """Return the name of the governing record of one column.

    A record that overturns the column at the stated scale precedes a record that does not; a record that overturns it
    in the central case precedes a record that does so in another case. Among equal records the smallest overturning
    scale decides (central case, then any case), then the largest peak tilt (stated scale, then any scale).

    Parameters
    ----------
    verdicts, margins
        Verdicts and margins of one column.
    scale
        Index of the stated scale.
    """
    stated = verdicts.isel(scale=scale)
    fallen = stated["overturned"] == 1
    central = {"dissipation": CENTRAL, "vertical": "with"}
    least = margins["least_overturning"].transpose("case", "record")
    tilts = margins["tilt_ratio"].sel(case=CENTRAL).transpose("record", "margin_scale")
    keys = [
        -fallen.sel(central).to_numpy().astype(int),
        -fallen.any(("dissipation", "vertical")).to_numpy().astype(int),
        least.sel(case=CENTRAL).fillna(np.inf).to_numpy(),
        least.min("case").fillna(np.inf).to_numpy(),
        -stated["tilt_ratio"].sel(central).fillna(0.0).to_numpy(),
        -tilts.where(np.isfinite(tilts)).max("margin_scale").fillna(0.0).to_numpy(),
    ]
    # Records are sorted by name, so the choice among equal records does not depend on their order in the input.
    return str(verdicts["record"].to_numpy()[np.lexsort(keys[::-1])[0]])


@dataclass(frozen=True, slots=True)
class _Shown:
    """A run to show: its name, scale and case; the scale is NaN if there is no such run."""

    run: str
    scale: float
    case: str


def _shown(inputs: Inputs, record: str, margins: xr.Dataset) -> list[_Shown]:
    """List the runs under a governing record; the margin is that of the central case, else the smallest of any case."""
    own = margins.sel(record=record)
    least = own["least_overturning"]
    case = CENTRAL
    if not np.isfinite(float(least.sel(case=CENTRAL))) and np.isfinite(least).any():
        case = str(least["case"].to_numpy()[int(least.argmin("case"))])
    own = own.sel(case=case)
    overturns, stands = float(own["least_overturning"]), float(own["largest_below"])
    if math.isnan(overturns):  # show the largest decided scale
        tilt = own["tilt_ratio"].to_numpy()
        known = own["margin_scale"].to_numpy()[np.isfinite(tilt)]
        stands = float(known[-1]) if known.size else math.nan
    return [
        _Shown(_STATED, float(inputs.scales[inputs.as_recorded]), CENTRAL),
        _Shown(_STANDS, stands, case),
        _Shown(_OVERTURNS, overturns, case),
    ]


def histories_of(
    inputs: Inputs, column: str, record: str, margins: xr.Dataset, parts: Parts, *, contact: bool
) -> xr.Dataset:
    """Compute the runs of a column under its governing record: at the stated scale, and beside the margin.

    Returns
    -------
    xarray.Dataset
        Over `run`: "stated", at the stated scale nearest to 1 and the central dissipation; "overturns", at the smallest
        overturning scale of the central case, or of all cases if the central case has none; "stands", the last
        survival below it. If no run overturned the column, "stands" is at the largest decided scale.
        Each run has its `scale`, NaN if there is no such run, and its `case`. Over `sample` too: `time` [s], NaN beyond
        the end of the run; `tilt_x`, `tilt_y` and `amplitude` in units of α_c; `base_x`, `base_y` [m/s²]. Over `run`
        only: `peak_tilt_ratio`, its `azimuth` [rad] and `time_of_peak_tilt` [s]; `overturned`; `outcome`;
        `friction_demand`, `pivoting_demand`, `minimum_normal_force`, NaN without `contact`.
    """
    shown = _shown(inputs, record, margins)
    known = [one for one in shown if math.isfinite(one.scale)]

    def compute(progress: Report) -> xr.Dataset:
        found = []
        for place, one in enumerate(known):
            progress(place, len(known))
            found.append(_history(inputs, column, record, one, contact=contact))
        return xr.concat(found, dim="run", data_vars="all")

    identity = {
        **inputs.with_records([record]).identity(column),
        "runs": [(one.scale, one.case) for one in known],
        "contact": contact,
    }
    found = parts.get(f"{column}: histories under {record}", len(known), identity, compute)
    return (
        found.assign_coords(run=[one.run for one in known])
        .reindex(run=[one.run for one in shown])
        .assign(
            scale=("run", [one.scale for one in shown], {"units": "1", "long_name": "scale factor of the record"}),
            case=("run", [one.case for one in shown]),
        )
    )


def _history(inputs: Inputs, column: str, record: str, shown: _Shown, *, contact: bool) -> xr.Dataset:
    model = inputs.model_of(column, shown.case)
    recorded = inputs.records[record]
    motion = (without_vertical(recorded) if shown.case == NO_VERTICAL else recorded).scaled(shown.scale)
    options: dict[str, Any] = {name: value for name, value in inputs.options.items() if name not in _OF_RUNS}
    duration = motion.duration + tail_of(model.column, inputs.tail)
    runs = simulate_ensemble(model, motion, duration=[duration], samples=_HISTORY_SAMPLES, demands=contact, **options)
    return _table_of_histories(runs.isel(run=0), motion, model.column.tipping_angle)


def _table_of_histories(run: xr.Dataset, motion: BaseMotion, alpha: float) -> xr.Dataset:
    times, tilt = run["sample_time"].to_numpy(), run["sampled_tilt"].to_numpy() / alpha
    size = np.hypot(tilt[:, 0], tilt[:, 1])
    largest = int(np.nanargmax(size))
    base = motion.acceleration(np.nan_to_num(times)) + 0.0 * times[:, np.newaxis]
    fallen = run["outcome"].item() == Outcome.OVERTURNED
    about = {"units": "1", "long_name": "tilt / α_c"}
    curves = {
        "time": (times, {"units": "s", "long_name": "time"}),
        "tilt_x": (tilt[:, 0], about),
        "tilt_y": (tilt[:, 1], about),
        "amplitude": (size, about),
        "base_x": (base[:, 0], {"units": "m s-2", "long_name": "base acceleration along x"}),
        "base_y": (base[:, 1], {"units": "m s-2", "long_name": "base acceleration along y"}),
    }
    numbers = {
        "peak_tilt_ratio": np.inf if fallen else float(run["peak_tilt"]) / alpha,
        "azimuth": float(run["direction"]) if fallen else math.atan2(tilt[largest, 1], tilt[largest, 0]),
        "time_of_peak_tilt": float(run["time_of_peak_tilt"]),
        "overturned": float(fallen),
        **{own: float(run[name]) if name in run else math.nan for name, own in _DEMANDS.items()},
    }
    return xr.Dataset(
        {
            **{name: ("sample", values, attributes) for name, (values, attributes) in curves.items()},
            **{name: ((), value) for name, value in numbers.items()},
            "outcome": ((), float(run["outcome"]), outcome_attributes()),
        }
    )
