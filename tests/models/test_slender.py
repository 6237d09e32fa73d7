"""The slender model by itself: right-hand side, criteria, series, units."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import stylobate as sb
from stylobate.errors import ParameterError
from stylobate.models.model import Push

C = 0.1
MODEL = sb.Slender(sb.Column.dimensionless(C), damping=0.1)
numbers = st.floats(-0.5, 0.5)


@given(x=numbers, y=numbers, vx=numbers, vy=numbers, ax=numbers, ay=numbers, az=numbers)
def test_rates_are_equations_1(x, y, vx, vy, ax, ay, az):
    tilt = math.hypot(x, y)
    if tilt < 1e-9:
        return
    found = MODEL.rates(x, y, vx, vy, ax, ay, az, *MODEL.parameters)
    expected = (
        vx,
        vy,
        (1.0 + az) * (x - C * x / tilt) - 0.1 * vx - ax,
        (1.0 + az) * (y - C * y / tilt) - 0.1 * vy - ay,
    )
    assert found == pytest.approx(expected, rel=1e-13, abs=1e-15)


@given(tilt=st.floats(1e-6, 0.5), rate=numbers, side=st.sampled_from([1.0, -1.0]), a=numbers, az=numbers)
def test_planar_rates_are_those_in_space_along_any_line(tilt, rate, side, a, az):
    line = (math.cos(1.1), math.sin(1.1))
    x, y = (side * tilt * part for part in line)
    vx, vy = (rate * part for part in line)
    _, _, fx, fy = MODEL.rates(x, y, vx, vy, a * line[0], a * line[1], az, *MODEL.parameters)
    found = MODEL.planar_rates(side * tilt, rate, side, a, az, *MODEL.parameters)
    assert found == pytest.approx((rate, fx * line[0] + fy * line[1]), rel=1e-12, abs=1e-14)
    assert fx * line[1] - fy * line[0] == pytest.approx(0.0, abs=1e-15)


def test_planar_states_lie_along_their_line():
    planar = np.array([[0.1, -0.2], [0.3, 0.4]])
    states = MODEL.from_plane(*planar, 0.6, 0.8, *MODEL.parameters)
    np.testing.assert_allclose(states, [[0.06, -0.12], [0.08, -0.16], [0.18, 0.24], [0.24, 0.32]], rtol=1e-15)


def test_a_start_is_scaled_to_the_time_of_the_model():
    column = sb.Column.solid(radius=0.5, height=10.0, density=2700.0)
    model = sb.Slender(column)
    state = model.start((0.01, 0.02), (0.3, -0.4))
    assert state == pytest.approx((0.01, 0.02, 0.3 / column.frequency_scale, -0.4 / column.frequency_scale), rel=1e-15)
    assert model.time_scale == pytest.approx(1.0 / column.frequency_scale, rel=1e-15)
    states = np.array(state)[:, np.newaxis]
    np.testing.assert_array_equal(model.tilt(states)[:, 0], state[:2])
    np.testing.assert_array_equal(model.tilt_rate(states)[:, 0], state[2:])


def test_damping_is_a_moment_by_angular_velocity():
    column = sb.Column.solid(radius=0.5, height=10.0, density=2700.0)
    model = sb.Slender(column, damping=0.1)
    assert model.damping_coefficient == pytest.approx(0.1 * column.frequency_scale * column.base_inertia, rel=1e-15)


def test_only_friction_brings_a_column_to_rest():
    assert MODEL.comes_to_rest
    assert not sb.Slender(MODEL.column).comes_to_rest


@given(tilt=st.floats(0.001, 0.05), speed=st.floats(0.0, 0.1), az=st.floats(-0.05, 0.5))
def test_energy_above_rest_is_the_kinetic_energy_and_the_work_to_the_upright(tilt, speed, az):
    # With the term ½A² of second order left out: an upper bound.
    work = C * (1.0 + az) * tilt
    assert MODEL.rest_energy(tilt, speed, az, *MODEL.parameters) == pytest.approx(0.5 * speed**2 + work, rel=1e-14)


@given(a=st.floats(0.0, 0.5), az=st.floats(-0.9, 0.0), beyond=st.floats(1e-6, 1.0), heading=st.floats(0.0, 6.3))
def test_beyond_the_no_return_tilt_every_acceleration_lets_the_tilt_grow(a, az, beyond, heading):
    tilt = MODEL.no_return_tilt(a, az, *MODEL.parameters) + beyond
    _, _, radial, _ = MODEL.rates(
        tilt, 0.0, 0.0, 0.0, a * math.cos(heading), a * math.sin(heading), az, *MODEL.parameters
    )
    assert radial > 0.0


def test_the_no_return_tilt_is_sharp_and_infinite_without_weight():
    tilt = MODEL.no_return_tilt(0.05, -0.5, *MODEL.parameters)
    assert tilt == pytest.approx(0.2, rel=1e-14)
    assert MODEL.rates(tilt, 0.0, 0.0, 0.0, 0.05, 0.0, -0.5, *MODEL.parameters)[2] == pytest.approx(0.0, abs=1e-15)
    assert MODEL.no_return_tilt(0.05, -1.0, *MODEL.parameters) == math.inf
    assert MODEL.no_return_tilt(0.05, -1.5, *MODEL.parameters) == math.inf


@pytest.mark.parametrize(("excess", "rate", "turning"), [(0.05, 0.0, 1.0), (0.0, 0.1, -2.0), (0.02, 0.3, 0.0)])
def test_departure_solves_equations_1_to_leading_order(excess, rate, turning):
    # The residual of (1) along the series, with the push as it changes, vanishes with the elapsed time.
    acceleration, model = C + excess, sb.Slender(MODEL.column)
    push = Push(direction=(-1.0, 0.0), acceleration=acceleration, excess=excess, excess_rate=rate, turning_rate=turning)

    def residual(t, h):
        before, now, after = (np.array(model.departure(push, t + k * h, *model.parameters)) for k in (-1, 0, 1))
        size, angle = acceleration + rate * t, turning * t
        forces = model.rates(*now, size * math.cos(angle), size * math.sin(angle), 0.0, *model.parameters)
        return np.array(forces[2:]) - (after[:2] - 2.0 * now[:2] + before[:2]) / h**2

    first, second = (np.abs(residual(t, 1e-2 * t)).max() / (excess + rate * t) for t in (1e-3, 5e-4))
    assert first < 1e-2
    assert second < 0.6 * first + 1e-6


def test_departure_without_excess_stays():
    push = Push(direction=(-1.0, 0.0), acceleration=C, excess=0.0, excess_rate=-0.1, turning_rate=1.0)
    assert MODEL.departure(push, 1e-3, *MODEL.parameters) == (0.0, 0.0, 0.0, 0.0)


@given(offset=st.floats(-1e-9, 1e-9), angle=st.floats(0.0, 6.3))
def test_a_passage_turns_with_its_direction(offset, angle):
    free = sb.Slender(MODEL.column)
    plain = np.array(free.passage(-1e-7, offset * C, 0.08, 0.0, 0.0, 0.0, 0.0, *free.parameters)[1])
    cos, sin = math.cos(angle), math.sin(angle)
    turn = np.array([[cos, -sin], [sin, cos]])
    start = (*(turn @ [-1e-7, offset * C]), *(turn @ [0.08, 0.0]))
    turned = np.array(free.passage(*start, 0.0, 0.0, 0.0, *free.parameters)[1])
    np.testing.assert_allclose(turned[:2], turn @ plain[:2], rtol=0.0, atol=1e-20)
    np.testing.assert_allclose(turned[2:], turn @ plain[2:], rtol=0.0, atol=1e-15)


def test_a_passage_through_the_upright_itself_goes_straight_on():
    _, end = sb.Slender.passage(-1e-7, 0.0, 0.08, 0.0, 0.0, 0.0, 0.0, C, 0.0)
    assert end == pytest.approx((1e-7, 0.0, 0.08, 0.0), rel=1e-12)


@pytest.mark.parametrize("column", [None, 0.1, "solid"])
def test_what_is_no_column_is_refused(column):
    with pytest.raises(ParameterError, match=r"^column must be a Column"):
        sb.Slender(column)


@pytest.mark.parametrize("damping", [-0.1, math.nan, math.inf, "x", None])
def test_impossible_damping_is_refused(damping):
    with pytest.raises(ParameterError, match=r"^damping must be"):
        sb.Slender(MODEL.column, damping=damping)


def test_the_centre_of_pressure_of_a_standing_column_follows_both_accelerations():
    column = sb.Column.dimensionless(C)
    shaken = sb.Harmonic.straight(acceleration=0.05, angular_frequency=2.0, direction=0.4)
    lifted = sb.Harmonic.vertical(acceleration=0.3, angular_frequency=3.0)
    data = sb.simulate(sb.Slender(column), shaken + lifted, duration=3.0).data
    assert bool(data["resting"].all())
    a = data["base_acceleration"].to_numpy()
    expected = -column.mass_height * a[:, :2] / (1.0 + a[:, 2:])
    np.testing.assert_allclose(data["centre_of_pressure"], expected, atol=1e-15)
