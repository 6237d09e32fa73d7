"""Conversion of a finished batch to arrays of results in SI units, one entry per run."""

import math

import numpy as np
import numpy.typing as npt

from stylobate.engine.doubt import FALLEN, in_doubt
from stylobate.engine.ensembles.batch import Batch
from stylobate.engine.ensembles.contacts import contact_arrays
from stylobate.engine.ensembles.orbit_columns import OrbitReached
from stylobate.engine.ensembles.outcomes import late_periods, outcomes
from stylobate.engine.ensembles.variables import DEMANDS, Arrays, empty
from stylobate.engine.kernel.columns import STATE, Log, Setup
from stylobate.engine.kernel.driver.events import Status
from stylobate.engine.thresholds import coarse
from stylobate.engine.tolerances import CLOSE_PASSAGE
from stylobate.errors import Outcome
from stylobate.models.contact import LEAST_FORCE

Floats = npt.NDArray[np.float64]


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
    return dict(zip(DEMANDS, (*found, np.where(borne, normal, np.nan)), strict=True))


def _turns(batch: Batch) -> Floats:
    turns = batch.log(Log.LAST_AZIMUTH) - batch.log(Log.FIRST_AZIMUTH)
    return np.where(np.isnan(turns), 0.0, turns)
