"""Overturning by one pulse: closed forms, arcs of the linear block joined one to another, and the engine."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import stylobate as sb
from stylobate import theory
from stylobate.errors import ParameterError

# So slender that finite angles change nothing: the error of the theory is of the order c².
C = 1e-3
COLUMN = sb.Column.dimensionless(slenderness=C)
BLOCK_FREQUENCY = COLUMN.frequency_scale / math.sqrt(1.0 + COLUMN.inertia_ratio * C**2)  # p = √(mgR/K)


@pytest.mark.parametrize(("nu", "least"), [(2.0, 1.8007), (5.0, 3.2891), (10.0, 5.7865)])
def test_the_least_half_sine_has_known_values(nu, least):
    assert float(theory.half_sine_overturning(nu, 1.0)) == pytest.approx(least, abs=5e-5)


def arcs(u, rate, side, start, nu, a):
    """Return the motion ü = u − side + a sin ντ from a state on: the tilt over c, on one side, within the pulse."""
    share = -a / (1.0 + nu**2)
    first = u - side - share * math.sin(nu * start)
    second = rate - share * nu * math.cos(nu * start)

    def tilt(tau):
        s = tau - start
        return side + first * np.cosh(s) + second * np.sinh(s) + share * np.sin(nu * tau)

    def speed(tau):
        s = tau - start
        return first * np.sinh(s) + second * np.cosh(s) + share * nu * np.cos(nu * tau)

    return tilt, speed


def overturns(a, nu, end, restitution):
    """Return the number of impacts before it overturns, or None: arc by arc, behind the pulse by its energy."""
    # Positive in the direction in which the first half of the pulse throws the column.
    now, u, rate, side, impacts = math.asin(1.0 / a) / nu, 0.0, 0.0, 1.0, 0
    while impacts < 3:
        tilt, speed = arcs(u, rate, side, now, nu, a)
        tau = np.linspace(now, end, 4001)
        values = side * tilt(tau)
        landed = np.flatnonzero((values[1:] <= 0.0) & (values[:-1] > 0.0))
        if landed.size == 0:
            u, rate = side * float(tilt(end)), side * float(speed(end))
            if u - 1.0 + rate > 0.0:
                return impacts
            # It comes back. Of the rate at which it lands e is left, and 1 carries it over the other side.
            landing = math.sqrt(rate**2 + 2.0 * u - u**2)
            return impacts + 1 if restitution * landing > 1.0 else None
        k = int(landed[0])
        now = brentq(tilt, tau[k], tau[k + 1], xtol=1e-15)
        u, rate, side, impacts = 0.0, restitution * float(speed(now)), -side, impacts + 1
    return None


@pytest.mark.parametrize("nu", [0.3, 1.0, 2.0, 5.0, 20.0])
@pytest.mark.parametrize(
    ("least", "half_turns"), [(theory.half_sine_overturning, 1.0), (theory.one_sine_overturning_without_impact, 2.0)]
)
def test_arcs_begin_to_overturn_without_impact_at_the_closed_form(least, half_turns, nu):
    a, end = float(least(nu, 1.0)), half_turns * math.pi / nu
    assert overturns(a * (1.0 + 1e-9), nu, end, 0.9) == 0
    assert overturns(a * (1.0 - 1e-9), nu, end, 0.9) != 0
    if half_turns == 1.0:
        assert overturns(a * (1.0 - 1e-9), nu, end, 1.0) is None


def test_one_sine_overturns_with_an_impact_below_a_gap_and_without_above_it():
    end = 2.0 * math.pi / 5.0
    for a, impacts in ((3.0185, None), (3.0187, 1), (6.3180, 1), (6.3182, None), (7.1680, None), (7.1682, 0)):
        assert overturns(a, 5.0, end, 0.9) == impacts
    assert float(theory.one_sine_overturning_without_impact(5.0, 1.0)) == pytest.approx(7.168, abs=5e-4)
    band = theory.one_sine_overturning_after_impact(5.0, 1.0, restitution=0.9)
    np.testing.assert_allclose(band, [3.0186, 6.3181], atol=5e-5)


@pytest.mark.parametrize("restitution", [0.7, 0.9, 0.98])
@pytest.mark.parametrize("nu", [0.5, 1.0, 2.0, 3.0, 5.0, 7.0])
def test_arcs_overturn_after_one_impact_within_the_band_and_nowhere_beside_it(nu, restitution):
    end = 2.0 * math.pi / nu
    lowest, highest = (float(a) for a in theory.one_sine_overturning_after_impact(nu, 1.0, restitution=restitution))
    without = float(theory.one_sine_overturning_without_impact(nu, 1.0))
    if math.isnan(lowest):
        amplitudes = np.linspace(1.2, 0.9999 * without, 60)
        assert all(overturns(a, nu, end, restitution) is None for a in amplitudes)
        return
    # Rounding grows by exp(3π/2ν) during the pulse, 1e4 where it is longest.
    for edge, inwards in ((lowest, 1.0), (highest, -1.0)):
        assert overturns(edge * (1.0 + inwards * 1e-9), nu, end, restitution) == 1
        assert overturns(edge * (1.0 - inwards * 1e-9), nu, end, restitution) is None
    assert all(overturns(a, nu, end, restitution) == 1 for a in np.linspace(lowest, highest, 22)[1:-1])
    assert all(overturns(a, nu, end, restitution) is None for a in np.linspace(highest, without, 7)[1:-1])


def integrated(a, nu, restitution):
    """Return whether the piecewise linear block overturns, by Runge and Kutta from impact to impact, 40/p long."""
    end = 2.0 * math.pi / nu
    now, state, side = math.asin(1.0 / a) / nu, np.array([0.0, 0.0]), 1.0
    while now < end + 40.0:

        def rates(tau, y, side=side):
            return [y[1], y[0] - side + (a * math.sin(nu * tau) if tau < end else 0.0)]

        def landing(tau, y, side=side, since=now):
            return side * y[0] if tau > since + 1e-6 else 1.0

        def fallen(tau, y):
            return abs(y[0]) - 50.0

        landing.terminal = fallen.terminal = True
        until = end if now < end else end + 40.0
        run = solve_ivp(
            rates, (now, until), state, events=(landing, fallen), rtol=1e-11, atol=1e-13, method="DOP853", max_step=0.05
        )
        now, state = float(run.t[-1]), run.y[:, -1]
        if run.t_events[1].size:
            return True
        if run.t_events[0].size:
            state, side = np.array([0.0, restitution * state[1]]), -side
        if abs(state[0]) + abs(state[1]) < 1e-3 and now > end:
            return False
    return False


@pytest.mark.parametrize(("nu", "restitution"), [(5.0, 0.9), (2.0, 0.8)])
def test_the_band_after_an_impact_is_that_of_integrated_equations(nu, restitution):
    lowest, highest = (float(a) for a in theory.one_sine_overturning_after_impact(nu, 1.0, restitution=restitution))
    for edge, inwards in ((lowest, 1.0), (highest, -1.0)):
        assert integrated(edge * (1.0 + inwards * 1e-6), nu, restitution)
        assert not integrated(edge * (1.0 - inwards * 1e-6), nu, restitution)


def test_the_band_after_an_impact_reaches_the_one_without_where_an_impact_takes_nothing_and_narrows_with_it():
    nu, c = np.array([0.3, 1.0, 3.0, 8.0])[:, np.newaxis], np.array([0.1, 0.2])
    lowest, highest = theory.one_sine_overturning_after_impact(nu, c, restitution=1.0)
    np.testing.assert_allclose(highest, theory.one_sine_overturning_without_impact(nu, c), rtol=1e-7)
    less, more = (theory.one_sine_overturning_after_impact(nu, c, restitution=e) for e in (0.95, 0.97))
    assert np.all(lowest < more[0])
    assert np.all(more[0] < less[0])
    assert np.all(less[1] < more[1])
    assert np.all(more[1] < highest)
    np.testing.assert_allclose(less[0][:, 1], 2.0 * less[0][:, 0], rtol=1e-14)


def test_no_band_is_reported_where_an_impact_takes_too_much_or_rounding_hides_it():
    for nu, restitution in ((5.0, 0.84), (10.0, 0.9), (0.05, 0.9)):
        assert np.isnan(theory.one_sine_overturning_after_impact(nu, 1.0, restitution=restitution)).all()
    assert np.isfinite(theory.one_sine_overturning_after_impact(5.0, 1.0, restitution=0.841)).all()


@pytest.mark.parametrize(
    ("restitution", "message"),
    [(1.1, r"restitution: at most 1 \(got 1.1\)"), (0.0, "restitution must be positive, got 0.0")],
)
def test_restitutions_that_cannot_be_are_refused(restitution, message):
    with pytest.raises(ParameterError, match=message):
        theory.one_sine_overturning_after_impact(5.0, 1.0, restitution=restitution)


def outcome(model, make, a, nu):
    pulse = make(acceleration=a * C * COLUMN.gravity, angular_frequency=nu * BLOCK_FREQUENCY)
    duration = (2.0 * math.pi / nu + 20.0) / BLOCK_FREQUENCY
    return sb.simulate(model, pulse, duration=duration, rtol=1e-10).outcome


@pytest.mark.parametrize("model", [sb.PlanarRocking(COLUMN, restitution=0.9), sb.Slender(COLUMN, damping=0.0)])
@pytest.mark.parametrize("nu", [2.0, 5.0, 10.0])
def test_the_engine_overturns_by_half_a_sine_where_theory_says(model, nu):
    a = float(theory.half_sine_overturning(nu, 1.0))
    assert outcome(model, sb.Pulse.half_sine, a * (1.0 + 1e-5), nu) is sb.Outcome.OVERTURNED
    assert outcome(model, sb.Pulse.half_sine, a * (1.0 - 1e-5), nu) is not sb.Outcome.OVERTURNED


@pytest.mark.parametrize(
    ("a", "falls"),
    [(3.0185, False), (3.0187, True), (5.0, True), (6.3180, True), (6.3182, False), (7.1680, False), (7.1683, True)],
)
def test_the_engine_has_the_two_ways_to_overturn_by_one_sine(a, falls):
    found = outcome(sb.PlanarRocking(COLUMN, restitution=0.9), sb.Pulse.one_sine, a, 5.0)
    assert (found is sb.Outcome.OVERTURNED) is falls


@pytest.mark.parametrize("least", [theory.half_sine_overturning, theory.one_sine_overturning_without_impact])
def test_long_pulses_need_only_release_and_short_ones_an_impulse(least):
    assert float(least(0.02, 0.1)) == pytest.approx(0.1, rel=1e-3)
    values = least(np.geomspace(0.1, 100.0, 31), 1.0)
    assert np.all(np.diff(values) > 0.0)
    np.testing.assert_allclose(least([[2.0], [3.0]], [0.1, 0.2]), least([[2.0], [3.0]], 1.0) * [[0.1, 0.2]], rtol=1e-15)


def test_a_short_half_sine_must_give_the_velocity_that_carries_over_the_edge():
    # A velocity 2a/ν at once gives the tilt rate that carries it to u = 1: 1.
    nu = 1e4
    assert float(theory.half_sine_overturning(nu, 1.0)) == pytest.approx(0.5 * nu, rel=1e-3)


@pytest.mark.parametrize("least", [theory.half_sine_overturning, theory.one_sine_overturning_without_impact])
@pytest.mark.parametrize(("values", "name"), [((0.0, 1.0), "nu"), ((1.0, -1.0), "c"), ((math.nan, 1.0), "nu")])
def test_impossible_numbers_are_refused_by_name(least, values, name):
    with pytest.raises(ParameterError, match=rf"^{name}\b"):
        least(*values)
