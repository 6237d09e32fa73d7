"""Lift-off of the column from the plane without an impact, and its condition."""

import math

from stylobate.models.sliding.phases import FLYING, Numbers, State
from stylobate.models.sliding.posture import (
    Triple,
    headed,
    height_of,
    lean_of,
    lean_with_rate,
    moving,
    placed,
    rates_of,
    turning,
)


def lifted(state: State, n: Numbers) -> State:
    """Return the column in the air at the instant of lift-off without an impact."""
    return lifted_with(state, 0.0, n)


def lifted_with(state: State, opening: float, n: Numbers) -> State:
    """Return a column in the air whose lowest point leaves the plane with this speed."""
    if state.tilt_x == 0.0 and state.tilt_y == 0.0:
        return headed(
            moving(state, (state.velocity_x, state.velocity_y), 0.0, opening, FLYING), (0.0, 0.0, 0.0), FLYING
        )
    ux, uy, sine, cos = lean_of(state)
    w1, w2 = turning(state)
    # V_d = v_d + ρ'w2, V_n = v_n − w, and z' w2 upwards
    ahead, swing = (cos + n.c * sine) * w2, n.c * state.spin + w1
    velocity = (state.velocity_x + ahead * ux + swing * uy, state.velocity_y + ahead * uy - swing * ux)
    flying = moving(state, velocity, height_of(sine, cos, n.c), opening + (n.c * cos - sine) * w2, FLYING)
    return headed(flying, (0.0, 0.0, 0.0), FLYING)


def opens(state: State, now: Triple, n: Numbers) -> bool:
    """Return whether the rim would leave the plane: without contact forces its lowest point accelerates upwards."""
    free = rates_of(placed(state, lean_with_rate(state), state.spin, FLYING), now, n)
    ux, uy, sine, cos = lean_of(state)
    _, w2 = turning(state)
    around = (state.tilt_rate_y * ux - state.tilt_rate_x * uy) / math.hypot(state.tilt_x, state.tilt_y)
    falling = free[2] * ux + free[3] * uy + around * around * math.hypot(state.tilt_x, state.tilt_y)
    return free[11] - (n.c * cos - sine) * falling + (cos + n.c * sine) * w2 * w2 >= 0.0
