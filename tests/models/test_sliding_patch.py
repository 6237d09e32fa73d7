"""Friction of the small contact of a rim against the integrals over a pressure after Hertz that it approximates."""

import numpy as np
import pytest

from stylobate.models.sliding.balance import TWISTING, per_normal

ALONG_X = (1.0, 0.0, 0.0)
NODES, WEIGHTS = np.polynomial.legendre.leggauss(200)
ROUND = 2.0 * np.pi * (np.arange(1000) + 0.5) / 1000


def integrals(turning):
    """Return force and moment over μN of a disc of radius 1 that slips at 1 and turns at `turning`, by quadrature.

    The pressure is p = 3/(2π) √(1 − r²). With r = sin u the integrand is smooth at the edge.
    """
    u, weights = 0.25 * np.pi * (NODES[:, np.newaxis] + 1.0), 0.25 * np.pi * WEIGHTS[:, np.newaxis]
    r, cos = np.sin(u), np.cos(u)
    vx, vy = 1.0 - turning * r * np.sin(ROUND), turning * r * np.cos(ROUND)
    share = 1.5 / np.pi * cos * r * cos * weights * (ROUND[1] - ROUND[0]) / np.hypot(vx, vy)
    return (share * vx).sum(), (share * (r * np.cos(ROUND) * vy - r * np.sin(ROUND) * vx)).sum()


def test_the_quadrature_has_the_limits_of_pure_slip_and_of_pure_turning():
    assert integrals(0.0)[0] == pytest.approx(1.0, rel=1e-12)
    assert integrals(1e6)[1] == pytest.approx(TWISTING, rel=1e-6)


def test_the_errors_of_force_and_moment_of_a_patch_are_those_of_the_documentation():
    ratios = np.linspace(0.05, 10.0, 200)
    exact = np.array([integrals(ratio) for ratio in ratios])
    found = np.array([per_normal(1.0, 0.0, ratio, *ALONG_X, 1.0, 0.0, 1.0) for ratio in ratios])
    force, moment = -found[:, 0] / exact[:, 0] - 1.0, -found[:, 2] / exact[:, 1] - 1.0
    assert np.abs(force).max() == pytest.approx(0.036, abs=5e-4)
    worst = np.abs(moment).argmax()
    assert moment[worst] == pytest.approx(-0.225, abs=5e-4)
    assert ratios[worst] == pytest.approx(1.57, abs=0.03)
    assert np.abs(-found[:, 2] - exact[:, 1]).max() / TWISTING == pytest.approx(0.16, abs=5e-3)
