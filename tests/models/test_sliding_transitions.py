"""What follows the end of a contact: slip that stops or goes on, rims that open, landings that do not approach."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

import stylobate as sb
from stylobate.models.sliding import Contact
from stylobate.models.sliding.balance import SlidingState
from stylobate.models.sliding.equations import energy_of, forces, height_of, rates_of
from stylobate.models.sliding.rim_and_base import STARTS, held, lifted, load_direction, opens, slip_rate

COLUMN = sb.Column.dimensionless(slenderness=0.3)
FRICTION, SUPPORT, REST = (sb.Sliding.guard_names.index(name) for name in ("friction", "support", "rest"))
AHEAD = 1e-3


def on_rim(rng, *, theta=(0.02, 1.2), contact=Contact.SLIPPING):
    """Return a random state of a column whose rim touches; its slip is zero."""
    tilt, azimuth = rng.uniform(*theta), rng.uniform(-math.pi, math.pi)
    lean = tilt * math.cos(azimuth), tilt * math.sin(azimuth)
    return SlidingState(*lean, *rng.normal(scale=0.3, size=3), *(0.0,) * 10, float(contact))


def after(model, state, guard, push=(0.0, 0.0, 0.0)):
    """Return elapsed time and state after a guard has broken, on a base with a constant acceleration."""
    elapsed, found = model.reset_map(*state, float(guard), *push, *push, AHEAD, 0.0, *model.parameters)
    return elapsed, SlidingState(*found)


def test_a_rim_opens_if_its_lowest_point_accelerates_upwards_without_contact():
    numbers = sb.Sliding(COLUMN).numbers
    rng, seen = np.random.default_rng(1), []
    step = np.array([-1e-3, 0.0, 1e-3])
    for _ in range(300):
        state, push = on_rim(rng), tuple(rng.uniform((-0.5, -0.5, -2.0), (0.5, 0.5, 0.0)))
        flying = lifted(state, numbers)
        rates = rates_of(flying, push, numbers)
        x, y = (flying[j] + rates[j] * step + 0.5 * rates[j + 2] * step**2 for j in (0, 1))
        rise = flying.rise + flying.rise_rate * step + 0.5 * rates[11] * step**2
        tilts = np.hypot(x, y)
        gap = rise - [height_of(math.sin(tilt), math.cos(tilt), numbers.c) for tilt in tilts]
        # Starts on the plane, with the velocity of the plane.
        np.testing.assert_allclose([gap[1], gap[2] - gap[0]], 0.0, atol=1e-5)
        bend = (gap[0] - 2.0 * gap[1] + gap[2]) / 1e-6
        if abs(bend) > 1e-2:  # the differences err by their fourth derivative times 1e-7
            seen.append(bend > 0.0)
            assert opens(state, push, numbers) == seen[-1]
    assert 50 < sum(seen) < len(seen) - 50


@pytest.mark.parametrize("patch", [0.0, 0.3])
def test_a_slip_stops_if_it_is_along_its_heading_and_goes_on_if_it_has_turned(patch):
    model = sb.Sliding(COLUMN, friction_coefficient=2.0, patch=patch)
    rng = np.random.default_rng(2)
    for _ in range(50):
        slip = rng.normal(scale=0.01, size=3) * (1.0, 1.0, float(patch > 0.0))
        state = on_rim(rng, theta=(0.02, 0.2))
        # The spin turns the patch by this slip over its radius.
        tilt = math.hypot(state.tilt_x, state.tilt_y)
        across = (state.tilt_rate_y * state.tilt_x - state.tilt_rate_x * state.tilt_y) / tilt
        sideways = across * math.sin(tilt) ** 2 / tilt
        spin = (slip[2] / (patch * 0.3) - sideways) / math.cos(tilt) if patch else state.spin
        size = float(np.linalg.norm(slip))
        state = state._replace(velocity_x=slip[0], velocity_y=slip[1], spin=spin)
        along = slip / size
        turned = np.cross(along, rng.normal(size=3)) if patch else np.array([-along[1], along[0], 0.0])
        for heading, stops in ((along, True), (turned / np.linalg.norm(turned), False)):
            names = dict(zip(("heading_x", "heading_y", "heading_z"), heading, strict=True))
            elapsed, found = after(model, state._replace(**names), FRICTION)
            if stops:
                assert (elapsed, found.contact, found.velocity_x, found.velocity_y) == (0.0, Contact.ROLLING, 0.0, 0.0)
            else:
                assert (elapsed, found.contact) == (0.0, Contact.SLIPPING)
                assert (found.velocity_x, found.velocity_y) == (slip[0], slip[1])
                np.testing.assert_allclose(found[12:15], along, atol=1e-12)


def test_a_slip_that_friction_cannot_hold_begins_again_in_the_same_reset():
    rng, seen = np.random.default_rng(4), []
    for friction in rng.uniform(0.01, 0.3, 60):
        model = sb.Sliding(COLUMN, friction_coefficient=friction)
        push = *rng.uniform(-0.4, 0.4, 2), 0.0
        state = on_rim(rng, theta=(0.02, 0.2))._replace(velocity_x=1e-11, heading_x=1.0)
        _, _, _, _, _, pressing, tx, ty, *_ = forces(held(state, model.numbers), push, model.numbers)
        holds = math.hypot(tx, ty) < friction * pressing
        elapsed, found = after(model, state, FRICTION, push)
        assert (elapsed > 0.0, found.contact) == ((False, Contact.ROLLING) if holds else (True, Contact.SLIPPING))
        seen.append(holds)
    assert 10 < sum(seen) < 50


def test_a_rim_that_does_not_approach_the_plane_is_not_struck():
    rng = np.random.default_rng(3)
    model = sb.Sliding(COLUMN, friction_coefficient=0.3, normal_restitution=0.5)
    for speed in (0.0, 0.1, 0.9):
        for _ in range(20):
            state = on_rim(rng, theta=(0.02, 0.2))._replace(velocity_x=0.3, velocity_y=-0.2)
            flying = lifted(state, model.numbers)
            flying = flying._replace(rise_rate=flying.rise_rate + speed)
            elapsed, found = after(model, flying, SUPPORT, (0.0, 0.0, 1.0))
            assert (elapsed, found.contact) == (0.0, Contact.SLIPPING)
            assert found[:5] == state[:5]
            assert (found.velocity_x, found.velocity_y) == pytest.approx((0.3, -0.2), rel=1e-12)


@pytest.mark.parametrize("approach", [0.05, 0.4, 3.0])
@pytest.mark.parametrize("restitution", [0.0, 0.5])
def test_a_base_that_lands_sliding_trips_if_its_impulse_leans_beyond_its_edge(approach, restitution):
    model = sb.Sliding(COLUMN, friction_coefficient=0.5, normal_restitution=restitution)
    struck = (1.0 + restitution) * approach
    # Friction stops the slip with an impulse of its speed, or slips on with half of the normal impulse.
    for slip, trips in ((0.29 * struck, False), (0.31 * struck, True), (0.6 * struck, True)):
        flying = SlidingState(*(0.0,) * 8, slip, 0.0, 0.0, -approach, 0.0, 0.0, 0.0, float(Contact.FLYING))
        _, found = after(model, flying, SUPPORT)
        assert (found.tilt_x > 0.0, found.tilt_y) == (trips, 0.0)
        assert (found.contact == Contact.FLYING) == (restitution > 0.0)


def test_a_patch_begins_to_slip_in_the_direction_in_which_it_accelerates():
    rng, seen = np.random.default_rng(5), 0
    for patch in rng.uniform(0.02, 0.5, 100):
        numbers = sb.Sliding(COLUMN, friction_coefficient=0.1, patch=patch).numbers
        state = held(on_rim(rng, theta=(0.02, 0.3), contact=Contact.ROLLING), numbers)
        push = tuple(rng.uniform((-0.4, -0.4, -0.3), (0.4, 0.4, 0.3)))

        def reserve(friction, state=state, push=push, numbers=numbers):
            return forces(state, push, numbers._replace(kinetic=friction, static=friction))[10]

        if forces(state, push, numbers)[5] < 0.0 or reserve(2.0) < 0.0:
            continue
        seen += 1
        weak = 0.95 * brentq(reserve, 1e-3, 2.0, rtol=1e-10)
        numbers = numbers._replace(kinetic=weak, static=weak)
        heading = np.array(load_direction(state, push, STARTS, numbers))
        rate = np.array(slip_rate(state, tuple(heading), push, STARTS, numbers))
        assert heading @ rate > 0.0
        # Newton's method ends at a change of 1e-9 of a slip that is less than a twentieth of the force.
        assert np.linalg.norm(np.cross(heading, rate)) < 1e-5 * np.linalg.norm(rate)
    assert seen > 50


def test_a_column_set_down_on_its_base_slides_on_with_the_velocity_of_its_centre():
    rng = np.random.default_rng(6)
    model = sb.Sliding(COLUMN, friction_coefficient=0.2)
    for _ in range(20):
        state = on_rim(rng, theta=(1e-7, 1e-6))
        slip, spin = rng.normal(scale=0.1, size=2), rng.normal()
        state = state._replace(velocity_x=slip[0], velocity_y=slip[1], spin=spin)
        elapsed, found = after(model, state, REST)
        assert (elapsed, found.contact, found[:4], found.spin) == (0.0, Contact.SLIDING, (0.0,) * 4, spin)
        assert (found.rise, found.rise_rate) == (0.0, 0.0)
        # From the rim point along the lean to the centre, which the spin carries round.
        lean = np.array(state[:2]) / math.hypot(*state[:2])
        expected = slip + spin * 0.3 * np.array([lean[1], -lean[0]])
        assert (found.velocity_x, found.velocity_y) == pytest.approx(tuple(expected), rel=1e-12)


@pytest.mark.parametrize("flies", [False, True])
def test_the_energy_that_impacts_limit_is_that_of_the_outputs(flies):
    model = sb.Sliding(COLUMN, incline=0.2)
    rng = np.random.default_rng(7)
    weight = COLUMN.mass * COLUMN.gravity * COLUMN.mass_height
    for _ in range(30):
        state = on_rim(rng)._replace(velocity_x=rng.normal(), velocity_y=rng.normal())
        state = lifted(state, model.numbers) if flies else state
        given = np.array(state)[:, np.newaxis], np.zeros((3, 1)), np.zeros(1, bool)
        shown = float(model.outputs(*given)["energy"].values[0])
        assert weight * sum(energy_of(state, model.numbers)) == pytest.approx(shown, rel=1e-12)
