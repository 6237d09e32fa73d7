"""What the contact must bear, against closed forms."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.compiler import compiled
from stylobate.models.contact import contact_loads, per_normal_force
from stylobate.models.sliding.balance import SlidingState, balance, forces_along
from stylobate.models.sliding.equations import forces

C, ETA, A0, NU = 0.1, 0.1, 0.065, 3.0
COLUMN = sb.Column.dimensionless(C)
CIRCLE = sb.Harmonic.circular(acceleration=A0, angular_frequency=NU)


def rolling(model, branch, spin=None):
    """A run that begins on steady rolling, by dense output over the last period."""
    size, psi = float(branch.amplitude), float(branch.phase)
    lean = size * np.array([math.cos(psi), math.sin(psi)])
    run = sb.simulate(
        model, CIRCLE, tilt=lean, tilt_rate=(-NU * lean[1], NU * lean[0]), duration=320.0 * CIRCLE.period
    )  # fmt: skip
    return run.data.isel(time=slice(-50, None))


def needed(branch, spin=0.0):
    """|a_h + κ(α̈ + cσν û)| on steady rolling, on which the footprint circles with the velocity −cσ n, and ηνA."""
    size, psi = float(branch.amplitude), float(branch.phase)
    friction = abs(A0 - 0.75 * NU * (NU * size - C * spin) * np.exp(1j * psi))
    return friction, ETA * NU * size


def test_steady_rolling_that_cannot_turn_needs_what_theory_says():
    branch = sb.theory.steady_rolling(NU, A0, c=C, eta=ETA).upper
    found = rolling(sb.Slender(COLUMN, damping=ETA), branch)
    friction, moment = needed(branch)
    # The share (1 − κ) of a_n, and of the friction couple its reaction κ: together a_n = ηνA.
    np.testing.assert_allclose(found["friction_demand"], friction, rtol=1e-6)
    np.testing.assert_allclose(found["pivoting_demand"], moment, rtol=1e-6)
    free = sb.theory.free_twist_rolling(NU, A0, c=C, eta=ETA, zeta=math.inf)
    assert float(free.friction_moment) == pytest.approx(moment, rel=1e-12)


def test_with_a_free_twist_the_spin_damping_gives_the_moment():
    branch = sb.theory.free_twist_rolling(NU, A0, c=C, eta=ETA, zeta=0.1)
    found = rolling(sb.SlenderRolling(COLUMN, damping=ETA, spin_damping=0.1), branch)
    friction, _ = needed(branch, float(branch.spin))
    np.testing.assert_allclose(found["friction_demand"], friction, rtol=1e-4)
    np.testing.assert_allclose(found["pivoting_demand"], float(branch.friction_moment), rtol=1e-4)


def test_a_standing_column_needs_what_the_base_demands():
    both = sb.Harmonic(amplitude=(0.05, 0.0, 0.3), phase=(0.0, 0.0, 0.4), angular_frequency=2.0)
    data = sb.simulate(sb.Slender(COLUMN, damping=ETA), both, duration=10.0).data
    assert bool(data["resting"].all())
    base = data["base_acceleration"].to_numpy().T
    np.testing.assert_allclose(data["friction_demand"], np.abs(base[0]) / (1.0 + base[2]), atol=1e-15)
    np.testing.assert_allclose(data["normal_force"], COLUMN.mass * COLUMN.gravity * (1.0 + base[2]), rtol=1e-14)
    np.testing.assert_array_equal(data["pivoting_demand"], 0.0)


def test_free_rocking_needs_friction_kappa_c_near_the_upright():
    run = sb.simulate(sb.Slender(COLUMN), tilt=(1e-4, 0.0), tilt_rate=(0.0, 0.0), duration=0.02)
    np.testing.assert_allclose(run.data["friction_demand"], 0.75 * C, rtol=2e-3)
    np.testing.assert_allclose(run.data["pivoting_demand"], 0.0, atol=1e-15)


SIX = {
    "slender": sb.Slender(COLUMN, damping=ETA),
    "slender rolling": sb.SlenderRolling(COLUMN, damping=ETA, spin_damping=0.2),
    "wobbling": sb.Wobbling(COLUMN, damping=ETA),
    "rolling": sb.Rolling(COLUMN, damping=ETA, spin_damping=0.2),
    "planar rocking": sb.PlanarRocking(COLUMN, damping=ETA),
    "sliding": sb.Sliding(COLUMN, friction_coefficient=0.3, patch=0.05, damping=ETA, spin_damping=0.2),
}


@pytest.mark.parametrize("name", SIX)
def test_loads_along_a_run_are_those_of_each_moment_and_are_compiled(name):
    model, rng = SIX[name], np.random.default_rng(7)
    states = 0.1 * rng.normal(size=(len(model.state_names), 100))
    if name == "sliding":
        states[-1] = np.arange(100) % (sb.Contact.FLYING + 1)
    push, still = 0.1 * rng.normal(size=(3, 100)), np.zeros(100, dtype=bool)
    expected = np.array(
        [model.contact(*state, *now, *model.parameters) for state, now in zip(states.T, push.T, strict=True)]
    )
    normal, friction, moment = expected.T
    loads = contact_loads(model, states, push, still)
    np.testing.assert_array_equal(loads.normal, normal)
    np.testing.assert_array_equal(loads.friction, per_normal_force(friction, normal))
    np.testing.assert_array_equal(loads.pivoting, per_normal_force(moment, normal))
    arguments = len(states) + 3 + len(model.parameters)
    assert compiled._compiled(model.contact, arguments, 3, model.name)._code()


def test_the_forces_of_a_column_that_slides_are_those_of_each_moment_and_are_compiled():
    model, rng = SIX["sliding"], np.random.default_rng(8)
    states, push = 0.1 * rng.normal(size=(16, 100)), 0.1 * rng.normal(size=(3, 100))
    states[-1] = np.arange(100) % (sb.Contact.FLYING + 1)
    expected = [
        forces(SlidingState(*state), tuple(now), model.numbers)
        for state, now in zip(states.T.tolist(), push.T.tolist(), strict=True)
    ]
    np.testing.assert_array_equal(forces_along(states, push, model.numbers), np.transpose(expected))
    assert compiled._compiled(balance, 26, 16, "sliding")._code()
