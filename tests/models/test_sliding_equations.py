"""Rates and forces of the column that can slip, against Newton's and Euler's equations with a quaternion."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.models.finite_tilt import FADING
from stylobate.models.sliding import Contact
from stylobate.models.sliding.balance import SlidingState
from stylobate.models.sliding.equations import JAM, forces

from .constrained_body import TURNING, VELOCITY
from .sliding_body import SlidingBody

# Both sides are sums of some ten terms, told to rounding; equations near Painlevé's limit magnify it.
ROUNDING, STATES = 1e-12, 100


def cases(patch, frictions):
    """A model, its body, and a random state of motion (θ, β, w1, w2, w3, slip, acceleration of the base)."""
    rng = np.random.default_rng(3)
    for c, kappa, axial, mu in rng.uniform([0.05, 0.5, 0.3, 0.05], [0.5, 0.85, 0.9, 0.8], (STATES, 4)):
        column = sb.Column.dimensionless(slenderness=c, inertia_ratio=kappa, axial_ratio=axial)
        static = mu * rng.uniform(1.0, 1.5)
        model = sb.Sliding(
            column, friction_coefficient=mu, static_friction_coefficient=static, patch=patch, **frictions
        )
        # Of this column m = g = ω0 = 1, h = J0 = κ: D1 = η J0, δ in lengths.
        body = SlidingBody(
            column,
            kinetic=mu,
            static=static,
            patch=patch * column.radius,
            viscous=model.damping * kappa,
            rolling_arm=model.rolling_resistance * column.radius,
            rolling_rate=FADING,
        )
        theta, beta = rng.uniform(0.02, 1.3), rng.uniform(-math.pi, math.pi)
        yield model, body, theta, beta, *rng.normal(scale=0.3, size=3), *rng.normal(scale=0.1, size=(2, 3))


def stated(model, body, contact, theta, beta, w1, w2, w3, slip):
    """The same motion as a `SlidingState` and as (G, q, v_C, ω)."""
    d, n = np.array([math.cos(beta), math.sin(beta)]), np.array([-math.sin(beta), math.cos(beta)])
    rate = w2 * d - theta / math.sin(theta) * w1 * n
    length = model.column.mass_height
    yawing = w3 * math.cos(theta) - w1 * math.sin(theta)
    slip = np.array([*slip[:2], model.patch * model.column.slenderness * yawing])
    heading = np.zeros(3)
    if contact == Contact.SLIPPING:
        heading = slip / np.linalg.norm(slip)
    state = SlidingState(*theta * d, *rate, w3, 0.0, 0.0, 0.0, *slip[:2], 0.0, 0.0, *heading, float(contact))
    whole = body.state(theta=theta, beta=beta, w1=w1, w2=w2, w3=w3, slip=slip[:2] * length)
    return state, body.touching(whole)


def accelerations(body, touching, rates):
    """θ̈, β̈ and ẇ3 of a body with these rates."""
    spin, e3 = touching[TURNING], body.axis(touching)
    lean = math.hypot(e3[0], e3[1])
    rate = np.cross(spin, e3)
    second = np.cross(rates[TURNING], e3) + np.cross(spin, rate)
    d, n = e3[:2] / lean, np.array([-e3[1], e3[0]]) / lean
    fall, around = -rate[2] / lean, rate[:2] @ n / lean
    # e3_z = cos θ;  e3·n = sin θ of a lean that turns
    falling = -(second[2] + e3[2] * fall**2) / lean
    turning = (second[:2] @ n - 2.0 * e3[2] * fall * around) / lean
    return falling, turning, rates[TURNING] @ e3 + spin @ rate, d, n, fall, around


@pytest.mark.parametrize("frictions", [{}, {"damping": 0.2, "rolling_resistance": 0.05}], ids=["free", "resisted"])
@pytest.mark.parametrize("patch", [0.0, 0.1], ids=["point", "patch"])
@pytest.mark.parametrize("contact", [Contact.ROLLING, Contact.SLIPPING])
def test_rates_and_forces_are_those_of_the_body(contact, patch, frictions):
    seen = 0
    for model, body, theta, beta, w1, w2, w3, slip, push in cases(patch, frictions):
        rolls = contact == Contact.ROLLING
        spin = w1 * math.tan(theta) if rolls and patch > 0.0 else w3
        state, touching = stated(model, body, contact, theta, beta, w1, w2, spin, np.zeros(3) if rolls else slip)
        at = body.touch(touching, push)
        load = (body.held if contact == Contact.ROLLING else body.slipping)(touching, at)
        found = forces(state, tuple(push), model.numbers)
        if contact == Contact.SLIPPING:
            assert found[11] == pytest.approx(load.denominator, abs=ROUNDING)
            if load.denominator < JAM:
                continue
        seen += 1
        length, scale = model.column.mass_height, 1.0 / (load.denominator if contact == Contact.SLIPPING else 1.0)
        size = max(1.0, float(np.abs(load.force).max()))
        within = {"rtol": 0.0, "atol": ROUNDING * scale * size / math.sin(theta) ** 2}
        np.testing.assert_allclose(found[5:8], load.force[[2, 0, 1]], **within)
        np.testing.assert_allclose(found[8] * length, load.couple[2] if patch else 0.0, **within)
        rates = body.rates_touching(touching, at, load)
        falling, turning, spinning, d, n, fall, around = accelerations(body, touching, rates)
        # α = θ d: α̈ = (θ̈ − θβ̇²) d + (θβ̈ + 2θ̇β̇) n
        leaning = (falling - theta * around**2) * d + (theta * turning + 2.0 * fall * around) * n
        mine = model.rates(*state, *push, *model.parameters)
        np.testing.assert_allclose(mine[2:4], leaning, **within)
        np.testing.assert_allclose(mine[4], spinning, **within)
        np.testing.assert_allclose(np.array(mine[8:10]) * length, rates[VELOCITY][:2], **within)
        # What friction has left: of a point per N, of a patch as the body has it
        if contact == Contact.ROLLING and load.force[2] > 0.0 and patch == 0.0:
            np.testing.assert_allclose(found[10] * model.numbers.static * load.force[2], body.reserve(load), **within)
        elif contact == Contact.ROLLING and load.force[2] > 0.1 and body.reserve(load) > -10.0:
            np.testing.assert_allclose(found[10], body.reserve(load), rtol=0.0, atol=20.0 * within["atol"])
    assert seen > 0.9 * STATES


def test_in_the_air_the_body_is_free():
    for model, body, theta, beta, w1, w2, w3, slip, push in cases(0.0, {"damping": 0.2, "spin_damping": 0.1}):
        state, _ = stated(model, body, Contact.FLYING, theta, beta, w1, w2, w3, slip)
        whole = body.state(theta=theta, beta=beta, w1=w1, w2=w2, w3=w3)
        rates = body.rates_flying(whole, push)
        falling, turning, spinning, d, n, fall, around = accelerations(body, whole, rates)
        leaning = (falling - theta * around**2) * d + (theta * turning + 2.0 * fall * around) * n
        mine = np.array(model.rates(*state, *push, *model.parameters))
        within = {"rtol": 0.0, "atol": ROUNDING / math.sin(theta) ** 2}
        np.testing.assert_allclose(mine[2:4], leaning, **within)
        np.testing.assert_allclose(mine[4], spinning, **within)
        np.testing.assert_allclose(mine[[8, 9, 11]] * model.column.mass_height, rates[VELOCITY], **within)
        assert forces(state, tuple(push), model.numbers)[5:9] == (0.0, 0.0, 0.0, 0.0)
