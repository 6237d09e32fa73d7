"""Passages through the vertical: planar ones, and analytical steps for close three-dimensional ones."""

import math

from stylobate.engine.elementary import length
from stylobate.engine.kernel.bound import CAN_LOSE, CAN_REST, R
from stylobate.engine.kernel.driver.equations import lean_of_new, model_impact, model_passage
from stylobate.engine.kernel.driver.events import TraceKind
from stylobate.engine.kernel.driver.moving import azimuth_now, set_lean, set_state, start_moving
from stylobate.engine.kernel.driver.peaks import record_loss
from stylobate.engine.kernel.driver.push import accelerations
from stylobate.engine.kernel.driver.resting import rest_margin, settle
from stylobate.engine.kernel.driver.stops import next_stop, resume
from stylobate.engine.kernel.driver.tracing import trace_analytical_step, trace_event
from stylobate.engine.kernel.driver.within import set_within
from stylobate.engine.kernel.layout import Table
from stylobate.engine.tolerances import PASSAGE_FROM, PASSAGE_OFFSET

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
