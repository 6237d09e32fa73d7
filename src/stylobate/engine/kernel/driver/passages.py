"""Passages of the upright: in a plane, and in closed form out of it."""

import math

from stylobate.engine.kernel.bound import CAN_LOSE, CAN_REST, R
from stylobate.engine.kernel.columns import TraceKind
from stylobate.engine.kernel.driver.equations import lean_of_new, model_passage, model_struck
from stylobate.engine.kernel.driver.moving import azimuth_now, set_lean, set_off, set_state
from stylobate.engine.kernel.driver.push import accelerations
from stylobate.engine.kernel.driver.resting import rest_margin, settle
from stylobate.engine.kernel.driver.stops import next_stop, resume
from stylobate.engine.kernel.driver.tracing import trace_event, trace_leap
from stylobate.engine.kernel.driver.within import set_within
from stylobate.engine.kernel.layout import Table
from stylobate.engine.tolerances import HOP_FROM, HOP_OFFSET

# The tilt that falls by less than this part of its speed does not fall: it is least there.
JUST_MET = 1e-6


def cross_upright(buf: Table, i: int, table: Table, pieces: Table) -> int:
    """Pass the upright in the plane, or come to rest there."""
    t, speed = buf[R.TIME, i], buf[R.STATE + 1, i]
    buf[R.TOUCHED_UPRIGHT, i] = 1.0
    buf[R.STATE, i] = 0.0
    rests = CAN_REST and buf[R.REST_ENERGY, i] > 0.0 and rest_margin(buf, i, t, 0.0, abs(speed)) > 0.0
    if speed == 0.0 or rests:
        return settle(buf, i, table, pieces, t)
    costs = CAN_LOSE and buf[R.PASSAGE_TILT, i] > 0.0
    trace_event(buf, i, table, TraceKind.IMPACT if costs else TraceKind.PASSAGE, t)
    if costs:
        set_state(buf, i, model_struck(buf, i))
    set_off(buf, i, t, buf[R.HELD_STEP, i])
    return resume(buf, i, table, pieces)


def loses(buf: Table, i: int) -> bool:
    """Return whether the step just made went past the upright so closely that the passage costs energy."""
    if buf[R.LOW, i] >= buf[R.PASSAGE_TILT, i] or buf[R.RADIAL, i] <= 0.0:
        return False
    set_within(buf, i, 0.0)
    x, y, vx, vy = lean_of_new(buf, i)
    # A passage that was just met is not met again.
    return x * vx + y * vy < -JUST_MET * math.hypot(x, y) * math.hypot(vx, vy)


def strike(buf: Table, i: int, table: Table, pieces: Table) -> int:
    """Take the loss of a passage, at the minimum tilt; return as `resume` does."""
    trace_event(buf, i, table, TraceKind.IMPACT, buf[R.TIME, i])
    set_state(buf, i, model_struck(buf, i))
    set_off(buf, i, buf[R.TIME, i], buf[R.WANTED, i])
    buf[R.ATOL_NOW, i] = buf[R.ATOL, i]
    return resume(buf, i, table, pieces)


def hops(buf: Table, i: int) -> bool:
    """Return whether the lane heads past the upright so closely that the passage is made in closed form."""
    c, speed = buf[R.SLENDERNESS, i], math.hypot(buf[R.VX, i], buf[R.VY, i])
    near = buf[R.RADIAL, i] < 0.0 and buf[R.TILT, i] < HOP_FROM * min(c, speed)
    return near and abs(buf[R.MOMENTUM, i]) < HOP_OFFSET * c * speed


def hop(buf: Table, i: int, table: Table) -> None:
    """Make the passage, if it ends before the next stop."""
    t = buf[R.TIME, i]
    ax, ay, az = accelerations(buf, i, t)
    elapsed, state = model_passage(buf, i, ax, ay, az)
    if t + elapsed > next_stop(buf, i):
        return
    momentum, speed = buf[R.MOMENTUM, i], math.hypot(buf[R.VX, i], buf[R.VY, i])
    # Half a turn on the side on which the momentum says it passes.
    azimuth = azimuth_now(buf, i) + math.copysign(0.5, momentum)
    trace_leap(buf, i, table, elapsed, state, azimuth)
    set_state(buf, i, state)
    if CAN_LOSE and buf[R.PASSAGE_TILT, i] > 0.0:
        trace_event(buf, i, table, TraceKind.IMPACT, t + elapsed)
        set_state(buf, i, model_struck(buf, i))
    set_lean(buf, i)
    closest = abs(momentum) / speed
    buf[R.MINIMUM_TILT, i] = min(buf[R.MINIMUM_TILT, i], closest)
    if speed * speed > buf[R.REST_SQUARE, i]:
        buf[R.LEAST_PASSAGE, i] = min(buf[R.LEAST_PASSAGE, i], closest)
    buf[R.LAST_AZIMUTH, i] = azimuth
    set_off(buf, i, t + elapsed, buf[R.WANTED, i])
    buf[R.ATOL_NOW, i] = buf[R.ATOL, i]
