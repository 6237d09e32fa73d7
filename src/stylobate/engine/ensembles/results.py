"""Results of a batch: measures of the last periods, outcomes, and arrays in SI units, one entry per run."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from stylobate.engine.ensembles.batch import Batch, OrbitReached
from stylobate.engine.ensembles.late import LATE_COLUMNS, Ground, Late, late_program
from stylobate.engine.ensembles.runs import CONTACT_KINDS, DEMANDS, TIMES_OF_CONTACTS, Arrays, empty
from stylobate.engine.forcing import coarse
from stylobate.engine.kernel.columns import SLACK, STATE, Change, Log, Setup
from stylobate.engine.kernel.driver.events import RunStatus
from stylobate.engine.tolerances import CLOSE_PASSAGE
from stylobate.engine.verdict import (
    FALLEN,
    energy_over_balance,
    has_ended,
    in_doubt,
    numbers_of_rules,
    outcome_on,
)
from stylobate.errors import Outcome
from stylobate.models.contact import LEAST_FORCE

Floats = npt.NDArray[np.float64]


def results_of(batch: Batch) -> Arrays:
    """Return the results of the runs of `batch`; runs that have not ended have the values of `empty`."""
    arrays = empty(batch.plan.model, batch.plan.options, len(batch.table))
    write_results(arrays, batch)
    return arrays


def write_results(arrays: Arrays, batch: Batch) -> None:
    """Write the results of the ended runs of `batch` into `arrays`, which have a row for each run."""
    ended = batch.log(Log.STATUS) != RunStatus.WAITING
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
            touched, 0.0, np.minimum.reduce([batch.first_tilt, batch.log(Log.MINIMUM_TILT), np.hypot(*tilt.T)])
        ),
        "turns": _turns(batch),
        "mean_tilt": late[:, Late.MEAN_TILT],
        "phase": _phase(batch, late),
        "mean_rolling_rate": 2.0 * math.pi * late[:, Late.TURNED] / (late[:, Late.SPAN] * scale),
        "repetition": late[:, Late.RETURNS],
        "repeats_after": late[:, Late.REPEATS_AFTER].astype(np.int8),
        "uplifts": batch.log(Log.RELEASES),
        "steps": batch.log(Log.STEPS),
    }
    if batch.plan.options["demands"]:
        arrays |= _demands(batch)
    if batch.plan.model.switches:
        arrays |= contact_arrays(batch, late[:, Late.SPAN])
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


_OTHERS = -1
_OUTCOME_OF_STATUS = np.array([_OTHERS if one.outcome is None else one.outcome for one in RunStatus], dtype=np.int8)
"""Outcomes of runs that ended in the kernel; the last periods decide the other outcomes."""

_OUTCOME_OF_GROUND = np.array([outcome_on(kind) for kind in Ground], dtype=np.int8)


def late_periods(batch: Batch) -> Floats:
    """Return the measures of the last periods of each run: a row with the columns of `Late`."""
    out = np.empty((len(batch.table), LATE_COLUMNS))
    numbers, first = np.array(numbers_of_rules(batch.plan.rules), dtype=float), np.array([float(batch.looks_at)])
    late_program()(batch.table, batch.planar.astype(float), numbers, first, out)
    return out


def _phase(batch: Batch, late: Floats) -> Floats:
    """Return the phase of the tilt vector relative to the base acceleration, in the sense in which it turned."""
    forward, backward = (
        np.arctan2(batch.log(Log[f"{name}_SIN"]), batch.log(Log[f"{name}_COS"])) for name in ("FORWARD", "BACKWARD")
    )
    phase = np.where(
        late[:, Late.TURNED] >= 0.0,
        forward - _reference(batch, batch.motions.forward),
        _reference(batch, batch.motions.backward) - backward,
    )
    return np.where(np.isnan(late[:, Late.SPAN]), np.nan, np.arctan2(np.sin(phase), np.cos(phase)))


def _reference(batch: Batch, azimuth: Floats) -> Floats:
    """Return the azimuth of a circular component of the forcing, relative to the line for planar motion."""
    line = np.arctan2(batch.table[:, Setup.LINE_Y], batch.table[:, Setup.LINE_X])
    return np.where(batch.planar, azimuth - line, azimuth)


def _survive(batch: Batch, moving: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
    """Return which of the runs that are `moving` at their end have survived a base motion that ends; see `survival`."""
    lasts = batch.motions.duration
    survive = moving & (batch.log(Log.STATUS) == RunStatus.STOPPED) & (batch.log(Log.STANDS) == 0.0)
    survive &= (lasts > 0.0) & has_ended(batch.log(Log.TIME) * batch.models.time_scale, lasts)
    chosen = np.flatnonzero(survive)
    if chosen.size:
        states, remaining = _states(batch)[:, chosen], batch.motions.remaining[chosen]
        energy = batch.models.models.of(chosen).evaluate(
            lambda changed, runs: {"over": energy_over_balance(changed, states[:, runs], remaining[runs])}
        )
        survive[chosen] = energy["over"] < 1.0
    return np.asarray(survive)


def _states(batch: Batch) -> Floats:
    """Return the three-dimensional states, shape (number of states, n)."""
    model = batch.plan.model
    states = batch.table[:, STATE : STATE + len(model.state_names)].T
    if not batch.planar.any():
        return states
    assert model.from_plane is not None
    line = batch.table[:, [Setup.LINE_X, Setup.LINE_Y]].T
    lifted = np.broadcast_arrays(*model.from_plane(states[0], states[1], *line, *batch.models.parameters.T))
    return np.where(batch.planar, np.stack(lifted), states)


def outcomes(batch: Batch, late: Floats) -> npt.NDArray[np.int8]:
    """Return the codes of the outcomes."""
    codes = _OUTCOME_OF_GROUND[late[:, Late.GROUND].astype(np.intp)]
    codes = np.where(_survive(batch, codes == Outcome.STILL_MOVING), Outcome.SURVIVED, codes)
    codes = np.where(batch.log(Log.STANDS) > 0.0, Outcome.AT_REST, codes)
    endings = _OUTCOME_OF_STATUS[batch.log(Log.STATUS).astype(np.intp)]
    codes = np.where(endings == _OTHERS, codes, endings).astype(np.int8)
    reached = batch.converged
    if reached is not None:
        codes[reached.runs] = np.where(reached.turns == 0.0, Outcome.ROCKING, Outcome.ROLLING)
    return upright_outcomes(batch, late[:, Late.SPAN], codes) if batch.plan.model.switches else codes


@dataclass(frozen=True, slots=True)
class Contacts:
    """Contact record of each run; times are in the units of the models."""

    state: Floats
    noted: Floats
    kind: npt.NDArray[np.int8]
    times: Mapping[str, Floats]

    @classmethod
    def of(cls, batch: Batch) -> "Contacts":
        """Return the contact record of a batch; the present kind of contact lasts to the end."""
        order = len(batch.plan.model.state_names)
        state, noted = batch.table[:, STATE : STATE + order].T, batch.table[:, STATE + order :]
        kind, present = state[-1].astype(np.int8), batch.log(Log.TIME) - noted[:, Change.SINCE]
        times = {
            name: noted[:, column] + np.where(kind == number, present, 0.0)
            for number, (name, column) in enumerate(zip(CONTACT_KINDS, TIMES_OF_CONTACTS, strict=True))
        }
        return cls(state, noted, kind, times)

    def late(self, name: str) -> npt.NDArray[np.bool_]:
        """Return the runs in which this contact occurred in the last periods."""
        rim = self.times["rolling"] + self.times["slipping"]
        taken = {"sliding": self.times["sliding"], "rim": rim, "flying": self.times["flying"]}[name]
        before = self.noted[:, Change[f"WINDOW_{name.upper()}"]]
        return np.asarray(taken - before > SLACK * (1.0 + taken))


def contact_arrays(batch: Batch, span: Floats) -> dict[str, npt.NDArray[Any]]:
    """Return final position, contact kind, mean velocities, contact times and event counts of each run.

    `span` is the length of the last periods, NaN if they were not computed.
    """
    names, scale, length = batch.plan.model.state_names, batch.models.time_scale, batch.models.length
    contacts = Contacts.of(batch)
    places = [names.index(name) for name in ("footprint_x", "footprint_y", "twist")]
    begun = contacts.noted[:, [Change.WINDOW_X, Change.WINDOW_Y, Change.WINDOW_TWIST]].T
    span = np.where(np.isnan(span), np.nan, batch.log(Log.TIME) - contacts.noted[:, Change.WINDOW_AT])
    with np.errstate(divide="ignore", invalid="ignore"):
        vx, vy, turning = (contacts.state[places] - begun) / (span * scale)
    return {
        "end_footprint": (contacts.state[places[:2]] * length).T,
        "end_twist": contacts.state[places[2]],
        "end_contact": contacts.kind,
        "mean_velocity": np.stack([vx, vy], axis=-1) * length[:, np.newaxis],
        "mean_twist_rate": turning,
        "impacts": contacts.noted[:, Change.IMPACTS],
        "slips": contacts.noted[:, Change.SLIPS],
        **{f"time_{name}": times * scale for name, times in contacts.times.items()},
    }


def upright_outcomes(batch: Batch, span: Floats, codes: npt.NDArray[np.int8]) -> npt.NDArray[np.int8]:
    """Replace the outcomes of columns that stay upright in the last periods, or at the end if there are none."""
    contacts = Contacts.of(batch)
    seen, decided = ~np.isnan(span), batch.log(Log.STATUS) == RunStatus.STOPPED
    names = [kind.name for kind in batch.plan.model.contact_kinds or ()]
    upright = ~np.any(contacts.state[:2], axis=0)
    rim = np.where(seen, contacts.late("rim"), ~upright)
    flies = np.where(seen, contacts.late("flying"), contacts.kind == names.index("FLYING"))
    slides = np.where(seen, contacts.late("sliding"), contacts.kind == names.index("SLIDING"))
    hops = decided & ~rim & flies
    codes = np.where(hops, Outcome.LIFTED_OFF, codes)
    return np.where(decided & ~rim & ~flies & slides, Outcome.SLID, codes).astype(np.int8)
