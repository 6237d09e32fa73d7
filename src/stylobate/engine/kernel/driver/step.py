"""One attempted step in all lanes: stages, error, events and extremes in it, and the next step."""

import math

from stylobate.compiler.marks import fast, lanes
from stylobate.engine.dop853 import E3, E5, LARGEST_FACTOR, LEAST_ERROR, LEAST_FACTOR, SAFETY, STAGES
from stylobate.engine.elementary import reciprocals, turning_point, weighted, winding
from stylobate.engine.kernel.bound import (
    DEMANDS,
    GROUP_MOVING,
    ORDER,
    PLANAR,
    SERIES,
    SLIDING,
    SLIP_X,
    SLIP_Y,
    SLIPPING,
    SWITCHING,
    WIDTH,
    R,
    Table,
)
from stylobate.engine.kernel.driver.equations import lean_of_new
from stylobate.engine.kernel.driver.events import lean, overshoot_of
from stylobate.engine.kernel.driver.guards import project_states
from stylobate.engine.kernel.driver.motion import follow_demands
from stylobate.engine.kernel.driver.stages import (
    STAGE_NUMBERS,
    extremes_by_series,
    falls_and_rises,
    make_long_stage,
    make_series_step,
    make_stage,
    rises_and_falls,
    slopes_of,
)
from stylobate.engine.tolerances import PASSAGE_FROM, PASSAGE_OFFSET, SLIP_SHARE


@fast
def step(buf: Table, width: int, group: int) -> None:
    """Try a step in each of the first `width` lanes; accept it if its error is small and it contains no event.

    The group of lanes is known when this is compiled.
    """
    if SERIES:
        make_series_step(buf, width)
    elif SWITCHING:
        make_long_step(buf, group)
    else:
        for stage in STAGE_NUMBERS:
            make_stage(buf, stage, width)
    control_step(buf, width, group)
    if SWITCHING:
        project_states(buf, group)
    if DEMANDS:
        follow_demands(buf, width)


@fast
def make_long_step(buf: Table, group: int) -> None:
    """Make a step of a model with long equations."""
    for i in lanes(WIDTH):
        for j in range(GROUP_MOVING[group]):
            buf[R.STEP + j, i] = buf[R.H, i]
    for stage in STAGE_NUMBERS:
        make_long_stage(buf, stage, group)
    for i in lanes(WIDTH):
        for j in range(ORDER):
            buf[R.NEW + j, i] = buf[(R.STAGE if j < GROUP_MOVING[group] else R.STATE) + j, i]


# Factor for a second attempt after a step by series that gave NaN.
RETRY = 0.5
# Minimum step, as a fraction of the time.
SHORTEST = 2.3e-15
# A peak tilt within a step is measured if it may exceed the previous peak by this factor.
NEW_PEAK = 1.0 + 1e-7
# Added to a divisor that may be zero.
TINY = 1e-300


@fast
def control_step(buf: Table, width: int, group: int) -> None:
    """Accept or reject the step of each lane, record extremes and events, and choose the next step."""
    # Short loops would leave registers unused; one long loop would spill them.
    for i in lanes(width):
        if not SERIES:  # steps by series have computed their error
            find_error(buf, i, group)
        accept(buf, i)
    for i in lanes(width):
        record_extremes(buf, i)
        if not PLANAR:
            follow_azimuth(buf, i)
    for i in lanes(width):
        nearer = approach(buf, i)
        keep_step(buf, i, group)
        choose_next_step(buf, i, nearer)
        flag_lane(buf, i)


# Error


def find_error(buf: Table, i: int, group: int) -> None:
    """Compute the error of the step in tolerances."""
    scales = reciprocals(tuple(scale_of(buf, i, j) for j in range(GROUP_MOVING[group])))
    e5 = e3 = 0.0
    for j in range(GROUP_MOVING[group]):
        slopes = slopes_of(buf, i, j)
        of_order_5, of_order_3 = weighted(E5, slopes) * scales[j], weighted(E3, slopes) * scales[j]
        e5 = e5 + of_order_5 * of_order_5
        e3 = e3 + of_order_3 * of_order_3
    spread = e5 + 0.01 * e3
    buf[R.ERROR, i] = abs(buf[R.H, i]) * e5 / math.sqrt(spread * float(ORDER) + TINY)


def scale_of(buf: Table, i: int, j: int) -> float:
    """Return the tolerance of a state."""
    size = max(abs(buf[R.STATE + j, i]), abs(buf[R.NEW + j, i]))
    return absolute_tolerance(buf, i, j) + buf[R.RTOL, i] * size


def absolute_tolerance(buf: Table, i: int, j: int) -> float:
    """Return the absolute tolerance of a state; it is finer for slip velocities while a contact slips."""
    atol = buf[R.ATOL_NOW, i]
    if not SWITCHING:
        return atol
    if j not in (SLIP_X, SLIP_Y):
        return atol
    kind = buf[R.CONTACT, i]
    return SLIP_SHARE * atol if kind in (SLIPPING, SLIDING) else atol


# Acceptance


def accept(buf: Table, i: int) -> None:
    """Compute the new tilt vector, and decide whether the step is accepted, rejected, or held back by an event."""
    x, y, vx, vy = lean_of_new(buf, i)
    new = lean(x, y, vx, vy)
    # The guards of a model that changes between kinds of contact have been evaluated.
    past = buf[R.BROKEN, i] if SWITCHING else overshoot_of(buf, i, new)
    ok = 1.0 if buf[R.ERROR, i] < 1.0 else 0.0
    ahead = (1.0 if past > 0.0 else 0.0) * (0.0 if buf[R.AIMED, i] > 0.0 else 1.0)
    buf[R.OK, i] = ok
    buf[R.HELD, i] = ok * ahead
    buf[R.GO, i] = ok * (1.0 - ahead)
    buf[R.NEW_X, i] = x
    buf[R.NEW_Y, i] = y
    buf[R.NEW_VX, i] = vx
    buf[R.NEW_VY, i] = vy
    buf[R.NEW_TILT, i] = new.tilt
    buf[R.NEW_RADIAL, i] = new.radial


# Extremes


def record_extremes(buf: Table, i: int) -> None:
    """Record the minimum and maximum tilt within the step.

    They are extremes of the squared tilt, which is smooth at a passage through the vertical; in planar motion they are
    extremes of the tilt, which may start from zero.
    """
    h, go = buf[R.H, i], buf[R.GO, i]
    tilt0, tilt1 = buf[R.TILT, i], buf[R.NEW_TILT, i]
    if SERIES:
        falls, lowest, rises, highest, share = extremes_by_series(buf, i)
    else:
        falls, rises, share, highest = extreme_by_cubic(buf, i)
        lowest = highest
    low = lowest if falls > 0.0 else min(tilt0, tilt1)
    buf[R.LOW, i] = low
    # A step aimed at an event may overshoot the event: its ends do not count yet.
    ends = 0.0 if buf[R.AIMED, i] > 0.0 else max(tilt0, tilt1)
    largest = buf[R.PEAK_TILT, i]
    # The driver measures an extreme that may exceed the peak so far; it handles aimed steps anyway.
    highest = highest if rises > 0.0 else 0.0
    above = max(2.0 * highest - ends - largest * NEW_PEAK, buf[R.AIMED, i])
    peak = go * rises * (1.0 if above > 0.0 else 0.0)
    buf[R.PEAK, i] = peak
    seen = max(ends, highest) * (1.0 - peak)
    seen = seen if go > 0.0 else 0.0
    now = buf[R.TIME, i] + h * (share if rises > 0.0 else (1.0 if tilt1 > tilt0 else 0.0))
    before = buf[R.PEAK_AT, i]
    buf[R.PEAK_AT, i] = now if seen > largest else before
    buf[R.PEAK_TILT, i] = max(largest, seen)
    record_minimum(buf, i, R.MINIMUM_TILT, low, go * falls)
    if not PLANAR:
        # Passages at the speed of rest or below do not count.
        square = buf[R.NEW_VX, i] * buf[R.NEW_VX, i] + buf[R.NEW_VY, i] * buf[R.NEW_VY, i]
        falls = falls if square > buf[R.REST_SQUARE, i] else 0.0
        record_minimum(buf, i, R.CLOSEST_PASSAGE, low, go * falls)
    if not PLANAR and not SWITCHING:
        mark_slow(buf, i, h)


def extreme_by_cubic(buf: Table, i: int) -> tuple[float, float, float, float]:
    """Return minimum flag, maximum flag, fraction of the step and tilt of the extreme of a cubic through the ends."""
    h = buf[R.H, i]
    if PLANAR:
        side = buf[R.SIDE, i]
        start, end = side * buf[R.X, i], side * buf[R.NEW_X, i]
        slope, end_slope = side * buf[R.VX, i] * h, side * buf[R.NEW_VX, i] * h
    else:
        tilt0, tilt1 = buf[R.TILT, i], buf[R.NEW_TILT, i]
        start, end = tilt0 * tilt0, tilt1 * tilt1
        slope, end_slope = 2.0 * buf[R.RADIAL, i] * h, 2.0 * buf[R.NEW_RADIAL, i] * h
    falls, rises = falls_and_rises(slope, end_slope), rises_and_falls(slope, end_slope)
    share, value = turning_point(start, end, slope, end_slope, rises - falls)
    value = max(value, 0.0)
    return falls, rises, share, value if PLANAR else math.sqrt(value)


def record_minimum(buf: Table, i: int, row: int, low: float, counts: float) -> None:
    least = buf[row, i]
    closer = low if counts > 0.0 else least
    buf[row, i] = min(least, closer)


def mark_slow(buf: Table, i: int, h: float) -> None:
    """Mark lanes in which the column may have been slow enough to come to rest within the step.

    The speed within the step is lower than at its ends at most by the change of the velocity, or by the change that the
    weight can cause. A step by series may be long and is always marked.
    """
    if SERIES:
        buf[R.SLOW, i] = 1.0
        return
    pull = h * buf[R.SLENDERNESS, i] * (1.0 + max(0.0, buf[R.MAXIMUM_VERTICAL, i]))
    x = buf[R.NEW_VX, i] - buf[R.VX, i]
    y = buf[R.NEW_VY, i] - buf[R.VY, i]
    change = x * x + y * y + pull * pull
    before = buf[R.VX, i] * buf[R.VX, i] + buf[R.VY, i] * buf[R.VY, i]
    after = buf[R.NEW_VX, i] * buf[R.NEW_VX, i] + buf[R.NEW_VY, i] * buf[R.NEW_VY, i]
    slowest = min(before, after)
    buf[R.SLOW, i] = 1.0 if slowest < 2.0 * (change + buf[R.SLOW_SQUARE, i]) else 0.0


def follow_azimuth(buf: Table, i: int) -> None:
    """Update the continuous azimuth of the tilt vector, and end the finer tolerance of small motions."""
    go = buf[R.GO, i]
    x1, y1 = buf[R.NEW_X, i], buf[R.NEW_Y, i]
    before, after = buf[R.MOMENTUM, i], x1 * buf[R.NEW_VY, i] - y1 * buf[R.NEW_VX, i]
    buf[R.TURNS, i] = buf[R.TURNS, i] + go * winding(buf[R.X, i], buf[R.Y, i], x1, y1, before + after)
    buf[R.MOMENTUM, i] = after if go > 0.0 else before
    # A motion that has grown or turned back gets the full tolerance.
    grown = max(buf[R.NEW_TILT, i] - buf[R.GROWN, i], -buf[R.NEW_RADIAL, i]) * go
    full, now = buf[R.ATOL, i], buf[R.ATOL_NOW, i]
    buf[R.ATOL_NOW, i] = full if grown > 0.0 else now


# Acceptance of the step, and the next step


def keep_step(buf: Table, i: int, group: int) -> None:
    """Replace the state by the new state if the step is accepted."""
    go = buf[R.GO, i]
    for j in range(ORDER):
        buf[R.LAST_STATE + j, i] = buf[R.STATE + j, i]
        if not SERIES:
            buf[R.LAST_SLOPE + j, i] = buf[R.SLOPE + j, i]
        if j < GROUP_MOVING[group]:
            keep(buf, i, R.STATE + j, R.NEW + j, go)
            if not SERIES:
                keep(buf, i, R.SLOPE + j, R.SLOPE + STAGES * ORDER + j, go)
    keep(buf, i, R.TILT, R.NEW_TILT, go)
    keep(buf, i, R.RADIAL, R.NEW_RADIAL, go)
    keep(buf, i, R.X, R.NEW_X, go)
    keep(buf, i, R.Y, R.NEW_Y, go)
    keep(buf, i, R.VX, R.NEW_VX, go)
    keep(buf, i, R.VY, R.NEW_VY, go)


def keep(buf: Table, i: int, target: int, source: int, go: float) -> None:
    """Copy one row into another if the step is accepted."""
    new, old = buf[source, i], buf[target, i]
    buf[target, i] = new if go > 0.0 else old


def choose_next_step(buf: Table, i: int, nearer: float) -> None:
    """Advance the time if the step is accepted, and choose the next step."""
    h, t = buf[R.H, i], buf[R.TIME, i]
    go, ok, stop = buf[R.GO, i], buf[R.OK, i], buf[R.STOP, i]
    # By rounding, a slightly shorter step may also reach the stop.
    reached = go * (1.0 if max(h - (stop - t), t + h - stop) >= 0.0 else 0.0)
    buf[R.REACHED, i] = reached
    buf[R.TRIED, i] = h
    buf[R.MADE, i] = h * go
    now = t + h * go
    now = stop if reached > 0.0 else now
    buf[R.TIME, i] = now
    wanted = wanted_by_series(buf, i, h, ok) if SERIES else wanted_by_error(buf, i, h) * nearer
    wanted = min(wanted, buf[R.LONGEST_STEP, i])
    buf[R.REJECTED, i] = 1.0 - ok
    # A rejected step back to an event remains aimed; otherwise it would continue backwards in time.
    buf[R.AIMED, i] = buf[R.AIMED, i] * (1.0 if h < 0.0 else ok)
    buf[R.WANTED, i] = wanted
    buf[R.H, i] = min(wanted, stop - now)
    buf[R.STEPS, i] = buf[R.STEPS, i] + go


def approach(buf: Table, i: int) -> float:
    """Return the factor by which the singularities of the equations come nearer within an accepted step; at most 1.

    On a straight path they lie at the complex times at which the squared tilt is zero, as far away as the tilt over the
    speed. The step that the error allows is a part of this distance.
    """
    if PLANAR or SERIES:
        return 1.0
    before = buf[R.VX, i] * buf[R.VX, i] + buf[R.VY, i] * buf[R.VY, i]
    after = buf[R.NEW_VX, i] * buf[R.NEW_VX, i] + buf[R.NEW_VY, i] * buf[R.NEW_VY, i]
    tilt0, tilt1 = buf[R.TILT, i], buf[R.NEW_TILT, i]
    ratio = math.sqrt(tilt1 * tilt1 * before / (tilt0 * tilt0 * after + TINY))
    inward = buf[R.GO, i] * (1.0 if buf[R.NEW_RADIAL, i] < 0.0 else 0.0)
    return min(1.0, max(LEAST_FACTOR, ratio)) if inward > 0.0 else 1.0


def wanted_by_error(buf: Table, i: int, h: float) -> float:
    """Return the next step that the error of this step allows, before it is cut at the next stop."""
    error = max(buf[R.ERROR, i], LEAST_ERROR)
    most = 1.0 if buf[R.REJECTED, i] > 0.0 else LARGEST_FACTOR
    # After NaN the factor is NaN; min and max then return their first argument.
    return h * min(most, max(LEAST_FACTOR, SAFETY / math.sqrt(math.sqrt(math.sqrt(error)))))


def wanted_by_series(buf: Table, i: int, h: float, ok: float) -> float:
    """Return the next step that the last terms of a step by series allow."""
    proposed = buf[R.PROPOSED, i]
    return proposed if ok > 0.0 else RETRY * h


# Flags for the driver


def flag_lane(buf: Table, i: int) -> None:
    """Flag lanes that have an event for the driver.

    Flagged lanes are held back by an event, at a stop, aimed at an event, at the step limit, or stuck. In
    three-dimensional motion without guards, lanes near rest or near the vertical are flagged too.
    """
    near = 0.0 if PLANAR or SWITCHING else near_vertical(buf, i)
    most = min(buf[R.MOST_STEPS, i], buf[R.STIFF_LOOK_AT, i]) if SWITCHING else buf[R.MOST_STEPS, i]
    over = 1.0 if buf[R.STEPS, i] >= most else 0.0
    stuck = 1.0 if abs(buf[R.TRIED, i]) < SHORTEST * abs(buf[R.TIME, i]) + TINY else 0.0
    met = buf[R.REACHED, i] + buf[R.AIMED, i] + buf[R.PEAK, i] + near + over
    flag = buf[R.HELD, i] + stuck * buf[R.REJECTED, i] + buf[R.GO, i] * met
    if SWITCHING:  # in a lane without a run the guards have no meaning
        flag = flag * (0.0 if buf[R.RUN, i] < 0.0 else 1.0)
    buf[R.FLAG, i] = flag


def near_vertical(buf: Table, i: int) -> float:
    """Return an indicator that is positive if the step passed the vertical closely, or heads straight for it."""
    c = buf[R.SLENDERNESS, i]
    square = buf[R.VX, i] * buf[R.VX, i] + buf[R.VY, i] * buf[R.VY, i]
    lowest = buf[R.SLOW, i] * buf[R.REST_TILT, i]
    near = 1.0 if buf[R.LOW, i] < max(lowest, buf[R.PASSAGE_TILT, i]) else 0.0
    inward = 1.0 if buf[R.RADIAL, i] < 0.0 else 0.0
    tilt, momentum = buf[R.TILT, i], buf[R.MOMENTUM, i]
    close = 1.0 if tilt * tilt < PASSAGE_FROM**2 * min(c * c, square) else 0.0
    straight = 1.0 if momentum * momentum < PASSAGE_OFFSET**2 * c * c * square else 0.0
    return near + inward * close * straight
