"""Passing near the upright: the turn of the contact point by integration, and the friction that it takes."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tests.theory.turning_frame import full_rolling_rates, wobbling_rates

from stylobate import theory
from stylobate.column import Column
from stylobate.errors import ParameterError


@pytest.mark.parametrize(("c", "degrees"), [(0.1, 180.6724805), (0.2, 182.660)])
def test_a_solid_cylinder_turns_by_what_is_known(c, degrees):
    ratio = Column.solid(radius=c, height=2.0, density=1000.0).inertia_ratio
    assert math.degrees(theory.angle_of_turn(c, inertia_ratio=ratio)) == pytest.approx(degrees, abs=5e-4)


def test_a_disk_turns_by_root_five_half_turns():
    ratio = Column.solid(radius=20.0, height=4e-5, density=1000.0).inertia_ratio
    assert float(theory.angle_of_turn(1e6, inertia_ratio=ratio)) == pytest.approx(math.sqrt(5.0) * math.pi, rel=1e-10)


@pytest.mark.parametrize("spin", [0.0, 6.0, -6.0])
def test_rolling_by_integration_turns_as_far(spin):
    # Approached at unit rate from 1e-3, missing the upright by about 1e-6: what is left of the turn before and after is
    # the ratio of the two, and gravity changes the rate by about c · 1e-3 of it.
    c, at, far, miss = 0.4, {"inertia_ratio": 0.7, "axial_ratio": 0.5}, 1e-3, 1e-6
    leaves = lambda tau, state: state[2] - far if tau > 0.0 else -1.0  # noqa: E731
    leaves.terminal, leaves.direction = True, 1.0
    run = solve_ivp(
        lambda _, x: full_rolling_rates(x, 0.0, 0.0, c=c, eta=0.0, zeta=0.0, **at), (0.0, 1.0),
        [-1.0, miss / far**2, 0.9999 * far, 0.0, spin], "DOP853", rtol=1e-10, atol=1e-14, events=leaves,
    )  # fmt: skip
    assert run.status == 1
    assert run.y[3, -1] == pytest.approx(float(theory.angle_of_turn(c, inertia_ratio=0.7, spin_ratio=spin)), abs=5e-3)


def test_a_column_let_go_near_the_upright_needs_the_required_friction():
    c, kappa = np.array([0.1, 0.3]), 0.7
    rates = [wobbling_rates([0.0, 0.0, 1e-12, 0.0], 0.0, 0.0, c=x, eta=0.0, inertia_ratio=kappa)[0] for x in c]
    horizontal, vertical = kappa * np.array(rates), 1.0 + kappa * c * np.array(rates)
    np.testing.assert_allclose(-horizontal / vertical, theory.required_friction(c, inertia_ratio=kappa), rtol=1e-10)


@pytest.mark.parametrize(
    ("change", "told"), [({"c": 0.0}, "c"), ({"inertia_ratio": 1.0}, "inertia_ratio"), ({"spin_ratio": np.inf}, "spin")]
)
def test_bad_numbers_are_refused_by_name(change, told):
    with pytest.raises(ParameterError, match=told):
        theory.angle_of_turn(**({"c": 0.1} | change))
