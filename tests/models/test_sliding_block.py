"""A squat column on a shaking plane slides and hops as a block: against the theory of conveying, and of starting."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stylobate as sb
from stylobate import theory
from stylobate.models.sliding.balance import even
from stylobate.theory import BlockPhase, FirstMotion

pytestmark = pytest.mark.long

# c above μ: it never tips. m = g = ω0 = 1, h = κ.
SQUAT = sb.Column.dimensionless(slenderness=0.8, inertia_ratio=0.5, axial_ratio=0.5)
FREQUENCY = 2.0
TURN = 2.0 * math.pi / FREQUENCY


def vibration(along, normal=0.0, phase=0.0, direction=0.0):
    """Base acceleration (along cos Ωt, normal cos(Ωt + phase)), along a horizontal `direction`."""
    motion = sb.Harmonic.straight(acceleration=along, angular_frequency=FREQUENCY, direction=direction)
    if normal == 0.0:
        return motion
    return motion + sb.Harmonic.vertical(acceleration=normal, angular_frequency=FREQUENCY, start_phase=phase)


def conveyed(model, motion, periods, direction=0.0, rtol=1e-9):
    """Mean velocity over the last of some periods, along a direction, and the run."""
    run = sb.simulate(model, motion, duration=(periods + 1e-6) * TURN, rtol=rtol)
    last, end = run.sample([(periods - 1) * TURN, periods * TURN])["footprint"].to_numpy()
    return (end - last) @ [math.cos(direction), math.sin(direction)] / TURN, run


@pytest.mark.parametrize(("amplitude", "static"), [(0.33, 0.3), (0.4, 0.35), (0.8, 0.3)])
def test_on_a_horizontal_plane_it_slides_to_and_fro_as_known(amplitude, static):
    known = theory.horizontal_sliding(amplitude, static_friction=static, kinetic_friction=0.3)
    model = sb.Sliding(SQUAT, friction_coefficient=0.3, static_friction_coefficient=static)
    # Without stops the mean velocity of the start fades, and the cycle with it; with them it is there at once.
    run = sb.simulate(model, vibration(amplitude), duration=12.0 * TURN, rtol=1e-10)
    late = run.sample(np.linspace(11.0 * TURN, 12.0 * TURN, 20001))
    speed = late["slip_velocity"].to_numpy()[:, 0] * FREQUENCY
    assert speed.max() == pytest.approx(known.peak_velocity, rel=1e-6)
    place = late["footprint"].to_numpy()[:, 0] * FREQUENCY**2
    assert np.ptp(place) == pytest.approx(known.stroke, rel=1e-6)
    assert run.outcome is sb.Outcome.SLID
    stops = sum(event.kind == "stop" for event in run.events if event.time > 11.0 * TURN)
    assert stops == (2 if known.slip_duration < math.pi else 0)


# Below and above throw number 1, which is normal/cos ψ; the last two hop.
@pytest.mark.parametrize(
    ("along", "normal", "phase", "incline", "static", "restitution", "direction"),
    [
        (0.6, 0.5, 0.0, 0.0, 0.3, 0.0, 0.0),
        (0.6, 0.5, 1.2, 0.0, 0.4, 0.0, 2.0),
        (0.7, 0.6, 0.3, 0.1, 0.3, 0.0, 1.0),
        (0.8, 1.3, 0.0, 0.0, 0.3, 0.0, 0.5),
        (0.8, 1.6, 0.4, 0.1, 0.3, 0.2, 2.0),
    ],
)
def test_it_is_conveyed_as_a_block(along, normal, phase, incline, static, restitution, direction):
    known = theory.block_cycle(
        along, normal, static_friction=static, kinetic_friction=0.3, phase=phase, incline=incline,
        normal_restitution=restitution,
    )  # fmt: skip
    assert known.period == 1
    # The way up is along `direction`.
    model = sb.Sliding(
        SQUAT, friction_coefficient=0.3, static_friction_coefficient=static, normal_restitution=restitution,
        incline=incline, incline_direction=direction + math.pi,
    )  # fmt: skip
    speed, run = conveyed(model, vibration(along, normal, phase, direction), 10, direction)
    assert speed * FREQUENCY == pytest.approx(known.mean_speed, abs=1e-6)
    times = run.measures
    flown = times["time_flying"] > 0.0
    assert flown == (known.fraction[BlockPhase.FLIGHT] > 0.0) == (normal > math.cos(incline))
    assert np.abs(run.data["tilt"]).max() == 0.0


def test_on_a_steep_plane_it_slides_ever_faster():
    incline, mu = 0.4, 0.2
    model = sb.Sliding(SQUAT, friction_coefficient=mu, incline=incline, incline_direction=0.5)
    run = sb.simulate(model, duration=3.0)
    down = math.sin(incline) - mu * math.cos(incline)
    np.testing.assert_allclose(
        run.data["slip_velocity"][-1], 3.0 * down * np.array([math.cos(0.5), math.sin(0.5)]), rtol=1e-9
    )
    assert run.outcome is sb.Outcome.SLID


@pytest.mark.parametrize("incline", [0.0, 0.05])
@pytest.mark.parametrize(("c", "mu"), [(0.2, 0.3), (0.3, 0.2)])
def test_it_begins_to_move_where_and_as_theory_says(c, mu, incline):
    known = theory.start_of_motion(1.0, 0.5, c=c, friction=mu, phase=0.7, incline=incline)
    model = sb.Sliding(
        sb.Column.dimensionless(slenderness=c), friction_coefficient=mu, incline=incline, incline_direction=math.pi
    )
    kinds = {FirstMotion.ROCK: "uplift", FirstMotion.SLIDE: "slide"}
    for factor in (0.999, 1.001):
        size = factor * float(known.amplitude)
        run = sb.simulate(model, vibration(size, 0.5 * size, 0.7), duration=2.0 * TURN)
        if factor < 1.0:
            assert not run.events
            assert run.outcome is sb.Outcome.AT_REST
        else:
            assert run.events[0].kind == kinds[FirstMotion(int(known.first))]
            # It begins before the peak of the load, by √(2 · 0.001) at most.
            early = float(known.phase) - run.events[0].time * FREQUENCY
            assert 0.0 < early % (2.0 * math.pi) < 0.05


@pytest.mark.parametrize(("kinetic", "static"), [(0.2, 0.2), (0.15, 0.2)])
def test_a_base_at_rest_stops_it_after_the_way_of_a_block(kinetic, static):
    model = sb.Sliding(SQUAT, friction_coefficient=kinetic, static_friction_coefficient=static)
    run = sb.simulate(model, velocity=(0.3, 0.4, 0.0), duration=10.0)
    assert run.outcome is sb.Outcome.AT_REST
    assert [event.kind for event in run.events] == ["stop"]
    assert run.events[0].time == pytest.approx(0.5 / kinetic, rel=1e-9)
    np.testing.assert_allclose(run.data["footprint"][-1], np.array([0.3, 0.4]) * 0.5 / (2.0 * kinetic), rtol=1e-8)
    assert run.measures["slip_distance"] == pytest.approx(0.25 / (2.0 * kinetic), rel=1e-8)


def test_a_spinning_base_stops_as_the_moment_of_an_even_pressure_says():
    # M = (2/3) μ N r, even pressure, and no slip but turning: I_a w3 falls at that rate.
    mu, spin = 0.3, 0.5
    run = sb.simulate(sb.Sliding(SQUAT, friction_coefficient=mu), spin=spin, duration=10.0)
    radius = SQUAT.radius
    slows = 2.0 / 3.0 * mu * radius / SQUAT.axial_inertia
    assert run.outcome is sb.Outcome.AT_REST
    assert run.events[0].time == pytest.approx(spin / slows, rel=1e-7)
    assert run.measures["residual_twist"] == pytest.approx(0.5 * spin**2 / slows, rel=1e-7)


def of_an_even_pressure(speed, twisting):
    """Return force and moment over μN and the radius, summed over a disc that slips and whose rim turns so fast."""
    x, weights = np.polynomial.legendre.leggauss(120)
    r, around = 0.5 * (x + 1.0), 2.0 * np.pi * (np.arange(720) + 0.5) / 720.0
    cos, sin = np.cos(around)[:, np.newaxis], np.sin(around)[:, np.newaxis]
    along, across = speed - twisting * r * sin, twisting * r * cos
    size = np.hypot(along, across)
    share = weights * r  # dr r, over the area π
    return ((along / size) @ share).mean(), ((r * (cos * across - sin * along) / size) @ share).mean()


@pytest.mark.parametrize(
    ("speed", "twisting"), [(1.0, 0.0), (0.01, 1.0), (0.5, 1.0), (1.0, 1.0), (1.0, 0.8), (1.0, 0.1)]
)
def test_friction_of_a_base_that_slides_and_turns_is_that_of_an_even_pressure(speed, twisting):
    along, about = even(speed, twisting)
    force, moment = of_an_even_pressure(speed, twisting)
    np.testing.assert_allclose([along * speed, about * twisting], [force, moment], rtol=0.0, atol=1e-4)


def test_a_base_that_slides_and_turns_stops_both_at_once():
    disc, mu, speed, spin = sb.Column.solid(radius=0.5, height=1.0, density=1000.0), 0.2, 1.0, 2.0
    run = sb.simulate(sb.Sliding(disc, friction_coefficient=mu), velocity=(speed, 0.0, 0.0), spin=spin, duration=2.0)

    def rates(time, state):
        force, moment = of_an_even_pressure(state[0], disc.radius * state[1])
        slows = mu * disc.gravity
        return [-slows * force, -slows * disc.mass * disc.radius * moment / disc.axial_inertia, *state[:2]]

    def stops(time, state):
        return state[0] - 1e-4

    stops.terminal = True
    known = solve_ivp(rates, (0.0, 2.0), [speed, spin, 0.0, 0.0], events=stops, rtol=1e-5, atol=1e-8)
    assert run.decided_at == pytest.approx(known.t[-1], abs=1e-3)
    assert run.measures["residual_displacement"] == pytest.approx(known.y[2, -1], abs=1e-4)
    assert run.measures["residual_twist"] == pytest.approx(known.y[3, -1], abs=1e-4)
