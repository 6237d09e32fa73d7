"""What the last periods of a run show that was followed alone."""

import math
from dataclasses import dataclass

import numpy as np

from stylobate.engine.forcing import Floats
from stylobate.engine.lanes.columns import SLACK
from stylobate.engine.switching.pieces import Trajectory
from stylobate.engine.verdict import Evidence, Ground, Verdict, grounds, outcome_on, reason_on
from stylobate.models import Model
from stylobate.results import OutcomeRules

# Samples to each forcing period on which least tilt and modulation are read.
_SAMPLES = 64


def long_term(
    model: Model, trajectory: Trajectory, period: float | None, rules: OutcomeRules, *, planar: bool
) -> Verdict:
    """Judge the last periods of a run that neither stands nor overturned; `period` is that of the forcing, or None."""
    n = rules.periods
    if period is None:
        return _verdict_on(Ground.NO_PERIOD, n, 0.0, {})
    seconds = period * model.time_scale
    end = trajectory.end * (1.0 + SLACK)
    if end < (n + 1) * period:
        return _verdict_on(Ground.SHORT, n, seconds, {})
    late = _Window.of(model, trajectory, trajectory.end, n, period)
    turned = 0.0 if planar else late.turned
    measures = {
        "mean_rolling_rate": 2.0 * math.pi * turned / (n * period * model.time_scale),
        "repetition": late.repetition,
        "mean_tilt_late": late.mean_tilt,
        "least_tilt_late": late.least_tilt,
        "largest_tilt_late": late.largest_tilt,
    }
    repetition_before = drift = math.nan
    if end >= (2 * n + 1) * period:
        before = _Window.of(model, trajectory, trajectory.end - n * period, n, period)
        drift = abs(late.mean_lag - before.mean_lag)
        repetition_before = before.repetition
        change = abs(late.repetition / before.repetition - 1.0) if before.repetition > 0.0 else 0.0
        measures |= {"modulation_change": change, "rolling_rate_error": drift / n}
    tilt = late.least_tilt / model.column.slenderness
    evidence = Evidence(turned, tilt, late.repetition, repetition_before, drift)
    return _verdict_on(Ground(int(grounds(evidence, rules))), n, seconds, measures)


def _verdict_on(ground: Ground, n: int, period: float, measures: dict[str, float]) -> Verdict:
    return Verdict(outcome_on(ground), reason_on(ground, n, period), measures)


@dataclass(frozen=True, slots=True)
class _Window:
    """Some periods of a motion under a periodic base motion.

    `turned` is how far the azimuth went, `mean_lag` its mean lag behind the forcing [turns]; `repetition` the largest
    difference of states one period apart, over the largest tilt or rate.
    """

    least_tilt: float
    largest_tilt: float
    mean_tilt: float
    turned: float
    mean_lag: float
    repetition: float

    @classmethod
    def of(cls, model: Model, trajectory: Trajectory, end: float, periods: int, period: float) -> "_Window":
        """Look at the `periods` before `end`, and one more to compare with."""
        turns = end / period - np.arange((periods + 1) * _SAMPLES, -1, -1) / _SAMPLES
        tau = np.maximum(period * turns, 0.0)
        states = trajectory.states(tau)
        tilt = model.tilt(states)
        repetition = max(_repetition(tilt), _repetition(model.tilt_rate(states)))
        turns, amplitude = turns[_SAMPLES:], np.hypot(*tilt[:, _SAMPLES:])
        # No azimuth while it stands: then it does not travel round.
        azimuth = np.nan_to_num(trajectory.azimuth(tau, tilt)[_SAMPLES:]) / (2.0 * math.pi)
        turned = float(azimuth[-1] - azimuth[0])
        lag = azimuth - math.copysign(1.0, turned) * turns
        return cls(
            least_tilt=float(amplitude.min()),
            largest_tilt=float(amplitude.max()),
            mean_tilt=float(np.trapezoid(amplitude, turns)) / periods,
            turned=turned,
            mean_lag=float(np.trapezoid(lag, turns)) / periods,
            repetition=repetition,
        )


def _repetition(vectors: Floats) -> float:
    largest = np.abs(vectors).max()
    return float(np.abs(vectors[:, _SAMPLES:] - vectors[:, :-_SAMPLES]).max() / largest) if largest > 0.0 else 0.0
