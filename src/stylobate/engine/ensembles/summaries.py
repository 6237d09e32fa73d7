"""Conversion of a finished batch to arrays of results in SI units, one entry per run."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from stylobate.engine.doubt import FALLEN, in_doubt
from stylobate.engine.ensembles.batch import Batch
from stylobate.engine.ensembles.contacts import CONTACT_KINDS, contact_arrays
from stylobate.engine.ensembles.orbit_columns import OrbitReached
from stylobate.engine.ensembles.outcomes import late_periods, outcomes
from stylobate.engine.kernel.columns import STATE, Log, Setup, Status
from stylobate.engine.memory import require_memory
from stylobate.engine.thresholds import coarse
from stylobate.engine.tolerances import CLOSE_PASSAGE
from stylobate.errors import Outcome
from stylobate.models import Model
from stylobate.models.contact import LEAST_FORCE
from stylobate.results.outcomes import NOT_COMPUTED, NUMERICALLY_UNCERTAIN, outcome_attributes
from stylobate.run_arguments import Options

Floats = npt.NDArray[np.float64]
Arrays = dict[str, npt.NDArray[Any]]


@dataclass(frozen=True, slots=True)
class Quantity:
    """Variable of the results: type, dimensions besides those of the runs, attributes, value if not computed."""

    dtype: type
    dims: tuple[str, ...]
    attributes: Mapping[str, Any]
    none: float = 0


def _numbers(long_name: str, units: str, *dims: str) -> Quantity:
    return Quantity(np.float64, dims, {"long_name": long_name, "units": units}, np.nan)


_CONTACTS = (
    *(
        "strobe_footprint",
        "strobe_twist",
        "end_footprint",
        "end_twist",
        "end_contact",
        "mean_velocity",
        "mean_twist_rate",
        "impacts",
        "slips",
    ),
    *(f"time_{kind}" for kind in CONTACT_KINDS),
)


QUANTITIES: Mapping[str, Quantity] = {
    "outcome": Quantity(np.int8, (), outcome_attributes(), NOT_COMPUTED),
    "decided_at": _numbers("time at which the outcome was decided", "s"),
    "end_time": _numbers("end of the run", "s"),
    "uncertain": Quantity(np.bool_, (), {"long_name": NUMERICALLY_UNCERTAIN}),
    "in_doubt": Quantity(np.bool_, (), {"long_name": "finer thresholds or another tolerance could change the outcome"}),
    "planar": Quantity(np.bool_, (), {"long_name": "moved in one vertical plane"}),
    "end_tilt": _numbers("tilt vector at the end", "rad", "axis"),
    "end_tilt_rate": _numbers("rate of the tilt vector at the end", "rad s-1", "axis"),
    "direction": _numbers("azimuth in which it overturned", "rad"),
    "peak_tilt": _numbers("peak tilt", "rad"),
    "time_of_peak_tilt": _numbers("time of the peak tilt", "s"),
    "minimum_tilt": _numbers("minimum tilt while it moves", "rad"),
    "turns": _numbers("turns of the contact point", "1"),
    "mean_tilt": _numbers("mean tilt over the last periods", "rad"),
    "phase": _numbers("phase of the tilt vector relative to the base acceleration, over the last periods", "rad"),
    "mean_rolling_rate": _numbers("mean rolling rate over the last periods", "rad s-1"),
    "repetition": _numbers("change from period to period, over the last periods", "1"),
    "repeats_after": Quantity(
        np.int8, (), {"long_name": "periods of the base motion after which the motion repeats; 0 if it does not"}
    ),
    "end_spin": _numbers("angular velocity about the axis at the end", "rad s-1"),
    "peak_friction_demand": _numbers("peak friction force over normal force", "1"),
    "peak_pivoting_demand": _numbers("peak moment about the vertical over normal force and radius", "1"),
    "minimum_normal_force": _numbers("minimum normal force over weight", "1"),
    "end_footprint": _numbers("centre of the footprint circle at the end", "m", "axis"),
    "end_twist": _numbers("angle of turn about the axis at the end", "rad"),
    "end_contact": Quantity(
        np.int8,
        (),
        {
            "long_name": "kind of contact at the end: "
            + ", ".join(f"{k} {kind}" for k, kind in enumerate(CONTACT_KINDS))
            + ", 5 jammed"
        },
    ),
    **{f"time_{kind}": _numbers(f"time spent {kind}", "s") for kind in CONTACT_KINDS},
    "mean_velocity": _numbers("mean velocity of the footprint over the last periods", "m s-1", "axis"),
    "mean_twist_rate": _numbers("mean rate of the twist over the last periods", "rad s-1"),
    "impacts": Quantity(np.int32, (), {"long_name": "landings and face impacts"}),
    "slips": Quantity(np.int32, (), {"long_name": "times that a sticking contact began to slip"}),
    "uplifts": Quantity(np.int32, (), {"long_name": "uplifts from rest"}),
    "steps": Quantity(np.int32, (), {"long_name": "integration steps"}),
    "strobe_tilt": _numbers("tilt vector at phase zero of the base motion", "rad", "strobe", "axis"),
    "strobe_tilt_rate": _numbers("its rate at phase zero of the base motion", "rad s-1", "strobe", "axis"),
    "strobe_footprint": _numbers("footprint at phase zero of the base motion", "m", "strobe", "axis"),
    "strobe_twist": _numbers("angle of turn about the axis at phase zero of the base motion", "rad", "strobe"),
    "sample_time": _numbers("time", "s", "sample"),
    "sampled_tilt": _numbers("tilt vector", "rad", "sample", "axis"),
    "sampled_tilt_rate": _numbers("rate of the tilt vector", "rad s-1", "sample", "axis"),
}


_DEMANDS = ("peak_friction_demand", "peak_pivoting_demand", "minimum_normal_force")


def empty(model: Model, options: Options, count: int) -> Arrays:
    """Return arrays for the results of `count` runs, filled with the values for runs that are not computed."""
    sizes = {"axis": 2, "strobe": options["strobes"], "sample": options["samples"] or 0}
    left_out = {*(() if options["demands"] else _DEMANDS), *(("end_spin",) if model.spin_state is None else ())}
    left_out |= {*(() if model.switches else _CONTACTS)}
    shapes = {
        name: tuple(sizes[dim] for dim in quantity.dims)
        for name, quantity in QUANTITIES.items()
        if name not in left_out
    }
    shapes = {name: shape for name, shape in shapes.items() if 0 not in shape}
    bytes_of_a_run = sum(np.dtype(QUANTITIES[name].dtype).itemsize * math.prod(shape) for name, shape in shapes.items())
    require_memory(bytes_of_a_run * count, count, "Take fewer runs, samples or strobes")
    return {
        name: np.full((count, *shape), QUANTITIES[name].none, QUANTITIES[name].dtype) for name, shape in shapes.items()
    }


def summaries(batch: Batch) -> Arrays:
    """Return the results of the runs of `batch`; runs that have not ended have the values of `empty`."""
    arrays = empty(batch.plan.model, batch.plan.options, len(batch.table))
    summarize_into(arrays, batch)
    return arrays


def summarize_into(arrays: Arrays, batch: Batch) -> None:
    """Write the results of the ended runs of `batch` into `arrays`, which have a row for each run."""
    ended = batch.log(Log.STATUS) != Status.WAITING
    every_run = bool(ended.all())
    for name, values in _all(batch).items():
        if every_run:
            arrays[name][:] = values
        else:
            arrays[name][ended] = values[ended]


def _all(batch: Batch) -> Arrays:
    scale = batch.models.time_scale
    tilt, rate = _tilt_vectors(batch)
    late = late_periods(batch)
    outcome = outcomes(batch, late)
    overturned = outcome == Outcome.OVERTURNED
    passage = batch.log(Log.CLOSEST_PASSAGE)
    touched = batch.log(Log.REACHED_VERTICAL) > 0.0
    start = np.hypot(*batch.plan.model.tilt_of(*batch.models.states.T, *batch.models.parameters.T)[:2])
    is_coarse = coarse(
        batch.rest_energy,
        batch.motions.mean_frequency,
        batch.motions.largest,
        batch.motions.minimum_vertical,
        batch.models.capacity,
    )
    uncertain = passage < CLOSE_PASSAGE * batch.models.slenderness
    uncertain |= (batch.log(Log.RELEASED_FROM_REST) > 0.0) & is_coarse
    uncertain |= outcome == Outcome.FAILED
    arrays: Arrays = {
        "outcome": outcome,
        "decided_at": batch.log(Log.DECIDED) * scale,
        "end_time": batch.log(Log.TIME) * scale,
        "uncertain": uncertain,
        "in_doubt": _in_doubt(batch, outcome),
        "planar": batch.log(Log.THREE_DIMENSIONAL) == 0.0,
        "end_tilt": tilt,
        "end_tilt_rate": rate / scale[:, np.newaxis],
        "direction": np.where(overturned, np.arctan2(tilt[:, 1], tilt[:, 0]), np.nan),
        "peak_tilt": batch.log(Log.PEAK_TILT),
        "time_of_peak_tilt": batch.log(Log.PEAK_AT) * scale,
        "minimum_tilt": np.where(
            touched, 0.0, np.minimum.reduce([start, batch.log(Log.MINIMUM_TILT), np.hypot(*tilt.T)])
        ),
        "turns": _turns(batch),
        "mean_tilt": late.mean_tilt,
        "phase": late.phase,
        "mean_rolling_rate": 2.0 * math.pi * late.turned / (late.span * scale),
        "repetition": late.repetition,
        "repeats_after": late.repeats_after,
        "uplifts": batch.log(Log.RELEASES),
        "steps": batch.log(Log.STEPS),
    }
    if batch.plan.options["demands"]:
        arrays |= _demands(batch)
    if batch.plan.model.switches:
        arrays |= contact_arrays(batch, late.span)
    index = batch.plan.model.spin_state
    if index is not None:
        spin = np.where(batch.planar | (batch.log(Log.STANDS) > 0.0), 0.0, batch.table[:, STATE + index])
        arrays["end_spin"] = spin / scale
    for strobes, names in (
        (True, ("strobe_tilt", "strobe_tilt_rate")),
        (False, ("sampled_tilt", "sampled_tilt_rate")),
    ):
        notes = batch.notes(strobes=strobes)
        if notes.shape[1]:
            arrays[names[0]] = notes[..., :2]
            arrays[names[1]] = notes[..., 2:4] / scale[:, np.newaxis, np.newaxis]
        if notes.shape[1] and not strobes:
            arrays["sample_time"] = notes[..., 4] * scale[:, np.newaxis]
    if batch.plan.model.switches and batch.plan.options["strobes"]:
        places = batch.places
        arrays["strobe_footprint"] = places[..., :2] * batch.models.length[:, np.newaxis, np.newaxis]
        arrays["strobe_twist"] = places[..., 2]
    reached = batch.converged
    return arrays if reached is None else arrays | _orbit_results(batch, arrays, reached)


def _orbit_results(batch: Batch, arrays: Arrays, reached: OrbitReached) -> Arrays:
    """Return last-period measures and later stroboscopic samples of the known orbits that runs have converged to."""
    runs, scale = reached.runs, batch.models.time_scale
    period = batch.motions.period[runs] * scale[runs]
    names = ("mean_tilt", "mean_rolling_rate", "repeats_after", "strobe_tilt", "strobe_tilt_rate")
    own = {name: arrays[name].copy() for name in names if name in arrays}
    own["mean_tilt"][runs] = reached.mean_tilt
    own["repeats_after"][runs] = 1
    own["mean_rolling_rate"][runs] = 2.0 * math.pi * reached.turns / period
    if "strobe_tilt" in own:
        place = np.arange(own["strobe_tilt"].shape[1])
        to_come = place >= batch.log(Log.NEXT_STROBE)[runs, np.newaxis]
        for name, vector in (("strobe_tilt", reached.tilt), ("strobe_tilt_rate", reached.tilt_rate)):
            own[name][runs] = np.where(to_come[..., np.newaxis], vector[:, np.newaxis], own[name][runs])
    return own


def fallen(outcomes: npt.NDArray[np.int8]) -> npt.NDArray[np.bool_]:
    """Return which outcome codes mean that the column overturned or reached the tilt limit."""
    return np.asarray(np.logical_or.reduce([outcomes == code for code in FALLEN]))


def _in_doubt(batch: Batch, outcome: npt.NDArray[np.int8]) -> npt.NDArray[np.bool_]:
    doubtful = in_doubt(
        overturned=fallen(outcome),
        decided=batch.log(Log.DECIDED),
        peak_tilt=batch.log(Log.PEAK_TILT),
        released_again=batch.log(Log.RELEASED_FROM_REST) > 0.0,
        widest_loss=batch.log(Log.WIDEST_LOSS),
        passage_tilt=batch.table[:, Setup.PASSAGE_TILT],
        slenderness=batch.models.slenderness,
    )
    return np.asarray(doubtful & (outcome != Outcome.FAILED))


def _tilt_vectors(batch: Batch) -> tuple[Floats, Floats]:
    """Return tilt vectors [rad] and their rates in the time of the models, shape (n, 2)."""
    states = batch.table[:, STATE : STATE + len(batch.plan.model.state_names)].T
    leans = np.stack(batch.plan.model.tilt_of(*states, *batch.models.parameters.T), axis=-1)
    if batch.planar.any():
        line = batch.table[:, [Setup.LINE_X, Setup.LINE_Y]]
        plane = np.concatenate([states[0][:, np.newaxis] * line, states[1][:, np.newaxis] * line], axis=1)
        leans = np.where(batch.planar[:, np.newaxis], plane, leans)
    leans[batch.log(Log.STANDS) > 0.0] = 0.0
    return leans[:, :2], leans[:, 2:]


def _demands(batch: Batch) -> Arrays:
    """Return the extremes of the contact demand, moving or standing; NaN for runs without either."""
    normal = batch.log(Log.NORMAL)
    borne, lifts = np.isfinite(normal), normal <= LEAST_FORCE
    found = [batch.log(column) for column in (Log.FRICTION, Log.PIVOTING)]
    found = [np.where(borne, np.where(lifts & (load > 0.0), np.inf, load), np.nan) for load in found]
    return dict(zip(_DEMANDS, (*found, np.where(borne, normal, np.nan)), strict=True))


def _turns(batch: Batch) -> Floats:
    turns = batch.log(Log.LAST_AZIMUTH) - batch.log(Log.FIRST_AZIMUTH)
    return np.where(np.isnan(turns), 0.0, turns)
