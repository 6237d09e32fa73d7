"""Transitions of the column when a kind of contact ends."""

import math

from stylobate.models.sliding.equations import STILL
from stylobate.models.sliding.face_impacts import face_impact
from stylobate.models.sliding.landing import land
from stylobate.models.sliding.lift_off import lifted
from stylobate.models.sliding.on_base import set_down, set_sliding, settle_flat, tripping, uplifted
from stylobate.models.sliding.on_rim import held, jammed, leaving, settle_rim
from stylobate.models.sliding.onset import begin_slip
from stylobate.models.sliding.phases import FLYING, RESTING, ROLLING, SLIDING, SLIPPING, Numbers, State
from stylobate.models.sliding.posture import (
    KICK,
    Triple,
    forces,
    headed_along_slip,
    lean_with_rate,
    moving,
    placed,
    radius_of,
    yaw,
)

_LIFT, _FRICTION, _SUPPORT, _REST, _JAM, _FACE_IMPACT = 0, 1, 2, 3, 4, 6

# A weight below this counts as zero [m g]: a sliding base lifts off, and friction vanishes.
_WEIGHTLESS = 1e-12


def reaction(
    state: State, event: int, now: Triple, later: Triple, ahead: float, rest: float, numbers: Numbers
) -> tuple[float, State]:
    """Return elapsed time and state after the guard of this number has fallen below zero.

    Parameters
    ----------
    state
        State at the event.
    event
        Index of the guard in GUARDS; any other number settles the contact of the state.
    now, later, ahead
        Base accelerations [g] at the event and after the time `ahead`, in which uplift or slip develops.
    rest
        Rest energy ε.
    numbers
        Parameters of the model.
    """
    rim = state.contact in (ROLLING, SLIPPING)
    flies = state.contact == FLYING
    if rim and event == _FACE_IMPACT:
        return face_impact(state, now, later, ahead, rest, numbers)
    if rim and event == _REST:
        return set_down(state, now, later, ahead, numbers)
    if rim and event == _JAM:
        return 0.0, settle_rim(jammed(state, numbers), now, numbers)
    if rim and event == _LIFT:
        return leaving(state, now, later, ahead, numbers)
    if rim and event == _FRICTION and state.contact == SLIPPING:
        return stopped(state, now, later, ahead, numbers)
    if rim and event == _FRICTION:
        return begin_slip(state, now, later, ahead, numbers)
    if rim:
        return 0.0, settle_rim(state, now, numbers)
    if flies:
        return land(state, now, later, ahead, rest, numbers)
    if event == _LIFT:
        return 0.0, lifted(state, numbers)
    if state.contact == SLIDING:
        if event == _FRICTION:
            return stopped(state, now, later, ahead, numbers)
        if event == _SUPPORT and 1.0 + now[2] - numbers.relief > _WEIGHTLESS:
            return tripping(state, now, numbers)
        if event == _SUPPORT:
            return 0.0, lifted(state, numbers)
        return settle_flat(state, now, later, ahead, numbers)
    if event == _FRICTION:
        return set_sliding(state, now, later, ahead, numbers)
    if event == _SUPPORT:
        return uplifted(state, now, later, ahead, numbers)
    return settle_flat(state, now, later, ahead, numbers)


def stopped(state: State, now: Triple, later: Triple, ahead: float, n: Numbers) -> tuple[float, State]:
    """Return elapsed time and state after the slip along the heading has ended.

    A slip that has turned across its heading continues along a new heading. Only a slip close to zero stops.
    """
    slip_z = radius_of(state, n) * yaw(state)
    along = state.velocity_x * state.heading_x + state.velocity_y * state.heading_y + slip_z * state.heading_z
    if math.sqrt(state.velocity_x**2 + state.velocity_y**2 + slip_z**2) > KICK * max(STILL, along):
        return 0.0, headed_along_slip(state, n)
    if state.contact == SLIDING:
        still = moving(placed(state, lean_with_rate(state), 0.0, RESTING), (0.0, 0.0), 0.0, 0.0, RESTING)
        return settle_flat(still, now, later, ahead, n)
    still = settle_rim(held(state, n), now, n)
    if still.contact == ROLLING and forces(still, now, n)[10] <= 0.0:
        return begin_slip(still, now, later, ahead, n)
    return 0.0, still
