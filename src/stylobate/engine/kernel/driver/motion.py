"""Motion of a lane: contact loads within a step, tilt vector and rates, start of motion, and peaks within a step."""

import math

from stylobate.compiler.marks import fast, lanes
from stylobate.engine.elementary import length, nearest_turn, quintic, turns_of, winding
from stylobate.engine.kernel.bound import DEMANDS, ORDER, PLANAR, SERIES, R, Table
from stylobate.engine.kernel.driver.equations import (
    State,
    accelerations,
    lean_of_new,
    loads_of,
    model_lean,
    model_rest_energy,
    rates_at,
    row_state,
)
from stylobate.engine.kernel.driver.stages import series_within, set_within
from stylobate.engine.tolerances import FINEST_SHARE, PLANAR_OFFSET

PLACES = tuple(range(1, 5))
"""Numbers of the equal parts of a step; the loads are evaluated at the end of each part."""
LOADS = 3
"""Normal force, friction demand and pivoting demand, in the order of their rows."""


@fast
def follow_demands(buf: Table, width: int) -> None:
    """Record the extremes of the loads within the step just made; the loads at its start remain from the last step."""
    for place in PLACES:  # one loop over lanes for each place: a joint loop would be too long
        evaluate_loads(buf, place, width)
    for i in lanes(width):
        record_extreme(buf, i, 0, R.NORMAL, -1.0)
        record_extreme(buf, i, 1, R.FRICTION, 1.0)
        record_extreme(buf, i, 2, R.PIVOTING, 1.0)


@fast
def evaluate_loads(buf: Table, place: int, width: int) -> None:
    """Compute the loads at the end of one part of the step."""
    for i in lanes(width):
        share = place / len(PLACES)
        h, t = buf[R.MADE, i], buf[R.TIME, i]
        time = t if place == len(PLACES) else t - (1.0 - share) * h
        loads = loads_of(buf, i, state_within(buf, i, share), accelerations(buf, i, time))
        for load in range(LOADS):
            buf[R.LOADS + LOADS * place + load, i] = loads[load]


def state_within(buf: Table, i: int, share: float) -> State:
    """Return the state at this fraction of the step, by cubics through its ends or by its series."""
    if share == 1.0:
        return tuple(buf[R.STATE + j, i] for j in range(ORDER))
    h = buf[R.MADE, i]
    if SERIES:
        return series_within(buf, i, share * h)
    return tuple(
        cubic_within(
            share, h, buf[R.LAST_STATE + j, i], buf[R.STATE + j, i], buf[R.LAST_SLOPE + j, i], buf[R.SLOPE + j, i]
        )
        for j in range(ORDER)
    )


def cubic_within(share: float, h: float, start: float, end: float, slope: float, end_slope: float) -> float:
    """Return the value at this fraction of a step of the cubic with these values and slopes at its ends."""
    rest = 1.0 - share
    value = rest * rest * (1.0 + 2.0 * share) * start + share * share * (3.0 - 2.0 * share) * end
    return value + h * (share * rest * rest * slope + -share * share * rest * end_slope)


def record_extreme(buf: Table, i: int, load: int, row: int, sign: float) -> None:
    """Record the maximum (sign 1) or minimum (sign −1) of a load within the step just made."""
    values = tuple(buf[R.LOADS + LOADS * place + load, i] for place in range(len(PLACES) + 1))
    top = values[0]
    for first in range(0, len(PLACES), 2):
        start, middle, end = values[first], values[first + 1], values[first + 2]
        bend = start - 2.0 * middle + end
        slant = end - start
        # The parabola has an extreme of the right kind within these two parts.
        inside = 1.0 if abs(slant) < -2.0 * sign * bend else 0.0
        peak = middle - slant * slant / (8.0 * (bend if inside > 0.0 else 1.0))
        peak = peak if inside > 0.0 else middle
        top = farther(farther(top, peak, sign), end, sign)
    go, before = buf[R.GO, i], buf[row, i]
    buf[row, i] = farther(before, top, sign) if go > 0.0 else before
    buf[R.LOADS + load, i] = values[-1] if go > 0.0 else values[0]


def farther(a: float, b: float, sign: float) -> float:
    return min(a, b) if sign < 0.0 else max(a, b)


def azimuth_now(buf: Table, i: int) -> float:
    """Return the continuous azimuth of the tilt vector [turns]; the last one while standing, 0 before any tilt."""
    if PLANAR or buf[R.STANDS, i] > 0.0:
        last = buf[R.LAST_AZIMUTH, i]
        return 0.0 if math.isnan(last) else last
    return buf[R.TURNS, i] + turns_of(buf[R.X, i], buf[R.Y, i])


def square_of_speed(buf: Table, i: int, energy: float) -> float:
    """Return the square of the speed at which a column near the vertical has this energy [c²]."""
    c = buf[R.SLENDERNESS, i]
    of_speed_c = model_rest_energy(buf, i, 0.0, c, 0.0)
    return energy * c**4 / of_speed_c if of_speed_c > 0.0 else 0.0


def set_lean(buf: Table, i: int) -> None:
    """Compute the rows of the tilt vector from the state."""
    x, y, vx, vy = model_lean(buf, i)
    buf[R.X, i] = x
    buf[R.Y, i] = y
    buf[R.VX, i] = vx
    buf[R.VY, i] = vy
    buf[R.TILT, i] = math.hypot(x, y)
    buf[R.RADIAL, i] = x * vx + y * vy
    buf[R.MOMENTUM, i] = x * vy - y * vx


def set_rates(buf: Table, i: int, t: float) -> None:
    """Compute the contact loads and the slopes at the start of a step, if the kernel has them."""
    if DEMANDS:
        set_loads(buf, i, t)
    if SERIES:
        return
    slopes = rates_at(buf, i, t, row_state(buf, i, R.STATE))
    for j in range(ORDER):
        buf[R.SLOPE + j, i] = slopes[j]


def set_loads(buf: Table, i: int, t: float) -> None:
    """Compute the contact loads at the start of a step."""
    loads = loads_of(buf, i, row_state(buf, i, R.STATE), accelerations(buf, i, t))
    for load in range(LOADS):
        buf[R.LOADS + load, i] = loads[load]


def set_state(buf: Table, i: int, state: tuple[float, ...]) -> None:
    for j in range(ORDER):
        buf[R.STATE + j, i] = state[j]


def is_at_rest(buf: Table, i: int) -> bool:
    x, y, vx, vy = model_lean(buf, i)
    return x == 0.0 and y == 0.0 and vx == 0.0 and vy == 0.0


def start_moving(buf: Table, i: int, t: float, wanted: float) -> None:
    """Start the motion from the state in the buffer at `t`; `wanted` is the first step to try, or 0."""
    buf[R.STANDS, i] = 0.0
    buf[R.TIME, i] = t
    set_lean(buf, i)
    x, y, tilt = buf[R.X, i], buf[R.Y, i], buf[R.TILT, i]
    if PLANAR:
        buf[R.SIDE, i] = math.copysign(1.0, x if x != 0.0 else buf[R.VX, i])
    else:
        buf[R.THREE_DIMENSIONAL, i] = 1.0
        here = turns_of(x, y)
        azimuth = nearest_turn(here, buf[R.LAST_AZIMUTH, i])
        buf[R.TURNS, i] = azimuth - here
        if math.isnan(buf[R.FIRST_AZIMUTH, i]):
            buf[R.FIRST_AZIMUTH, i] = azimuth
        buf[R.TRACE_AZIMUTH, i] = azimuth
    atol = buf[R.ATOL, i]
    buf[R.ATOL_NOW, i] = min(atol, max(buf[R.RTOL, i] * tilt, FINEST_SHARE * atol)) if tilt > 0.0 else atol
    if tilt > buf[R.PEAK_TILT, i]:
        buf[R.PEAK_TILT, i] = tilt
        buf[R.PEAK_AT, i] = t
    set_rates(buf, i, t)
    buf[R.AIMED, i] = 0.0
    buf[R.REJECTED, i] = 0.0
    buf[R.WANTED, i] = wanted if wanted > 0.0 else first_step(buf, i, t)


def first_step(buf: Table, i: int, t: float) -> float:
    """Return a first step (Hairer, Nørsett, Wanner, section II.4)."""
    atol, rtol = buf[R.ATOL_NOW, i], buf[R.RTOL, i]
    longest = min(buf[R.LONGEST_STEP, i], buf[R.END, i] - t)
    slopes = rates_at(buf, i, t, row_state(buf, i, R.STATE))
    d0 = d1 = d2 = 0.0
    for j in range(ORDER):
        scale = atol + rtol * abs(buf[R.STATE + j, i])
        d0 += (buf[R.STATE + j, i] / scale) ** 2 / ORDER
        d1 += (slopes[j] / scale) ** 2 / ORDER
    d0, d1 = math.sqrt(d0), math.sqrt(d1)
    h = 1e-6 if d0 < 1e-5 or d1 < 1e-5 else 0.01 * d0 / d1  # noqa: PLR2004  numbers of the reference
    h = min(h, longest)
    for j in range(ORDER):
        buf[R.NEW + j, i] = buf[R.STATE + j, i] + h * slopes[j]
    ahead = rates_at(buf, i, t + h, row_state(buf, i, R.NEW))
    for j in range(ORDER):
        scale = atol + rtol * abs(buf[R.STATE + j, i])
        d2 += ((ahead[j] - slopes[j]) / scale) ** 2 / ORDER
    d2 = math.sqrt(d2) / h if h > 0.0 else 0.0
    still = d1 <= 1e-15 and d2 <= 1e-15  # noqa: PLR2004
    other = max(1e-6, h * 1e-3) if still else (0.01 / max(d1, d2)) ** 0.125
    found = min(100.0 * h, other, longest)
    # If the rates overflow, the step is zero or NaN. The longest step is then shortened until the run fails.
    return found if found > 0.0 else longest


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
