"""The body that may slip, leave the plane and land: its forces, its events, and motions known by other means."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from .constrained_body import PLACE, TURNING, VELOCITY, ConstrainedBody
from .sliding_body import SlidingBody
from .sliding_events import follow
from .sliding_track import Limits
from .test_constrained_body import SHAKEN, shaking

START = {"theta": 0.05, "beta": 0.3, "w1": -0.03, "w2": 0.1, "w3": 0.1}
WEIGHT = SHAKEN.mass * SHAKEN.gravity
SPEED = math.sqrt(SHAKEN.gravity * SHAKEN.radius)
COARSE = Limits(rtol=1e-9, atol=1e-12)


def shaken_hard(time):
    x, y, z = shaking(time)
    return 2.5 * x, 2.5 * y, z


def horizontal(time):
    return 3.0 * math.sin(9.0 * time), 0.0, 0.0


def kinds(track):
    return [event.kind for event in track.events]


# Forces


@pytest.mark.parametrize("friction", [{}, {"viscous": 0.02}, {"rolling_arm": 0.003, "rolling_rate": 0.05}])
def test_without_slip_it_is_the_constrained_body(friction):
    held = ConstrainedBody(column=SHAKEN, **friction)
    start, times = held.state(**START), [0.25, 0.5, 0.75]
    tight = Limits(rtol=1e-13, atol=1e-17)
    free = SlidingBody(SHAKEN, kinetic=10.0, **friction)
    found = follow(free, start, duration=1.0, acceleration=shaking, times=times, limits=tight)
    known = held.follow(start, duration=1.0, acceleration=shaking, times=times)
    assert set(found.phase) == {"stick"}
    np.testing.assert_allclose(found.state, known.state, rtol=0.0, atol=1e-10)
    np.testing.assert_allclose(found.force[:, 2], known.normal, rtol=0.0, atol=1e-9)
    assert np.hypot(*found.force.T[:2]) == pytest.approx(known.demand * known.normal, abs=1e-9)


def test_a_large_patch_that_holds_is_rubber():
    held = ConstrainedBody(column=SHAKEN, hold="rubber")
    start = held.state(**{**START, "w3": None})
    patched = SlidingBody(SHAKEN, kinetic=10.0, patch=1.0)
    found = follow(patched, start, duration=0.5, acceleration=shaking, times=[0.25])
    known = held.follow(start, duration=0.5, acceleration=shaking, times=[0.25])
    assert set(found.phase) == {"stick"}
    np.testing.assert_allclose(found.state, known.state, rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(found.couple, known.couple, rtol=0.0, atol=1e-9)


@pytest.mark.parametrize("patch", [0.0, 0.02])
def test_forces_keep_the_gap_shut_and_take_what_energy_is_lost(patch):
    rng = np.random.default_rng(5)
    body = SlidingBody(SHAKEN, kinetic=0.4, patch=patch, rolling_arm=0.003)
    for theta, beta, *moving in rng.uniform([0.02, -3, -1, -1, -1, -1, -1], [1.4, 3, 1, 1, 1, 1, 1], (200, 7)):
        w1, w2, w3, *slip = moving
        state = body.state(theta=theta, beta=beta, w1=w1, w2=w2, w3=w3, slip=slip)
        touching = body.touching(state)
        at = body.touch(touching)
        load = body.slipping(touching, at)
        rates = body.rates_touching(touching, at, load)
        assert rates[VELOCITY][2] == pytest.approx(0.0, abs=1e-12 * load.force[2])
        # m v̇ = F − m g Z, v̇_C = v̇ + (ω × ρ)˙ by differences along the motion
        whole = body.rates_flying(state, np.zeros(3))
        whole[VELOCITY] += load.force / SHAKEN.mass
        whole[TURNING] = rates[TURNING]
        ahead, behind = (body.touching(state + step * whole)[VELOCITY] for step in (1e-6, -1e-6))
        np.testing.assert_allclose((ahead - behind) / 2e-6, rates[VELOCITY], rtol=1e-6, atol=1e-6)
        power = load.force[:2] @ slip + load.couple @ state[TURNING]
        gain = (body.energy(state + 1e-6 * whole) - body.energy(state - 1e-6 * whole)) / 2e-6
        assert gain == pytest.approx(power, rel=1e-6, abs=1e-7)
        assert power < 0.0


def test_friction_on_a_patch_is_on_the_surface_of_what_it_bears():
    body = SlidingBody(SHAKEN, kinetic=0.4, patch=0.02)
    state = body.state(theta=0.3, w1=0.4, w3=2.0, slip=(0.02, -0.01))
    touching = body.touching(state)
    load = body.slipping(touching, body.touch(touching))
    assert body.reserve(load) == pytest.approx(0.0, abs=1e-14)
    kick = body.slip(body.kicked(touching, load, 1.0))
    np.testing.assert_allclose(kick, body.slip(touching) / np.linalg.norm(body.slip(touching)), atol=1e-12)


# Laws of motions from event to event


@pytest.mark.parametrize(
    "body",
    [
        SlidingBody(SHAKEN, kinetic=0.2),
        SlidingBody(SHAKEN, kinetic=0.15, static=0.2, rolling_arm=0.002),
        SlidingBody(SHAKEN, kinetic=0.2, patch=0.02),
    ],
    ids=["equal", "static", "patch"],
)
def test_the_law_of_contact_holds_at_every_step(body):
    track = follow(body, body.state(**START), duration=0.8, acceleration=shaken_hard, limits=COARSE)
    assert "slip" in kinds(track)
    touching = np.array([phase in {"stick", "slip"} for phase in track.phase])
    normal, drag = track.force[:, 2], np.hypot(*track.force.T[:2])
    assert normal[touching].min() > 0.0
    assert np.abs(track.gap[touching]).max() < 1e-9 * SHAKEN.radius
    for row in np.flatnonzero(touching):
        friction, slip = track.force[row, :2], track.slip[row]
        if track.phase[row] == "stick":
            assert np.linalg.norm(slip) < 1e-12
            assert drag[row] <= body.threshold * normal[row] * (1.0 + 1e-9)
        else:
            speed = math.hypot(slip[0], slip[1])
            assert friction @ slip[:2] == pytest.approx(-drag[row] * speed, rel=1e-9)
            assert drag[row] <= body.kinetic * normal[row] * (1.0 + 1e-9)
            if body.patch == 0.0:
                assert drag[row] == pytest.approx(body.kinetic * normal[row], rel=1e-9)


@pytest.mark.parametrize("patch", [0.0, 0.02])
def test_slip_takes_energy_and_rolling_keeps_it(patch):
    body = SlidingBody(SHAKEN, kinetic=0.1, patch=patch)
    start = body.state(theta=0.3, beta=0.4, w1=-0.2, w2=0.1, w3=1.0, slip=(0.2, 0.1))
    track = follow(body, start, duration=0.25, limits=COARSE)
    change = np.diff(track.energy)
    slipping = np.array(track.phase[:-1]) == "slip"
    assert slipping.any()
    assert change.max() < 1e-12 * WEIGHT
    np.testing.assert_allclose(change[np.array(track.phase[:-1]) == "stick"], 0.0, atol=1e-9)
    assert track.energy[-1] < track.energy[0] - 1e-3


def test_without_friction_the_centre_of_mass_keeps_its_horizontal_momentum():
    body = SlidingBody(SHAKEN, kinetic=0.0)
    start = body.state(**START, slip=(0.1, 0.2))
    track = follow(body, start, duration=0.4, acceleration=horizontal)
    assert set(track.phase) == {"slip"}
    # In the frame of the plane V_x + ∫a_x is constant.
    pushed = 3.0 / 9.0 * (1.0 - np.cos(9.0 * track.time))
    np.testing.assert_allclose(track.state[:, 7] + pushed, start[7], atol=1e-10)
    np.testing.assert_allclose(track.state[:, 8], start[8], atol=1e-10)


def test_little_friction_is_the_limit_of_none():
    start = SlidingBody(SHAKEN, kinetic=0.0).state(**START, slip=(0.1, 0.2))
    ends = [
        follow(SlidingBody(SHAKEN, kinetic=kinetic), start, duration=0.2, acceleration=shaking).state[-1]
        for kinetic in (0.0, 1e-4, 2e-4)
    ]
    near, far = (np.abs(end - ends[0]).max() for end in ends[1:])
    assert near < 1e-3
    assert far / near == pytest.approx(2.0, rel=0.01)


def test_a_small_patch_is_the_limit_of_a_point():
    # With s = ε|ω·Z| well below |v|, what a patch changes is M_z ∝ ε² at p = 3, and T by (s/|v|)³.
    start = SlidingBody(SHAKEN, kinetic=0.2).state(**START, slip=(0.3, 0.2))
    ends = [
        follow(SlidingBody(SHAKEN, kinetic=0.2, patch=patch), start, duration=0.05).state[-1]
        for patch in (0.0, 1e-3, 2e-3)
    ]
    near, far = (np.abs(end - ends[0]).max() for end in ends[1:])
    assert near < 1e-4
    assert far / near == pytest.approx(4.0, rel=0.05)


def test_events_converge_with_the_tolerance():
    body = SlidingBody(SHAKEN, kinetic=0.2)
    tracks = [
        follow(body, body.state(**START), duration=0.55, acceleration=shaken_hard, times=[],
               limits=Limits(rtol=rtol, atol=1e-3 * rtol))
        for rtol in (1e-7, 1e-9, 1e-11)
    ]  # fmt: skip
    assert [kinds(track) for track in tracks] == 3 * [["slip", "stick", "slip"]]
    times = [np.array([event.time for event in track.events]) for track in tracks]
    off = [np.abs(time - times[-1]).max() for time in times[:-1]]
    off_state = [np.abs(track.state[-1] - tracks[-1].state[-1]).max() for track in tracks[:-1]]
    assert off[0] < 1e-6 > off_state[0]
    assert off[1] < 1e-8 > off_state[1]


def test_what_counts_as_no_slip_decides_nothing():
    body = SlidingBody(SHAKEN, kinetic=0.2)
    tracks = [
        follow(body, body.state(**START), duration=0.55, acceleration=shaken_hard, times=[],
               limits=Limits(still=still))
        for still in (1e-8, 1e-10)
    ]  # fmt: skip
    assert kinds(tracks[0]) == kinds(tracks[1])
    np.testing.assert_allclose(tracks[0].state[-1], tracks[1].state[-1], atol=1e-7)


# Slip in a vertical plane, by equations of its own


def planar_motion(friction, start, duration, push):
    """Integrate x, z, θ and their rates from stick to slip and back: times of the changes, and the end.

    `start` sticks. Friction is ±μN or what keeps C where it is; slip begins and ends where that changes.
    """
    r, h, mass = SHAKEN.radius, SHAKEN.mass_height, SHAKEN.mass

    def lever(theta):
        return -h * math.sin(theta) + r * math.cos(theta), -h * math.cos(theta) - r * math.sin(theta)

    def forces(time, state, sense):
        theta, rate = state[2], state[5]
        x, z = lever(theta)
        # ẍ_C = T(1/m + z²/I) − N x z/I − x ω² − a;  z̈_C = N(1/m + x²/I) − T x z/I − z ω² − g
        inertia = SHAKEN.transverse_inertia
        along, across = (1.0 / mass + z * z / inertia, -x * z / inertia), 1.0 / mass + x * x / inertia
        known = x * rate**2 + push(time), z * rate**2 + SHAKEN.gravity
        if sense == 0.0:
            return np.linalg.solve([along, (along[1], across)], known)
        normal = known[1] / (across - sense * friction * along[1])
        return np.array([-sense * friction * normal, normal])

    def rates(time, state, sense):
        drag, normal = forces(time, state, sense)
        x, z = lever(state[2])
        angular = (z * drag - x * normal) / SHAKEN.transverse_inertia
        return [*state[3:], drag / mass - push(time), normal / mass - SHAKEN.gravity, angular]

    def slipping(_, state, sense):
        return state[3] + state[5] * lever(state[2])[1] if sense else 1.0

    def left(time, state, sense):
        drag, normal = forces(time, state, 0.0)
        return friction * normal - abs(drag) if sense == 0.0 else 1.0

    slipping.terminal = left.terminal = True
    time, state, sense, changes = 0.0, start, 0.0, []
    while True:
        slipping.direction = -sense
        run = solve_ivp(rates, (time, duration), state, "DOP853", events=(slipping, left), args=(sense,),
                        rtol=1e-12, atol=1e-14)  # fmt: skip
        time, state = run.t[-1], run.y[:, -1]
        if run.status == 0:
            return changes, state
        drag, normal = forces(time, state, 0.0)
        held = sense != 0.0 and abs(drag) < friction * normal
        changes.append(time)
        sense = 0.0 if held else -math.copysign(1.0, drag)


@pytest.mark.parametrize("friction", [0.12, 0.2])
def test_slip_in_a_vertical_plane(friction):
    body = SlidingBody(SHAKEN, kinetic=friction)
    start = body.state(theta=0.1, w2=0.2)
    turned = [*start[[0, 2]], 0.1, *start[[7, 9]], 0.2]
    changes, end = planar_motion(friction, turned, 0.7, horizontal)
    track = follow(body, start, duration=0.7, acceleration=horizontal, times=[])
    assert len(changes) > 1
    assert [event.time for event in track.events] == pytest.approx(changes, abs=1e-8)
    found = track.state[-1]
    assert found[[0, 2, 7, 9, 11]] == pytest.approx(end[[0, 1, 3, 4, 5]], abs=1e-8)
    assert found[[1, 8, 10, 12]] == pytest.approx(0.0, abs=1e-12)


def test_static_friction_above_kinetic_delays_slip_only():
    start = SlidingBody(SHAKEN, kinetic=0.2).state(**START)
    first = [
        follow(SlidingBody(SHAKEN, kinetic=kinetic, static=0.2), start, duration=0.3, acceleration=shaken_hard,
               times=[]).times_of("slip")[0]
        for kinetic in (0.1, 0.2)
    ]  # fmt: skip
    assert first[0] == pytest.approx(first[1], abs=1e-12)
    held = replace(ConstrainedBody(column=SHAKEN))
    known = held.follow(start, duration=first[0], acceleration=shaken_hard)
    assert known.demand[-1] == pytest.approx(0.2, abs=1e-9)
    assert start[PLACE][2] > 0.0
