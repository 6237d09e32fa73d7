"""What a finished run amounts to: the rules of the outcomes, with their thresholds."""

import math
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
import numpy.typing as npt

from stylobate.engine.forcing import Floats
from stylobate.engine.lanes.columns import SLACK
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


class Ground(IntEnum):
    """On what an outcome rests that is told from the last periods."""

    NO_PERIOD = 0
    SHORT = 1
    ROLLS = 2
    ROCKS = 3
    SHORT_FOR_MODULATION = 4
    DRIFTS = 5
    MODULATED = 6
    NOT_SETTLED = 7
    UNSTEADY = 8


_VERDICTS = {
    Ground.NO_PERIOD: (Outcome.STILL_MOVING, "it moved to the end of the run"),
    Ground.SHORT: (
        Outcome.STILL_MOVING,
        "the run is shorter than the {more} periods of the base motion by which a steady motion is told; "
        "set duration to at least {steady:.4g} s",
    ),
    Ground.ROLLS: (Outcome.ROLLING, "it rolled once round in each of the last {n} periods and repeats"),
    Ground.ROCKS: (Outcome.ROCKING, "it repeats over the last {n} periods without travelling round"),
    Ground.SHORT_FOR_MODULATION: (
        Outcome.STILL_MOVING,
        "the run is shorter than the {twice} periods of the base motion by which modulation is told; "
        "set duration to at least {modulated:.4g} s",
    ),
    Ground.DRIFTS: (Outcome.STILL_MOVING, "its last {both} periods are no steady motion"),
    Ground.MODULATED: (Outcome.MODULATED, "it rolls at the mean rate of the base motion, its tilt modulated"),
    Ground.NOT_SETTLED: (
        Outcome.STILL_MOVING,
        "it rolls at the mean rate of the base motion and has not settled; follow it longer",
    ),
    Ground.UNSTEADY: (Outcome.STILL_MOVING, "its last {n} periods are no steady motion"),
}


def outcome_on(ground: Ground) -> Outcome:
    """Return the outcome that rests on `ground`."""
    return _VERDICTS[ground][0]


@dataclass(frozen=True, slots=True)
class Evidence:
    """What the last n periods of runs show; numbers or arrays of one shape.

    Parameters
    ----------
    turned
        How far the lean travelled round [turns].
    least_tilt
        [units of c].
    repetition
        The largest difference of states one period apart, over the largest tilt or rate.
    repetition_before
        The same over the n periods before; NaN where the run is too short for them.
    drift
        Change of the mean lag behind the forcing from those periods to the last [turns].
    """

    turned: npt.ArrayLike
    least_tilt: npt.ArrayLike
    repetition: npt.ArrayLike
    repetition_before: npt.ArrayLike
    drift: npt.ArrayLike


def grounds(evidence: Evidence, rules: OutcomeRules) -> npt.NDArray[np.int8]:
    """Return on which `Ground` the outcome of each run rests."""
    n = rules.periods
    turned, repetition = np.abs(evidence.turned), np.asarray(evidence.repetition)
    before = np.asarray(evidence.repetition_before)
    off = np.abs(turned / n - 1.0)
    tilted = np.asarray(evidence.least_tilt) > rules.rest_tilt
    repeats = repetition < rules.repeat_tolerance
    follows = tilted & (off * n < _LESS_THAN_ONE_TURN) & ~repeats
    with np.errstate(divide="ignore", invalid="ignore"):
        settled = np.abs(repetition / before - 1.0) < rules.settled_tolerance
    chosen = np.select(
        [
            repeats & tilted & (off < rules.frequency_tolerance),
            repeats & (turned < rules.frequency_tolerance * n),
            follows & np.isnan(before),
            follows & ~(np.asarray(evidence.drift) / n < rules.frequency_tolerance),
            follows & settled & (repetition > rules.modulation_floor),
            follows,
        ],
        [
            Ground.ROLLS,
            Ground.ROCKS,
            Ground.SHORT_FOR_MODULATION,
            Ground.DRIFTS,
            Ground.MODULATED,
            Ground.NOT_SETTLED,
        ],
        Ground.UNSTEADY,
    )
    return chosen.astype(np.int8)


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
    """Return the verdict on `ground`, told by n periods of the base motion of this length [s]."""
    outcome, reason = _VERDICTS[ground]
    needed = {"steady": _rounded_up((n + 1) * period), "modulated": _rounded_up((2 * n + 1) * period)}
    return Verdict(outcome, reason.format(n=n, more=n + 1, both=2 * n, twice=2 * n + 1, **needed), measures)


def _rounded_up(value: float) -> float:
    """Return the least number of four digits that is not less than `value`, which is not negative.

    >>> _rounded_up(43.98229715), _rounded_up(0.0)
    (43.99, 0.0)
    """
    if value == 0.0:
        return 0.0
    digits = 3 - math.floor(math.log10(value))
    return math.ceil(value * 10.0**digits * (1.0 - SLACK)) / 10.0**digits


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
