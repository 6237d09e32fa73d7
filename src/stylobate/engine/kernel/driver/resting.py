"""Rest: conditions of rest, standing, and uplift from rest."""

import math

from stylobate.engine.elementary import length
from stylobate.engine.kernel.bound import CAN_DEPART, CAN_GO_TO_PLANE, CAN_LOSE, PLANAR, SPIN, R
from stylobate.engine.kernel.driver.base_motion import forcing_rate, held_for_good
from stylobate.engine.kernel.driver.equations import lean_of_new, model_at_rest, model_departure, model_rest_energy
from stylobate.engine.kernel.driver.events import Status, TraceKind
from stylobate.engine.kernel.driver.moving import azimuth_now, is_at_rest, set_state, start_moving
from stylobate.engine.kernel.driver.push import Accelerations, accelerations
from stylobate.engine.kernel.driver.release import RELEASE_MARGIN
from stylobate.engine.kernel.driver.release_search import next_release, search_end
from stylobate.engine.kernel.driver.standing_loads import record_standing_loads
from stylobate.engine.kernel.driver.stops import leg_end, meet_stop, next_stop, set_next_stop, stand_to_the_end
from stylobate.engine.kernel.driver.tracing import trace_event, trace_stand
from stylobate.engine.kernel.driver.within import set_dense_output, set_within, set_within_closely
from stylobate.engine.kernel.layout import Table
from stylobate.engine.tolerances import CHATTER, DEPARTURE, SHORTEST_DEPARTURE, STILL, SWINGS_APART
from stylobate.models.model import Push


def holding_force(buf: Table, i: int, push: Accelerations) -> float:
    """Return the force that holds a standing column down; its future minimum, if that is not negative."""
    ax, ay, az = push
    force = buf[R.LEAST_FORCE, i]
    return force if force >= 0.0 else buf[R.CAPACITY, i] * (1.0 + az) - length(ax, ay)


def rest_margin(buf: Table, i: int, push: Accelerations, tilt: float, speed: float) -> float:
    """Return an indicator that is positive if a column of this tilt and speed comes to rest now."""
    force = holding_force(buf, i, push)
    energy = model_rest_energy(buf, i, tilt, speed, push[2])
    square = buf[R.SLENDERNESS, i] ** 2
    held = buf[R.LEAST_FORCE, i] >= 0.0
    share = buf[R.REST_ENERGY_FOR_GOOD, i] if held else buf[R.REST_ENERGY, i]
    small = share * square - energy
    if force < 0.0 and chatters(buf, i):
        return CHATTER * buf[R.REST_ENERGY, i] * square - energy
    if force < 0.0 or small <= 0.0:
        return min(force, small)
    # During a swing the force changes by 2 √(2 energy) times its rate; SWINGS_APART times this is less than force².
    apart = SWINGS_APART * forcing_rate(buf, i)
    dies = min(small, force**4 - 8.0 * max(energy, 0.0) * apart * apart)
    return max(min(share, STILL) * square - energy, dies) if held else dies


def chatters(buf: Table, i: int) -> bool:
    """Return whether passages can lose energy without end in a finite time: with losses, in three dimensions.

    A column with spin returns to the side from which it came. Its passages follow each other ever faster, although the
    base pushes harder than the column can resist; once the energy is negligible, it stands, and uplift follows at once.
    """
    return CAN_LOSE and not PLANAR and buf[R.PASSAGE_TILT, i] > 0.0


def rest_within_step(buf: Table, i: int) -> float:
    """Return the time within the step just made at which the column came to rest, or NaN.

    Cubics show whether the column may have come to rest; the dense output decides whether it did, and when.
    """
    h = buf[R.MADE, i]
    start = buf[R.TIME, i] - h
    before = 0.0
    closely = False
    for k in range(5):
        u = 0.25 * k
        rests = margin_within_step(buf, i, start, h, u, closely) > 0.0
        if rests and k == 0:
            return start
        if rests and not closely:
            set_dense_output(buf, i)
            closely = True
            rests = margin_within_step(buf, i, start, h, u, closely) > 0.0
        if rests:
            return start + first_rest(buf, i, start, h, before, u) * h
        before = u
    return math.nan


def first_rest(buf: Table, i: int, start: float, h: float, low: float, high: float) -> float:
    """Return the fraction of the step at which the column came to rest, between two fractions."""
    for _ in range(40):
        middle = 0.5 * (low + high)
        if margin_within_step(buf, i, start, h, middle, True) > 0.0:
            high = middle
        else:
            low = middle
    return high


def margin_within_step(buf: Table, i: int, start: float, h: float, u: float, closely: bool) -> float:
    """Return `rest_margin` at a fraction of the step, from cubics or, if `closely`, from the dense output."""
    push = accelerations(buf, i, start + u * h)
    force = holding_force(buf, i, push)
    if force <= 0.0 and not chatters(buf, i):  # then the margin is not positive either
        return force
    if closely:
        set_within_closely(buf, i, u * h)
    else:
        set_within(buf, i, u * h)
    x, y, vx, vy = lean_of_new(buf, i)
    margin = rest_margin(buf, i, push, length(x, y), length(vx, vy))
    return margin if force > 0.0 else min(margin, -(x * vx + y * vy))


def settle(buf: Table, i: int, table: Table, pieces: Table, t: float) -> int:
    """Come to rest at `t`; return as `stand` does. A column that stands for an instant only keeps its spin."""
    spin = 0.0
    if not PLANAR:
        buf[R.LAST_AZIMUTH, i] = azimuth_now(buf, i)
        if SPIN >= 0 and holding_force(buf, i, accelerations(buf, i, t)) < 0.0:
            spin = buf[R.STATE + SPIN, i]
    set_state(buf, i, model_at_rest(buf, i))
    if not PLANAR and SPIN >= 0:
        buf[R.STATE + SPIN, i] = spin
    trace_event(buf, i, table, TraceKind.REST, t)
    buf[R.STANDS, i] = 1.0
    buf[R.RESTS, i] += 1.0
    buf[R.REACHED_VERTICAL, i] = 1.0
    return stand(buf, i, table, pieces, t)


def stand(buf: Table, i: int, table: Table, pieces: Table, t: float) -> int:
    """Stand from `t` until uplift; return WAITING if the column moves again, else the final status."""
    trace_stand(buf, i, table, t)
    release = release_within_leg(buf, i, t)
    while True:
        if held_for_good(buf, i):
            buf[R.DECIDED, i] = t
            return stand_to_the_end(buf, i, table, pieces, t)
        if math.isnan(release):
            buf[R.TIME, i] = search_end(buf, i, t)
            return Status.UNSEEN
        stop = next_stop(buf, i)
        t = stop
        if release < stop:
            if 1.0 + accelerations(buf, i, release)[2] <= RELEASE_MARGIN:  # lift-off, not uplift
                buf[R.TIME, i] = release
                return Status.LIFTED
            if not CAN_DEPART:
                return Status.CANNOT_DEPART
            t = min(depart(buf, i, release), buf[R.END, i])
            if t < buf[R.END, i]:
                buf[R.RELEASES, i] += 1.0
                trace_event(buf, i, table, TraceKind.RELEASE, release)
                if not is_at_rest(buf, i):
                    return leave_rest(buf, i, table, pieces, t)
        buf[R.TIME, i] = t
        # Stops within a leg do not cut the search, so that samples do not change a run.
        again = release < stop or t >= leg_end(buf, i)
        while next_stop(buf, i) <= t:
            status = meet_stop(buf, i, table, pieces, next_stop(buf, i))
            if status != Status.WAITING:
                return status
        if again:
            release = release_within_leg(buf, i, t)


def release_within_leg(buf: Table, i: int, t: float) -> float:
    """Return `next_release`, and record the contact loads until then.

    Loads are computed by legs, not by stops, so that samples do not change them.
    """
    release = next_release(buf, i, t)
    # min keeps the first argument if the release is NaN.
    record_standing_loads(buf, i, t, min(search_end(buf, i, t), release))
    return release


def depart(buf: Table, i: int, release: float) -> float:
    """Set the state a short time after uplift, and return that time.

    The series needs the mean rate of the push over its first two thirds; a break of the base motion ends it early.
    """
    usual = DEPARTURE / (1.0 + buf[R.FREQUENCY, i])
    elapsed = min(usual, max(leg_end(buf, i) - release, SHORTEST_DEPARTURE * usual))
    apart = elapsed * (2.0 / 3.0)
    ax, ay, az = accelerations(buf, i, release)
    bx, by, bz = accelerations(buf, i, release + apart)
    ux, uy = buf[R.LINE_X, i], buf[R.LINE_Y, i]
    if PLANAR:
        ax, ay, bx, by = ax * ux, ax * uy, bx * ux, bx * uy
    here, there = math.hypot(ax, ay), math.hypot(bx, by)
    c = buf[R.SLENDERNESS, i]
    over = max(here - c * (1.0 + az), 0.0)
    rate = (there - c * (1.0 + bz) - over) / apart
    turning = math.atan2(ax * by - ay * bx, ax * bx + ay * by) / apart
    push = Push((-ax / here, -ay / here), here, over, rate, turning)
    spin = buf[R.STATE + SPIN, i] if not PLANAR and SPIN >= 0 else 0.0
    set_state(buf, i, model_departure(buf, i, push, elapsed, ux, uy))
    if not PLANAR and SPIN >= 0 and not is_at_rest(buf, i):
        buf[R.STATE + SPIN, i] += spin
    return release + elapsed


def leave_rest(buf: Table, i: int, table: Table, pieces: Table, t: float) -> int:
    """Continue with motion from the state after uplift at `t`."""
    # Samples within this time show a standing column: the displacement is of third order in the time.
    while next_stop(buf, i) <= t:
        meet_stop(buf, i, table, pieces, next_stop(buf, i))
    if buf[R.RESTS, i] > 0.0:
        buf[R.RELEASED_FROM_REST, i] = 1.0
    buf[R.TIME, i] = t
    if CAN_GO_TO_PLANE and (buf[R.LINE_X, i] != 0.0 or buf[R.LINE_Y, i] != 0.0):
        buf[R.STANDS, i] = 0.0
        return Status.TO_PLANE
    start_moving(buf, i, t, 0.0)
    set_next_stop(buf, i)
    return Status.WAITING
