"""The body that may slip, leave the plane and land: its forces, its events, and motions known by other means."""

import math

import numpy as np
import pytest

from .constrained_body import TURNING, VELOCITY, ConstrainedBody
from .sliding_body import SlidingBody
from .sliding_events import follow
from .sliding_track import Limits
from .test_constrained_body import SHAKEN, shaking

START = {"theta": 0.05, "beta": 0.3, "w1": -0.03, "w2": 0.1, "w3": 0.1}
WEIGHT = SHAKEN.mass * SHAKEN.gravity
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


@pytest.mark.slow
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
    track = follow(body, body.state(**START), duration=0.6, acceleration=shaken_hard, limits=COARSE)
    assert "slip" in track.phase
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


@pytest.mark.slow
def test_events_converge_with_the_tolerance():
    body = SlidingBody(SHAKEN, kinetic=0.2)
    tracks = [
        follow(body, body.state(**START), duration=0.3, acceleration=shaken_hard, times=[],
               limits=Limits(rtol=rtol, atol=1e-3 * rtol))
        for rtol in (1e-7, 1e-9, 1e-11)
    ]  # fmt: skip
    assert [kinds(track) for track in tracks] == 3 * [["slip", "stick"]]
    times = [np.array([event.time for event in track.events]) for track in tracks]
    off = [np.abs(time - times[-1]).max() for time in times[:-1]]
    off_state = [np.abs(track.state[-1] - tracks[-1].state[-1]).max() for track in tracks[:-1]]
    assert off[0] < 1e-6 > off_state[0]
    assert off[1] < 1e-8 > off_state[1]


@pytest.mark.slow
def test_what_counts_as_no_slip_decides_nothing():
    body = SlidingBody(SHAKEN, kinetic=0.2)
    tracks = [
        follow(body, body.state(**START), duration=0.3, acceleration=shaken_hard, times=[],
               limits=Limits(still=still))
        for still in (2e-9, 1e-9)
    ]  # fmt: skip
    assert kinds(tracks[0]) == kinds(tracks[1])
    np.testing.assert_allclose(tracks[0].state[-1], tracks[1].state[-1], atol=1e-7)


# Where slip begins, and where it cannot go on


def test_slip_begins_where_its_own_friction_lets_it():
    # If friction falls at once, v̇_C must be along v_C, which is not quite against the friction that was overcome.
    body = SlidingBody(SHAKEN, kinetic=0.1, static=0.2)
    track = follow(body, body.state(**START), duration=0.2, acceleration=shaken_hard)
    event = track.events[0]
    early = np.flatnonzero((track.time > event.time + 1e-10) & (track.time < event.time + 1e-8))
    slip = track.slip[early[-1]] / np.linalg.norm(track.slip[early[-1]])
    touching = body.touching(track.state[early[-1]])
    at = body.touch(touching, np.array(shaken_hard(track.time[early[-1]])))
    rate = body.slip(body.rates_touching(touching, at, body.slipping(touching, at)))
    assert math.hypot(*np.cross(slip, rate)) < 1e-4 * (slip @ rate)


def test_a_jam_is_reported_where_no_normal_force_keeps_the_gap_shut():
    # In a vertical plane m Z·v̇_C per N is 1 + m x (x − z T/N)/I_t, (x, z) the arm.
    body = SlidingBody(SHAKEN, kinetic=3.0)
    for slip in (0.5, -0.5):
        start = body.state(theta=0.01, slip=(slip, 0.0))
        x, _, z = body.arm(start)
        expected = 1.0 + SHAKEN.mass * x * (x + 3.0 * math.copysign(1.0, slip) * z) / SHAKEN.transverse_inertia
        touching = body.touching(start)
        assert body.slipping(touching, body.touch(touching)).denominator == pytest.approx(expected, rel=1e-12)
        track = follow(body, start, duration=0.01, times=[])
        assert (kinds(track)[:1] == ["jam"]) == (expected < 0.0)


@pytest.mark.slow
def test_static_friction_above_kinetic_delays_slip_only():
    start = SlidingBody(SHAKEN, kinetic=0.2).state(**START)
    first = [
        follow(SlidingBody(SHAKEN, kinetic=kinetic, static=0.2), start, duration=0.2, acceleration=shaken_hard,
               times=[]).times_of("slip")[0]
        for kinetic in (0.1, 0.2)
    ]  # fmt: skip
    assert first[0] == pytest.approx(first[1], abs=1e-12)
    known = ConstrainedBody(column=SHAKEN).follow(start, duration=first[0], acceleration=shaken_hard)
    assert known.demand[-1] == pytest.approx(0.2, abs=1e-9)
