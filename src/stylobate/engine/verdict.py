"""What a finished run amounts to: the rules of the outcomes, with their thresholds."""

import math
from dataclasses import dataclass

import numpy as np

from stylobate.engine.forcing import Floats
from stylobate.engine.trajectory import Trajectory
from stylobate.errors import Outcome
from stylobate.models import Model
from stylobate.results import OutcomeRules

# Samples to each forcing period on which least tilt and modulation are read.
_SAMPLES = 64
# A motion that lost or won this many turns against the forcing does not follow it.
_LESS_THAN_ONE_TURN = 0.5


@dataclass(frozen=True, slots=True)
class Verdict:
    """An outcome, the line that explains it and the measures it rests on."""

    outcome: Outcome
    reason: str
    measures: dict[str, float]


def long_term(
    model: Model, trajectory: Trajectory, period: float | None, rules: OutcomeRules, *, planar: bool
) -> Verdict:
    """Judge the last periods of a run that neither stands nor overturned; `period` is that of the forcing, or None."""
    n = rules.periods
    if period is None:
        return Verdict(Outcome.STILL_MOVING, "it moved to the end of the run", {})
    if trajectory.end < (n + 1) * period:
        reason = f"the run is shorter than the {n + 1} periods of the base motion by which a steady motion is told"
        return Verdict(Outcome.STILL_MOVING, reason, {})
    late = _Window.of(model, trajectory, trajectory.end, n, period)
    turned = 0.0 if planar else late.turned
    measures = {
        "mean_rolling_rate": 2.0 * math.pi * turned / (n * period * model.time_scale),
        "repetition": late.repetition,
        "mean_tilt_late": late.mean_tilt,
        "least_tilt_late": late.least_tilt,
        "largest_tilt_late": late.largest_tilt,
    }
    off = abs(abs(turned) / n - 1.0)
    tilted = late.least_tilt > rules.rest_tilt * model.column.slenderness
    if late.repetition < rules.repeat_tolerance:
        if tilted and off < rules.frequency_tolerance:
            reason = f"it rolled once round in each of the last {n} periods and repeats"
            return Verdict(Outcome.ROLLING, reason, measures)
        if abs(turned) < rules.frequency_tolerance * n:
            return Verdict(Outcome.ROCKING, f"it repeats over the last {n} periods without travelling round", measures)
    # The lag of a modulated motion swings to and fro: its mean rate is told from averages over windows.
    elif tilted and off * n < _LESS_THAN_ONE_TURN:
        return _modulated(model, trajectory, period, rules, late, measures)
    return Verdict(Outcome.STILL_MOVING, f"its last {n} periods are no steady motion", measures)


def _modulated(
    model: Model,
    trajectory: Trajectory,
    period: float,
    rules: OutcomeRules,
    late: "_Window",
    measures: dict[str, float],
) -> Verdict:
    n = rules.periods
    if trajectory.end < (2 * n + 1) * period:
        reason = f"the run is shorter than the {2 * n + 1} periods of the base motion by which modulation is told"
        return Verdict(Outcome.STILL_MOVING, reason, measures)
    before = _Window.of(model, trajectory, trajectory.end - n * period, n, period)
    drift = abs(late.mean_lag - before.mean_lag) / n
    change = abs(late.repetition / before.repetition - 1.0)
    measures = measures | {"modulation_change": change, "rolling_rate_error": drift}
    if not drift < rules.frequency_tolerance:
        return Verdict(Outcome.STILL_MOVING, f"its last {2 * n} periods are no steady motion", measures)
    if change < rules.settled_tolerance and late.repetition > rules.modulation_floor:
        return Verdict(Outcome.MODULATED, "it rolls at the mean rate of the base motion, its tilt modulated", measures)
    return Verdict(
        Outcome.STILL_MOVING,
        "it rolls at the mean rate of the base motion and has not settled; follow it longer",
        measures,
    )


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
