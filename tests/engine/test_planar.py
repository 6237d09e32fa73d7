"""Motion in one vertical plane: it stays there, and it is piecewise linear."""

import cmath
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

import stylobate as sb

C = 0.1
DIRECTIONS = [0.0, 0.3, 1.1, math.pi / 3.0, math.pi / 2.0, 2.0, 4.5]


def model(damping=0.0):
    return sb.Slender(sb.Column.dimensionless(C), damping=damping)


class PiecewiseLinear:
    """α̈ = α − c s − ηα̇ − a cos(ντ + φ) with s = sgn α: solved by exponentials from crossing to crossing."""

    def __init__(self, a, nu, phi, eta):
        self.eta, self.nu = eta, nu
        # α = Re(B e^{iντ}): −ν²B + iηνB − B = −a e^{iφ}
        self.wave = a * cmath.exp(1j * phi) / (1.0 + nu**2 - 1j * eta * nu)
        root = math.sqrt(1.0 + eta**2 / 4.0)
        self.roots = -eta / 2.0 + root, -eta / 2.0 - root

    def stretch(self, start, tilt, rate, side):
        turning = self.wave * cmath.exp(1j * self.nu * start)
        x, v = tilt - C * side - turning.real, rate - (1j * self.nu * turning).real
        grow, fall = self.roots
        p, q = (v - fall * x) / (grow - fall), (grow * x - v) / (grow - fall)

        def at(tau):
            e, f = p * np.exp(grow * (tau - start)), q * np.exp(fall * (tau - start))
            wave = self.wave * np.exp(1j * self.nu * tau)
            return C * side + e + f + wave.real, grow * e + fall * f + (1j * self.nu * wave).real

        return at

    def at(self, times, tilt, rate):
        """Return tilt and rate at increasing `times`, and the number of crossings before the last."""
        out, start, crossings = np.empty((2, times.size)), 0.0, 0
        while True:
            side = math.copysign(1.0, tilt if tilt != 0.0 else rate)
            solution = self.stretch(start, tilt, rate, side)
            grid = np.linspace(start, times[-1], 4001)[1:]
            below = np.flatnonzero(side * solution(grid)[0] < 0.0)
            end = times[-1]
            if below.size:
                before = grid[below[0] - 1] if below[0] else start + 1e-9
                end = brentq(lambda tau, on=solution: on(tau)[0], before, grid[below[0]], xtol=1e-15)
            here = times >= start
            out[:, here] = solution(times[here])
            if not below.size:
                return out, crossings
            start, tilt, rate, crossings = end, 0.0, float(solution(end)[1]), crossings + 1


@pytest.mark.parametrize("direction", DIRECTIONS)
def test_free_motion_in_a_plane_has_its_closed_form_and_period(direction):
    # (2) with the sign: α = ±(c − (c − A0) cosh τ), a quarter of the period where cosh τ = c/(c − A0).
    a0 = 0.07
    quarter = math.acosh(C / (C - a0))
    line = np.array([math.cos(direction), math.sin(direction)])
    run = sb.simulate(model(), tilt=a0 * line, duration=4.0 * quarter * 25, rtol=1e-12)
    time = run.data.time.to_numpy()
    phase = (time + quarter) % (4.0 * quarter) - quarter
    sign = np.where(phase < quarter, 1.0, -1.0)
    folded = np.where(phase < quarter, phase, phase - 2.0 * quarter)
    closed = sign * (C - (C - a0) * np.cosh(folded))
    assert run.planar
    np.testing.assert_allclose(run.data.tilt.to_numpy() @ line, closed, rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(run.data.tilt.to_numpy()[-1], a0 * line, rtol=0.0, atol=1e-9)


@pytest.mark.parametrize("damping", [0.0, 0.2])
@pytest.mark.parametrize("direction", DIRECTIONS)
def test_coplanar_start_and_motion_stay_on_their_line(direction, damping):
    line = np.array([math.cos(direction), math.sin(direction)])
    motion = sb.Harmonic.straight(acceleration=0.13, angular_frequency=3.0, direction=direction)
    run = sb.simulate(model(damping), motion, tilt=0.02 * line, tilt_rate=-0.01 * line, duration=40.0)
    tilt = run.data.tilt.to_numpy()
    off_line = tilt @ np.array([-line[1], line[0]])
    assert run.planar
    assert not run.uncertain
    # The rounded unit vector is off by half an ulp in each component.
    assert np.all(np.abs(off_line) <= 1e-15 * np.hypot(*tilt.T))
    assert run.measures["turns"] == pytest.approx(round(2.0 * run.measures["turns"]) / 2.0, abs=1e-12)


@pytest.mark.parametrize("direction", [0.3, 1.1, 2.0])
def test_release_by_a_straight_motion_stays_in_its_plane(direction):
    motion = sb.Harmonic.straight(acceleration=0.13, angular_frequency=3.0, direction=direction, start_phase=-1.4)
    run = sb.simulate(model(0.1), motion, duration=30.0)
    tilt = run.data.tilt.to_numpy()
    assert run.planar
    assert run.data.amplitude.max() > 0.005
    assert np.all(np.abs(tilt @ [-math.sin(direction), math.cos(direction)]) <= 2e-15 * np.hypot(*tilt.T))


@pytest.mark.parametrize(
    "motion",
    [
        sb.Harmonic.elliptic(amplitude=(0.1, 0.05), phase=math.pi, angular_frequency=3.0),
        sb.Harmonic(amplitude=(0.1, 0.05, 0.3), phase=(math.pi / 2.0, -math.pi / 2.0, 0.2), angular_frequency=3.0),
        sb.Harmonic.straight(acceleration=0.1, angular_frequency=3.0, direction=math.atan2(-0.05, 0.1)),
    ],
    ids=["opposite phase", "opposite quarter phases", "straight"],
)
def test_every_way_to_say_a_straight_motion_is_planar(motion):
    run = sb.simulate(model(), motion, tilt=(0.02, -0.01), duration=5.0)
    assert run.planar


def test_a_start_off_the_line_of_the_motion_is_not_planar():
    motion = sb.Harmonic.straight(acceleration=0.1, angular_frequency=3.0)
    assert not sb.simulate(model(), motion, tilt=(0.02, 1e-15), duration=1.0).planar
    assert sb.simulate(model(), motion, tilt=(0.02, 0.0), duration=1.0).planar


@pytest.mark.slow
@settings(max_examples=60)
@given(
    tilt=st.floats(-0.6, 0.6),
    rate=st.floats(-0.5, 0.5),
    a=st.floats(0.0, 3.0),
    nu=st.floats(0.2, 6.0),
    phi=st.floats(0.0, 6.0),
    eta=st.sampled_from([0.0, 0.1, 1.0]),
)
def test_forced_motion_in_a_plane_is_piecewise_linear(tilt, rate, a, nu, phi, eta):
    tilt, rate = C * (tilt + math.copysign(0.01, tilt)), C * rate
    motion = sb.Harmonic.straight(acceleration=C * a, angular_frequency=nu, direction=0.3, start_phase=phi)
    line = np.array([math.cos(0.3), math.sin(0.3)])
    run = sb.simulate(
        model(eta),
        motion,
        tilt=tilt * line,
        tilt_rate=rate * line,
        duration=6.0,
        rtol=1e-11,
        rest_energy=0.0,
        samples=301,
    )
    exact, crossings = PiecewiseLinear(C * a, nu, phi, eta).at(run.data.time.to_numpy(), tilt, rate)
    if crossings > 40:  # swings of no size: nothing to compare
        return
    # The tolerance 1e-11 times a growth of at most e⁶ = 400, and ten more for the crossings at low speed.
    scale = max(C, np.abs(exact).max())
    np.testing.assert_allclose(run.data.tilt.to_numpy() @ line, exact[0], rtol=0.0, atol=1e-7 * scale)


def test_a_swing_over_the_upright_and_back_within_one_step_is_not_missed():
    # |a| > c pushes back at once: the swing to the other side lasts 0.05, less than a step of the integrator.
    motion = sb.Harmonic.straight(acceleration=-0.15, angular_frequency=0.01)
    run = sb.simulate(model(), motion, tilt=(0.001, 0.0), tilt_rate=(-0.012, 0.0), duration=0.6, samples=101)
    exact, crossings = PiecewiseLinear(-0.15, 0.01, 0.0, 0.0).at(run.data.time.to_numpy(), 0.001, -0.012)
    assert crossings == 2
    np.testing.assert_allclose(run.data.tilt.to_numpy()[:, 0], exact[0], rtol=0.0, atol=1e-7 * C)


def test_straight_release_follows_the_closed_form():
    nu, a1, phi = 1.7, 0.14, -1.2
    motion = sb.Harmonic.straight(acceleration=a1, angular_frequency=nu, start_phase=phi)
    run = sb.simulate(model(0.1), motion, duration=3.0, rtol=1e-11)
    release = run.events[0].time
    assert release == pytest.approx((-phi - math.acos(C / a1)) / nu, abs=1e-10)
    time = run.data.time.to_numpy()
    moving = time > release + 1e-2
    exact, _ = PiecewiseLinear(a1, nu, phi + nu * release, 0.1).at(time[moving] - release, 0.0, -1e-300)
    # What the departure series neglects, of the fourth order in 1e-3/(1 + ν), and the tolerance.
    np.testing.assert_allclose(run.data.tilt.to_numpy()[moving, 0], exact[0], rtol=0.0, atol=1e-9 * C)
