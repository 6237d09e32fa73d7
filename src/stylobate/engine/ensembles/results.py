"""Results of a batch: measures of the last periods, outcomes, and arrays in SI units, one entry per run."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from numpy.lib.stride_tricks import sliding_window_view

from stylobate.engine.ensembles.batch import Batch, OrbitReached
from stylobate.engine.ensembles.beginnings import periods_of
from stylobate.engine.ensembles.runs import CONTACT_KINDS, DEMANDS, TIMES_OF_CONTACTS, Arrays, empty
from stylobate.engine.forcing import coarse
from stylobate.engine.kernel.columns import EARLIER, LAGS, PAIRS, SLACK, STATE, Change, Log, Pair, Setup, pair_begins
from stylobate.engine.kernel.driver.events import RunStatus
from stylobate.engine.tolerances import CLOSE_PASSAGE
from stylobate.engine.verdict import (
    FALLEN,
    Evidence,
    Ground,
    energy_over_balance,
    grounds,
    has_ended,
    in_doubt,
    outcome_on,
    steady_periods,
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


_OTHERS = -1
_OUTCOME_OF_STATUS = np.array([_OTHERS if one.outcome is None else one.outcome for one in RunStatus], dtype=np.int8)
"""Outcomes of runs that ended in the kernel; the last periods decide the other outcomes."""

_OUTCOME_OF_GROUND = np.array([outcome_on(kind) for kind in Ground], dtype=np.int8)


@dataclass(frozen=True, slots=True)
class Late:
    """Measures of the last periods of each run; NaN if these were not completed.

    `runs` are the indices of runs that completed them, and `evidence` is that of these runs.
    """

    span: Floats
    turned: Floats
    mean_tilt: Floats
    phase: Floats
    minimum_tilt: Floats
    repetition: Floats
    repeats_after: npt.NDArray[np.int8]
    runs: npt.NDArray[np.intp]
    evidence: Evidence | None


def late_periods(batch: Batch) -> Late:
    """Return the measures of the last periods of each run."""
    rules, period = batch.plan.rules, batch.motions.period
    n, end = rules.periods, batch.table[:, Setup.END] * (1.0 + SLACK)
    seen = (batch.log(Log.STATUS) == RunStatus.STOPPED) & (period > 0.0) & (end >= (n + 1) * period)

    def known(values: Floats) -> Floats:
        return np.where(seen, values, np.nan)

    runs, span = np.flatnonzero(seen), known(n * period)
    turned, repetition = known(np.zeros(len(seen))), known(np.zeros(len(seen)))
    mean_tilt, minimum_tilt = known(batch.log(Log.MEAN_TILT)) / span, known(batch.log(Log.LATE_MINIMUM_TILT))
    repeats_after, evidence = np.zeros(len(seen), dtype=np.int8), None
    if runs.size:
        azimuth = batch.looks[:, [EARLIER + LAGS, -1], -1]
        turned = known(np.where(batch.planar, 0.0, azimuth[:, 1] - azimuth[:, 0]))
        least = minimum_tilt / batch.models.slenderness
        evidence = evidence_of(batch, runs, turned[runs], least[runs], mean_tilt[runs])
        repetition[runs], repeats_after[runs] = evidence.returns[:, 0], evidence.repeats_after(rules)
    return Late(
        span=span,
        turned=turned,
        mean_tilt=mean_tilt,
        phase=known(_phase(batch, turned)),
        minimum_tilt=minimum_tilt,
        repetition=repetition,
        repeats_after=repeats_after,
        runs=runs,
        evidence=evidence,
    )


def _phase(batch: Batch, turned: Floats) -> Floats:
    """Return the phase of the tilt vector relative to the base acceleration, in the sense in which it turned."""
    parts = {
        name: batch.log(Log[f"{name}_COS"]) + 1j * batch.log(Log[f"{name}_SIN"]) for name in ("FORWARD", "BACKWARD")
    }
    phase = np.where(
        turned >= 0.0,
        np.angle(parts["FORWARD"]) - _reference(batch, batch.motions.forward),
        _reference(batch, batch.motions.backward) - np.angle(parts["BACKWARD"]),
    )
    return np.asarray(np.angle(np.exp(1j * phase)))


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


def grounds_of(batch: Batch, late: Late) -> npt.NDArray[np.int8]:
    """Return the `Ground` of the outcome of each run that moves at its end."""
    ground = np.full(len(batch.table), Ground.SHORT, dtype=np.int8)
    if late.evidence is not None:
        ground[late.runs] = grounds(late.evidence, batch.plan.rules)
    return np.where(batch.motions.period > 0.0, ground, Ground.NO_PERIOD).astype(np.int8)


def outcomes(batch: Batch, late: Late) -> npt.NDArray[np.int8]:
    """Return the codes of the outcomes."""
    codes = _OUTCOME_OF_GROUND[grounds_of(batch, late)]
    codes = np.where(_survive(batch, codes == Outcome.STILL_MOVING), Outcome.SURVIVED, codes)
    codes = np.where(batch.log(Log.STANDS) > 0.0, Outcome.AT_REST, codes)
    endings = _OUTCOME_OF_STATUS[batch.log(Log.STATUS).astype(np.intp)]
    codes = np.where(endings == _OTHERS, codes, endings).astype(np.int8)
    reached = batch.converged
    if reached is not None:
        codes[reached.runs] = np.where(reached.turns == 0.0, Outcome.ROCKING, Outcome.ROLLING)
    return upright_outcomes(batch, late.span, codes) if batch.plan.model.switches else codes


Integers = npt.NDArray[np.intp]

# Pairs begin this many periods before the end, a linear function of their spacing, with the opposite sign.
_AT_ZERO = -pair_begins(np.arange(PAIRS), 0.0)
_PER_SPACING = pair_begins(np.arange(PAIRS), 1.0) + _AT_ZERO

# Distances of states in units of the motion below this are rounding errors.
_ROUNDING = 1e-12


@dataclass(frozen=True, slots=True)
class Units:
    """Units of the tilts and rates of motions, shape (n,): their peaks at the looks, at least those of the mean tilt.

    All looks may fall on passages through the vertical, or on turning points. The unit of what is always zero is
    infinite.
    """

    tilt: Floats
    rate: Floats

    @classmethod
    def of(cls, looks: Floats, mean_tilt: Floats, period: Floats) -> "Units":
        """Return the units of runs with these looks."""
        tilt, rate = _largest(looks)
        turning = 2.0 * math.pi / period
        tilt, rate = np.fmax(tilt, mean_tilt), np.fmax(rate, mean_tilt * turning)
        return cls(np.where(tilt > 0.0, tilt, np.inf), np.where(rate > 0.0, rate, np.inf))

    def of_some(self, chosen: Integers) -> "Units":
        """Return the units of some of the runs."""
        return Units(self.tilt[chosen], self.rate[chosen])

    def distances(self, tilt_change: Floats, rate_change: Floats) -> Floats:
        """Return the larger of two differences in their units, shape (…, n) as the differences."""
        return np.maximum(tilt_change / self.tilt, rate_change / self.rate)

    def returns(self, looks: Floats, last: int, lags: int) -> Floats:
        """Return the maximum distance of the `last` looks from those earlier by 1, 2, … `lags`, shape (lags, n)."""
        groups = np.moveaxis(sliding_window_view(looks, last, axis=1), -1, 1)
        return self.distances(*_largest(groups[:, :, -1:] - groups[:, :, -2 : -2 - lags : -1]))


def evidence_of(batch: Batch, runs: Integers, turned: Floats, minimum_tilt: Floats, mean_tilt: Floats) -> Evidence:
    """Return the evidence of these `runs`, all of which have the looks of their last periods.

    It is complete as far as the outcome depends on it: a run that repeats after one period has no trends, and a run
    that nearly repeats, or has a trend, is not compared over several periods.

    Parameters
    ----------
    batch, runs
        The batch, and the indices of the runs.
    turned, minimum_tilt, mean_tilt
        Turns of the contact point, minimum tilt [units of c] and mean tilt of these runs in the last periods.
    """
    rules, period = batch.plan.rules, batch.motions.period[runs]
    held = np.floor(periods_of(batch.table[runs, Setup.END], period))
    evidence = Evidence.unknown(turned, minimum_tilt, held, batch.table[runs, Setup.LOOKED_BACK])
    steady = held >= steady_periods(rules)
    last = _looks_of(batch, runs, EARLIER + LAGS - 1)
    units = Units.of(last[:, 1:], mean_tilt, period)
    after_one = units.returns(last, rules.periods, 1)[0]
    after_one[~np.any(last[:, 1:], axis=(0, 1))] = np.inf  # the motion between the looks is unknown
    evidence.returns[:, 0] = after_one
    moves = np.flatnonzero(steady & ~(after_one < rules.repeat_tolerance))
    if moves.size:
        _fill_change(evidence, batch, runs, moves, units)
    settled = ~evidence.change.exceeds(math.log1p(rules.settled_tolerance), rules.sampling_errors)
    open_runs = np.flatnonzero(settled & (after_one >= rules.modulation_floor))
    looks = _looks_of(batch, runs[open_runs])
    near = _near_repeats(looks, units.of_some(open_runs), rules.repeat_tolerance)
    compared = steady[open_runs] | near
    kept = open_runs[compared]
    if kept.size:
        _fill_returns(evidence, kept, looks[..., compared], units.of_some(kept), rules.periods)
        _fill_lag(evidence, batch, runs, kept)
    return evidence


def _looks_of(batch: Batch, runs: Integers, first: int = 0) -> Floats:
    """Return the looks of runs from the `first` one: tilt vectors and rates, shape (4, number, n)."""
    return np.ascontiguousarray(batch.looks[runs, first:, :4].transpose(2, 1, 0))


def _near_repeats(looks: Floats, units: Units, tolerance: float) -> npt.NDArray[np.bool_]:
    """Return which runs are within the tolerance after several periods, by their last look alone."""
    return np.asarray(np.any(units.returns(looks, 1, LAGS)[1:] < tolerance, axis=0))


def _fill_returns(evidence: Evidence, kept: Integers, looks: Floats, units: Units, periods: int) -> None:
    """Compare these runs over several periods, at their end and a quarter of the run before."""
    few, lags = EARLIER - LAGS, np.arange(1, LAGS + 1)[:, np.newaxis]
    held, back = evidence.held[kept], evidence.back[kept]
    returns = np.where(held < periods + lags, np.nan, units.returns(looks, periods, LAGS))
    evidence.returns[kept, 1:] = returns[1:].T
    evidence.returns_latest[kept] = units.returns(looks, few, LAGS).T
    before = units.returns(looks[:, :EARLIER], few, LAGS)
    evidence.returns_before[kept] = np.where(back == 0.0, np.nan, before).T


def _fill_change(evidence: Evidence, batch: Batch, runs: Integers, kept: Integers, units: Units) -> None:
    """Set the trend of the distances of states one period apart."""
    pairs, places, known = _pairs_of(batch, runs[kept], evidence.held[kept])
    apart = units.of_some(kept).distances(pairs[..., Pair.TILT_CHANGE].T, pairs[..., Pair.RATE_CHANGE].T).T
    evidence.change.fill(kept, np.log(np.maximum(apart, _ROUNDING)), places, known)


def _fill_lag(evidence: Evidence, batch: Batch, runs: Integers, kept: Integers) -> None:
    """Set the trend and the range of the azimuth relative to the forcing."""
    pairs, places, known = _pairs_of(batch, runs[kept], evidence.held[kept])
    lags = pairs[..., Pair.AZIMUTH] - np.sign(evidence.turned[kept])[:, np.newaxis] * places
    evidence.lag.fill(kept, lags, places, known)
    most, least = np.where(known, lags, -np.inf).max(axis=1), np.where(known, lags, np.inf).min(axis=1)
    evidence.lag_range[kept] = most - least


def _pairs_of(batch: Batch, runs: Integers, held: Floats) -> tuple[Floats, Floats, npt.NDArray[np.bool_]]:
    """Return the pairs of runs, their places in periods before the end, negative, and which of them the run has."""
    spacing = batch.table[runs, Setup.PAIR_SPACING]
    places = _AT_ZERO - spacing[:, np.newaxis] * _PER_SPACING
    return batch.pairs[runs], places, places >= -held[:, np.newaxis]


def _largest(vectors: Floats) -> tuple[Floats, Floats]:
    """Return the maximum lengths of tilts and of rates among vectors of shape (4, number, …, n), each (…, n)."""
    squares = vectors * vectors
    tilt, rate = squares[0] + squares[1], squares[2] + squares[3]
    return np.sqrt(tilt.max(axis=0)), np.sqrt(rate.max(axis=0))


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
