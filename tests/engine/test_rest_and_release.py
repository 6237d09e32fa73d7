"""The column at rest: what cannot move it, when it is released, how it departs, how it comes to rest again."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq
from tests.reference.forcing import Forcing
from tests.reference.resting import departure, release_time

import stylobate as sb

C = 0.1


def model(damping=0.0):
    return sb.Slender(sb.Column.dimensionless(C), damping=damping)


def standing_acceleration(kind, frequency, start_phase, acceleration=C):
    options = {"angular_frequency": frequency, "start_phase": start_phase}
    if kind == "circular":
        return sb.Harmonic.circular(acceleration=acceleration, **options)
    if kind == "straight":
        return sb.Harmonic.straight(acceleration=acceleration, direction=start_phase / 3.0, **options)
    return sb.Harmonic.elliptic(amplitude=(acceleration, 0.6 * acceleration), phase=math.pi / 2.0, **options)


@pytest.mark.parametrize("kind", ["circular", "straight", "elliptic"])
@settings(max_examples=30)
@given(frequency=st.floats(0.05, 40.0), start_phase=st.floats(-7.0, 7.0))
def test_a_column_at_rest_stays_while_the_acceleration_never_exceeds_c(kind, frequency, start_phase):
    run = sb.simulate(model(0.1), standing_acceleration(kind, frequency, start_phase), duration=100.0)
    assert run.outcome is sb.Outcome.AT_REST
    assert run.decided_at == 0.0
    assert run.events == ()
    assert run.data.amplitude.max() == 0.0
    assert bool(run.data.resting.all())


def test_standing_column_shows_the_centre_of_pressure_on_the_rim_at_the_limit():
    run = sb.simulate(model(), sb.Harmonic.circular(acceleration=C, angular_frequency=2.0), duration=5.0)
    pressure = np.hypot(*run.data.centre_of_pressure.to_numpy().T)
    np.testing.assert_allclose(pressure, model().column.radius, rtol=1e-12)


@pytest.mark.parametrize("start_phase", [-1.5, -0.9, 0.6, 2.0, 3.0])
@pytest.mark.parametrize("excess", [1e-8, 1e-4, 0.1, 2.0])
def test_release_comes_when_a_straight_acceleration_reaches_c(excess, start_phase):
    peak, frequency = C * (1.0 + excess), 1.7
    motion = sb.Harmonic.straight(
        acceleration=peak, angular_frequency=frequency, direction=0.4, start_phase=start_phase
    )
    run = sb.simulate(model(0.1), motion, duration=8.0)
    # |cos(Ωt + φ)| = c/peak for the first time: Ωt + φ = nπ − acos(c/peak), unless it is exceeded from the start.
    before = math.acos(C / peak)
    turns = math.ceil((start_phase + before) / math.pi)
    released = max(0.0, (turns * math.pi - before - start_phase) / frequency)
    if abs(math.cos(start_phase)) * peak > C:
        released = 0.0
    first = run.events[0]
    # The margin of 8 ulp shifts the instant by 8 ulp/(Ω √(2 excess)), below 1e-10.
    assert first.kind == "uplift"
    assert first.time == pytest.approx(released, abs=1e-9)


@pytest.mark.parametrize("start_phase", [0.3, 1.1, 2.9])
def test_release_comes_when_an_elliptic_acceleration_reaches_the_weight_left(start_phase):
    motion = sb.Harmonic.elliptic(
        amplitude=(0.09, 0.02), phase=0.8, angular_frequency=1.3, start_phase=start_phase
    ) + sb.Harmonic.vertical(acceleration=0.4, angular_frequency=3.1, start_phase=0.5)

    def excess(t):
        ax = 0.09 * math.cos(1.3 * t + start_phase)
        ay = 0.02 * math.cos(1.3 * t + start_phase + 0.8)
        return math.hypot(ax, ay) - C * (1.0 + 0.4 * math.cos(3.1 * t + 0.5))

    grid = np.linspace(0.0, 10.0, 100_001)
    values = np.array([excess(t) for t in grid])
    above = int(np.argmax(values > 0.0))
    expected = grid[0] if above == 0 else brentq(excess, grid[above - 1], grid[above], xtol=1e-14)
    run = sb.simulate(model(0.1), motion, duration=10.0)
    assert run.events[0].kind == "uplift"
    assert run.events[0].time == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize("width", [1e-2, 1e-4, 1e-6])
def test_a_release_between_samples_is_not_missed(width):
    # |a_h| > c only within ± width/Ω of the peaks, far less than the 1/64 period between samples.
    motion = sb.Harmonic.straight(acceleration=C / math.cos(width), angular_frequency=1.0, start_phase=1.234567)
    forcing = Forcing.of(model(), motion)
    released = release_time(model(), forcing, 0.0, 20.0)
    # The margin of 8 ulp delays it by 8 ulp/width.
    assert released == pytest.approx(math.pi - width - 1.234567, abs=1e-12 + 3e-15 / width)


def test_release_of_a_delayed_motion_comes_at_its_onset():
    motion = sb.Harmonic.circular(acceleration=0.15, angular_frequency=2.0).delayed(3.3)
    run = sb.simulate(model(0.1), motion, duration=5.0)
    assert run.events[0] == sb.Event("uplift", pytest.approx(3.3, abs=1e-9))
    assert float(run.sample(3.29).amplitude[0]) == 0.0
    assert float(run.sample(3.6).amplitude[0]) > 0.0


def test_a_base_that_starts_with_a_jump_releases_the_column_at_any_time():
    jump = sb.Harmonic.straight(acceleration=0.2, angular_frequency=2.0)
    model = sb.Slender(sb.Column.dimensionless(slenderness=C))
    at_once = sb.simulate(model, jump, duration=1.0)
    for delay in np.random.default_rng(5).uniform(0.1, 9.0, 40):
        run = sb.simulate(model, jump.delayed(delay), duration=delay + 1.0)
        assert run.events[0].time == pytest.approx(delay, rel=1e-14)
        np.testing.assert_allclose(run.data["tilt"][-1], at_once.data["tilt"][-1], rtol=1e-11, atol=1e-15)


@pytest.mark.parametrize("acceleration", [0.12, 0.3])
@pytest.mark.parametrize("shape", [1.0, 0.95])
def test_motion_after_release_agrees_with_starts_ever_closer_to_the_upright(shape, acceleration, integrate_equations_1):
    motion = sb.Harmonic.elliptic(
        amplitude=(acceleration, shape * acceleration), phase=math.pi / 2.0, angular_frequency=1.4, start_phase=0.5
    )
    run = sb.simulate(model(0.1), motion, duration=4.0, rtol=1e-11)
    now = motion.acceleration(0.0)[:2]
    push = -(1.0 - C / np.hypot(*now)) * now

    def reference(delta):
        # To leading order α = Fδ²/2 with F = −(|a_h| − c) â; the rate neglects terms of the order δ².
        state = (*(0.5 * push * delta**2), *(push * delta))
        span = (delta, float(run.data.time[-1]))
        return integrate_equations_1(state, span, c=C, eta=0.1, acceleration=motion.acceleration, atol=1e-17).y[:, -1]

    coarse, fine = reference(5e-4), reference(2.5e-4)
    error = (fine - coarse) / 3.0  # second order in δ
    found = np.concatenate([run.data.tilt.to_numpy()[-1], run.data.tilt_rate.to_numpy()[-1]])
    assert run.events[0] == sb.Event("uplift", 0.0)
    assert np.abs(error).max() < 1e-5
    # What is left is of the third order in δ, less than a tenth of what was removed.
    np.testing.assert_allclose(found, fine + error, rtol=0.0, atol=0.1 * np.abs(error).max() + 1e-9 * C)


@pytest.mark.parametrize("damping", [0.0, 0.1, 2.0])
def test_the_departure_is_right_to_the_second_order_in_its_duration(damping):
    motion = sb.Harmonic.straight(acceleration=0.15, angular_frequency=1.4, start_phase=0.5)
    later, state = departure(model(damping), Forcing.of(model(damping), motion), 0.0)
    # In a plane (1) is linear after the release: α̈ = α + c − ηα̇ − a cos(τ + …), leaning against the acceleration;
    # its Taylor series about the release, four terms of it.
    push = C - 0.15 * math.cos(0.5)
    push_rate = 0.15 * 1.4 * math.sin(0.5)
    jerk = push_rate - damping * push
    snap = push + 0.15 * 1.4**2 * math.cos(0.5) - damping * jerk
    tilt = push * later**2 / 2.0 + jerk * later**3 / 6.0 + snap * later**4 / 24.0
    rate = push * later + jerk * later**2 / 2.0 + snap * later**3 / 6.0
    assert push < 0.0
    np.testing.assert_allclose([state[0], state[2]], [tilt, rate], rtol=50.0 * later**2)


@pytest.mark.parametrize("rate", [(0.0, 0.0), (0.0, 0.01)], ids=["in a plane", "in space"])
@pytest.mark.parametrize("damping", [0.3, 1.5])
def test_friction_brings_the_column_to_rest_at_the_threshold_of_energy(damping, rate):
    run = sb.simulate(model(damping), tilt=(0.01, 0.0), tilt_rate=rate, duration=100.0)
    assert run.outcome is sb.Outcome.AT_REST
    rest = next(event for event in run.events if event.kind == "rest")
    assert run.decided_at == pytest.approx(rest.time, rel=1e-12)
    before = run.sample(np.nextafter(rest.time, 0.0))
    tilt, speed = float(before.amplitude[0]), float(np.hypot(*before.tilt_rate.to_numpy()[0]))
    energy = (0.5 * speed**2 + C * tilt) / C**2
    assert run.thresholds["rest_energy"] == 1e-4
    assert energy <= 1e-4 * (1.0 + 1e-6)
    assert energy >= 0.5e-4  # entered at the threshold, not long after
    assert float(run.data.amplitude[-1]) == 0.0


def test_without_friction_the_column_never_comes_to_rest():
    run = sb.simulate(model(), tilt=(1e-5, 0.0), tilt_rate=(0.0, 1e-6), duration=2.0)
    assert run.outcome is sb.Outcome.STILL_MOVING
    assert not any(event.kind == "rest" for event in run.events)


def test_rest_is_followed_by_release_when_the_base_begins_to_move():
    motion = sb.Harmonic.circular(acceleration=0.13, angular_frequency=2.0, ramp=30.0).delayed(40.0)
    run = sb.simulate(model(1.0), motion, tilt=(0.01, 0.0), duration=70.0, recheck=False)
    kinds = [event.kind for event in run.events]
    assert kinds[:2] == ["rest", "uplift"]
    rest, release = run.events[:2]
    assert rest.time < 40.0
    # ½(1 − cos(π s/30)) 0.13 = c
    assert release.time == pytest.approx(40.0 + 30.0 / math.pi * math.acos(1.0 - 2.0 * C / 0.13), abs=1e-9)
    assert bool(run.sample(0.5 * (rest.time + release.time)).resting[0])


@pytest.mark.parametrize(("nu", "a0"), [(5.0, 0.05), (20.0, 0.05), (20.0, 0.02), (60.0, 0.09)])
def test_steady_rolling_is_never_taken_for_rest(nu, a0):
    upper = sb.theory.steady_rolling(nu, a0, c=C, eta=0.1).upper
    amplitude, phase = float(upper.amplitude), float(upper.phase)
    motion = sb.Harmonic.circular(acceleration=a0, angular_frequency=nu)
    lean = amplitude * np.array([math.cos(phase), math.sin(phase)])
    along = amplitude * nu * np.array([-math.sin(phase), math.cos(phase)])
    run = sb.simulate(model(0.1), motion, tilt=lean, tilt_rate=along, duration=12.0 * 2.0 * math.pi / nu)
    assert run.outcome is sb.Outcome.ROLLING
    assert not run.data.resting.any()


STONE = sb.Slender(sb.Column.solid(radius=0.5, height=10.0, density=2700.0), damping=0.1)


@pytest.mark.parametrize("acceleration", [0.99, 1.0, 1.02])
def test_small_hops_after_release_are_not_cut_off(acceleration):
    # Just above the limit c g = 0.981 m/s² each peak lifts the column by little. The hops build on each other and
    # overturn it, as integration with a rest threshold ten thousand times finer shows.
    motion = sb.Harmonic.straight(acceleration=acceleration, angular_frequency=2.0, start_phase=-math.pi / 2.0)
    run = sb.simulate(STONE, motion, duration=60.0)
    finer = sb.simulate(STONE, motion, duration=60.0, rest_energy=1e-12)
    assert run.outcome is finer.outcome is sb.Outcome.OVERTURNED
    assert run.decided_at == pytest.approx(finer.decided_at, rel=1e-6)


@pytest.mark.parametrize("rtol", [1e-6, 1e-8, 1e-10])
def test_the_outcome_near_the_release_limit_does_not_hang_on_the_tolerance(rtol):
    vase = sb.Column.frustum(radius=0.16, top_radius=0.22, height=1.5, density=2710.0)
    motion = sb.Harmonic.straight(acceleration=2.0, angular_frequency=2.0 * math.pi, ramp=3.0)
    run = sb.simulate(sb.Slender(vase, damping=0.05), motion, duration=40.0, rtol=rtol)
    assert run.outcome is sb.Outcome.OVERTURNED
    assert run.decided_at == pytest.approx(5.907, abs=2e-3)


def test_rest_between_hops_too_small_to_follow_is_reported_as_uncertain():
    motion = sb.Harmonic.straight(acceleration=0.9815 * 1.0001, angular_frequency=2.0, start_phase=-math.pi / 2.0)
    column = sb.Column.dimensionless(0.1)
    tiny = sb.Harmonic.straight(acceleration=0.1 * 1.0001, angular_frequency=2.0, start_phase=-math.pi / 2.0)
    run = sb.simulate(sb.Slender(column, damping=0.1), tiny, duration=20.0)
    assert run.uncertain
    assert not sb.simulate(STONE, motion.scaled(0.99), duration=20.0).uncertain
