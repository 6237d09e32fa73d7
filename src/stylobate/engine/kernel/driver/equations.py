"""Equations of the model as the driver calls them, for one lane or vectorised over lanes."""

import math

from stylobate.engine.kernel.bound import (
    CAN_DEPART,
    CAN_LOSE,
    CAN_PASS,
    CAN_PROVE_NO_RETURN,
    CAN_REST,
    DEMANDS,
    KEEPS_AT_REST,
    ORDER,
    PARAMETERS,
    PLANAR,
    R,
    at_rest,
    contact,
    departure,
    from_plane,
    impact_map,
    no_return_tilt,
    passage,
    rates,
    rest_energy,
    tilt_of,
)
from stylobate.engine.kernel.driver.push import Accelerations, accelerations
from stylobate.engine.kernel.layout import Table
from stylobate.models.model import Push

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


def rates_under(buf: Table, i: int, state: State, push: Accelerations) -> State:
    """Return the right-hand side under these accelerations."""
    ax, ay, az = push
    if PLANAR:
        return rates(*state, buf[R.SIDE, i], ax, az, *numbers(buf, i))
    return rates(*state, ax, ay, az, *numbers(buf, i))


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
