"""Transitions of a column whose rim touches the plane: rolling, slip, lift-off and dynamic jamming."""

from stylobate.models.finite_tilt import sine_over_angle
from stylobate.models.sliding.equations import JAM
from stylobate.models.sliding.impacts import responses
from stylobate.models.sliding.lift_off import lifted, opens
from stylobate.models.sliding.onset import begin_slip
from stylobate.models.sliding.phases import ROLLING, SLIPPING, Numbers, State
from stylobate.models.sliding.posture import (
    Triple,
    forces,
    headed,
    headed_along_slip,
    lean_of,
    lean_with_rate,
    moving,
    placed,
    slips,
    turning,
    yaw,
)


def settle_rim(state: State, now: Triple, n: Numbers) -> State:
    """Return the next state of a column whose rim touches the plane without normal velocity.

    A column without slip rolls, even if friction is too weak: its slip then begins with the next event. Without
    friction it slips at any speed.
    """
    if n.static == 0.0 or slips(state.velocity_x, state.velocity_y, n.patch * n.c * yaw(state)):
        slipping = headed_along_slip(placed(state, lean_with_rate(state), state.spin, SLIPPING), n)
        found = forces(slipping, now, n)
        if found[11] >= JAM:
            return slipping if found[5] > 0.0 else lifted(slipping, n)
        state = jammed(slipping, n)
    still = held(state, n)
    found = forces(still, now, n)
    if found[5] > 0.0 and found[10] > 0.0:
        return still
    return lifted(still, n) if opens(still, now, n) else still


def leaving(state: State, now: Triple, later: Triple, ahead: float, n: Numbers) -> tuple[float, State]:
    """Return elapsed time and state at a negative normal force: in the air, or slipping if slip presses the rim."""
    if state.contact == SLIPPING or opens(state, now, n):
        return 0.0, lifted(state, n)
    return begin_slip(state, now, later, ahead, n)


def held(state: State, n: Numbers) -> State:
    """Return `state` rolling: its contact does not slip, and its patch does not turn."""
    spin = state.spin
    if n.patch > 0.0:
        _, _, sine, cos = lean_of(state)
        spin = turning(state)[0] * sine / cos
    rolling = placed(state, lean_with_rate(state), spin, ROLLING)
    return headed(moving(rolling, (0.0, 0.0), 0.0, 0.0, ROLLING), (0.0, 0.0, 0.0), ROLLING)


def jammed(state: State, n: Numbers) -> State:
    """Return the state after the impulse that ends slip at a zero of Painlevé's denominator (dynamic jamming).

    The impulse stops the contact and dissipates energy; it is the limit of an unbounded normal force.
    """
    ux, uy, sine, cos = lean_of(state)
    vd = state.velocity_x * ux + state.velocity_y * uy
    vn = state.velocity_y * ux - state.velocity_x * uy
    dd, dz, zz, nn = responses(sine, cos, n.c, n.kappa, n.axial)
    along = -vd / (dd - dz * dz / zz)
    struck = kicked(state, (along, -vn / nn, -dz / zz * along), n)
    return moving(struck, (0.0, 0.0), 0.0, 0.0, SLIPPING)


def kicked(state: State, struck: Triple, n: Numbers) -> State:
    """Return `state` with its angular velocity after an impulse along d, n and the vertical at its lowest point."""
    ux, uy, sine, cos = lean_of(state)
    w1, w2 = turning(state)
    w1 += struck[1] / (1.0 - n.kappa)
    w2 -= ((n.c * cos - sine) * struck[2] + (cos + n.c * sine) * struck[0]) / (1.0 - n.kappa)
    spin = state.spin + struck[1] / (n.kappa * n.axial * n.c)
    across = -w1 / sine_over_angle(state.tilt_x**2 + state.tilt_y**2)
    rate = (w2 * ux - across * uy, w2 * uy + across * ux)
    return placed(state, (state.tilt_x, state.tilt_y, rate[0], rate[1]), spin, state.contact)
