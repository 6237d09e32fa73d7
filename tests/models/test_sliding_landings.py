"""Flights and landings of the column that can slip: free motion, impulses at one point, bounces that end."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.models.sliding import Contact
from stylobate.models.sliding.balance import SlidingState
from stylobate.models.sliding.rim_and_base import REST_SPEED

from .constrained_body import PLACE, TURNING, VELOCITY
from .sliding_body import SlidingBody
from .sliding_impact import impulse
from .sliding_starts import random_start

# Base accelerations now and later, how much later, ε: of a base at rest.
AT_REST = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1e-3, 0.0)
ROUNDING = 1e-12
COLUMN = sb.Column.dimensionless(slenderness=0.3)


def arrivals(count, restitution):
    """A model, its body, and a state in which the lowest point comes down on the plane, as both have it."""
    rng = np.random.default_rng(17)
    for c, kappa, axial, mu in rng.uniform([0.05, 0.5, 0.3, 0.02], [1.0, 0.8, 0.5, 1.5], (count, 4)):
        column = sb.Column.dimensionless(slenderness=c, inertia_ratio=kappa, axial_ratio=axial)
        model = sb.Sliding(column, friction_coefficient=mu, normal_restitution=restitution)
        body = SlidingBody(column, kinetic=mu, restitution=restitution, impact="dissipative")
        theta, beta = rng.uniform(0.02, 1.4), rng.uniform(-math.pi, math.pi)
        w1, w2, w3, vx, vy = rng.normal(scale=0.5, size=5)
        vz = -rng.uniform(0.01, 1.0)
        d, n = np.array([math.cos(beta), math.sin(beta)]), np.array([-math.sin(beta), math.cos(beta)])
        begun = model.begun(
            tuple(theta * d), tuple(w2 * d - theta / math.sin(theta) * w1 * n), spin=w3, twist=0.0, position=(0.0, 0.0),
            velocity=(vx, vy, vz), clearance=0.0,
        )  # fmt: skip
        yield model, body, begun, body.state(theta=theta, beta=beta, w1=w1, w2=w2, w3=w3, slip=(vx, vy), rise=vz)


def velocities(state, body, place):
    """(v_G, ω) of a `SlidingState`, with the attitude that `place` has; rates are in units of ω0 = 1."""
    x, y, vx, vy = state[:4]
    theta = math.hypot(x, y)
    d = np.array([x, y, 0.0]) / theta
    n, e3 = np.array([-d[1], d[0], 0.0]), body.axis(place)
    u = np.cross(n, e3)
    fall, around = (x * vx + y * vy) / theta, (x * vy - y * vx) / theta**2
    spin = -math.sin(theta) * around * u + fall * n + state.spin * e3
    if state.contact == Contact.FLYING:
        velocity = np.array([state.velocity_x, state.velocity_y, state.rise_rate]) * body.column.mass_height
    else:
        sliding = np.array([state.velocity_x, state.velocity_y, 0.0]) * body.column.mass_height
        velocity = sliding - np.cross(spin, body.arm(place))
    return velocity, spin


@pytest.mark.parametrize("restitution", [0.0, 0.3, 1.0])
def test_a_landing_is_one_impulse_at_the_lowest_point_within_the_cone(restitution):
    compared = 0
    for model, body, begun, before in arrivals(300, restitution):
        elapsed, after = model.reset_map(*begun, 2.0, *AT_REST, *model.parameters)
        if elapsed > 0.0:
            continue  # it slips anew, from a contact that the impact has stopped
        compared += 1
        velocity, spin = velocities(SlidingState(*after), body, before)
        struck = body.column.mass * (velocity - before[VELOCITY])
        left = before.copy()
        left[VELOCITY], left[TURNING] = velocity, spin
        size = max(1.0, float(np.abs(struck).max()))
        turned = body.spin_momentum(left) - body.spin_momentum(before)
        np.testing.assert_allclose(turned, np.cross(body.arm(before), struck), rtol=0.0, atol=ROUNDING * size)
        assert math.hypot(struck[0], struck[1]) <= body.kinetic * struck[2] * (1.0 + 1e-9)
        lost = body.energy(before) - body.energy(left)
        assert lost >= -ROUNDING * body.energy(before)
        arrival = body.touching(before)[VELOCITY]
        known = impulse(arrival, body.touch(before).response, body.kinetic, restitution, "dissipative")
        np.testing.assert_allclose(struck, known, rtol=0.0, atol=1e2 * ROUNDING * size)
    assert compared > 100


@pytest.mark.parametrize("moving", ["straight", "aside", "spinning", "slipping", "all"])
@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("friction", [0.02, 0.3, 1.5])
def test_a_stroke_of_the_base_never_adds_energy(friction, restitution, moving):
    rng = np.random.default_rng(5)
    stroke = float(sb.Sliding(COLUMN).guard_names.index("face_impact"))
    # Where all moves at once the slip and spin may hold most of the energy.
    scale = 3.0 if moving == "all" else 1.0
    for c, kappa, axial in rng.uniform([0.05, 0.5, 0.3], [0.9, 0.8, 0.5], (30, 3)):
        column = sb.Column.dimensionless(slenderness=c, inertia_ratio=kappa, axial_ratio=axial)
        model = sb.Sliding(column, friction_coefficient=friction, normal_restitution=restitution)
        tilt, fall, around = c * rng.uniform([1e-4, -0.5, -0.5], [0.009, -0.1, 0.5])
        beta, spin = rng.uniform(-math.pi, math.pi), rng.normal(scale=0.3 * scale)
        slip = rng.normal(scale=0.1 * scale, size=2)
        around = around if moving in ("aside", "all") else 0.0
        spin = spin if moving in ("spinning", "all") else 0.0
        slip = slip if moving in ("slipping", "all") else np.zeros(2)
        d, n = np.array([math.cos(beta), math.sin(beta)]), np.array([-math.sin(beta), math.cos(beta)])
        begun = SlidingState(
            *tilt * d, *fall * d + around * n, spin, 0.0, 0.0, 0.0, *slip, 0.0, 0.0, 0.0, 0.0, 0.0,
            float(Contact.SLIPPING if slip.any() else Contact.ROLLING),
        )  # fmt: skip
        _, after = model.reset_map(*begun, stroke, *AT_REST, *model.parameters)
        before, left = (
            float(model.outputs(np.array([state]).T, np.zeros((3, 1)), np.zeros(1, dtype=bool))["energy"].values[0])
            for state in (begun, after)
        )
        assert left <= before * (1.0 + ROUNDING)


@pytest.mark.parametrize(
    ("column", "numbers", "start"),
    [
        (
            sb.Column.dimensionless(slenderness=0.5594860838162148),
            {
                "friction_coefficient": 0.03315,
                "static_friction_coefficient": 0.04973,
                "patch": 0.05,
                "normal_restitution": 0.9,
            },
            {"tilt": (-0.29256, -0.19951), "velocity": (-0.022847, 0.487995, 0.0), "spin": 0.5, "duration": 9.0},
        ),
        (
            sb.Column.dimensionless(slenderness=0.475),
            {"friction_coefficient": 0.1, "normal_restitution": 0.5},
            {"tilt": (0.19, 0.0), "tilt_rate": (0.0, 0.05), "duration": 4.0},
        ),
    ],
)
def test_no_stroke_adds_energy_to_a_squat_column_that_spins_and_slips(column, numbers, start):
    model = sb.Sliding(column, damping=0.03, passage_tilt=0.01 * column.slenderness, **numbers)
    run = sb.simulate(model, **start, samples=4001)
    assert sum(event.kind == "face_impact" for event in run.events) > 0
    energy = run.data["energy"].to_numpy()
    assert np.all(np.diff(energy) <= 1e-8 * energy[0])


def test_a_part_that_was_dropped_and_then_slides_has_slid():
    part = sb.Column.solid(radius=0.02, height=0.03, density=7800.0)
    tray = sb.Harmonic.oblique(acceleration=15.0, angular_frequency=60.0, angle=0.52)
    model = sb.Sliding(part, friction_coefficient=0.3, normal_restitution=0.2)
    run = sb.simulate(model, tray, clearance=0.01, duration=1.0)
    assert run.measures["time_flying"] > 0.05
    assert run.outcome is sb.Outcome.SLID


@pytest.mark.parametrize("c", [0.3, 0.46, 0.8])
def test_a_base_that_trips_over_its_edge_gains_no_energy(c):
    # Slip to the edge in front jams where κ/(1 − κ) c (μ − c) > 1.
    column = sb.Column.dimensionless(slenderness=c, inertia_ratio=0.78, axial_ratio=0.36)
    run = sb.simulate(sb.Sliding(column, friction_coefficient=1.5), velocity=(0.1, 0.0, 0.0), duration=1.0)
    energy = run.data["energy"].to_numpy()
    assert energy.max() <= energy[0] * (1.0 + 1e-6)


def test_flight_is_a_parabola_and_keeps_angular_momentum():
    start = random_start(4, airborne=True)
    body, column = start.body, start.model.column
    state = start.state.copy()
    state[PLACE][2] += 0.3 * column.mass_height
    given = {**start.given, "clearance": body.gap(state)}
    run = sb.simulate(start.model, **given, duration=0.4 * start.model.time_scale, rtol=1e-12)
    assert not run.events
    data = run.data
    time, tilt = data["time"].to_numpy(), data["tilt"].to_numpy()
    theta = np.hypot(*tilt.T)[:, np.newaxis]
    # G = B0 + (h sin θ + r(1 − cos θ)) d, and upwards h cos θ + r sin θ over the lowest point
    out = column.mass_height * np.sin(theta) + column.radius * (1.0 - np.cos(theta))
    level = data["footprint"].to_numpy() + out * tilt / theta
    up = data["clearance"].to_numpy() + column.mass_height * np.cos(theta[:, 0]) + column.radius * np.sin(theta[:, 0])
    path = np.column_stack([level, up])
    fallen = 0.5 * column.gravity * time**2
    known = state[PLACE] + time[:, np.newaxis] * state[VELOCITY] - fallen[:, np.newaxis] * [0.0, 0.0, 1.0]
    np.testing.assert_allclose(path, known, rtol=0.0, atol=1e-11 * column.mass_height)
    # e3 turns about the angular momentum L at |L|/I_t, by Rodrigues' formula; w3 stays.
    momentum, axis = body.spin_momentum(state), body.axis(state)
    along, angle = momentum / np.linalg.norm(momentum), np.linalg.norm(momentum) / column.transverse_inertia * time
    turned = np.outer(np.cos(angle), axis) + np.outer(np.sin(angle), np.cross(along, axis))
    turned += np.outer(1.0 - np.cos(angle), along * (along @ axis))
    np.testing.assert_allclose(np.sin(theta) * tilt / theta, turned[:, :2], rtol=0.0, atol=1e-11)
    np.testing.assert_allclose(data["spin"], start.given["spin"], rtol=1e-13)


def test_an_upright_drop_without_rebound_lands_at_rest():
    run = sb.simulate(sb.Sliding(COLUMN), clearance=0.1, duration=2.0)
    assert run.outcome is sb.Outcome.AT_REST
    assert [event.kind for event in run.events] == ["land"]
    assert run.events[0].time == pytest.approx(math.sqrt(0.2), rel=1e-10)


@pytest.mark.parametrize("restitution", [0.2, 0.5, 0.8])
def test_an_upright_drop_bounces_for_a_geometric_series(restitution):
    run = sb.simulate(sb.Sliding(COLUMN, normal_restitution=restitution), clearance=0.1, duration=10.0)
    assert run.outcome is sb.Outcome.AT_REST
    times = [event.time for event in run.events]
    first = math.sqrt(0.2)
    hops = 2.0 * first * restitution ** np.arange(1, len(times))
    # Heights are told to 1e-13, and the speed of the last approach is REST_SPEED at least.
    np.testing.assert_allclose(np.diff(times), hops, rtol=0.0, atol=1e-7)
    slowest = first * restitution ** len(times) / COLUMN.mass_height
    assert slowest <= REST_SPEED < slowest / restitution
    left = 2.0 * REST_SPEED * COLUMN.mass_height / (1.0 - restitution)
    assert 0.0 < first * (1.0 + restitution) / (1.0 - restitution) - times[-1] < left


def test_an_upright_column_that_lands_sliding_loses_what_friction_takes():
    # Impulse μ times that of the landing, along the plane and, 2/3 r times it, about the axis.
    mu, speed, height, spin = 0.1, 0.5, 0.02, 2.0
    run = sb.simulate(
        sb.Sliding(COLUMN, friction_coefficient=mu), velocity=(speed, 0.0, 0.0), spin=spin, clearance=height,
        duration=math.sqrt(2.0 * height) + 1e-9,
    )  # fmt: skip
    assert [event.kind for event in run.events] == ["land"]
    approach = math.sqrt(2.0 * height)
    assert float(run.data["slip_velocity"][-1, 0]) == pytest.approx(speed - mu * approach, rel=1e-8)
    slowed = 2.0 / 3.0 * mu * approach * COLUMN.radius / COLUMN.axial_inertia
    assert float(run.data["spin"][-1]) == pytest.approx(spin - slowed, rel=1e-8)


def test_a_rim_that_lifts_off_leaves_and_lands_in_ever_shorter_hops():
    model = sb.Sliding(sb.Column.dimensionless(slenderness=0.27), friction_coefficient=0.04, normal_restitution=0.5)
    dropping = sb.Harmonic.vertical(acceleration=1.2, angular_frequency=2.0, start_phase=1.0)
    run = sb.simulate(model, dropping, tilt=(0.1, 0.0), tilt_rate=(0.0, 0.05), duration=3.0)
    kinds = [event.kind for event in run.events]
    assert "lift" in kinds
    # Rebounds halve: of a drop by some h there are log2(1/REST_SPEED) at most.
    assert kinds.count("land") <= math.log2(1.0 / REST_SPEED) * kinds.count("lift")
    assert run.data["clearance"].min() >= -1e-12 * model.column.mass_height
