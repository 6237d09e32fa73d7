"""Peak tilt and minimum tilt within a step, and distance from the vertical of passages that lose energy."""

from stylobate.engine.elementary import length, winding
from stylobate.engine.kernel.bound import ORDER, PLANAR, SERIES, R
from stylobate.engine.kernel.driver.equations import lean_of_new, row_state
from stylobate.engine.kernel.driver.moving import set_lean
from stylobate.engine.kernel.driver.within import set_within
from stylobate.engine.kernel.layout import Table
from stylobate.engine.kernel.roots import quintic
from stylobate.engine.tolerances import PLANAR_OFFSET

# Time difference for the second derivative of the tilt vector.
DIFFERENCE = 1e-5


def measure_peak(buf: Table, i: int) -> float:
    """Measure the peak tilt within the step just made.

    Return 0 and record the peak, or return the time into the step at which the tilt passes its limit.
    """
    h = buf[R.MADE, i]
    before = after = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    if not SERIES:
        before, after = lean_before(buf, i), lean_after(buf, i)
    limit = buf[R.TILT_LIMIT, i]
    low, high = 0.0, 1.0
    x = y = 0.0
    for _ in range(40):
        u = 0.5 * (low + high)
        x, y, vx, vy = lean_within(buf, i, u, before, after)
        if x * vx + y * vy > 0.0:
            low = u
        else:
            high = u
    tilt = length(x, y)
    if tilt <= limit:
        if tilt > buf[R.PEAK_TILT, i]:
            buf[R.PEAK_TILT, i] = tilt
            buf[R.PEAK_AT, i] = buf[R.TIME, i] - h + low * h
        return 0.0
    low = 0.0
    for _ in range(40):
        u = 0.5 * (low + high)
        x, y, _, _ = lean_within(buf, i, u, before, after)
        if length(x, y) > limit:
            high = u
        else:
            low = u
    return high * h


def closest_within(buf: Table, i: int) -> float:
    """Return the time from the minimum tilt to the end of the step just made."""
    before = after = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    if not SERIES:
        before, after = lean_before(buf, i), lean_after(buf, i)
    low, high = 0.0, 1.0
    for _ in range(40):
        u = 0.5 * (low + high)
        x, y, vx, vy = lean_within(buf, i, u, before, after)
        if x * vx + y * vy < 0.0:
            low = u
        else:
            high = u
    return (1.0 - high) * buf[R.MADE, i]


def record_loss(buf: Table, i: int) -> None:
    """Record the distance from the vertical of the present passage, which loses energy."""
    speed = length(buf[R.VX, i], buf[R.VY, i])
    offset = abs(buf[R.MOMENTUM, i]) / speed
    buf[R.WIDEST_LOSS, i] = max(buf[R.WIDEST_LOSS, i], offset)
    # In planar motion the offset is a rounding error.
    if speed * speed > buf[R.REST_SQUARE, i] and offset > PLANAR_OFFSET * buf[R.SLENDERNESS, i]:
        buf[R.CLOSEST_PASSAGE, i] = min(buf[R.CLOSEST_PASSAGE, i], offset)


def undo_step(buf: Table, i: int) -> None:
    """Restore the state at the start of the step just made."""
    x1, y1, momentum1 = buf[R.X, i], buf[R.Y, i], buf[R.MOMENTUM, i]
    for j in range(ORDER):
        buf[R.STATE + j, i] = buf[R.LAST_STATE + j, i]
        if not SERIES:
            buf[R.SLOPE + j, i] = buf[R.LAST_SLOPE + j, i]
    buf[R.TIME, i] -= buf[R.MADE, i]
    set_lean(buf, i)
    if not PLANAR:
        buf[R.TURNS, i] -= winding(buf[R.X, i], buf[R.Y, i], x1, y1, buf[R.MOMENTUM, i] + momentum1)


def lean_before(buf: Table, i: int) -> tuple[float, float, float, float, float, float]:
    return lean_and_rates(buf, i, row_state(buf, i, R.LAST_STATE), row_state(buf, i, R.LAST_SLOPE))


def lean_after(buf: Table, i: int) -> tuple[float, float, float, float, float, float]:
    return lean_and_rates(buf, i, row_state(buf, i, R.STATE), row_state(buf, i, R.SLOPE))


def lean_and_rates(
    buf: Table, i: int, state: tuple[float, ...], slopes: tuple[float, ...]
) -> tuple[float, float, float, float, float, float]:
    """Return the tilt vector, its rate and, by differences along the motion, its acceleration."""
    for j in range(ORDER):
        buf[R.NEW + j, i] = state[j] + DIFFERENCE * slopes[j]
    _, _, ahead_x, ahead_y = lean_of_new(buf, i)
    for j in range(ORDER):
        buf[R.NEW + j, i] = state[j] - DIFFERENCE * slopes[j]
    _, _, behind_x, behind_y = lean_of_new(buf, i)
    for j in range(ORDER):
        buf[R.NEW + j, i] = state[j]
    x, y, vx, vy = lean_of_new(buf, i)
    return x, y, vx, vy, (ahead_x - behind_x) / (2.0 * DIFFERENCE), (ahead_y - behind_y) / (2.0 * DIFFERENCE)


def lean_within(
    buf: Table,
    i: int,
    u: float,
    before: tuple[float, float, float, float, float, float],
    after: tuple[float, float, float, float, float, float],
) -> tuple[float, float, float, float]:
    """Return the tilt vector and its rate at the fraction `u` of the step, by its series or by quintics."""
    if SERIES:
        set_within(buf, i, u * buf[R.MADE, i])
        return lean_of_new(buf, i)
    h = buf[R.MADE, i]
    x0, y0, vx0, vy0, ax0, ay0 = before
    x1, y1, vx1, vy1, ax1, ay1 = after
    x, x_rate = quintic(u, h, x0, vx0, ax0, x1, vx1, ax1)
    y, y_rate = quintic(u, h, y0, vy0, ay0, y1, vy1, ay1)
    return x, y, x_rate, y_rate
