"""The body that leaves the plane and lands: flight, impulses, and what the laws of impact do to energy."""

import math

import numpy as np
import pytest

from .constrained_body import PLACE, TURNING, VELOCITY
from .sliding_body import SlidingBody
from .sliding_events import follow
from .sliding_impact import impulse
from .sliding_track import Limits
from .test_constrained_body import SHAKEN

COARSE = Limits(rtol=1e-9, atol=1e-12)
FALLING = {"theta": 0.2, "beta": 0.4, "w1": 0.3, "w2": -0.2, "w3": 0.8, "slip": (0.2, -0.1), "rise": -0.3, "gap": 0.01}


def random_arrivals(count):
    """Arrivals at the rim: v_C (3,), W (3, 3), coefficient of friction."""
    rng = np.random.default_rng(11)
    body = SlidingBody(SHAKEN, kinetic=0.0)
    for theta, x, y, z, friction in rng.uniform([0.02, -1, -1, -2, 0], [1.4, 1, 1, 0, 1.5], (count, 5)):
        yield np.array([x, y, z]), body.touch(body.state(theta=theta)).response, friction


def energy_gain(velocity, response, struck):
    after = velocity + response @ struck
    return 0.5 * (after @ np.linalg.solve(response, after) - velocity @ np.linalg.solve(response, velocity))


@pytest.mark.parametrize("impact", ["stopping", "dissipative"])
@pytest.mark.parametrize("restitution", [0.0, 0.3, 0.7, 1.0])
def test_an_impulse_reflects_and_stays_within_the_cone(impact, restitution):
    stopped = 0
    for velocity, response, friction in random_arrivals(500):
        struck = impulse(velocity, response, friction, restitution, impact)
        after = velocity + response @ struck
        assert after[2] == pytest.approx(-restitution * velocity[2], abs=1e-12)
        assert math.hypot(*struck[:2]) <= friction * struck[2] * (1.0 + 1e-12)
        stopped += math.hypot(*after[:2]) < 1e-12
    if impact == "stopping" or restitution == 0.0:
        assert 100 < stopped < 400


@pytest.mark.parametrize(
    ("impact", "restitution"),
    [("dissipative", 0.0), ("dissipative", 0.3), ("dissipative", 0.7), ("dissipative", 1.0), ("stopping", 0.0)],
)
def test_no_impact_of_these_adds_energy(impact, restitution):
    for velocity, response, friction in random_arrivals(2000):
        struck = impulse(velocity, response, friction, restitution, impact)
        scale = velocity @ np.linalg.solve(response, velocity)
        assert energy_gain(velocity, response, struck) <= 1e-13 * scale


def test_stopping_a_bouncing_rim_can_add_energy():
    # W couples normal and tangential velocity, so to reflect the one and stop the other may need more than there is.
    gains = [energy_gain(*arrival[:2], impulse(*arrival, 1.0, "stopping")) for arrival in random_arrivals(500)]
    assert max(gains) > 0.1


def test_without_friction_and_loss_impacts_conserve_energy():
    body = SlidingBody(SHAKEN, kinetic=0.0, restitution=1.0)
    track = follow(body, body.state(**FALLING), duration=0.5)
    assert len(track.times_of("land")) > 3
    np.testing.assert_allclose(track.energy, track.energy[0], rtol=1e-10)


@pytest.mark.parametrize("impact", ["stopping", "dissipative"])
@pytest.mark.parametrize("friction", [0.05, 0.8])
def test_momenta_balance_through_impacts(impact, friction):
    body = SlidingBody(SHAKEN, kinetic=friction, restitution=0.6, impact=impact)
    track = follow(body, body.state(**FALLING), duration=0.3, times=[], limits=COARSE)
    landings = [event for event in track.events if event.kind == "land"]
    assert landings
    for event in landings:
        change = event.after - event.before
        np.testing.assert_allclose(SHAKEN.mass * change[VELOCITY], event.impulse, atol=1e-10)
        turned = body.spin_momentum(event.after) - body.spin_momentum(event.before)
        np.testing.assert_allclose(turned, np.cross(body.arm(event.before), event.impulse), atol=1e-10)
        np.testing.assert_allclose(change[:7], 0.0, atol=1e-11)


def test_flight_is_a_parabola_and_keeps_angular_momentum():
    body = SlidingBody(SHAKEN, kinetic=0.3)
    start = body.state(**{**FALLING, "rise": 0.5})
    push = np.array([1.0, -2.0, 0.5])
    track = follow(body, start, duration=0.08, acceleration=lambda _: push)
    assert set(track.phase) == {"flight"}
    time, falling = track.time[:, np.newaxis], -push - np.array([0.0, 0.0, SHAKEN.gravity])
    path = start[PLACE] + start[VELOCITY] * time + 0.5 * falling * time**2
    np.testing.assert_allclose(track.state[:, PLACE], path, atol=1e-12)
    momentum = np.array([body.spin_momentum(state) for state in track.state])
    np.testing.assert_allclose(momentum, np.tile(body.spin_momentum(start), (len(momentum), 1)), atol=1e-12)
    # e3 turns about the angular momentum L at |L|/I_t, by Rodrigues' formula.
    from_start, axis = body.spin_momentum(start), body.axis(start)
    along, angle = (
        from_start / np.linalg.norm(from_start),
        np.linalg.norm(from_start) / SHAKEN.transverse_inertia * 0.08,
    )
    turned = axis * math.cos(angle) + np.cross(along, axis) * math.sin(angle)
    turned += along * (along @ axis) * (1.0 - math.cos(angle))
    np.testing.assert_allclose(body.axis(track.state[-1]), turned, atol=1e-11)


@pytest.mark.parametrize("restitution", [0.0, 0.5, 0.9])
@pytest.mark.parametrize("friction", [0.1, 0.6])
def test_slip_and_impacts_only_take_energy(friction, restitution):
    body = SlidingBody(SHAKEN, kinetic=friction, restitution=restitution, impact="dissipative")
    track = follow(body, body.state(**FALLING), duration=0.3, limits=COARSE)
    assert track.times_of("land")
    assert np.diff(track.energy).max() < 1e-10 * track.energy[0]


def test_a_plane_that_drops_away_is_left_where_nothing_presses():
    def dropping(time):
        return 0.0, 0.0, -40.0 * time

    body = SlidingBody(SHAKEN, kinetic=0.3)
    track = follow(body, body.state(theta=0.05, w3=0.2), duration=0.3, acceleration=dropping)
    assert [event.kind for event in track.events] == ["slip", "lift"]
    assert track.force[:, 2].min() >= 0.0
    lift = track.times_of("lift")[0]
    # Hardly turning, the column presses with next to no force once the plane falls with g.
    assert lift == pytest.approx(SHAKEN.gravity / 40.0, abs=0.01)
    aloft = np.array(track.phase) == "flight"
    assert (np.diff(track.gap[aloft]) > -1e-15).all()


def test_bounces_pile_up_to_rest_on_the_rim():
    body = SlidingBody(SHAKEN, kinetic=0.5, restitution=0.4, impact="dissipative")
    start = body.state(theta=0.3, rise=-0.1, w2=0.4, w3=0.3)
    tracks = [
        follow(body, start, duration=0.3, times=[], limits=Limits(rtol=1e-9, atol=1e-12, resting=resting))
        for resting in (1e-5, 5e-6)
    ]
    assert 5 < len(tracks[0].times_of("land")) < 60
    assert tracks[0].phase[-1] in {"stick", "slip"}
    assert tracks[0].phase[-1] == tracks[1].phase[-1]
    np.testing.assert_allclose(tracks[0].state[-1], tracks[1].state[-1], atol=1e-6)


def test_an_upright_drop_ends_flat_on_the_base():
    body = SlidingBody(SHAKEN, kinetic=0.5)
    track = follow(body, body.state(theta=0.0, gap=0.1), duration=1.0)
    assert track.events[-1].kind == "flat"
    assert track.events[-1].time == pytest.approx(math.sqrt(0.2 / SHAKEN.gravity), rel=1e-10)
    np.testing.assert_allclose(track.state[-1][TURNING], 0.0)
