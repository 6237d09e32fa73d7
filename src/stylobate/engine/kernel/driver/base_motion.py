"""Base motion of a lane: its present leg, and bounds for the remaining time.

A leg is an interval of the base motion with one formula: a piece of the tabulation, or the time between two breaks.
"""

import math

from stylobate.engine.elementary import length
from stylobate.engine.kernel.bound import (
    CAN_PROVE_NO_RETURN,
    DEGREE,
    FIRST_FORCING,
    FORCING_ROWS,
    MOTION_AT,
    PLANAR,
    TERMS,
    VERTICAL,
    WINDOWED,
    R,
)
from stylobate.engine.kernel.columns import Piece, Tabulated, Wave
from stylobate.engine.kernel.driver.equations import model_no_return
from stylobate.engine.kernel.layout import Table

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
