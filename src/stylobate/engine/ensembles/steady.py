"""Evidence of a steady motion in the looks and pairs of each run."""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from stylobate.engine.ensembles.batch import Batch
from stylobate.engine.ensembles.look_times import periods_of
from stylobate.engine.kernel.columns import EARLIER, LAGS, PAIRS, Pair, Setup, pair_begins
from stylobate.engine.verdict import Evidence, steady_periods

Floats = npt.NDArray[np.float64]
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

    def returns(self, looks: Floats, last: int, lag: int) -> Floats:
        """Return the maximum distance of the `last` looks from those earlier by this lag, shape (n,)."""
        first = looks.shape[1] - last
        return self.distances(*_largest(looks[:, first:] - looks[:, first - lag : looks.shape[1] - lag]))


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
    after_one = units.returns(last, rules.periods, 1)
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
    near = [units.returns(looks, 1, lag) < tolerance for lag in range(2, LAGS + 1)]
    return np.asarray(np.any(near, axis=0))


def _fill_returns(evidence: Evidence, kept: Integers, looks: Floats, units: Units, periods: int) -> None:
    """Compare these runs over several periods, at their end and a quarter of the run before."""
    few = EARLIER - LAGS
    held, back = evidence.held[kept], evidence.back[kept]
    for lag in range(1, LAGS + 1):
        if lag > 1:
            returns = units.returns(looks, periods, lag)
            evidence.returns[kept, lag - 1] = np.where(held < periods + lag, np.nan, returns)
        evidence.returns_latest[kept, lag - 1] = units.returns(looks, few, lag)
        before = units.returns(looks[:, :EARLIER], few, lag)
        evidence.returns_before[kept, lag - 1] = np.where(back == 0.0, np.nan, before)


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
    """Return the maximum lengths of tilts and of rates among vectors of shape (4, number, n), each of shape (n,)."""
    squares = vectors * vectors
    tilt, rate = squares[0] + squares[1], squares[2] + squares[3]
    return np.sqrt(tilt.max(axis=0)), np.sqrt(rate.max(axis=0))
