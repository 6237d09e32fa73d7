"""Start and events of lanes whose model keeps one kind of contact."""

import math

from stylobate.engine.elementary import length
from stylobate.engine.kernel.bound import CAN_LOSE, CAN_PASS, CAN_REST, ORDER, PLANAR, SERIES, R, Table
from stylobate.engine.kernel.driver.equations import (
    accelerations,
    lean_of,
    lean_of_new,
    model_impact,
    model_passage,
    row_state,
)
from stylobate.engine.kernel.driver.events import (
    RunStatus,
    Target,
    TraceKind,
    first_event,
    lean,
    limit_passed,
    status_at_target,
    time_left,
)
from stylobate.engine.kernel.driver.motion import (
    azimuth_now,
    closest_within,
    measure_peak,
    record_loss,
    set_lean,
    set_state,
    start_moving,
    undo_step,
)
from stylobate.engine.kernel.driver.records import (
    meet_stop,
    next_stop,
    remove_trace_entry,
    resume,
    set_next_stop,
    trace_analytical_step,
    trace_event,
)
from stylobate.engine.kernel.driver.rest import find_lift, rest_margin, rest_within_step, settle, stand
from stylobate.engine.kernel.driver.stages import set_within
from stylobate.engine.tolerances import PASSAGE_FROM, PASSAGE_OFFSET


def begin(buf: Table, i: int, table: Table, pieces: Table) -> int:
    """Start the run of a lane; return WAITING if the column moves, else the status with which the run ends at once."""
    t = buf[R.TIME, i]
    find_lift(buf, i, table, pieces)
    if buf[R.STANDS, i] > 0.0:
        return stand(buf, i, table, pieces, t)
    start_moving(buf, i, t, 0.0)
    status = limit_passed(buf, i)
    return resume(buf, i, table, pieces) if status == RunStatus.WAITING else status


# Maximum number of steps aimed at an event. A remaining step below the second number, in units of the longest step, is
# made by a Taylor polynomial, whose error is of third order.
MOST_AIMS, SHORT_AIM = 6, 1e-6
# Minimum step back to an event, as a fraction of the step that passed it.
SHORTEST_AIM = 1e-9


def advance_briefly(buf: Table, i: int, h: float) -> None:
    """Advance by a very short time, by the series of the step or by two Taylor terms."""
    if SERIES:
        set_within(buf, i, buf[R.MADE, i] + h)
        set_state(buf, i, row_state(buf, i, R.NEW))
    for j in range(0 if SERIES else ORDER):
        slope = buf[R.SLOPE + j, i]
        bend = (slope - buf[R.LAST_SLOPE + j, i]) / buf[R.MADE, i]
        buf[R.STATE + j, i] += h * (slope + 0.5 * h * bend)
    buf[R.TIME, i] += h
    set_lean(buf, i)


def handle_held_step(buf: Table, i: int, table: Table, pieces: Table) -> int:
    """Aim at the event within the step that was held back."""
    h = buf[R.TRIED, i]
    buf[R.HELD_STEP, i] = h
    target, ahead = first_event(buf, i, h, lean(*lean_of_new(buf, i)))
    if ahead <= 0.0:  # a swing too short to be resolved within the step
        buf[R.STATE, i] = 0.0
        return settle(buf, i, table, pieces, buf[R.TIME, i])
    aim(buf, i, target, ahead)
    return RunStatus.WAITING


def aim(buf: Table, i: int, target: int, ahead: float) -> None:
    """Let the next step end at the target, at the time `ahead`."""
    buf[R.TARGET, i] = target
    buf[R.H, i] = ahead
    buf[R.AIMED, i] = 1.0


def approach_target(buf: Table, i: int, table: Table, pieces: Table) -> int:
    """Make another step towards the target, or handle the event if it is reached."""
    further = time_left(buf, i, lean(*lean_of(buf, i, row_state(buf, i, R.LAST_STATE))))
    short = abs(further) < SHORT_AIM * min(1.0, buf[R.LONGEST_STEP, i])
    if not short and buf[R.AIMED, i] < MOST_AIMS:
        buf[R.H, i] = further
        buf[R.AIMED, i] += 1.0
        return RunStatus.WAITING
    advance_briefly(buf, i, further)
    buf[R.AIMED, i] = 0.0
    if buf[R.TILT, i] > buf[R.PEAK_TILT, i]:
        buf[R.PEAK_TILT, i] = buf[R.TILT, i]
        buf[R.PEAK_AT, i] = buf[R.TIME, i]
    if PLANAR and buf[R.TARGET, i] == Target.VERTICAL:
        return cross_vertical(buf, i, table, pieces)
    if CAN_LOSE and buf[R.TARGET, i] == Target.IMPACT:
        return apply_impact(buf, i, table, pieces)
    return status_at_target(buf, i)


def handle_near_vertical(buf: Table, i: int, table: Table) -> float:
    """Handle a three-dimensional passage near the vertical; return the time at which the column rests, or NaN."""
    if CAN_REST and buf[R.REST_ENERGY, i] > 0.0 and buf[R.LOW, i] < buf[R.SLOW, i] * buf[R.REST_TILT, i]:
        rest = rest_within_step(buf, i)
        if not math.isnan(rest):
            return rest
    if CAN_PASS and nears_vertical(buf, i):
        pass_analytically(buf, i, table)
    return math.nan


def handle(buf: Table, i: int, table: Table, pieces: Table) -> int:
    """Handle the event of a lane; return the final status if the run ends, else WAITING."""
    if buf[R.HELD, i] > 0.0:
        return handle_held_step(buf, i, table, pieces)
    if buf[R.GO, i] == 0.0:
        return RunStatus.STEP_TOO_SMALL
    if buf[R.PEAK, i] > 0.0:
        ahead = measure_peak(buf, i)
        if ahead > 0.0 and buf[R.AIMED, i] == 0.0:  # only the peak within the step exceeds the limit
            undo_step(buf, i)
            remove_trace_entry(buf, i)
            aim(buf, i, Target.LIMIT, ahead)
            return RunStatus.WAITING
    if buf[R.AIMED, i] > 0.0:
        return approach_target(buf, i, table, pieces)
    if buf[R.STEPS, i] >= buf[R.MOST_STEPS, i]:
        return RunStatus.STEP_LIMIT
    if not PLANAR:
        if CAN_LOSE and loses_energy(buf, i):
            aim(buf, i, Target.IMPACT, -max(closest_within(buf, i), SHORTEST_AIM * buf[R.MADE, i]))
            return RunStatus.WAITING
        rest = handle_near_vertical(buf, i, table)
        if not math.isnan(rest):
            return settle(buf, i, table, pieces, rest)
    t = buf[R.TIME, i]
    if t >= buf[R.STOP, i]:
        status = meet_stop(buf, i, table, pieces, t)
        if status != RunStatus.WAITING:
            return status
    set_next_stop(buf, i)
    return RunStatus.WAITING


# A tilt that falls at less than this fraction of the speed is at its minimum.
JUST_MET = 1e-6


def cross_vertical(buf: Table, i: int, table: Table, pieces: Table) -> int:
    """Pass the vertical in planar motion, or come to rest there."""
    t, speed = buf[R.TIME, i], buf[R.STATE + 1, i]
    buf[R.REACHED_VERTICAL, i] = 1.0
    buf[R.STATE, i] = 0.0
    can_rest = CAN_REST and buf[R.REST_ENERGY, i] > 0.0
    if speed == 0.0 or (can_rest and rest_margin(buf, i, accelerations(buf, i, t), 0.0, abs(speed)) > 0.0):
        return settle(buf, i, table, pieces, t)
    costs = CAN_LOSE and buf[R.PASSAGE_TILT, i] > 0.0
    trace_event(buf, i, table, TraceKind.IMPACT if costs else TraceKind.PASSAGE, t)
    if costs:
        set_state(buf, i, model_impact(buf, i))
    start_moving(buf, i, t, buf[R.HELD_STEP, i])
    return resume(buf, i, table, pieces)


def loses_energy(buf: Table, i: int) -> bool:
    """Return whether the step just made passed the vertical so closely that the passage loses energy."""
    if buf[R.LOW, i] >= buf[R.PASSAGE_TILT, i] or buf[R.RADIAL, i] <= 0.0:
        return False
    set_within(buf, i, 0.0)
    x, y, vx, vy = lean_of_new(buf, i)
    # A passage that has just been handled does not count again.
    return x * vx + y * vy < -JUST_MET * length(x, y) * length(vx, vy)


def apply_impact(buf: Table, i: int, table: Table, pieces: Table) -> int:
    """Apply the impact map of a lossy passage at the minimum tilt; return as `resume` does."""
    set_lean(buf, i)
    record_loss(buf, i)
    trace_event(buf, i, table, TraceKind.IMPACT, buf[R.TIME, i])
    set_state(buf, i, model_impact(buf, i))
    start_moving(buf, i, buf[R.TIME, i], buf[R.WANTED, i])
    buf[R.ATOL_NOW, i] = buf[R.ATOL, i]
    return resume(buf, i, table, pieces)


def nears_vertical(buf: Table, i: int) -> bool:
    """Return whether the column approaches the vertical so closely that the passage is an analytical step."""
    c, speed = buf[R.SLENDERNESS, i], length(buf[R.VX, i], buf[R.VY, i])
    near = buf[R.RADIAL, i] < 0.0 and buf[R.TILT, i] < PASSAGE_FROM * min(c, speed)
    return near and abs(buf[R.MOMENTUM, i]) < PASSAGE_OFFSET * c * speed


def pass_analytically(buf: Table, i: int, table: Table) -> None:
    """Make the passage by an analytical step, if it ends before the next stop."""
    t = buf[R.TIME, i]
    ax, ay, az = accelerations(buf, i, t)
    elapsed, state = model_passage(buf, i, ax, ay, az)
    if t + elapsed > next_stop(buf, i):
        return
    momentum, speed = buf[R.MOMENTUM, i], length(buf[R.VX, i], buf[R.VY, i])
    # The contact point travels half a turn; the momentum gives the direction.
    azimuth = azimuth_now(buf, i) + math.copysign(0.5, momentum)
    trace_analytical_step(buf, i, table, elapsed, state, azimuth)
    set_state(buf, i, state)
    if CAN_LOSE and buf[R.PASSAGE_TILT, i] > 0.0:
        record_loss(buf, i)
        trace_event(buf, i, table, TraceKind.IMPACT, t + elapsed)
        set_state(buf, i, model_impact(buf, i))
    set_lean(buf, i)
    closest = abs(momentum) / speed
    buf[R.MINIMUM_TILT, i] = min(buf[R.MINIMUM_TILT, i], closest)
    if speed * speed > buf[R.REST_SQUARE, i]:
        buf[R.CLOSEST_PASSAGE, i] = min(buf[R.CLOSEST_PASSAGE, i], closest)
    buf[R.LAST_AZIMUTH, i] = azimuth
    start_moving(buf, i, t + elapsed, buf[R.WANTED, i])
    buf[R.ATOL_NOW, i] = buf[R.ATOL, i]
