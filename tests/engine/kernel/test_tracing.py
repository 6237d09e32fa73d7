"""Entries of a trace and observation of steps in a lane, in plain Python, and the state within a step by series."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.engine.kernel.columns import Trace
from stylobate.engine.kernel.driver.events import TraceKind
from stylobate.models.sliding.balance import Contact

SLENDER = sb.Slender(sb.Column.dimensionless(0.1))
SLIDING = sb.Sliding(sb.Column.solid(radius=0.5, height=3.0, density=2700.0))
AZIMUTH = math.atan2(0.01, 0.02) / (2.0 * math.pi)
CIRCLE = sb.Harmonic.circular(acceleration=0.065, angular_frequency=3.0)


def entry(one, number=0):
    """Return the columns of an entry of the trace, and its terms, shape (terms, states)."""
    width, states = one.shape.trace_width, max(one.shape.states, 2)
    first = one.scope("trace_entry")["BREAKS_AT"] + width * number
    row = one.table[0, first : first + width]
    return row[: len(Trace)], row[len(Trace) :].reshape(-1, states)


@pytest.fixture(params=[SLENDER, SLIDING], ids=["four states", "kept states"])
def traced(request, lane_of):
    """Make a lane with a trace whose column leans along the azimuth of 3/8 of a turn."""
    leaning = {"x": -0.03, "y": 0.03, "turns": 2.0, "trace_azimuth": 1.8, "time": 5.0, "traces": 3.0}
    one = lane_of(request.param, CIRCLE, **leaning)
    one.table[:] = 7.0
    for j in range(one.shape.order):
        one[f"y{j}"] = 0.1 + j
    return one


def test_an_analytical_step_is_a_straight_line_between_its_states(traced):
    order = traced.shape.order
    after = tuple(np.linspace(0.5, 2.0, order))
    traced.do("trace_analytical_step", traced.table, 0.2, after, 2.9)
    columns, terms = entry(traced)
    assert columns[Trace.KIND] == TraceKind.ANALYTICAL_STEP
    assert (columns[Trace.START], columns[Trace.LENGTH], columns[Trace.AZIMUTH]) == (5.0, 0.2, 1.8)
    assert columns[Trace.END_AZIMUTH] == 2.9
    start = 0.1 + np.arange(order)
    np.testing.assert_array_equal(terms[0], start)
    # The kind of contact and the heading do not change on the way.
    kept = list(traced.shape.kept)
    change = after - start
    change[kept] = 0.0
    np.testing.assert_allclose(terms[1], change, rtol=1e-15)
    assert not terms[2:].any()


def test_a_stand_has_one_state(traced):
    traced.do("trace_stand", traced.table, 6.0)
    columns, terms = entry(traced)
    assert (columns[Trace.KIND], columns[Trace.START], columns[Trace.LENGTH]) == (TraceKind.STAND, 6.0, 1.0)
    assert columns[Trace.END_AZIMUTH] == pytest.approx(2.375)
    np.testing.assert_array_equal(terms[0], 0.1 + np.arange(traced.shape.order))
    assert not terms[1:].any()
    assert traced["next_trace"] == 1.0


def test_a_run_without_a_trace_has_no_entry(traced):
    traced["traces"] = 0.0
    traced.do("trace_stand", traced.table, 6.0)
    traced.do("trace_event", traced.table, TraceKind.REST, 6.0)
    traced.do("trace_analytical_step", traced.table, 0.2, (0.0,) * traced.shape.order, 2.9)
    assert traced["next_trace"] == 0.0
    assert (traced.table == 7.0).all()


@pytest.mark.parametrize(
    ("tilt", "last", "begins", "ends"), [(0.0, 1.8, 2.0 + AZIMUTH, 2.0 + AZIMUTH), (0.04, 1.8, 1.8, 2.0 + AZIMUTH)]
)
def test_a_reset_that_takes_time_turns_from_the_last_azimuth_to_the_nearest_one(lane_of, tilt, last, begins, ends):
    one = lane_of(SLIDING, CIRCLE, traces=3.0, tilt=tilt, last_azimuth=last)
    after = [0.0] * one.shape.order
    after[0], after[1] = 0.02, 0.01
    after[-1] = float(Contact.ROLLING)
    one.do("trace_lapse", one.table, 0.1, tuple(after))
    columns, _ = entry(one)
    assert (columns[Trace.AZIMUTH], columns[Trace.END_AZIMUTH]) == pytest.approx((begins, ends))
    upright = lane_of(SLIDING, CIRCLE, traces=3.0, last_azimuth=last)
    upright.do("trace_lapse", upright.table, 0.1, (0.0,) * one.shape.order)
    assert entry(upright)[0][Trace.END_AZIMUTH] == last


# Steps by series.


@pytest.fixture
def expanded(lane_of):
    """Make a lane with a step by series, and return it with the polynomials of its tilt vector."""
    one, h = lane_of(SLENDER, CIRCLE, method="taylor", time=3.0, made=0.4, per_turn=0.3), 0.4
    polynomials = []
    for j in (0, 1):
        degree = one.shape.degree(j)
        coefficients = np.random.default_rng(j).normal(size=degree + 1) * 0.5 ** np.arange(degree + 1)
        polynomials.append(np.polynomial.Polynomial(coefficients))
        one[f"last{j}"], one[f"last{j + 2}"] = coefficients[:2]
        for k in range(1, degree + 1):
            one[f"c{k}_{j}"] = coefficients[k]
        one[f"y{j}"], one[f"y{j + 2}"] = polynomials[j](h), polynomials[j].deriv()(h)
    return one, polynomials


@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
def test_the_state_within_a_step_by_series_is_the_polynomial_and_its_derivative(expanded, share):
    one, (x, y) = expanded
    at = share * 0.4
    expected = [x(at), y(at), x.deriv()(at), y.deriv()(at)]
    assert one.do("series_within", at) == pytest.approx(expected, rel=1e-13)


def test_a_step_by_series_is_observed_in_frames_that_rotate_with_and_against_the_forcing(expanded):
    one, (x, y) = expanded
    one["late_minimum_tilt"], one["low"] = 1.0, 0.3
    one.do("observe")
    places, weights = np.polynomial.legendre.leggauss(40)
    at = 0.2 + 0.2 * places
    path, phase = x(at) + 1j * y(at), 2.0j * math.pi * 0.3 * (2.6 + at)
    expected = [0.2 * weights @ np.abs(path)]
    for frame in (np.exp(-phase), np.exp(phase)):
        turned = 0.2 * weights @ (path * frame)
        expected += [turned.real, turned.imag]
    names = ("mean_tilt", "forward_cos", "forward_sin", "backward_cos", "backward_sin")
    assert [one[name] for name in names] == pytest.approx(expected, rel=1e-9)
    assert one["late_minimum_tilt"] == 0.3


@pytest.mark.parametrize("early", [0.0, 1.0])
@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_an_extreme_by_series_is_that_of_the_cubic_over_its_half_of_the_step(lane_of, early, sign):
    one = lane_of(SLENDER, CIRCLE, method="taylor")
    # Over either half a cubic from 1 with an extreme inside, given by the rates at its ends.
    start, end, slope, end_slope = 1.0, 1.0 + 0.1 * sign, 0.9 * sign, -0.7 * sign
    here, other = (start, end), (slope, end_slope)
    values = (*here, 5.0) if early else (5.0, *here)
    slopes = (*other, 3.0) if early else (3.0, *other)
    u = np.linspace(0.0, 1.0, 20_001)
    path = start + u * (slope + u * (3.0 * (end - start) - 2.0 * slope - end_slope))
    path += u**3 * (slope + end_slope - 2.0 * (end - start))
    expected = 0.5 * (u[np.argmax(sign * path)] + (0.0 if early else 1.0))
    assert one.driver.place_of_extreme(values, slopes, early, sign) == pytest.approx(expected, abs=5e-5)
