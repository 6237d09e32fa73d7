"""Steady rolling on a base at rest: balance, round trip, and the stability that the full equations show."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.theory.turning_frame import full_rolling_rates

from stylobate import theory
from stylobate.errors import ParameterError


@given(tilt=st.floats(0.01, 1.5), spin=st.floats(-30.0, 30.0), c=st.floats(0.02, 1.5), kappa=st.floats(0.1, 0.6))
def test_nothing_changes_and_the_rate_gives_back_the_spin(tilt, spin, c, kappa):
    found = theory.free_rolling(tilt, spin, c=c, inertia_ratio=kappa)
    assert found.exists.sum() in {0, 2}
    if tilt < math.atan(c):
        assert found.rate[0] > 0.0 > found.rate[1]
    for rate in found.rate[found.exists]:
        rates = full_rolling_rates([0.0, rate, tilt, 0.0, spin], 0.0, 0.0, c=c, eta=0.0, zeta=0.0, inertia_ratio=kappa)
        assert np.abs(rates[[0, 1, 2, 4]]).max() <= 1e-12 * (1.0 + rate**2 + abs(rate * spin))
        if abs(rate) > 1e-3:
            back = theory.free_rolling_spin(tilt, rate, c=c, inertia_ratio=kappa)
            assert back == pytest.approx(spin, rel=1e-8, abs=1e-8 * (1.0 + abs(rate) + 1.0 / abs(rate)) / c)


def test_the_eigenvalues_are_those_of_the_full_equations():
    tilt, spin, at = 0.3, 15.0, {"c": 0.4, "inertia_ratio": 0.6, "axial_ratio": 0.7}
    found = theory.free_rolling([tilt, 0.1], [spin, 0.2], **at)
    for cell, x in enumerate([(tilt, spin), (0.1, 0.2)]):
        for branch in range(2):
            state = np.array([0.0, found.rate[cell, branch], x[0], 0.0, x[1]])
            step, columns = 1e-6, []
            for j in range(5):
                ends = [
                    full_rolling_rates(state + s * step * np.eye(5)[j], 0.0, 0.0, eta=0.0, zeta=0.0, **at)
                    for s in (1, -1)
                ]
                columns.append((ends[0] - ends[1]) / (2.0 * step))
            values = np.linalg.eigvals(np.array(columns).T)
            nearest = np.abs(values - found.eigenvalue[cell, branch]).min()
            # Second-order differences; the other three eigenvalues are a triple zero, to the cube root of that.
            assert nearest <= 1e-5 * np.abs(found.eigenvalue[cell, branch])
            assert np.sort(np.abs(values))[:3].max() < 2e-2


def test_small_tilts_roll_on_the_paper_s_backbone_and_are_stable_up_to_three_quarters_of_the_tipping_angle():
    c = 1e-4
    ratio = np.array([0.1, 0.5, 0.74, 0.76, 0.9])
    found = theory.free_rolling(ratio * c, c=c)
    np.testing.assert_allclose(theory.rolling_backbone(found.rate[:, 0], c), ratio * c, rtol=1e-6)
    np.testing.assert_array_equal(found.stable[:, 0], ratio < 0.75)
    # Ä = A(1 + ω²) − c with A²ω constant
    square = 1.0 - 3.0 * found.rate**2
    np.testing.assert_allclose(found.eigenvalue**2, square, rtol=1e-5)
    np.testing.assert_allclose(found.rate[:, 0], -found.rate[:, 1], rtol=1e-14)


def test_a_column_beyond_its_tipping_angle_needs_spin():
    found = theory.free_rolling(0.2, [0.0, 1.0, -20.0], c=0.1)
    np.testing.assert_array_equal(found.exists, [[False] * 2, [False] * 2, [True] * 2])
    assert np.all(found.rate[2] < 0.0)


def test_at_the_tipping_angle_one_of_both_stands_still():
    found = theory.free_rolling(math.atan(0.1), 5.0, c=0.1)
    assert found.rate[1] == pytest.approx(0.0, abs=1e-15)
    assert np.isnan(theory.free_rolling_spin(0.05, 0.0, c=0.1))


@pytest.mark.parametrize("tilt", [0.0, -0.1, math.pi / 2, math.nan])
def test_bad_tilts_are_refused(tilt):
    with pytest.raises(ParameterError, match="tilt"):
        theory.free_rolling(tilt, 0.0, c=0.1)
