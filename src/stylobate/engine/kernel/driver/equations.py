"""Equations of the model and base motion of a lane, as the driver evaluates them."""

import math

from stylobate.engine.elementary import cos_turns, length
from stylobate.engine.kernel.bound import (
    CAN_DEPART,
    CAN_LOSE,
    CAN_PASS,
    CAN_PROVE_NO_RETURN,
    CAN_REST,
    COMPONENTS,
    DEGREE,
    DEMANDS,
    FIRST_FORCING,
    FORCING_ROWS,
    GROUP_KINDS,
    GROUP_MOVING,
    KEEPS_AT_REST,
    MOTION_AT,
    ORDER,
    PARAMETERS,
    PLANAR,
    TERMS,
    VERTICAL,
    WINDOWED,
    R,
    Table,
    at_rest,
    contact,
    departure,
    from_plane,
    guards,
    impact_map,
    no_return_tilt,
    passage,
    rates,
    rest_energy,
    tilt_of,
)
from stylobate.engine.kernel.columns import Piece, Tabulated, Wave
from stylobate.engine.kernel.shape import ANY_KIND
from stylobate.models.model import Push

Accelerations = tuple[float, float, float]


def accelerations(buf: Table, i: int, t: float) -> Accelerations:
    """Return the accelerations at a time [g]: x and y (along the line and 0 if planar), and vertical."""
    if DEGREE >= 0:
        u = (t - buf[FIRST_FORCING, i]) * buf[FIRST_FORCING + 1, i]
        return directed(tuple(piece_polynomial(buf, i, u, k) for k in range(COMPONENTS)))
    return directed(tuple(waves(buf, i, t, k) for k in range(COMPONENTS)))


def directed(components: tuple[float, ...]) -> Accelerations:
    """Return the accelerations x, y and z from the components of the kernel."""
    vertical = components[-1] if VERTICAL else 0.0
    return components[0], 0.0 if PLANAR else components[1], vertical


def waves(buf: Table, i: int, t: float, component: int) -> float:
    """Return Σ a cos 2π(ft + φ) of a component, each term times its window."""
    total = 0.0
    for term in tuple(range(TERMS)):
        row = FIRST_FORCING + term * FORCING_ROWS
        turns = buf[row, i] * t
        wave = buf[row + 1 + 2 * component, i] * cos_turns(turns + buf[row + 2 + 2 * component, i])
        if WINDOWED:
            wave = wave * window(buf, i, t, row + 1 + 2 * COMPONENTS)
        total = wave if term == 0 else total + wave
    return total


def window(buf: Table, i: int, t: float, row: int) -> float:
    """Return the window α − β cos 2π(ft + φ) of a term, from the coefficients that begin at this row."""
    return buf[row, i] - buf[row + 1, i] * cos_turns(buf[row + 2, i] * t + buf[row + 3, i])


def piece_polynomial(buf: Table, i: int, u: float, component: int) -> float:
    """Return a component by Horner's rule; `u` is the time from the middle of the piece over half its length."""
    row = FIRST_FORCING + 2 + component * (DEGREE + 1)
    value = buf[row + DEGREE, i]
    for power in tuple(range(DEGREE)):
        value = value * u + buf[row + DEGREE - 1 - power, i]
    return value


def keep_end_push(buf: Table, i: int, push: Accelerations) -> None:
    """Store the accelerations at the end of the step, which its last two stages use."""
    ax, ay, az = push
    buf[R.END_PUSH, i] = ax
    if not PLANAR:
        buf[R.END_PUSH + 1, i] = ay
    if VERTICAL:
        buf[R.END_PUSH + COMPONENTS - 1, i] = az


def end_push(buf: Table, i: int) -> Accelerations:
    """Return the accelerations at the end of the step."""
    return directed(tuple(buf[R.END_PUSH + k, i] for k in range(COMPONENTS)))


# Taylor coefficients about a time.


def push_series(buf: Table, i: int, t: float, order: int) -> tuple[tuple[float, ...], ...]:
    """Return the Taylor coefficients below `order` of each component about a time."""
    if DEGREE >= 0:
        u = (t - buf[FIRST_FORCING, i]) * buf[FIRST_FORCING + 1, i]
        return tuple(shifted_polynomial(buf, i, u, k, order) for k in range(COMPONENTS))
    return tuple(wave_series(buf, i, t, k, order) for k in range(COMPONENTS))


def wave_series(buf: Table, i: int, t: float, component: int, order: int) -> tuple[float, ...]:
    """Return the coefficients of the sum of the terms; a term with a window is a sum of three waves."""
    total = tuple(0.0 for _ in range(order))
    for term in tuple(range(TERMS)):
        row = FIRST_FORCING + term * FORCING_ROWS
        turns, size, phase = buf[row, i], buf[row + 1 + 2 * component, i], buf[row + 2 + 2 * component, i]
        if not WINDOWED:
            total = added(total, wave(t, turns, size, 0.0, phase, order))
        else:
            at = row + 1 + 2 * COMPONENTS
            full, half, rate, begins = buf[at, i], -0.5 * buf[at + 1, i], buf[at + 2, i], buf[at + 3, i]
            total = added(total, wave(t, turns, full * size, 0.0, phase, order))
            total = added(total, wave(t, turns + rate, half * size, begins, phase, order))
            total = added(total, wave(t, turns - rate, half * size, -begins, phase, order))
    return total


def added(a: tuple[float, ...], b: tuple[float, ...]) -> tuple[float, ...]:
    return tuple(one + other for one, other in zip(a, b, strict=True))


def wave(t: float, turns: float, size: float, begins: float, phase: float, order: int) -> tuple[float, ...]:
    """Return the coefficients of a wave, by the recurrence of f″ = −ω²f."""
    omega = 6.283185307179586 * turns
    square = -omega * omega
    angle = turns * t + begins + phase
    out: tuple[float, ...] = (size * cos_turns(angle), -omega * size * cos_turns(angle - 0.25))
    for k in tuple(range(2, order)):
        out = (*out, square * (1.0 / (k * (k - 1))) * out[k - 2])
    return out


def shifted_polynomial(buf: Table, i: int, u: float, component: int, order: int) -> tuple[float, ...]:
    """Return the coefficients of a polynomial expanded about `u`, by repeated synthetic division."""
    row = FIRST_FORCING + 2 + component * (DEGREE + 1)
    b = tuple(buf[row + power, i] for power in range(DEGREE + 1))
    for k in tuple(range(DEGREE)):
        shifted: tuple[float, ...] = (b[DEGREE],)
        for j in tuple(range(DEGREE - 1, k - 1, -1)):
            shifted = (b[j] + u * shifted[0], *shifted)
        b = (*b[:k], *shifted)
    per_half = buf[FIRST_FORCING + 1, i]
    power = 1.0
    out: tuple[float, ...] = (b[0],)
    for k in tuple(range(1, order)):
        power = per_half if k == 1 else power * per_half
        out = (*out, b[k] * power if k <= DEGREE else 0.0)
    return out


State = tuple[float, ...]

# Negligible tilt that has a sign.
ASIDE = 1e-140
# Lower bound of the normal force in demands, in fractions of the weight; demands there are practically infinite.
LEAST_NORMAL = 1e-12


def numbers(buf: Table, i: int) -> tuple[float, ...]:
    """Return the parameters of the model."""
    return tuple(buf[R.PARAMETER + j, i] for j in range(PARAMETERS))


def row_state(buf: Table, i: int, row: int) -> State:
    """Return the state stored from this row on."""
    return tuple(buf[row + j, i] for j in range(ORDER))


def stage_state(buf: Table, i: int, group: int) -> State:
    """Return the state at a stage; where a group has one kind of contact, it is known when this is compiled."""
    moved = tuple(buf[R.STAGE + j, i] for j in range(GROUP_MOVING[group]))
    kept = tuple(buf[R.STATE + j, i] for j in range(GROUP_MOVING[group], ORDER - 1))
    return *moved, *kept, buf[R.CONTACT, i] if GROUP_KINDS[group] == ANY_KIND else float(GROUP_KINDS[group])


def rates_under(buf: Table, i: int, state: State, push: Accelerations) -> State:
    """Return the right-hand side under these accelerations."""
    ax, ay, az = push
    if PLANAR:
        return rates(*state, buf[R.SIDE, i], ax, az, *numbers(buf, i))
    return rates(*state, ax, ay, az, *numbers(buf, i))


def guards_under(buf: Table, i: int, state: State, push: Accelerations) -> tuple[float, ...]:
    """Return the guards of a state under these accelerations."""
    return guards(*state, *push, buf[R.REST_ENERGY, i], buf[R.PASSAGE_TILT, i], *numbers(buf, i))


def rates_at(buf: Table, i: int, t: float, state: State) -> State:
    """Return the right-hand side at a time."""
    return rates_under(buf, i, state, accelerations(buf, i, t))


def lean_of(buf: Table, i: int, state: State) -> tuple[float, float, float, float]:
    """Return the tilt vector and its rate; along x if planar."""
    if PLANAR:
        return state[0], 0.0, state[1], 0.0
    return tilt_of(*state, *numbers(buf, i))


def model_lean(buf: Table, i: int) -> tuple[float, float, float, float]:
    return lean_of(buf, i, row_state(buf, i, R.STATE))


def lean_of_new(buf: Table, i: int) -> tuple[float, float, float, float]:
    return lean_of(buf, i, row_state(buf, i, R.NEW))


def loads_of(buf: Table, i: int, state: State, push: Accelerations) -> tuple[float, float, float]:
    """Return normal force, friction demand and pivoting demand; 1, 0, 0 if the kernel does not compute demands."""
    if not DEMANDS:
        return 1.0, 0.0, 0.0
    if PLANAR:
        # At tilt zero the column stands on the edge of the side towards which it moves.
        tilt = state[0] + ASIDE * buf[R.SIDE, i]
        normal, force, moment = contact(
            *from_plane(tilt, state[1], 1.0, 0.0, *numbers(buf, i)), *push, *numbers(buf, i)
        )
    else:
        normal, force, moment = contact(*state, *push, *numbers(buf, i))
    per = 1.0 / max(normal, LEAST_NORMAL)
    return normal, force * per, moment * per


def model_rest_energy(buf: Table, i: int, tilt: float, speed: float, az: float) -> float:
    return rest_energy(tilt, speed, az, *numbers(buf, i)) if CAN_REST else math.inf


def model_no_return(buf: Table, i: int, largest: float, least: float) -> float:
    return no_return_tilt(largest, least, *numbers(buf, i)) if CAN_PROVE_NO_RETURN else math.inf


def model_passage(buf: Table, i: int, ax: float, ay: float, az: float) -> tuple[float, State]:
    """Return the duration of the analytical passage through the vertical, and the state after it."""
    state = row_state(buf, i, R.STATE)
    return passage(*state, ax, ay, az, *numbers(buf, i)) if CAN_PASS else (0.0, state)


def model_at_rest(buf: Table, i: int) -> State:
    """Return the state of a column that comes to rest."""
    if KEEPS_AT_REST:
        return at_rest(*row_state(buf, i, R.STATE), *numbers(buf, i))
    return tuple(0.0 for _ in range(ORDER))


def model_impact(buf: Table, i: int) -> State:
    """Return the state after an impact."""
    state = row_state(buf, i, R.STATE)
    if not CAN_LOSE:
        return state
    if not PLANAR:
        return impact_map(*state, *numbers(buf, i))
    struck = impact_map(*from_plane(state[0], state[1], 1.0, 0.0, *numbers(buf, i)), *numbers(buf, i))
    x, _, vx, _ = tilt_of(*struck, *numbers(buf, i))
    return x, vx


def model_departure(buf: Table, i: int, push: Push, elapsed: float, ux: float, uy: float) -> State:
    """Return the state a short time after uplift; if planar, tilt and rate along the line."""
    if not CAN_DEPART:
        return row_state(buf, i, R.STATE)
    state = departure(push, elapsed, *numbers(buf, i))
    if not PLANAR:
        return state
    x, y, vx, vy = tilt_of(*state, *numbers(buf, i))
    return x * ux + y * uy, vx * ux + vy * uy


# First coefficient of a piece.
COEFFICIENTS_AT = len(Piece)


def set_leg(buf: Table, i: int, table: Table, pieces: Table, t: float) -> None:
    """Set the rows of the base motion for the leg that begins at `t`."""
    motion = table[int(buf[R.RUN, i]), MOTION_AT:]
    buf[R.LEG_ENDS, i] = math.inf
    if DEGREE >= 0:
        set_piece(buf, i, motion, pieces, t)
    else:
        set_terms(buf, i, motion, t)


def set_terms(buf: Table, i: int, motion: Table, t: float) -> None:
    """Set the terms of a harmonic base motion."""
    columns = len(Wave) if WINDOWED else Wave.ONSET
    for term in range(TERMS):
        wave = motion[term * columns :]
        row = FIRST_FORCING + term * FORCING_ROWS
        buf[row, i] = wave[Wave.TURNS]
        if PLANAR:
            # The acceleration along the line is a sum of two cosines of one frequency.
            ux, uy = buf[R.LINE_X, i], buf[R.LINE_Y, i]
            fx, fy = 2.0 * math.pi * wave[Wave.PHASE_X], 2.0 * math.pi * wave[Wave.PHASE_Y]
            cos = ux * wave[Wave.SIZE_X] * math.cos(fx) + uy * wave[Wave.SIZE_Y] * math.cos(fy)
            sin = ux * wave[Wave.SIZE_X] * math.sin(fx) + uy * wave[Wave.SIZE_Y] * math.sin(fy)
            buf[row + 1, i] = math.hypot(cos, sin)
            buf[row + 2, i] = math.atan2(sin, cos) / (2.0 * math.pi)
            row += 3
        else:
            for k in range(4):
                buf[row + 1 + k, i] = wave[Wave.SIZE_X + k]
            row += 5
        if VERTICAL:
            buf[row, i] = wave[Wave.SIZE_Z]
            buf[row + 1, i] = wave[Wave.PHASE_Z]
            row += 2
        if WINDOWED:
            begins, ends = wave[Wave.BEGINS], wave[Wave.ENDS]
            full = 0.0 if t < wave[Wave.ONSET] else 0.5 if t < ends else 1.0
            per_turn = 0.5 / (ends - begins) if ends > begins else 0.0
            buf[row, i] = full
            buf[row + 1, i] = 0.5 if full == 0.5 else 0.0  # noqa: PLR2004
            buf[row + 2, i] = per_turn
            buf[row + 3, i] = -per_turn * begins


def set_piece(buf: Table, i: int, motion: Table, pieces: Table, t: float) -> None:
    """Load the polynomial that begins at `t`."""
    delay, first = motion[Tabulated.DELAY], int(motion[Tabulated.FIRST])
    last = int(motion[Tabulated.FIRST] + motion[Tabulated.COUNT]) - 1
    time = t * buf[R.TIME_SCALE, i] * (1.0 + 4e-16)  # a leg that begins at a knot has passed it
    if time < delay:
        for row in range(FIRST_FORCING, FIRST_FORCING + 2 + (2 - PLANAR + VERTICAL) * FORCING_ROWS):
            buf[row, i] = 0.0
        add_offset(buf, i, motion)
        buf[R.CONTINUED, i] = 0.0
        buf[R.LEG_ENDS, i] = delay * buf[R.PER_SECOND, i]
        return
    load_piece(buf, i, motion, pieces, piece_at(pieces, first + int(buf[R.PIECE, i]), first, last, delay, time))


def load_piece(buf: Table, i: int, motion: Table, pieces: Table, index: int) -> None:
    """Load the polynomial in row `index`, and the bounds of the base motion after its start."""
    factor, cos, sin = motion[Tabulated.FACTOR], motion[Tabulated.COS], motion[Tabulated.SIN]
    vertical, delay = motion[Tabulated.VERTICAL], motion[Tabulated.DELAY]
    number, count = index - int(motion[Tabulated.FIRST]), int(motion[Tabulated.COUNT])
    per_second = buf[R.PER_SECOND, i]
    piece = pieces[index]
    end = piece[Piece.END]
    buf[R.PIECE, i] = number
    buf[R.CONTINUED, i] = piece[Piece.CONTINUED]
    buf[FIRST_FORCING, i] = (0.5 * (piece[Piece.START] + end) + delay) * per_second
    buf[FIRST_FORCING + 1, i] = piece[Piece.PER_HALF] * buf[R.TIME_SCALE, i]
    for k in range(FORCING_ROWS):
        x, y = piece[COEFFICIENTS_AT + k], piece[COEFFICIENTS_AT + FORCING_ROWS + k]
        x, y = factor * (cos * x - sin * y), factor * (sin * x + cos * y)
        row = FIRST_FORCING + 2 + k
        if PLANAR:
            buf[row, i] = x * buf[R.LINE_X, i] + y * buf[R.LINE_Y, i]
        else:
            buf[row, i] = x
            row += FORCING_ROWS
            buf[row, i] = y
        if VERTICAL:
            buf[row + FORCING_ROWS, i] = vertical * piece[COEFFICIENTS_AT + 2 * FORCING_ROWS + k]
    largest = abs(factor) * piece[Piece.LARGEST_HORIZONTAL] + add_offset(buf, i, motion)
    up, down = vertical * piece[Piece.MINIMUM_VERTICAL], vertical * piece[Piece.MAXIMUM_VERTICAL]
    least = min(up, down)
    changed = largest != buf[R.LARGEST_HORIZONTAL, i] or least != buf[R.MINIMUM_VERTICAL, i]
    buf[R.LARGEST_HORIZONTAL, i] = largest
    buf[R.MINIMUM_VERTICAL, i] = least
    buf[R.MAXIMUM_VERTICAL, i] = max(up, down)
    if changed:
        set_bounds(buf, i)
    buf[R.LEG_ENDS, i] = (end + delay) * per_second if number < count - 1 else math.inf


def add_offset(buf: Table, i: int, motion: Table) -> float:
    """Add the constant acceleration to the polynomial, and return its size."""
    x, y = motion[Tabulated.OFFSET_X], motion[Tabulated.OFFSET_Y]
    row = FIRST_FORCING + 2
    if PLANAR:
        buf[row, i] = buf[row, i] + x * buf[R.LINE_X, i] + y * buf[R.LINE_Y, i]
    else:
        buf[row, i] = buf[row, i] + x
        buf[row + FORCING_ROWS, i] = buf[row + FORCING_ROWS, i] + y
    return length(x, y)


def continues_in_next_piece(buf: Table, i: int, table: Table, pieces: Table) -> bool:
    """Load the next piece if it continues this leg without a jump, so that slopes are valid; return whether it does."""
    if buf[R.CONTINUED, i] == 0.0:
        return False
    motion, leg_end = table[int(buf[R.RUN, i]), MOTION_AT:], buf[R.LEG_ENDS, i]
    load_piece(buf, i, motion, pieces, int(motion[Tabulated.FIRST] + buf[R.PIECE, i]) + 1)
    return buf[R.LEG_ENDS, i] > leg_end  # a very short piece can have no length, by rounding


def piece_at(pieces: Table, near: int, first: int, last: int, delay: float, time: float) -> int:
    """Return the index of the last piece that begins no later than `time`; `near` is the index of the last query."""
    if pieces[near, Piece.START] + delay <= time:
        first = near
        if near == last or pieces[near + 1, Piece.START] + delay > time:
            return near
        if near + 1 == last or pieces[near + 2, Piece.START] + delay > time:
            return near + 1
    while first < last:
        middle = (first + last + 1) // 2
        if pieces[middle, Piece.START] + delay <= time:
            first = middle
        else:
            last = middle - 1
    return first


def set_bounds(buf: Table, i: int) -> None:
    """Set the point of no return and the minimum holding force under the remaining base motion."""
    pushed = buf[R.LARGEST_HORIZONTAL, i] + length(buf[R.SLOPE_X, i], buf[R.SLOPE_Y, i])
    buf[R.LEAST_FORCE, i] = buf[R.CAPACITY, i] * minimum_weight(buf, i) - pushed
    bound = math.inf
    if CAN_PROVE_NO_RETURN:
        bound = model_no_return(buf, i, buf[R.LARGEST_HORIZONTAL, i], buf[R.MINIMUM_VERTICAL, i])
    buf[R.NO_RETURN, i] = bound if bound < math.inf else buf[R.OVERTURNED_TILT, i]


def forcing_rate(buf: Table, i: int) -> float:
    """Return the maximum rate of change of the force on a column near rest; exact for linear pieces."""
    if DEGREE == 1:
        per_half = buf[FIRST_FORCING + 1, i]
        x, row = buf[FIRST_FORCING + 3, i], FIRST_FORCING + 5
        y = 0.0
        if not PLANAR:
            y = buf[row, i]
            row += 2
        z = buf[row, i] if VERTICAL else 0.0
        return per_half * (length(x, y) + buf[R.SLENDERNESS, i] * abs(z))
    vertical = max(abs(buf[R.MINIMUM_VERTICAL, i]), abs(buf[R.MAXIMUM_VERTICAL, i]))
    return buf[R.FREQUENCY, i] * (buf[R.LARGEST_HORIZONTAL, i] + buf[R.SLENDERNESS, i] * vertical)


def minimum_weight(buf: Table, i: int) -> float:
    return 1.0 + buf[R.MINIMUM_VERTICAL, i] + buf[R.SLOPE_Z, i]


def held_for_good(buf: Table, i: int) -> bool:
    return buf[R.LEAST_FORCE, i] >= 0.0 and minimum_weight(buf, i) > 0.0
