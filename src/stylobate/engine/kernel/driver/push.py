"""Base acceleration in a lane: a sum of harmonic terms, or the present polynomial of a tabulated motion."""

from stylobate.engine.elementary import cos_turns
from stylobate.engine.kernel.bound import (
    COMPONENTS,
    DEGREE,
    FIRST_FORCING,
    FORCING_ROWS,
    PLANAR,
    TERMS,
    VERTICAL,
    WINDOWED,
    R,
)
from stylobate.engine.kernel.layout import Table

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
