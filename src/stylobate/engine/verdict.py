"""Outcome of a run: duration and survival, rules for the last periods, and doubt."""

import math
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import BaseMotion
from stylobate.elementwise import cos, sin
from stylobate.engine.kernel.columns import LAGS, SLACK
from stylobate.engine.trajectory import Trajectory
from stylobate.errors import Outcome, ParameterError, require_positive
from stylobate.models import Model
from stylobate.models.model import belongs_to_equations
from stylobate.results import OutcomeRules
from stylobate.run_arguments import RTOL_RANGE, duration_with_tail

Floats = npt.NDArray[np.float64]


MOST_PERIODS = 2000
"""Maximum number of periods of a run that is followed until its outcome is decided."""


def duration_of(duration: float | None, model: Model, motion: BaseMotion, rules: OutcomeRules) -> float:
    """Return the duration of a run [s]: `duration`, or the base motion and a free-vibration tail of 20/p.

    Under a periodic motion that never ends, the default is the duration after which most outcomes are known.

    Raises
    ------
    ParameterError
        If the duration is not positive; or if there is none, and the base is at rest or moves for ever without period.
    """
    if duration is not None:
        return require_positive("duration", duration, "s")
    if motion.duration == math.inf and motion.period is not None:
        return steady_periods(rules) * motion.period
    if not 0.0 < motion.duration < math.inf:
        what = "a base at rest" if motion.duration == 0.0 else "a base motion that never ends and has no period"
        raise ParameterError(f"duration must be given, in s, with {what}, such as duration=60.0; got None")
    return duration_with_tail(motion.duration, model.column.frequency_parameter)


def survival(model: Model, motion: BaseMotion, trajectory: Trajectory) -> tuple[Outcome, str]:
    """Return outcome and reason of a column that moves at the end of a run, after its base motion or without any.

    After the base motion the energy of a column can only fall, see `energy_over_balance`. A column that can no longer
    overturn has the outcome SURVIVED, or STILL_MOVING if there was no base motion.
    """
    end = trajectory.end * model.time_scale
    if not has_ended(end, motion.duration):
        left = motion.duration - end
        return Outcome.STILL_MOVING, f"still moving, {left:.4g} s before the base motion ends; {_OPEN}"
    after = max(0.0, end - motion.duration)
    moving = f"still moving {after:.4g} s after the base motion ended" if motion.duration > 0.0 else "still moving"
    push = remaining_acceleration(motion) / model.column.gravity
    share = float(energy_over_balance(model, trajectory.own_states(np.array([trajectory.end])), push)[0])
    if share >= 1.0:
        return Outcome.STILL_MOVING, f"{moving}; {_OPEN}"
    outcome = Outcome.SURVIVED if motion.duration > 0.0 else Outcome.STILL_MOVING
    return outcome, f"{moving}, but it cannot overturn any more: it has {100.0 * share:.2g} % of the energy required"


_OPEN = "it may overturn later: simulate longer"


def has_ended(time: npt.ArrayLike, duration: npt.ArrayLike) -> npt.NDArray[np.bool_]:
    """Return whether base motions of these durations have ended at these times [s]."""
    return np.asarray(np.asarray(time) * (1.0 + SLACK) >= np.asarray(duration))


def remaining_acceleration(motion: BaseMotion) -> float:
    """Return sup |a_h| after the end of a base motion [m/s²]: 0 on a level base."""
    return motion.peak_horizontal(math.nextafter(motion.duration, math.inf)) if motion.duration < math.inf else 0.0


def energy_over_balance(model: Model, states: Floats, push: npt.ArrayLike = 0.0) -> Floats:
    """Return the energy over that required to overturn, shape (n,), for `states` of shape (number of states, n).

    A column with a smaller tilt and less energy than at its balance, at the tilt α, cannot overturn on a base at rest.
    A constant horizontal acceleration, `push` in g, lowers the energy at the balance by at most push²/2 m g R, and does
    at most the work 2 push sin α m g R between the balances of both sides; the energy of the balance is 1 − cos α. The
    result is infinite beyond the balance, and for a model without its own `balance`.
    """
    balance, energy = model.balance, model.energy(states)
    if balance is None or energy is None or not belongs_to_equations(type(model), "balance", "energy"):
        return np.full(states.shape[1], math.inf)
    required = np.broadcast_to(balance.energy, states.shape[1])
    if np.all(balance.tilt < math.inf):
        a, rise = np.asarray(push), 1.0 - cos(balance.tilt)
        required = required * (1.0 - (2.0 * a * sin(balance.tilt) + 0.5 * a * a) / rise)
    share = np.divide(energy, required, out=np.full(states.shape[1], math.inf), where=required > 0.0)
    return np.where(np.hypot(*model.tilt(states)) < balance.tilt, share, math.inf)


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
    after = 0 if evidence is None else int(evidence.repeats_after(rules)[0] or evidence.nearest[0])
    return _VERDICTS[ground][1].format(
        n=rules.periods,
        short=short,
        steady=steady,
        most=LAGS,
        after="each period" if after == 1 else f"{after} periods",
        needed=duration_needed(ground, evidence, rules, period),
    )


def duration_needed(ground: Ground, evidence: Evidence | None, rules: OutcomeRules, period: float) -> float:
    """Return the duration that suffices for an outcome of a run that moves at its end [s]; see `reason_on`."""
    periods = rules.periods + 1 if evidence is None else _periods_needed(ground, evidence, rules)
    return _rounded_up(periods * period)


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


FINER_REST = 0.01
"""Factor of the rest energy when a run is repeated."""

FINER_PASSAGE = 0.5
"""Factor of the passage tilt when a run is repeated."""

LARGE_TILT = 0.5
"""A column that is uplifted from rest again is in doubt if it tilts beyond this fraction of its tipping angle."""

NEAR_BALANCE = 0.95
"""A column that comes back from beyond this fraction of its tipping angle is in doubt."""

LATE = 40.0
"""A column that overturns after this many units of its time is in doubt, because small changes had time to grow."""

FALLEN = (Outcome.OVERTURNED, Outcome.LIMIT_REACHED)
"""Outcomes that differ from all others: only a change from these to others, or back, makes a run uncertain."""

UNSETTLED = (Outcome.AT_REST, Outcome.SURVIVED, Outcome.STILL_MOVING, Outcome.APERIODIC)
"""Outcomes of motions whose peak tilt is that of a transient or of an aperiodic motion."""

MANY_PASSAGES = 40
"""A single run that passes the vertical more often is repeated: at each passage small changes can grow."""

FIRST_DIGIT = 0.1
"""A peak tilt that changes by this fraction when the run is repeated has no certain digit."""

_OTHER_TOLERANCE = 10.0


def in_doubt(
    *,
    overturned: npt.ArrayLike,
    decided: npt.ArrayLike,
    peak_tilt: npt.ArrayLike,
    released_again: npt.ArrayLike,
    widest_loss: npt.ArrayLike,
    passage_tilt: npt.ArrayLike,
    slenderness: npt.ArrayLike,
) -> npt.NDArray[np.bool_]:
    """Return whether finer thresholds or another tolerance could give another outcome; arguments of one shape.

    Parameters
    ----------
    overturned
        Whether the column overturned.
    decided
        Dimensionless time at which the outcome was decided.
    peak_tilt
        Peak tilt [rad].
    released_again
        Whether the column came to rest in the run and was uplifted again.
    widest_loss, passage_tilt
        Largest distance from the vertical of the passages that lost energy, and the limit of such distances [rad].
    slenderness
        c = tan α_c.
    """
    fell, again = np.asarray(overturned), np.asarray(released_again)
    share = np.asarray(peak_tilt) / np.arctan(np.asarray(slenderness, dtype=float))
    resting = again & (fell | (share > LARGE_TILT))
    moving = np.where(fell, np.asarray(decided) > LATE, share > NEAR_BALANCE)
    passing = np.asarray(widest_loss) > FINER_PASSAGE * np.asarray(passage_tilt)
    return np.asarray(resting | moving | passing)


def other_tolerance(rtol: float) -> float:
    """Return the relative tolerance for a repeated run: ten times `rtol`, at most the largest valid tolerance."""
    return min(_OTHER_TOLERANCE * rtol, RTOL_RANGE[1])
