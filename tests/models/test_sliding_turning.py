"""Slip that turns as it goes on, and a plane without friction: against Coulomb's law integrated by SciPy, and Newton's.

A slip ends where its velocity vanishes, and nowhere else: one that turns by more than a right angle within a step of
the integration goes on along its new direction.
"""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stylobate as sb
from stylobate.models.sliding import Contact
from stylobate.models.sliding.balance import SlidingState
from stylobate.models.sliding.rim_and_base import lifted

COLUMN = sb.Column.dimensionless(slenderness=0.3)
CIRCLE = sb.Harmonic.circular(acceleration=1.0, angular_frequency=3.0)
# Errors of a few tolerances in each of the few dozen steps of a run.
TOLERANCES = 200.0


def slid(friction, motion, velocity, duration):
    """Return footprint and slip of a base that slides all the time, v̇ = −a − μ g v/|v|."""

    def rates(time, state):
        ax, ay, _ = motion.derivative(time, 2)
        vx, vy = state[2:]
        per = friction * COLUMN.gravity / math.hypot(vx, vy)
        return vx, vy, -ax - per * vx, -ay - per * vy

    found = solve_ivp(rates, (0.0, duration), (0.0, 0.0, *velocity), method="DOP853", rtol=1e-12, atol=1e-13)
    return found.y[:, -1]


def ended(run):
    """Return footprint and slip at the end of a run."""
    last = run.data.isel(time=-1)
    return np.concatenate([last["footprint"], last["slip_velocity"]])


@pytest.mark.parametrize("rtol", [1e-5, 1e-6, 1e-7])
def test_a_slip_that_turns_within_a_step_is_not_stopped(rtol):
    friction, velocity, duration = 1e-3, (0.0, 1.0 / 3.0), 20.0
    run = sb.simulate(
        sb.Sliding(COLUMN, friction_coefficient=friction),
        CIRCLE,
        velocity=(*velocity, 0.0),
        duration=duration,
        rtol=rtol,
    )
    expected = slid(friction, CIRCLE, velocity, duration)
    np.testing.assert_allclose(ended(run), expected, atol=TOLERANCES * rtol)
    np.testing.assert_allclose(expected, [-0.21, -0.03, 0.102, -0.317], atol=5e-3)
    assert not run.events
    assert run.measures["slips"] == 0.0


@pytest.mark.parametrize("rtol", [1e-5, 1e-6, 1e-8])
def test_slips_that_turn_again_and_again_are_those_of_coulombs_law(rtol):
    rng = np.random.default_rng(8)
    for friction in np.geomspace(1e-4, 0.03, 8):
        frequency, velocity = rng.uniform(1.0, 6.0), rng.normal(size=2) * 0.4
        motion = sb.Harmonic.circular(acceleration=1.0, angular_frequency=frequency)
        model = sb.Sliding(COLUMN, friction_coefficient=friction)
        run = sb.simulate(model, motion, velocity=(*velocity, 0.0), duration=8.0, rtol=rtol)
        np.testing.assert_allclose(ended(run), slid(friction, motion, velocity, 8.0), atol=TOLERANCES * rtol)


@pytest.mark.parametrize("rtol", [1e-6, 1e-8])
@pytest.mark.parametrize("friction", [1e-12, 1e-7, 1e-5, 1e-3])
def test_little_friction_only_takes_energy_from_a_rim_that_slips(friction, rtol):
    model = sb.Sliding(COLUMN, friction_coefficient=friction)
    run = sb.simulate(model, tilt=(0.1, 0.05), tilt_rate=(0.02, -0.1), duration=5.0, rtol=rtol)
    energy = run.data["energy"].to_numpy()
    assert np.diff(energy).max() <= TOLERANCES * rtol * energy[0]
    # What slips with |v| < 1 over the time of the run loses no more than μ N |v| t, with N near the weight.
    assert energy[-1] >= energy[0] * (1.0 - TOLERANCES * rtol) - 2.0 * friction * 5.0


@pytest.mark.parametrize("velocity", [(0.0, 0.0), (0.1, 0.2)])
def test_without_friction_the_base_slides_freely(velocity):
    motion = sb.Harmonic(amplitude=(0.3, 0.2, 0.1), phase=(0.3, 1.0, 2.0), angular_frequency=3.0)
    model = sb.Sliding(COLUMN, friction_coefficient=0.0)
    run = sb.simulate(model, motion, velocity=(*velocity, 0.0), duration=6.0, rtol=1e-10)
    times = run.data["time"].to_numpy()
    moved, speed = (np.array(motion.derivative(times, order))[:2].T for order in (0, 1))
    v0 = np.array(velocity) + speed[0]
    np.testing.assert_allclose(run.data["slip_velocity"], v0 - speed, atol=1e-8)
    np.testing.assert_allclose(run.data["footprint"], np.outer(times, v0) - (moved - moved[0]), atol=1e-8)
    assert run.outcome is sb.Outcome.SLID
    assert not run.data["friction_force"].any()


def test_without_friction_a_column_that_stands_on_a_base_at_rest_stays():
    assert sb.simulate(sb.Sliding(COLUMN, friction_coefficient=0.0), duration=2.0).outcome is sb.Outcome.AT_REST


def test_without_friction_a_rim_keeps_its_horizontal_momentum_and_its_energy():
    model = sb.Sliding(COLUMN, friction_coefficient=0.0)
    start = {"tilt": (0.1, 0.05), "tilt_rate": (0.02, -0.1), "spin": 0.3, "velocity": (0.1, 0.0, 0.0)}
    duration = 0.4  # before its base strikes the plane
    at_rest = sb.simulate(model, **start, duration=duration, rtol=1e-11)
    energy = at_rest.data["energy"].to_numpy()
    np.testing.assert_allclose(energy, energy[0], rtol=1e-8)
    motion = sb.Harmonic(amplitude=(0.3, 0.2, 0.1), phase=(0.3, 1.0, 2.0), angular_frequency=3.0)
    for base in (None, motion):
        run = at_rest if base is None else sb.simulate(model, base, **start, duration=duration, rtol=1e-11)
        assert not run.events
        times = run.data["time"].to_numpy()
        speed = np.zeros((times.size, 2)) if base is None else np.array(base.derivative(times, 1))[:2].T
        momentum = centre_velocities(model, run) + speed
        np.testing.assert_allclose(momentum, np.broadcast_to(momentum[0], momentum.shape), atol=1e-9)


@pytest.mark.parametrize("slenderness", [0.1, 0.25, 0.3])
def test_a_base_whose_friction_equals_its_slenderness_slides(slenderness):
    column = sb.Column.dimensionless(slenderness=slenderness)
    motion = sb.Harmonic.circular(acceleration=0.5, angular_frequency=3.0)
    model = sb.Sliding(column, friction_coefficient=column.slenderness)
    run = sb.simulate(model, motion, duration=2.0)
    assert run.outcome is sb.Outcome.SLID
    assert not run.data["tilt"].any()


def centre_velocities(model, run):
    """Return the horizontal velocity of the centre of mass relative to the base, of a column on its rim."""
    data, unit = run.data, model.column.mass_height / model.time_scale
    names = ("tilt", "tilt_rate", "spin", "slip_velocity")
    found = []
    for tilt, rate, spin, slip in zip(*(data[name].to_numpy() for name in names), strict=True):
        turning = (*(rate * model.time_scale), spin * model.time_scale, 0.0, 0.0, 0.0)
        state = SlidingState(*tilt, *turning, *(slip / unit), *(0.0,) * 5, float(Contact.SLIPPING))
        flying = lifted(state, model.numbers)
        found.append((flying.velocity_x * unit, flying.velocity_y * unit))
    return np.array(found)
