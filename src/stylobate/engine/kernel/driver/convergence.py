"""Convergence of a run to a known periodic orbit, which ends the run before its duration.

At each phase zero of the base motion `watch` measures the distance of the state from the orbit, in units of the mean
tilt of the orbit. Near the orbit the distance falls in each period by the factor ρ, the modulus of the largest
multiplier; complex multipliers add oscillations. Therefore the largest distances within successive windows of m periods
are compared: each must be ρ^m times the previous one, within a margin. The dense output gives the state, so that no
step changes.
"""

import math

from stylobate.engine.kernel.bound import ORBITS, ORBITS_AT, SPIN, R
from stylobate.engine.kernel.columns import ORBIT, SLACK, Orbit
from stylobate.engine.kernel.driver.equations import lean_of_new
from stylobate.engine.kernel.driver.release_search import repeats_to_the_end
from stylobate.engine.kernel.driver.within import set_dense_output, set_within, set_within_closely
from stylobate.engine.kernel.layout import Table

Approach = tuple[float, float, float, float]
"""Largest distances in the previous and in the present window, periods of the present window so far, and number of
successive windows that fell as the multipliers demand."""

# Distance from an orbit within which perturbations are assumed to follow its multipliers.
NEAR = 0.03
# The largest distance of a window agrees with ρ^m times the previous one within this factor.
MARGIN = 1.6
# Number of successive windows that must fall as the multipliers demand.
WINDOWS = 3.0
# A run is on the orbit below this distance: rounding and tolerance prevent smaller distances.
ON_ORBIT = 1e-6
# A run is not compared with an orbit above this distance.
FAR = 0.2
# Maximum error of the first estimates of distances, by cubics through the ends of a step.
OF_CUBICS = 0.1
# States one period apart must differ by less than this fraction of the tolerance that decides the outcome.
CERTAIN = 0.05


def approach_after(approach: Approach, distance: float, window: float, fall: float) -> Approach:
    """Update the record of an approach with the distance one period later.

    Parameters
    ----------
    approach
        The record.
    distance
        Distance from the orbit.
    window
        Number m of periods in a window.
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
    """Return whether a run has converged and will repeat when its outcome is decided.

    Parameters
    ----------
    approach
        The record.
    fall_to_judgement
        Factor by which the distance falls before the last periods, which decide the outcome.
    repeats
        Maximum difference of states one period apart of a repeating motion, in units of the largest state.
    """
    largest, _, periods, falls = approach
    return periods == 0.0 and falls >= WINDOWS and largest * fall_to_judgement <= CERTAIN * repeats


def start_watching(buf: Table, i: int, table: Table) -> None:
    """Start the comparison of the run of a lane with its known orbits."""
    run = int(buf[R.RUN, i])
    for k in range(ORBITS):
        first = R.ORBIT + k * ORBIT
        for column in range(ORBIT):
            buf[first + column, i] = table[run, ORBITS_AT + k * ORBIT + column]
        reset_approach(buf, i, k)
    buf[R.CONVERGED, i] = 0.0
    buf[R.PHASE_ZERO_AT, i] = math.inf
    if latest(buf, i) > buf[R.TIME, i]:
        set_phase_zero(buf, i)


def set_phase_zero(buf: Table, i: int) -> None:
    """Set the next time at which the base motion has phase zero; none if it is too late for a run to end early."""
    t, period, first = buf[R.TIME, i], buf[R.PERIOD, i], buf[R.STROBE, i]
    following = first + (math.floor((t - first) / period + SLACK) + 1.0) * period
    buf[R.PHASE_ZERO_AT, i] = following if following < judged_from(buf, i) else math.inf


def judged_from(buf: Table, i: int) -> float:
    """Return the start of the last periods, which decide the outcome."""
    return buf[R.END, i] - (buf[R.PERIODS, i] + 1.0) * buf[R.PERIOD, i]


def reset_approach(buf: Table, i: int, k: int) -> None:
    """Reset the record of the approach to an orbit."""
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
    if elapsed < 0.0:  # the column stood, or made an analytical step past the vertical
        for k in range(ORBITS):
            reset_approach(buf, i, k)
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
                buf[R.FLAG, i] += 1.0
        else:
            reset_approach(buf, i, k)


def latest(buf: Table, i: int) -> float:
    """Return the last time at which a run far from its orbits can still converge before its outcome is decided."""
    last = -math.inf
    for k in range(ORBITS):
        last = max(last, buf[R.ORBIT + k * ORBIT + Orbit.LATEST, i])
    return last


def distance_of_new(buf: Table, i: int, k: int) -> float:
    """Return the distance of the new state from an orbit; NaN if the run has no such orbit."""
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
    """Record the distance from an orbit; return whether the run has converged to the orbit."""
    first = R.ORBIT + k * ORBIT
    before = first + Orbit.BEFORE
    approach = buf[before, i], buf[before + 1, i], buf[before + 2, i], buf[before + 3, i]
    approach = approach_after(approach, distance, buf[first + Orbit.WINDOW, i], buf[first + Orbit.FALL, i])
    set_approach(buf, i, k, approach)
    left = judged_from(buf, i) - buf[R.TIME, i]
    fall = math.exp(-buf[first + Orbit.DECAY, i] * left)
    return left >= 0.0 and is_certain(approach, fall, buf[first + Orbit.REPEATS, i]) and repeats_to_the_end(buf, i)
