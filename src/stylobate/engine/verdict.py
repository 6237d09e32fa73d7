"""What a finished run amounts to: the rules of the outcomes, with their thresholds."""

import math
from dataclasses import dataclass

import numpy as np

from stylobate.engine.forcing import Floats
from stylobate.engine.trajectory import Trajectory
from stylobate.errors import Outcome, require_positive
from stylobate.models import Model

# Samples to each forcing period on which least tilt and modulation are read.
_SAMPLES = 64
# A motion that lost or won this many turns against the forcing does not follow it.
_LESS_THAN_ONE_TURN = 0.5


@dataclass(frozen=True, slots=True, kw_only=True)
class OutcomeRules:
    """When a motion under a periodic base motion counts as rolling, rocking or modulated.

    Parameters
    ----------
    periods
        Number n of forcing periods at the end of the run that are looked at.
    frequency_tolerance
        Rolling and modulated: the mean of β̇ differs from the forcing frequency by less than this part of it. For a
        modulated motion the mean is told from the average lag behind the forcing over the last n periods and over
        the n before.
    repeat_tolerance
        The motion repeats if states one period apart differ by less than this part of the largest tilt and rate.
    rest_tilt
        Rolling: the tilt never falls below this part of c.
    settled_tolerance
        Modulated: the range of the tilt over the last n periods and over the n before differ by less than this part
        of the tilt; otherwise the motion is still on its way.
    """

    periods: int = 10
    frequency_tolerance: float = 1e-3
    repeat_tolerance: float = 1e-6
    rest_tilt: float = 1e-6
    settled_tolerance: float = 0.02

    def __post_init__(self) -> None:
        for name in self.__slots__:
            require_positive(f"rules.{name}", getattr(self, name))


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
    tau = trajectory.end - period * np.arange(n * _SAMPLES, -1, -1) / _SAMPLES
    states = trajectory.states(tau)
    tilt = np.hypot(*model.tilt(states))
    turned = 0.0 if planar else _turned(model, trajectory, tau)
    measures = {
        "mean_rolling_rate": turned / (n * period * model.time_scale),
        "repetition": _repetition(model, states[:, ::_SAMPLES]),
        "mean_tilt_late": float(np.trapezoid(tilt, tau) / (n * period)),
        "least_tilt_late": float(tilt.min()),
        "largest_tilt_late": float(tilt.max()),
    }
    off = abs(abs(turned) / (2.0 * math.pi * n) - 1.0)
    tilted = tilt.min() > rules.rest_tilt * model.column.slenderness
    repeats = measures["repetition"] < rules.repeat_tolerance
    if repeats and tilted and off < rules.frequency_tolerance:
        return Verdict(Outcome.ROLLING, f"it rolled once round in each of the last {n} periods and repeats", measures)
    if repeats and abs(turned) < rules.frequency_tolerance * 2.0 * math.pi * n:
        return Verdict(Outcome.ROCKING, f"it repeats over the last {n} periods without travelling round", measures)
    # The lag of a modulated motion swings to and fro: its mean rate is told from averages over windows.
    if tilted and not repeats and off * n < _LESS_THAN_ONE_TURN:
        return _modulated(model, trajectory, period, rules, measures)
    return Verdict(Outcome.STILL_MOVING, f"its last {n} periods are no steady motion", measures)


def _modulated(
    model: Model, trajectory: Trajectory, period: float, rules: OutcomeRules, measures: dict[str, float]
) -> Verdict:
    n = rules.periods
    if trajectory.end < 2 * n * period:
        reason = f"the run is shorter than the {2 * n} periods of the base motion by which lasting modulation is told"
        return Verdict(Outcome.STILL_MOVING, reason, measures)
    before, late = (_Window.of(model, trajectory, trajectory.end - first * period, n, period) for first in (2 * n, n))
    mean_tilt = measures["mean_tilt_late"]
    drift = abs(late.mean_lag - before.mean_lag) / (2.0 * math.pi * n)
    change = abs(late.depth - before.depth) / mean_tilt
    measures = measures | {"modulation_depth": late.depth, "modulation_change": change, "rolling_rate_error": drift}
    if not drift < rules.frequency_tolerance:
        return Verdict(Outcome.STILL_MOVING, f"its last {2 * n} periods are no steady motion", measures)
    if change < rules.settled_tolerance < late.depth / mean_tilt:
        return Verdict(Outcome.MODULATED, "it rolls at the mean rate of the base motion, its tilt modulated", measures)
    return Verdict(Outcome.STILL_MOVING, "it rolls at the mean rate of the base motion and has not settled", measures)


@dataclass(frozen=True, slots=True)
class _Window:
    """Some periods of a rolling motion: the range of its tilt, and the mean lag of its azimuth behind the forcing."""

    depth: float
    mean_lag: float

    @classmethod
    def of(cls, model: Model, trajectory: Trajectory, start: float, periods: int, period: float) -> "_Window":
        turns = np.arange(periods * _SAMPLES + 1) / _SAMPLES
        tau = start + period * turns
        tilt = model.tilt(trajectory.states(tau))
        azimuth = trajectory.azimuth(tau, tilt)
        sense = math.copysign(1.0, azimuth[-1] - azimuth[0])
        lag = azimuth - sense * 2.0 * math.pi * (turns + start / period)
        return cls(float(np.ptp(np.hypot(*tilt))), float(np.trapezoid(lag, turns)) / periods)


def _turned(model: Model, trajectory: Trajectory, tau: Floats) -> float:
    ends = tau[[0, -1]]
    first, last = trajectory.azimuth(ends, model.tilt(trajectory.states(ends)))
    return float(np.nan_to_num(last - first))  # no azimuth while it stands: then it does not travel round


def _repetition(model: Model, states: Floats) -> float:
    tilt, rate = model.tilt(states), model.tilt_rate(states)
    scale_tilt, scale_rate = np.abs(tilt).max(), np.abs(rate).max()
    if scale_tilt == 0.0 or scale_rate == 0.0:
        return 0.0
    return float(max(np.abs(np.diff(tilt)).max() / scale_tilt, np.abs(np.diff(rate)).max() / scale_rate))
