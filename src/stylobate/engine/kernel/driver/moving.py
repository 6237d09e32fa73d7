"""State of a lane, its tilt vector and rates, and the start of motion."""

import math

from stylobate.engine.kernel.bound import DEMANDS, ORDER, PLANAR, SERIES, R
from stylobate.engine.kernel.driver.demands import LOADS
from stylobate.engine.kernel.driver.equations import loads_of, model_lean, model_rest_energy, rates_at, row_state
from stylobate.engine.kernel.driver.push import accelerations
from stylobate.engine.kernel.layout import Table
from stylobate.engine.kernel.roots import nearest_turn, turns_of
from stylobate.engine.tolerances import FINEST_SHARE


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
