"""Passages of the vertical in closed form turn with the frame, are mirrored with it, and feel the push of the base."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stylobate as sb

BODY = sb.Column.solid(radius=0.4, height=3.0, density=2700.0)
MODELS = [
    sb.Slender(BODY, damping=0.1),
    sb.SlenderRolling(BODY, damping=0.1, spin_damping=0.2),
    sb.Wobbling(BODY, damping=0.1),
    sb.Rolling(BODY, damping=0.1, spin_damping=0.2),
]
# The path comes in along a line of its own, beside the vertical, and the base pushes along another.
LEAN, RATE, SPIN, PUSH, LIFT = (-8e-6, 3e-6), (0.05, 0.02), 0.7, (0.02, 0.03), 0.1

every_model = pytest.mark.parametrize("model", MODELS, ids=lambda model: model.name)


def passage(model, lean, rate, spin, push):
    """Return duration, lean, tilt rate and spin at the end of a passage."""
    spins = model.spin_state is not None
    state = (*lean, *rate, *([spin] if spins else []))
    elapsed, end = model.passage(*state, *push, LIFT, *model.parameters)
    return elapsed, np.array(end[:2]), np.array(end[2:4]), end[4] if spins else 0.0


@every_model
@pytest.mark.parametrize("angle", [0.7, 0.5 * math.pi, -2.0])
def test_a_passage_turns_with_the_frame(model, angle):
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    elapsed, lean, rate, spin = passage(model, LEAN, RATE, SPIN, PUSH)
    expected = elapsed, turn @ lean, turn @ rate, spin
    found = passage(model, turn @ LEAN, turn @ RATE, SPIN, turn @ PUSH)
    for one, other in zip(found, expected, strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-11, atol=1e-16)


@every_model
def test_the_mirror_image_of_a_passage_is_the_passage_of_the_mirror_image(model):
    mirror = np.diag([1.0, -1.0])
    elapsed, lean, rate, spin = passage(model, LEAN, RATE, SPIN, PUSH)
    expected = elapsed, mirror @ lean, mirror @ rate, -spin
    found = passage(model, mirror @ LEAN, mirror @ RATE, -SPIN, mirror @ PUSH)
    for one, other in zip(found, expected, strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-11, atol=1e-16)


@every_model
@pytest.mark.parametrize("push", [(0.02, 0.0), (0.0, 0.02)])
def test_without_spin_the_push_of_the_base_adds_what_it_adds_to_the_motion_integrated(model, push):
    lean, rate = (-1e-5, 2e-9), (0.05, 0.0)
    elapsed, _, pushed, _ = passage(model, lean, rate, 0.0, push)
    _, _, free, _ = passage(model, lean, rate, 0.0, (0.0, 0.0))
    state = (*lean, *rate, *([0.0] if model.spin_state is not None else []))

    def end(push):
        run = solve_ivp(
            lambda _, y: model.rates(*y, *push, LIFT, *model.parameters), (0.0, elapsed), state, "DOP853",
            rtol=1e-13, atol=1e-20,
        )  # fmt: skip
        return run.y[2:4, -1]

    # The weight slows and speeds the path by a part c/V of the time, which is left out.
    expected = end(push) - end((0.0, 0.0))
    np.testing.assert_allclose(pushed - free, expected, rtol=0.0, atol=2e-2 * 0.02 * elapsed)
