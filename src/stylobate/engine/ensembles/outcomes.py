"""Outcomes of runs and measures of their last periods, from the log of the kernels."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from stylobate.engine.end_of_motion import energy_over_balance, has_ended
from stylobate.engine.ensembles.batch import Batch
from stylobate.engine.ensembles.contacts import upright_outcomes
from stylobate.engine.ensembles.steady import evidence_of
from stylobate.engine.kernel.columns import EARLIER, LAGS, SLACK, STATE, Log, Setup
from stylobate.engine.kernel.driver.events import Status
from stylobate.engine.verdict import Evidence, Ground, grounds, outcome_on
from stylobate.errors import Outcome

Floats = npt.NDArray[np.float64]

_OTHERS = -1
_OUTCOME_OF_STATUS = np.array([_OTHERS if one.outcome is None else one.outcome for one in Status], dtype=np.int8)
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
    seen = (batch.log(Log.STATUS) == Status.STOPPED) & (period > 0.0) & (end >= (n + 1) * period)

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
    survive = moving & (batch.log(Log.STATUS) == Status.STOPPED) & (batch.log(Log.STANDS) == 0.0)
    survive &= (lasts > 0.0) & has_ended(batch.log(Log.TIME) * batch.models.time_scale, lasts)
    states = _states(batch) if survive.any() else np.empty((0, 0))
    for changed, runs in batch.models.kinds:
        if survive[runs].any():
            survive[runs] &= energy_over_balance(changed, states[:, runs], batch.motions.remaining[runs]) < 1.0
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
