"""Convergence of a run to a periodic orbit that is known beforehand, by which the run ends before its duration.

At each phase zero of the base motion the distance of the state from the orbit is measured, in units of the orbit's mean
tilt. Near the orbit this distance falls by the modulus ρ of the largest multiplier in each period, but for oscillations
of complex multipliers. So the largest distances within successive windows of m periods are compared, of which each must
be ρ^m times the one before, within a margin. The dense output of the step gives the state: no step is changed.
"""

import math

from stylobate.engine.kernel.bound import ORBITS, ORBITS_AT, SPIN, R
from stylobate.engine.kernel.columns import ORBIT, SLACK, Orbit
from stylobate.engine.kernel.driver.equations import lean_of_new
from stylobate.engine.kernel.driver.release_search import repeats_to_the_end
from stylobate.engine.kernel.driver.within import set_dense_output, set_within, set_within_closely
from stylobate.engine.kernel.layout import Table

Approach = tuple[float, float, float, float]
"""Largest distance in the window before; the same in the present window; its periods so far; windows that fell."""

# Distance from an orbit within which disturbances are taken to follow its multipliers.
NEAR = 0.03
# The largest distance of a window agrees with ρ^m times the one before within this factor.
MARGIN = 1.6
# So many successive windows must fall as the multipliers demand.
WINDOWS = 3.0
# Distances below this are those of a run on the orbit: rounding and tolerance keep them from falling further.
ON_ORBIT = 1e-6
# At distances above this a run is not compared with an orbit.
FAR = 0.2
# Cubics through the ends of a step, by which distances are estimated first, are in error by less than this.
OF_CUBICS = 0.1
# States one period apart must differ by less than this part of the tolerance with which the outcome is judged.
CERTAIN = 0.05


def approach_after(approach: Approach, distance: float, window: float, fall: float) -> Approach:
    """Continue the record of an approach by the distance one period later.

    Parameters
    ----------
    approach
        The record.
    distance
        Distance from the orbit.
    window
        Periods m of a window.
    fall
        ρ^m.
    """
    before, largest, periods, falls = approach
    largest, periods = max(largest, distance), periods + 1.0
    if periods < window:
        return before, largest, periods, falls
    demanded = fall * before
    follows = before <= NEAR and demanded <= MARGIN * largest and largest <= MARGIN * demanded
    stays = largest <= ON_ORBIT and before <= NEAR
    return largest, 0.0, 0.0, falls + 1.0 if follows or stays else 0.0


def is_certain(approach: Approach, fall_to_judgement: float, repeats: float) -> bool:
    """Return whether a run has converged, and will repeat when its outcome is judged.

    Parameters
    ----------
    approach
        The record.
    fall_to_judgement
        Factor by which the distance falls until the last periods begin, by which the outcome is judged.
    repeats
        Largest difference of states one period apart, in units of the largest state, of a motion that repeats.
    """
    largest, _, periods, falls = approach
    return periods == 0.0 and falls >= WINDOWS and largest * fall_to_judgement <= CERTAIN * repeats


def watch_from(buf: Table, i: int, table: Table) -> None:
    """Begin to watch the run of a lane."""
    run = int(buf[R.RUN, i])
    for k in range(ORBITS):
        first = R.ORBIT + k * ORBIT
        for column in range(ORBIT):
            buf[first + column, i] = table[run, ORBITS_AT + k * ORBIT + column]
        forget(buf, i, k)
    buf[R.CONVERGED, i] = 0.0
    buf[R.PHASE_ZERO_AT, i] = math.inf
    if latest(buf, i) > buf[R.TIME, i]:
        set_phase_zero(buf, i)


def set_phase_zero(buf: Table, i: int) -> None:
    """Set the next time at which the base motion has phase zero; none too late for a run to end early."""
    t, period, first = buf[R.TIME, i], buf[R.PERIOD, i], buf[R.STROBE, i]
    following = first + (math.floor((t - first) / period + SLACK) + 1.0) * period
    buf[R.PHASE_ZERO_AT, i] = following if following < judged_from(buf, i) else math.inf


def judged_from(buf: Table, i: int) -> float:
    """Return when the last periods begin, by which the outcome is judged."""
    return buf[R.END, i] - (buf[R.PERIODS, i] + 1.0) * buf[R.PERIOD, i]


def forget(buf: Table, i: int, k: int) -> None:
    """Forget the approach to an orbit."""
    set_approach(buf, i, k, (math.inf, 0.0, 0.0, 0.0))


def set_approach(buf: Table, i: int, k: int, approach: Approach) -> None:
    first = R.ORBIT + k * ORBIT + Orbit.BEFORE
    for column in range(4):
        buf[first + column, i] = approach[column]


def watch(buf: Table, i: int, table: Table) -> None:
    """Measure the distances from the known orbits after a step past phase zero; flag a run that has converged."""
    end, h = buf[R.TIME, i], buf[R.MADE, i]
    elapsed = buf[R.PHASE_ZERO_AT, i] - (end - h)
    set_phase_zero(buf, i)
    if elapsed < 0.0:  # the column stood, or passed the upright in closed form
        for k in range(ORBITS):
            forget(buf, i, k)
        return
    set_within(buf, i, elapsed)
    closest = math.inf
    for k in range(ORBITS):
        closest = min(closest, distance_of_new(buf, i, k))
    if end > latest(buf, i) and closest > NEAR + OF_CUBICS:
        buf[R.PHASE_ZERO_AT, i] = math.inf
        return
    near = closest < FAR + OF_CUBICS
    if near:
        set_dense_output(buf, i)
        set_within_closely(buf, i, elapsed)
    for k in range(ORBITS):
        distance = distance_of_new(buf, i, k) if near else math.inf
        if distance < FAR:
            if approaches(buf, i, k, distance):
                table[int(buf[R.RUN, i]), ORBITS_AT + k * ORBIT + Orbit.REACHED] = 1.0
                buf[R.CONVERGED, i] = 1.0
                buf[R.FLAG, i] = 2.0  # more than a stop reached, which may be a knot that is passed
        else:
            forget(buf, i, k)


def latest(buf: Table, i: int) -> float:
    """Return the last time at which a run that is not near an orbit can still converge to it before it is judged."""
    last = -math.inf
    for k in range(ORBITS):
        last = max(last, buf[R.ORBIT + k * ORBIT + Orbit.LATEST, i])
    return last


def distance_of_new(buf: Table, i: int, k: int) -> float:
    """Return the distance of the new state from an orbit; NaN where the run has no such orbit."""
    first = R.ORBIT + k * ORBIT
    x, y, vx, vy = lean_of_new(buf, i)
    size, rate = buf[first + Orbit.SIZE, i], buf[first + Orbit.RATE, i]
    x, y = (x - buf[first + Orbit.X, i]) / size, (y - buf[first + Orbit.Y, i]) / size
    vx, vy = (vx - buf[first + Orbit.VX, i]) / rate, (vy - buf[first + Orbit.VY, i]) / rate
    square = x * x + y * y + vx * vx + vy * vy
    if SPIN >= 0:
        square += ((buf[R.NEW + SPIN, i] - buf[first + Orbit.SPIN, i]) / rate) ** 2
    return math.sqrt(square)


def approaches(buf: Table, i: int, k: int, distance: float) -> bool:
    """Note the distance from an orbit; return whether the run has converged to it."""
    first = R.ORBIT + k * ORBIT
    before = first + Orbit.BEFORE
    approach = buf[before, i], buf[before + 1, i], buf[before + 2, i], buf[before + 3, i]
    approach = approach_after(approach, distance, buf[first + Orbit.WINDOW, i], buf[first + Orbit.FALL, i])
    set_approach(buf, i, k, approach)
    left = judged_from(buf, i) - buf[R.TIME, i]
    fall = math.exp(-buf[first + Orbit.DECAY, i] * left)
    return left >= 0.0 and is_certain(approach, fall, buf[first + Orbit.REPEATS, i]) and repeats_to_the_end(buf, i)
