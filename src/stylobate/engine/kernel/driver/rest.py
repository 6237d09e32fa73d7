"""Rest of a column and its end: search for uplift and lift-off, conditions of rest, and standing."""

import math

from stylobate.engine.elementary import length
from stylobate.engine.kernel.bound import (
    CAN_DEPART,
    CAN_GO_TO_PLANE,
    CAN_LOSE,
    DEGREE,
    PLANAR,
    SPIN,
    VERTICAL,
    R,
    Table,
)
from stylobate.engine.kernel.driver.equations import (
    Accelerations,
    accelerations,
    forcing_rate,
    held_for_good,
    lean_of_new,
    model_at_rest,
    model_departure,
    model_rest_energy,
    set_leg,
)
from stylobate.engine.kernel.driver.events import RunStatus, TraceKind
from stylobate.engine.kernel.driver.motion import azimuth_now, is_at_rest, set_state, start_moving
from stylobate.engine.kernel.driver.records import (
    leg_end,
    meet_stop,
    next_stop,
    record_standing_loads,
    set_break,
    set_next_stop,
    stand_to_the_end,
    trace_event,
    trace_stand,
)
from stylobate.engine.kernel.driver.stages import set_dense_output, set_within, set_within_closely
from stylobate.engine.tolerances import CHATTER, DEPARTURE, SAMPLES_PER_PERIOD, SHORTEST_DEPARTURE, STILL, SWINGS_APART
from stylobate.models.model import Push


def find_lift(buf: Table, i: int, table: Table, pieces: Table) -> None:
    """Set the time at which the base begins to fall faster than gravity."""
    buf[R.LIFTS_AT, i] = math.inf
    if not VERTICAL or buf[R.MINIMUM_VERTICAL, i] > -1.0:
        return
    t, end = buf[R.TIME, i], buf[R.END, i]
    first = int(buf[R.NEXT_BREAK, i])
    while t < end and math.isinf(buf[R.LIFTS_AT, i]):
        leg_end = min(end, buf[R.LEG_ENDS, i])
        while buf[R.BREAKS_AT, i] <= t:
            buf[R.NEXT_BREAK, i] += 1.0
            set_break(buf, i, table)
        leg_end = min(leg_end, buf[R.BREAKS_AT, i])
        buf[R.LIFTS_AT, i] = lift_in_leg(buf, i, t, leg_end)
        t = leg_end
        if t < end:
            set_leg(buf, i, table, pieces, t)
    buf[R.NEXT_BREAK, i] = first
    set_break(buf, i, table)
    set_leg(buf, i, table, pieces, buf[R.TIME, i])


def weight(buf: Table, i: int, t: float) -> float:
    return 1.0 + accelerations(buf, i, t)[2]


def lift_in_leg(buf: Table, i: int, start: float, end: float) -> float:
    frequency = buf[R.FREQUENCY, i]
    # A weight that is linear in time has its minimum at an end.
    sampled = frequency > 0.0 and DEGREE != 1
    spacing = 2.0 * math.pi / (frequency * SAMPLES_PER_PERIOD) if sampled else end - start
    t0 = t1 = start
    w0 = w1 = weight(buf, i, start)
    if w0 < 0.0:
        return start
    for k in range(1, math.ceil((end - start) / spacing) + 1):
        t2 = min(start + k * spacing, end)
        w2 = weight(buf, i, t2)
        below = t2
        if k > 1 and w1 <= w0 and w1 <= w2 and w2 >= 0.0:
            low, high = t0, t2  # minimum weight between three samples, by ternary search
            for _ in range(80):
                a, b = low + (high - low) / 3.0, high - (high - low) / 3.0
                if weight(buf, i, a) < weight(buf, i, b):
                    high = b
                else:
                    low = a
            below = low
        if weight(buf, i, below) < 0.0:
            low, high = t0, below
            for _ in range(60):
                middle = 0.5 * (low + high)
                if weight(buf, i, middle) < 0.0:
                    high = middle
                else:
                    low = middle
            return high
        t0, t1, w0, w1 = t1, t2, w1, w2
    return math.inf


# Time difference that counts as zero [samples].
MOMENT = 1e-6
# Weight that counts as zero.
RELEASE_MARGIN = 8.0 * 2.220446049250313e-16


def excess(buf: Table, i: int, t: float) -> float:
    ax, ay, az = accelerations(buf, i, t)
    pushed = length(ax + buf[R.SLOPE_X, i], ay + buf[R.SLOPE_Y, i])
    return pushed - buf[R.CAPACITY, i] * (1.0 + az + buf[R.SLOPE_Z, i])


def release_time(buf: Table, i: int, start: float, end: float) -> float:
    """Return the first time of uplift of a standing column in [start, end), or infinity."""
    if held_for_good(buf, i) or end <= start:
        return math.inf
    if DEGREE == 1:
        return release_on_line(buf, i, start, end)
    frequency = buf[R.FREQUENCY, i]
    spacing = 2.0 * math.pi / (frequency * SAMPLES_PER_PERIOD) if frequency > 0.0 else end - start
    spacing = min(spacing, 0.5 * (end - start))
    # An excess that vanishes at once is a rounding error of the time at which the column came to rest.
    if excess(buf, i, start) > 0.0:
        moment = min(start + MOMENT * spacing, end)
        if excess(buf, i, moment) > 0.0:
            return start
        start = moment
    e1 = excess(buf, i, start)
    t0, e0, t1 = start, e1, start
    for k in range(1, math.ceil((end - start) / spacing) + 1):
        t2 = min(start + k * spacing, end)
        e2 = excess(buf, i, t2)
        curvature = e0 - 2.0 * e1 + e2
        # A peak counts if twice the rise of the parabola through three samples would pass the limit.
        if k > 1 and e1 >= e0 and e1 >= e2 and curvature < 0.0:
            rise = -((e2 - e0) ** 2) / (8.0 * curvature)
            if e1 + 2.0 * rise - curvature > 0.0:
                top = peak(buf, i, t0, t2)
                if excess(buf, i, top) > 0.0:
                    return crossing(buf, i, t0, top)
        if e2 > 0.0:
            found = crossing(buf, i, t1, t2)
            return found if found < end else math.inf
        t0, e0, t1, e1 = t1, e1, t2, e2
    return math.inf


def release_on_line(buf: Table, i: int, start: float, end: float) -> float:
    """Return the same for a base acceleration linear in time: the excess is convex, with its maximum at an end."""
    if excess(buf, i, start) > 0.0:
        moment = min(start + MOMENT * (end - start), end)
        if excess(buf, i, moment) > 0.0:
            return start
        start = moment
    if excess(buf, i, end) <= 0.0:
        return math.inf
    found = crossing(buf, i, start, end)
    return found if found < end else math.inf


def peak(buf: Table, i: int, low: float, high: float) -> float:
    """Return the time of the maximum excess, by golden-section search."""
    golden = 0.6180339887498949
    a, b = high - golden * (high - low), low + golden * (high - low)
    ea, eb = excess(buf, i, a), excess(buf, i, b)
    for _ in range(50):
        if ea > eb:
            high, b, eb = b, a, ea
            a = high - golden * (high - low)
            ea = excess(buf, i, a)
        else:
            low, a, ea = a, b, eb
            b = low + golden * (high - low)
            eb = excess(buf, i, b)
    return a if ea > eb else b


def crossing(buf: Table, i: int, low: float, high: float) -> float:
    if excess(buf, i, low) >= 0.0:
        return low
    for _ in range(60):
        middle = 0.5 * (low + high)
        if excess(buf, i, middle) > 0.0:
            high = middle
        else:
            low = middle
    return high


# Number of periods that show all of a periodic motion, whatever the phase at their start.
PERIODS_KNOWN = 2.0


def next_release(buf: Table, i: int, t: float) -> float:
    """Return the time of the next uplift before the leg ends, or infinity.

    NaN means that the search reached its limit of one period per allowed step; a moving column takes two steps in a
    period.
    """
    end = search_end(buf, i, t)
    release = release_time(buf, i, t, end)
    return math.nan if release > end and end < leg_end(buf, i) and not repeats_to_the_end(buf, i) else release


def search_end(buf: Table, i: int, t: float) -> float:
    """Return the end of the search for uplift that begins at `t` within the leg."""
    end, frequency = leg_end(buf, i), buf[R.FREQUENCY, i]
    if DEGREE == 1 or frequency == 0.0:
        return end
    most = t + buf[R.MOST_STEPS, i] * (2.0 * math.pi / frequency)
    known = t + PERIODS_KNOWN * buf[R.PERIOD, i]
    return min(end, known if end > most and known < most and repeats_to_the_end(buf, i) else most)


def repeats_to_the_end(buf: Table, i: int) -> bool:
    """Return whether the base motion is periodic from now to the end of the run."""
    return buf[R.PERIOD, i] > 0.0 and min(buf[R.LEG_ENDS, i], buf[R.BREAKS_AT, i]) >= buf[R.END, i]


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
            return RunStatus.UNSEEN
        stop = next_stop(buf, i)
        t = stop
        if release < stop:
            if 1.0 + accelerations(buf, i, release)[2] <= RELEASE_MARGIN:  # lift-off, not uplift
                buf[R.TIME, i] = release
                return RunStatus.LIFTED
            if not CAN_DEPART:
                return RunStatus.CANNOT_DEPART
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
            if status != RunStatus.WAITING:
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
        return RunStatus.TO_PLANE
    start_moving(buf, i, t, 0.0)
    set_next_stop(buf, i)
    return RunStatus.WAITING
