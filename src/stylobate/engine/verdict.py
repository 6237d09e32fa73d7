"""Rules that decide the outcome of a run from its last periods, and their reasons."""

import math
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
import numpy.typing as npt

from stylobate.engine.kernel.columns import LAGS, SLACK
from stylobate.errors import Outcome
from stylobate.results import OutcomeRules

Floats = npt.NDArray[np.float64]
Bools = npt.NDArray[np.bool_]

# Maximum difference in turns between motion and forcing, for rolling at the mean rate.
_LESS_THAN_ONE_TURN, _ONE_TURN = 0.5, 1.0
# Minimum number of pairs for a trend and its error.
_LEAST_PAIRS = 8
# A motion nears an orbit of several periods if it returns to this fraction of the distance of successive states …
_NEAR = 0.1
# … and to this fraction of its returns a quarter of the run before. Returns of a stationary motion scatter less.
_NEARER = 0.25
# Safety factor of the duration in which a transient decays.
_MARGIN = 1.1


class Ground(IntEnum):
    """Ground of an outcome that the last periods decide."""

    NO_PERIOD = 0
    SHORT = 1
    ROLLS = 2
    ROCKS = 3
    REPEATS = 4
    SHORT_FOR_STEADY = 5
    SETTLES = 6
    GROWS = 7
    NEARS_ORBIT = 8
    NEARLY_REPEATS = 9
    DRIFTS = 10
    MODULATED = 11
    APERIODIC = 12


_LONGER = "set duration to at least {needed:.10g} s"
_VERDICTS = {
    Ground.NO_PERIOD: (Outcome.STILL_MOVING, "it moved to the end of the run"),
    Ground.SHORT: (
        Outcome.STILL_MOVING,
        f"the run is shorter than the {{short}} periods of the base motion that show a steady motion; {_LONGER}",
    ),
    Ground.ROLLS: (Outcome.ROLLING, "it rolled once round in each of the last {n} periods and repeats"),
    Ground.ROCKS: (
        Outcome.ROCKING,
        "it repeats over the last {n} periods, and the contact point does not travel round",
    ),
    Ground.REPEATS: (Outcome.PERIODIC, "it repeats after {after} of the base motion"),
    Ground.SHORT_FOR_STEADY: (
        Outcome.STILL_MOVING,
        "the run is shorter than the {steady} periods of the base motion that show a motion which does not repeat; "
        + _LONGER,
    ),
    Ground.SETTLES: (Outcome.STILL_MOVING, f"its change from period to period still shrinks; {_LONGER}"),
    Ground.GROWS: (Outcome.STILL_MOVING, f"its change from period to period still grows; {_LONGER}"),
    Ground.NEARS_ORBIT: (
        Outcome.STILL_MOVING,
        f"it approaches a motion that repeats after {{after}} of the base motion; {_LONGER}",
    ),
    Ground.NEARLY_REPEATS: (
        Outcome.STILL_MOVING,
        "it changes from period to period by less than modulation_floor and more than repeat_tolerance; " + _LONGER,
    ),
    Ground.DRIFTS: (Outcome.STILL_MOVING, f"its phase behind the base motion still changes; {_LONGER}"),
    Ground.MODULATED: (Outcome.MODULATED, "it rolls at the mean rate of the base motion, its tilt modulated"),
    Ground.APERIODIC: (
        Outcome.APERIODIC,
        "it goes on without repeating after 1 to {most} periods of the base motion",
    ),
}


def outcome_on(ground: Ground) -> Outcome:
    """Return the outcome of a ground."""
    return _VERDICTS[ground][0]


@dataclass(frozen=True, slots=True)
class Trend:
    """Linear trend of values over the pairs of runs: `slope` per period, its standard `error`, `window` [periods]."""

    slope: Floats
    error: Floats
    window: Floats

    @classmethod
    def unknown(cls, count: int) -> "Trend":
        """Return the trends of so many runs, all of them NaN."""
        return cls(*np.full((3, count), np.nan))

    def fill(self, runs: npt.NDArray[np.intp], values: Floats, places: Floats, known: Bools) -> None:
        """Set the trends of some of the runs: those of the `known` of their values over `places`, by least squares."""
        count = known.sum(axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            x, y = (np.where(known, one, 0.0) for one in (places, values))
            x, y = ((one - one.sum(axis=1, keepdims=True) / count[:, np.newaxis]) * known for one in (x, y))
            spread = np.einsum("ij,ij->i", x, x)
            slope = np.einsum("ij,ij->i", x, y) / spread
            left = np.einsum("ij,ij->i", y, y) - slope * slope * spread
            self.error[runs] = np.sqrt(np.maximum(left, 0.0) / spread / (count - 2))
        self.slope[runs] = slope
        self.window[runs] = -places.min(axis=1, where=known, initial=0.0)

    def exceeds(self, bound: npt.ArrayLike, errors: float) -> Bools:
        """Return whether the change over the window is larger than `bound` and than so many standard errors."""
        return np.abs(self.slope) * self.window > np.maximum(bound, errors * self.error * self.window)


@dataclass(frozen=True, slots=True)
class Evidence:
    """Measures of runs that have completed their last n periods.

    Parameters
    ----------
    turned
        Change of the azimuth of the tilt vector in the last n periods [turns], shape (runs,).
    minimum_tilt
        Minimum tilt in them [units of c].
    held
        Number of whole periods of the run.
    back
        Number of periods from the end of the run to the end of the earlier group of looks; 0 without this group.
    returns
        Maximum distances of the states in the last n periods from those 1, 2, … `LAGS` periods before, over the peak
        tilt or rate, shape (runs, `LAGS`); NaN if the run is too short.
    returns_latest, returns_before
        The same for the last few periods, and for as many periods of the earlier group; NaN if there is none.
    change
        Trend of the logarithm of the distances of states one period apart, over the pairs.
    lag
        Trend of the azimuth relative to the forcing, over the pairs [turns].
    lag_range
        Range of the same [turns].
    """

    turned: Floats
    minimum_tilt: Floats
    held: Floats
    back: Floats
    returns: Floats
    returns_latest: Floats
    returns_before: Floats
    change: Trend
    lag: Trend
    lag_range: Floats

    @classmethod
    def unknown(cls, turned: Floats, minimum_tilt: Floats, held: Floats, back: Floats) -> "Evidence":
        """Return the evidence without comparisons: these are NaN."""
        count = len(turned)
        returns, latest, before = np.full((3, count, LAGS), np.nan)
        change, lag = Trend.unknown(count), Trend.unknown(count)
        return cls(
            turned, minimum_tilt, held, back, returns, latest, before, change, lag, lag_range=np.full(count, np.nan)
        )

    def repeats_after(self, rules: OutcomeRules) -> npt.NDArray[np.int8]:
        """Return the smallest number of periods after which each run repeats; 0 if there is none.

        A run that repeats after several periods must not nearly repeat before: a transient does.
        """
        repeats: Bools = self.returns < rules.repeat_tolerance
        apart = np.fmin.accumulate(self.returns, axis=1) >= rules.modulation_floor
        repeats[:, 1:] &= apart[:, :-1]
        return np.asarray(np.where(repeats.any(axis=1), repeats.argmax(axis=1) + 1, 0), dtype=np.int8)

    @property
    def nearest(self) -> npt.NDArray[np.int8]:
        """The number of periods, from 2, after which each run returns most closely."""
        several = np.nan_to_num(self.returns[:, 1:], nan=np.inf)
        return np.asarray(np.argmin(several, axis=1) + 2, dtype=np.int8)

    def at_nearest(self, returns: Floats) -> Floats:
        """Return the closest return after several periods."""
        return np.take_along_axis(returns, self.nearest[:, np.newaxis].astype(np.intp) - 1, axis=1)[:, 0]


def steady_periods(rules: OutcomeRules) -> int:
    """Return the number of periods from which a motion that does not repeat can be classified."""
    return max(rules.steady_periods, 2 * rules.periods + 1, rules.periods + LAGS + 1, 2 * _LEAST_PAIRS)


def grounds(evidence: Evidence, rules: OutcomeRules) -> npt.NDArray[np.int8]:
    """Return the `Ground` of the outcome of each run."""
    n, after = rules.periods, evidence.repeats_after(rules)
    turned = np.abs(evidence.turned)
    off = np.abs(turned / n - 1.0)
    tilted = evidence.minimum_tilt > rules.rest_tilt
    follows = tilted & (off * n < _LESS_THAN_ONE_TURN) & (evidence.lag_range < _ONE_TURN)
    changes = evidence.change.exceeds(math.log1p(rules.settled_tolerance), rules.sampling_errors)
    drifts = evidence.lag.exceeds(rules.frequency_tolerance * evidence.lag.window, rules.sampling_errors)
    chosen = np.select(
        [
            (after == 1) & tilted & (off < rules.frequency_tolerance),
            (after == 1) & (turned < rules.frequency_tolerance * n),
            after > 0,
            evidence.held < steady_periods(rules),
            changes & (evidence.change.slope < 0.0),
            changes,
            _nears_orbit(evidence, rules),
            evidence.returns[:, 0] < rules.modulation_floor,
            follows & drifts,
            follows,
        ],
        [
            Ground.ROLLS,
            Ground.ROCKS,
            Ground.REPEATS,
            Ground.SHORT_FOR_STEADY,
            Ground.SETTLES,
            Ground.GROWS,
            Ground.NEARS_ORBIT,
            Ground.NEARLY_REPEATS,
            Ground.DRIFTS,
            Ground.MODULATED,
        ],
        Ground.APERIODIC,
    )
    return chosen.astype(np.int8)


def _nears_orbit(evidence: Evidence, rules: OutcomeRules) -> Bools:
    """Return which runs approach an orbit of several periods."""
    latest, before = (evidence.at_nearest(each) for each in (evidence.returns_latest, evidence.returns_before))
    near = latest < _NEAR * evidence.returns_latest[:, 0]
    approaches = near & ~(latest > _NEARER * before)
    return np.asarray(approaches | (evidence.at_nearest(evidence.returns) < rules.modulation_floor))


def reason_on(ground: Ground, evidence: Evidence | None, rules: OutcomeRules, period: float) -> str:
    """Return the reason of the ground of one run.

    Parameters
    ----------
    ground
        The ground.
    evidence
        Evidence of this run alone; None if its last periods were not completed.
    rules
        Thresholds.
    period
        Period of the base motion [s].
    """
    steady, short = steady_periods(rules), rules.periods + 1
    needed = short if evidence is None else _periods_needed(ground, evidence, rules)
    after = 0 if evidence is None else int(evidence.repeats_after(rules)[0] or evidence.nearest[0])
    return _VERDICTS[ground][1].format(
        n=rules.periods,
        short=short,
        steady=steady,
        most=LAGS,
        after="each period" if after == 1 else f"{after} periods",
        needed=_rounded_up(needed * period),
    )


def _periods_needed(ground: Ground, evidence: Evidence, rules: OutcomeRules) -> float:
    """Return the number of periods that suffices for an outcome of a run; twice the run if no decay shows it."""
    steady, held = float(steady_periods(rules)), float(evidence.held[0])
    fall, left = 0.0, math.inf
    if ground is Ground.SETTLES:
        fall, left = -float(evidence.change.slope[0]), float(evidence.returns[0, 0])
    if ground is Ground.NEARS_ORBIT and evidence.back[0] > 0.0:
        left, before = (float(evidence.at_nearest(each)[0]) for each in (evidence.returns, evidence.returns_before))
        fall = math.log(before / left) / float(evidence.back[0]) if 0.0 < left < before else 0.0
    if ground is Ground.SHORT_FOR_STEADY:
        return steady
    if fall <= 0.0:
        return 2.0 * held
    return held + _MARGIN * max(math.log(left / rules.repeat_tolerance), 0.0) / fall + 1.0


def _rounded_up(value: float) -> float:
    """Round a number that is not negative up to four digits.

    >>> _rounded_up(43.98229715), _rounded_up(0.0)
    (43.99, 0.0)
    """
    if value == 0.0:
        return 0.0
    digits = 3 - math.floor(math.log10(value))
    return math.ceil(value * 10.0**digits * (1.0 - SLACK)) / 10.0**digits
