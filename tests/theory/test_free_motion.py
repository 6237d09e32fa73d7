"""Free motion in general: turning points, period and advance of the azimuth."""

import mpmath
import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from stylobate.theory import free_motion, planar_free_period, rolling_backbone

# tilt in units of c and rolling rate, down to turning points 1e-10 apart in ratio and close to the separatrix
STARTS = [(0.5, 0.5), (0.9, 0.1), (0.1, 5.0), (0.01, 3.0), (0.6, 1e-4), (0.5, 1e-10), (0.95, 0.2), (0.99, 1e-6)]


def quadrature(tilt, rate):
    """Turning points, period and advance with 30 digits, from the roots of the cubic and adaptive quadrature."""
    with mpmath.workdps(30):
        a0, w = mpmath.mpf(tilt), mpmath.mpf(rate)
        roots = mpmath.polyroots([1, a0 - 2, (a0 * w) ** 2, a0**3 * w**2], maxsteps=500, extraprec=300)
        fourth, partner, third = sorted(mpmath.re(root) for root in roots)
        low, high = sorted([a0, partner])

        def root(a):
            return mpmath.sqrt((a + low) * (a + high) / ((third - a) * (a - fourth)))

        def azimuth(phi):
            a = mpmath.hypot(low * mpmath.cos(phi), high * mpmath.sin(phi))
            return a0**2 * w * root(a) / a**2

        def time(phi):
            return root(mpmath.hypot(low * mpmath.cos(phi), high * mpmath.sin(phi)))

        ends = [mpmath.mpf(10) ** -k for k in range(12, 0, -2)]
        nodes = [0, *ends, mpmath.pi / 4, *(mpmath.pi / 2 - end for end in reversed(ends)), mpmath.pi / 2]
        return float(low), float(high), float(2 * mpmath.quad(time, nodes)), float(2 * mpmath.quad(azimuth, nodes))


@pytest.mark.parametrize(("tilt", "rate"), STARTS)
def test_agrees_with_quadrature_in_thirty_digits(tilt, rate):
    motion = free_motion(tilt, rate, 1.0)
    low, high, period, advance = quadrature(tilt, rate)
    assert motion.smallest_tilt == pytest.approx(low, rel=1e-15)
    assert motion.peak_tilt == pytest.approx(high, rel=1e-15)
    assert motion.period == pytest.approx(period, rel=1e-12)
    assert motion.azimuth_advance == pytest.approx(advance, rel=1e-12)


@pytest.mark.parametrize(("tilt", "rate"), [(0.05, 0.5), (0.03, -1.2), (0.02, 1.6), (0.09, 0.1)])
def test_agrees_with_integration_of_the_equations_of_motion(tilt, rate):
    c = 0.1
    motion = free_motion(tilt, rate, c)

    def rates(_, y):  # (1) without friction and base motion, and the azimuth
        z = np.hypot(y[0], y[1])
        return [y[2], y[3], y[0] - c * y[0] / z, y[1] - c * y[1] / z, (y[0] * y[3] - y[1] * y[2]) / z**2]

    start = [tilt, 0.0, 0.0, tilt * rate, 0.0]
    run = solve_ivp(rates, [0.0, float(motion.period)], start, "DOP853", rtol=1e-12, atol=1e-14, dense_output=True)
    end = run.y[:, -1]
    assert np.hypot(end[0], end[1]) == pytest.approx(tilt, rel=1e-9)
    assert (end[0] * end[2] + end[1] * end[3]) / tilt == pytest.approx(0.0, abs=1e-9)
    assert end[4] == pytest.approx(float(motion.azimuth_advance), rel=1e-9)
    half = run.sol(0.5 * motion.period)
    other = motion.smallest_tilt + motion.peak_tilt - tilt
    assert np.hypot(half[0], half[1]) == pytest.approx(other, rel=1e-9)


@pytest.mark.slow
@given(tilt=st.floats(0.01, 1.5), rate=st.floats(0.01, 20.0))
def test_both_turning_points_have_the_same_integrals_and_give_the_same_motion(tilt, rate):
    motion = free_motion(tilt, rate, 1.0)
    assume(np.isfinite(motion.period) and motion.period < 8.0)  # close to the separatrix the problem is ill-posed
    for turning in (motion.smallest_tilt, motion.peak_tilt):
        energy = 0.5 * (motion.angular_momentum / turning) ** 2 + turning - 0.5 * turning**2
        assert energy == pytest.approx(motion.energy, rel=1e-13)
        again = free_motion(turning, motion.angular_momentum / turning**2, 1.0)
        assert again.period == pytest.approx(motion.period, rel=1e-9)
        assert again.azimuth_advance == pytest.approx(motion.azimuth_advance, rel=1e-9)


def test_the_azimuth_turns_by_pi_at_each_passage_as_the_angular_momentum_vanishes():
    motion = free_motion(0.05, [0.0, 1e-12, 1e-8, 1e-4], 0.1)
    assert motion.azimuth_advance[0] == np.pi
    excess = motion.azimuth_advance - np.pi
    # linear in ℓ but for a logarithm, hence far below 100 w
    assert (np.abs(excess) <= 100.0 * np.array([0.0, 1e-12, 1e-8, 1e-4]) + 1e-12).all()
    assert (np.diff(excess[1:]) > 0.0).all()


def test_one_period_without_angular_momentum_is_half_the_planar_period():
    tilt = np.array([1e-4, 0.02, 0.05, 0.09, 0.0999])
    motion = free_motion(tilt, 0.0, 0.1)
    assert motion.period == pytest.approx(0.5 * planar_free_period(tilt, 0.1), rel=1e-12)
    assert (motion.smallest_tilt == 0.0).all()
    assert motion.peak_tilt == pytest.approx(tilt, rel=1e-15)


@pytest.mark.parametrize("omega", [0.7, 1.0, 3.0])
def test_small_oscillations_about_steady_rolling_have_the_linear_frequency(omega):
    # Ä = ℓ²/A³ + A − c: the linear frequency is √(3ω² − 1); its error is quadratic in the deviation
    deviation = 1e-6
    motion = free_motion(rolling_backbone(omega, 0.1) * (1.0 + deviation), omega, 0.1)
    linear = 2.0 * np.pi / np.sqrt(3.0 * omega**2 - 1.0)
    assert motion.period == pytest.approx(linear, rel=1e3 * deviation)
    assert motion.azimuth_advance == pytest.approx(omega * linear, rel=1e3 * deviation)
    steady = free_motion(rolling_backbone(omega, 0.1), omega, 0.1)
    assert steady.period == pytest.approx(linear, rel=1e-10)
    assert steady.smallest_tilt == pytest.approx(steady.peak_tilt, rel=1e-14)


def test_nan_where_the_column_overturns_but_the_integrals_stay():
    motion = free_motion([0.1, 0.2, 0.03, 0.05], [0.0, 0.1, 3.0, 40.0], 0.1)
    for values in (motion.smallest_tilt, motion.peak_tilt, motion.period, motion.azimuth_advance):
        assert np.isnan(values).all()
    assert np.isfinite(motion.energy).all()
    assert np.isfinite(motion.angular_momentum).all()


def test_the_azimuth_runs_with_the_rolling_rate():
    there, back = free_motion(0.05, [0.5, -0.5], 0.1).azimuth_advance
    assert there == -back > 0.0
