"""Outcomes of runs and measures of their last periods, from the log of the kernels."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from stylobate.engine.end_of_motion import energy_over_balance, has_ended
from stylobate.engine.endings import ENDINGS
from stylobate.engine.ensembles.batch import Batch
from stylobate.engine.ensembles.contacts import upright_outcomes
from stylobate.engine.kernel.columns import BEFORE, LATE, LOOKS, SLACK, STATE, Log, Setup, Status, Window
from stylobate.engine.verdict import Evidence, Ground, grounds, outcome_on
from stylobate.errors import Outcome

Floats = npt.NDArray[np.float64]

_OTHERS = -1
_OUTCOME_OF_STATUS = np.array(
    [ENDINGS[status].outcome if status in ENDINGS else _OTHERS for status in Status], dtype=np.int8
)
"""Outcomes of runs that ended in the kernel; the last periods decide the other outcomes."""

_OUTCOME_OF_GROUND = np.array([outcome_on(kind) for kind in Ground], dtype=np.int8)


@dataclass(frozen=True, slots=True)
class Late:
    """Measures of the last periods of each run; NaN if these were not completed."""

    span: Floats
    turned: Floats
    mean_tilt: Floats
    phase: Floats
    minimum_tilt: Floats
    repetition: Floats
    repetition_before: Floats
    drift: Floats


def late_periods(batch: Batch) -> Late:
    """Return the measures of the last periods of each run."""
    n = batch.plan.options.rules.periods
    period, end = batch.motions.period, batch.table[:, Setup.END]
    end = end * (1.0 + SLACK)
    seen = (batch.log(Log.STATUS) == Status.STOPPED) & (period > 0.0) & (end >= (n + 1) * period)
    before = seen & (end >= (2 * n + 1) * period)

    def known(values: Floats, where: npt.NDArray[np.bool_] = seen) -> Floats:
        return np.where(where, values, np.nan)

    span = known(n * period)
    turned = _window(batch, LATE, Window.LAST_AZIMUTH) - _window(batch, LATE, Window.FIRST_AZIMUTH)
    turned = np.where(batch.planar, 0.0, turned)
    forward = turned >= 0.0
    lags = [
        np.where(forward, _window(batch, first, Window.LAG_FORWARD), _window(batch, first, Window.LAG_BACKWARD))
        for first in (LATE, BEFORE)
    ]
    parts = {
        name: batch.log(Log[f"{name}_COS"]) + 1j * batch.log(Log[f"{name}_SIN"]) for name in ("FORWARD", "BACKWARD")
    }
    phase = np.where(
        forward,
        np.angle(parts["FORWARD"]) - _reference(batch, batch.motions.forward),
        _reference(batch, batch.motions.backward) - np.angle(parts["BACKWARD"]),
    )
    mean_tilt = known(batch.log(Log.MEAN_TILT)) / span
    return Late(
        span=span,
        turned=known(turned),
        mean_tilt=mean_tilt,
        phase=known(np.angle(np.exp(1j * phase))),
        minimum_tilt=known(batch.log(Log.LATE_MINIMUM_TILT)),
        repetition=known(_repetition(batch, LATE, mean_tilt)),
        repetition_before=known(_repetition(batch, BEFORE, mean_tilt), before),
        drift=known(np.abs(lags[0] / (n * LOOKS) - lags[1] / (n * LOOKS)), before),
    )


def _reference(batch: Batch, azimuth: Floats) -> Floats:
    """Return the azimuth of a circular component of the forcing, relative to the line for planar motion."""
    line = np.arctan2(batch.table[:, Setup.LINE_Y], batch.table[:, Setup.LINE_X])
    return np.where(batch.planar, azimuth - line, azimuth)


def _window(batch: Batch, first: int, column: Window) -> Floats:
    return batch.table[:, first + column]


def _repetition(batch: Batch, first: int, mean_tilt: Floats) -> Floats:
    """Return the maximum difference of states one period apart, over the peak tilt or rate.

    All looks may fall on passages through the vertical; then the mean tilt of the last periods is the unit of tilts.
    The result is infinite if the column stood at all looks, because the motion between the looks is unknown.
    """
    tilt_size, rate_size = _window(batch, first, Window.TILT_SIZE), _window(batch, first, Window.RATE_SIZE)
    with np.errstate(divide="ignore", invalid="ignore"):
        tilt = _window(batch, first, Window.TILT_CHANGE) / np.fmax(tilt_size, mean_tilt)
        rate = _window(batch, first, Window.RATE_CHANGE) / rate_size
    found = np.fmax(np.nan_to_num(tilt), np.nan_to_num(rate))
    return np.where((tilt_size > 0.0) | (rate_size > 0.0), found, np.inf)


def _survive(batch: Batch, moving: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
    """Return which of the runs that are `moving` at their end have survived a base motion that ends; see `survival`."""
    lasts = batch.motions.duration
    survive = moving & (batch.log(Log.STATUS) == Status.STOPPED) & (batch.log(Log.STANDS) == 0.0)
    survive &= (lasts > 0.0) & has_ended(batch.log(Log.TIME) * batch.models.time_scale, lasts)
    states = _states(batch) if survive.any() else np.empty((0, 0))
    for changed, runs in batch.models.kinds:
        if survive[runs].any():
            survive[runs] &= energy_over_balance(changed, states[:, runs]) < 1.0
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
    evidence = Evidence(
        turned=np.nan_to_num(late.turned),
        minimum_tilt=np.nan_to_num(late.minimum_tilt) / batch.models.slenderness,
        repetition=np.nan_to_num(late.repetition, nan=np.inf),
        repetition_before=late.repetition_before,
        drift=late.drift,
    )
    ground = np.where(np.isnan(late.span), Ground.SHORT, grounds(evidence, batch.plan.options.rules))
    return np.where(batch.motions.period > 0.0, ground, Ground.NO_PERIOD)


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
