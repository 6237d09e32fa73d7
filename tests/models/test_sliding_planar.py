"""Slip in a vertical plane: the body in six freedoms against three equations of motion of their own."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from .sliding_body import SlidingBody
from .sliding_events import follow
from .test_constrained_body import SHAKEN


def vibrating(time):
    return 6.0 * math.sin(40.0 * time), 0.0, 0.0


def planar_motion(friction, start, duration):
    """Integrate x, z, θ and their rates from stick to slip and back: times of the changes, and the end.

    `start` sticks. Friction is ±μN or what keeps C where it is; slip begins and ends where that changes.
    """
    r, h, mass = SHAKEN.radius, SHAKEN.mass_height, SHAKEN.mass

    def lever(theta):
        return -h * math.sin(theta) + r * math.cos(theta), -h * math.cos(theta) - r * math.sin(theta)

    def forces(time, state, sense):
        theta, rate = state[2], state[5]
        x, z = lever(theta)
        # ẍ_C = T(1/m + z²/I) − N x z/I − x ω² − a;  z̈_C = N(1/m + x²/I) − T x z/I − z ω² − g
        inertia = SHAKEN.transverse_inertia
        along, across = (1.0 / mass + z * z / inertia, -x * z / inertia), 1.0 / mass + x * x / inertia
        known = x * rate**2 + vibrating(time)[0], z * rate**2 + SHAKEN.gravity
        if sense == 0.0:
            return np.linalg.solve([along, (along[1], across)], known)
        normal = known[1] / (across - sense * friction * along[1])
        return np.array([-sense * friction * normal, normal])

    def rates(time, state, sense):
        drag, normal = forces(time, state, sense)
        x, z = lever(state[2])
        angular = (z * drag - x * normal) / SHAKEN.transverse_inertia
        return [*state[3:], drag / mass - vibrating(time)[0], normal / mass - SHAKEN.gravity, angular]

    def slipping(_, state, sense):
        return state[3] + state[5] * lever(state[2])[1] if sense else 1.0

    def left(time, state, sense):
        drag, normal = forces(time, state, 0.0)
        return friction * normal - abs(drag) if sense == 0.0 else 1.0

    slipping.terminal = left.terminal = True
    time, state, sense, changes = 0.0, start, 0.0, []
    while True:
        slipping.direction = -sense
        run = solve_ivp(rates, (time, duration), state, "DOP853", events=(slipping, left), args=(sense,),
                        rtol=1e-12, atol=1e-14)  # fmt: skip
        time, state = run.t[-1], run.y[:, -1]
        if run.status == 0:
            return changes, state
        drag, normal = forces(time, state, 0.0)
        held = sense != 0.0 and abs(drag) < friction * normal
        changes.append(time)
        sense = 0.0 if held else -math.copysign(1.0, drag)


@pytest.mark.parametrize(
    ("friction", "events"), [(0.05, ["slip", *3 * ["reverse"]]), (0.12, [*3 * ["slip", "stick"], "slip"])]
)
def test_slip_in_a_vertical_plane(friction, events):
    body = SlidingBody(SHAKEN, kinetic=friction)
    start = body.state(theta=0.15)  # c = 0.15: almost balanced on the rim
    changes, end = planar_motion(friction, [*start[[0, 2]], 0.15, 0.0, 0.0, 0.0], 0.3)
    track = follow(body, start, duration=0.3, acceleration=vibrating, times=[])
    assert [event.kind for event in track.events] == events
    assert [event.time for event in track.events] == pytest.approx(changes, abs=1e-9)
    found = track.state[-1]
    assert found[[0, 2, 7, 9, 11]] == pytest.approx(end[[0, 1, 3, 4, 5]], abs=1e-9)
    assert found[[1, 8, 10, 12]] == pytest.approx(0.0, abs=1e-12)
