"""Planar impacts: restitution and friction from the impulse of the contact, and the energy of a cycle."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from stylobate import theory
from stylobate.column import Column
from stylobate.errors import ParameterError


@pytest.mark.parametrize(("c", "value"), [(0.1, 0.985139318885), (0.2, 0.942168674699)])
def test_a_solid_cylinder_has_the_known_restitution(c, value):
    ratio = Column.solid(radius=c, height=2.0, density=1000.0).inertia_ratio
    assert float(theory.housner_restitution(c, inertia_ratio=ratio)) == pytest.approx(value, abs=1e-12)


@pytest.mark.parametrize(("c", "kappa"), [(0.1, 0.75), (0.5, 0.6), (1.1, 0.3)])
def test_the_impulse_of_the_new_contact_gives_restitution_and_required_friction(c, kappa):
    # In the plane, m = h = 1: about (0, 0) before at unit rate, (2c, 0) after at the rate e; the mass centre at (c, 1).
    # Its velocity is (1, −c) before and e(1, c) after, clockwise rates. Unknown are e and the impulse (P, Q), which at
    # (c, −1) from the mass centre has the clockwise moment −P − cQ.
    transverse = 1.0 / kappa - 1.0
    equations = [[1.0, -1.0, 0.0], [c, 0.0, -1.0], [transverse, 1.0, c]]
    e, across, up = np.linalg.solve(equations, [1.0, -c, transverse])
    assert e == pytest.approx(float(theory.housner_restitution(c, inertia_ratio=kappa)), rel=1e-12)
    assert abs(across) / up == pytest.approx(float(theory.required_friction(c, inertia_ratio=kappa)), rel=1e-12)


def test_the_block_is_the_same_law_with_its_own_inertia():
    c = np.array([0.1, 0.4, 1.0])
    np.testing.assert_allclose(
        theory.block_restitution(c), theory.housner_restitution(c, inertia_ratio=3.0 / (4.0 + c**2)), rtol=1e-14
    )


def test_flat_bodies_stay_down():
    assert float(theory.block_restitution(1.5)) == 0.0
    assert float(theory.housner_restitution(2.0, inertia_ratio=0.3)) == 0.0


@pytest.mark.parametrize("ratio", [1e-3, 0.02, 0.5, 0.97])
def test_equivalent_friction_takes_from_a_cycle_what_two_impacts_take(ratio):
    c, e = 0.2, 0.94
    eta = float(theory.equivalent_viscous_damping(ratio * c, c=c, restitution=e))
    period = float(theory.planar_free_period(ratio * c, c))
    taken, _ = quad(lambda tau: eta * theory.planar_free_motion(tau, ratio * c, c)[1] ** 2, 0.0, period / 4.0)
    _, impact_rate = theory.planar_free_motion(period / 4.0, ratio * c, c)
    assert 4.0 * taken == pytest.approx(2.0 * 0.5 * (1.0 - e**2) * float(impact_rate) ** 2, rel=1e-9)


def test_equivalent_friction_has_its_limits_and_no_seam():
    small = 1e-12
    eta = float(theory.equivalent_viscous_damping(small, c=1.0, restitution=0.9))
    assert eta == pytest.approx(0.75 * 0.19 / math.sqrt(2.0 * small), rel=1e-10)
    assert float(theory.equivalent_viscous_damping(1.0 - 1e-12, c=1.0, restitution=0.9)) == pytest.approx(0.095)
    seam = 1.0 - math.sqrt(1.0 - 0.1**2)  # where S changes from its series to its closed form
    both = theory.equivalent_viscous_damping(seam * (1.0 + np.array([-1e-9, 1e-9])), c=1.0, restitution=0.9)
    assert both[0] == pytest.approx(both[1], rel=3e-9)
    assert np.isnan(theory.equivalent_viscous_damping(1.0, c=1.0, restitution=0.9))


def test_an_impact_gives_no_energy():
    with pytest.raises(ParameterError, match="restitution must be at most 1"):
        theory.equivalent_viscous_damping(0.05, c=0.1, restitution=1.01)
