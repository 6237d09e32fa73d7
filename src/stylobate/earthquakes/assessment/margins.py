"""Margins of one column: all overturning intervals of the scale factor, by record and case."""

import numpy as np
import xarray as xr

from stylobate.base_motions import BaseMotion, OneOf
from stylobate.earthquakes.assessment.inputs import CENTRAL, NO_VERTICAL, Inputs
from stylobate.earthquakes.assessment.parts import Parts
from stylobate.earthquakes.assessment.slip import standing_slip
from stylobate.earthquakes.following import tail_of
from stylobate.earthquakes.fragility import limit_states
from stylobate.earthquakes.incremental import tilt_ratios, without_vertical
from stylobate.earthquakes.spectra import overturning_intervals
from stylobate.models import Model
from stylobate.progress import Report
from stylobate.studies.maps.uncertainty_exponent import overturned_or_not
from stylobate.studies.sweeps import Executor

FINE_SCALES = 2000
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
    reached = limit_states(scanned, slenderness=body.slenderness).transpose("record", "limit_state", "margin_scale")
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
        "fine scales": FINE_SCALES,
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
        fine_scales=FINE_SCALES,
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
