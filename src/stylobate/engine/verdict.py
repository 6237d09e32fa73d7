"""Outcome of a run: duration and survival, rules for the last periods, and doubt."""

import math
from collections.abc import Mapping
from dataclasses import asdict
from itertools import product

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import BaseMotion
from stylobate.base_motions.combined import members_of
from stylobate.base_motions.declared import numbers_of_motion
from stylobate.elementwise import cos, sin
from stylobate.engine.ensembles.late import RETURNS_BEFORE, Ground, Late, Rules
from stylobate.engine.kernel.columns import LAGS, SLACK
from stylobate.engine.parameters import changed_motion
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


def duration_of_runs(model: Model, motion: BaseMotion, ends: Mapping[str, tuple[float, float]]) -> float:
    """Return the duration of runs that state none [s]: the longest of their base motions, and 20/p of `model`.

    Parameters
    ----------
    model, motion
        Model and base motion of the runs.
    ends
        Smallest and largest value of each number that varies between the runs.

    Raises
    ------
    ParameterError
        If the base is at rest, or a base motion does not end.
    """
    longest = 0.0
    for one in members_of(motion):
        lasting = {**numbers_of_motion(one), "delay": None}
        varied = {name: pair for name, pair in ends.items() if name.removeprefix("motion.") in lasting}
        for corner in product(*varied.values()):
            longest = max(longest, changed_motion(one, dict(zip(varied, corner, strict=True))).duration)
    if not 0.0 < longest < math.inf:
        what = "a base at rest" if longest == 0.0 else "a base motion that does not end"
        raise ParameterError(f"duration: missing for {what} (got None). State it in s, such as duration=60.0.")
    return duration_with_tail(longest, model.column.frequency_parameter)


def survival(model: Model, motion: BaseMotion, trajectory: Trajectory) -> tuple[Outcome, str]:
    """Return outcome and reason of a column that moves at the end of a run, after its base motion or without any.

    After the base motion the energy of a column can only fall, see `energy_over_balance`. A column that can no longer
    overturn has the outcome SURVIVED, or STILL_MOVING if there was no base motion.
    """
    end = trajectory.end * model.time_scale
    if not has_ended(end, motion.duration):
        return Outcome.STILL_MOVING, BEFORE_END.format(left=motion.duration - end)
    after = max(0.0, end - motion.duration)
    moving = AFTER_END.format(after=after) if motion.duration > 0.0 else MOVING
    push = remaining_acceleration(motion) / model.column.gravity
    share = float(energy_over_balance(model, trajectory.own_states(np.array([trajectory.end])), push)[0])
    if share >= 1.0:
        return Outcome.STILL_MOVING, moving + OPEN
    outcome = Outcome.SURVIVED if motion.duration > 0.0 else Outcome.STILL_MOVING
    return outcome, moving + SAFE.format(share=100.0 * share)


MOVING = "still moving"
OPEN = "; it may overturn later: simulate longer"
BEFORE_END = f"{MOVING}, {{left:.4g}} s before the base motion ends{OPEN}"
AFTER_END = f"{MOVING} {{after:.4g}} s after the base motion ended"
SAFE = ", but it cannot overturn any more: it has {share:.2g} % of the energy required"
"""Reasons of a column that moves at the end of a run, with gaps for numbers."""


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


# Minimum number of pairs for a trend and its error.
_LEAST_PAIRS = 8
_FOUR_DIGITS = 1000.0
# Safety factor of the duration in which a transient decays.
_MARGIN = 1.1


_LONGER = "set duration to at least {needed:.10g} s"
VERDICTS = {
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
    return VERDICTS[ground][0]


def steady_periods(rules: OutcomeRules) -> int:
    """Return the number of periods from which a motion that does not repeat can be classified."""
    return max(rules.steady_periods, 2 * rules.periods + 1, rules.periods + LAGS + 1, 2 * _LEAST_PAIRS)


def numbers_of_rules(rules: OutcomeRules) -> Rules:
    """Return the numbers by which the last periods of a run decide its outcome."""
    return Rules(**{**asdict(rules), "steady_periods": steady_periods(rules)})


def reason_on(late: Floats, rules: OutcomeRules, period: float) -> str:
    """Return the reason of the ground of one run that moves at its end.

    Parameters
    ----------
    late
        The numbers of `Late` of this run.
    rules
        Thresholds.
    period
        Period of the base motion [s].
    """
    steady, short = steady_periods(rules), rules.periods + 1
    after = 0 if math.isnan(late[Late.SPAN]) else int(late[Late.REPEATS_AFTER] or late[Late.NEAREST])
    return VERDICTS[Ground(int(late[Late.GROUND]))][1].format(
        n=rules.periods,
        short=short,
        steady=steady,
        most=LAGS,
        after="each period" if after == 1 else f"{after} periods",
        needed=duration_needed(late, rules, period),
    )


def duration_needed(late: Floats, rules: OutcomeRules, period: float) -> float:
    """Return the duration that suffices for an outcome of a run that moves at its end [s]; see `reason_on`."""
    periods = rules.periods + 1 if math.isnan(late[Late.SPAN]) else _periods_needed(late, rules)
    return _rounded_up(periods * period)


def _periods_needed(late: Floats, rules: OutcomeRules) -> float:
    """Return the number of periods that suffices for an outcome of a run; twice the run if no decay shows it."""
    ground, held = int(late[Late.GROUND]), float(late[Late.HELD])
    at, back = int(late[Late.NEAREST]) - 1, float(late[Late.BACK])
    fall, left = 0.0, math.inf
    if ground == Ground.SETTLES:
        fall, left = -float(late[Late.CHANGE_SLOPE]), float(late[Late.RETURNS])
    if ground == Ground.NEARS_ORBIT and back > 0.0:
        left, before = float(late[Late.RETURNS + at]), float(late[RETURNS_BEFORE + at])
        fall = math.log(before / left) / back if 0.0 < left < before else 0.0
    if ground == Ground.SHORT_FOR_STEADY:
        return float(steady_periods(rules))
    if fall <= 0.0:
        return 2.0 * held
    return held + _MARGIN * max(math.log(left / rules.repeat_tolerance), 0.0) / fall + 1.0


def _rounded_up(value: float) -> float:
    """Round a number that is not negative up to four digits.

    >>> _rounded_up(43.98229715), _rounded_up(0.0)
    (43.99, 0.0)
    """
    part, unit = 1.0, 1.0  # of the fourth digit: its reciprocal below 1, itself above
    while 0.0 < value * part < _FOUR_DIGITS:
        part = 10.0 * part
    while value >= 10.0 * _FOUR_DIGITS * unit:
        unit = 10.0 * unit
    return math.ceil(value * part / unit * (1.0 - SLACK)) * unit / part


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
