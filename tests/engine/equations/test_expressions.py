"""A model's equations differentiated: exact derivatives of all that can be recorded, and a refusal of the rest."""

import cmath
import math
from dataclasses import dataclass
from math import sqrt
from typing import ClassVar

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import stylobate as sb
from stylobate.engine.expressions import FUNCTIONS, Recording, recorded
from stylobate.engine.flow.periodic import PeriodicSystem
from stylobate.errors import UnsupportedError

COLUMN = sb.Column.dimensionless(0.1)
CIRCLE = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8)
STATE = np.array([0.03, 0.01, -0.02, 0.05])
EPS = float(np.finfo(float).eps)


def derivatives(function, at, row=None):
    """Return value and gradient of `function` at a point, by the source that its recording leaves behind.

    `row` chooses one of several results.
    """
    record = Recording()
    inputs = [record.input(f"x{j}") for j in range(len(at))]
    made = recorded(function, tuple(inputs))
    result = record.known(made if row is None else made[row])
    (gradient,) = record.derivatives([result], inputs)
    lines, names = record.source([result, *gradient])
    space = {"math": math, **{f"x{j}": value for j, value in enumerate(at)}}
    exec("\n".join(lines), space)  # noqa: S102  the text is what is tested
    value, *found = (eval(name, space) for name in names)  # noqa: S307
    return value, found


# Of each function an analytic continuation, by which a complex step gives the derivative to rounding.
CONTINUED = {
    "fabs": lambda z: z if z.real > 0.0 else -z,
    "atan2": lambda y, x: cmath.atan(y / x) + (0.0 if x.real > 0.0 else math.copysign(math.pi, y.real)),
    "hypot": lambda x, y: cmath.sqrt(x * x + y * y),
}
# Points within each function's range, on both sides where it has two.
PLACES = {"sqrt": [(0.3,), (7.0,)], "log": [(0.3,), (7.0,)]} | {
    name: [(0.4, 0.7), (0.4, -0.7), (-1.3, -0.2)] for name in ("atan2", "hypot")
}
USUAL_PLACES = [(0.37,), (-0.81,)]


@pytest.mark.parametrize("name", FUNCTIONS)
def test_derivatives_of_functions_equal_those_by_a_complex_step(name):
    continued = CONTINUED.get(name) or getattr(cmath, name)
    function = getattr(math, name)
    step = 1e-30  # its square is lost in rounding
    for at in PLACES.get(name, USUAL_PLACES):
        arguments = ("x", "y")[: len(at)]
        called = eval(f"lambda {', '.join(arguments)}: math.{name}({', '.join(arguments)})", {"math": math})  # noqa: S307
        value, gradient = derivatives(called, at)
        assert value == function(*at)
        for j, found in enumerate(gradient):
            moved = [complex(x, step if j == k else 0.0) for k, x in enumerate(at)]
            # The closed forms have a handful of operations.
            assert found == pytest.approx(continued(*moved).imag / step, rel=16 * EPS, abs=0.0)


@pytest.mark.parametrize(
    ("function", "closed"),
    [
        (lambda x, y: x + y * 2.0 - 3, lambda x, y: (1.0, 2.0)),
        (lambda x, y: 3.0 - x - y, lambda x, y: (-1.0, -1.0)),
        (lambda x, y: x * y * x, lambda x, y: (2.0 * x * y, x * x)),
        (lambda x, y: x / y, lambda x, y: (1.0 / y, -x / y**2)),
        (lambda x, y: 2.0 / (x * y), lambda x, y: (-2.0 / (x * x * y), -2.0 / (x * y * y))),
        (lambda x, y: -x + +y, lambda x, y: (-1.0, 1.0)),
        (lambda x, y: x**5 * y**0, lambda x, y: (5.0 * x**4, 0.0)),
        (lambda x, y: x**-2 + y**9, lambda x, y: (-2.0 * x**-3, 9.0 * y**8)),
        (lambda x, y: x**1.5, lambda x, y: (1.5 * math.sqrt(x), 0.0)),
        (lambda x, y: abs(-x) + abs(y), lambda x, y: (1.0, 1.0)),
        (lambda x, y: 0.0 * x + y * 1.0 - 0.0, lambda x, y: (0.0, 1.0)),
        (lambda x, y: x - x + 0 * y, lambda x, y: (0.0, 0.0)),
        (lambda x, y: math.sin(x * math.cos(y)), lambda x, y: (
            math.cos(y) * math.cos(x * math.cos(y)), -x * math.sin(y) * math.cos(x * math.cos(y)))),
        (lambda x, y: np.arctan2(np.sqrt(x), np.abs(y)) + np.square(x), lambda x, y: (
            y / (x + y * y) * 0.5 / math.sqrt(x) + 2.0 * x, -math.sqrt(x) / (x + y * y))),
        (lambda x, y: np.float64(2.0) * x + np.power(y, 3), lambda x, y: (2.0, 3.0 * y * y)),
        (lambda x, y: sqrt(x) * math.sqrt(y) * np.sqrt(2.0), lambda x, y: (
            math.sqrt(0.5 * y / x), math.sqrt(0.5 * x / y))),
    ],
)  # fmt: skip
def test_derivatives_of_arithmetic_equal_closed_forms(function, closed):
    at = (0.7, 1.3)
    value, gradient = derivatives(function, at)
    assert value == pytest.approx(function(*at), rel=8 * EPS)
    assert gradient == pytest.approx(closed(*at), rel=16 * EPS, abs=16 * EPS)


def waving(x, y):
    return math.sin(x) + y**3 - 1.0 / (y * y)


def growing(x, y):
    return math.exp(0.1 * x * y)


def product(x, y):
    return waving(x, y) * growing(x, y)


@given(x=st.floats(-5.0, 5.0), y=st.floats(0.1, 5.0))
def test_the_product_rule_holds(x, y):
    (f, df), (g, dg), (value, found) = (derivatives(function, (x, y)) for function in (waving, growing, product))
    assert value == f * g
    for whole, first, second in zip(found, df, dg, strict=True):
        size = abs(f * second) + abs(g) * (300.0 if whole is found[1] else 1.0)
        assert whole == pytest.approx(f * second + g * first, rel=0.0, abs=16 * EPS * size + 1e-300)


def test_what_is_said_twice_is_recorded_once():
    record = Recording()
    x = record.input("x")
    lines, _ = record.source([x * x + x * x])
    assert lines == ["v0 = x * x", "v1 = v0 + v0"]


def half_lean(x):
    return 0.5 * x


def lean_of_both(x, y):
    return half_lean(x) + half_lean(y * y)


class Formulas:
    @staticmethod
    def cube(x):
        return x * x * x


def test_functions_that_are_called_are_recorded_too():
    _, gradient = derivatives(lambda x, y: lean_of_both(x, y) + Formulas.cube(x), (2.0, 3.0))
    assert gradient == [0.5 + 12.0, 3.0]


@pytest.mark.parametrize(
    "function",
    [
        lambda x, y: x if x < y else 2.0 * y,
        lambda x, y: x if x >= 0.0 else -x,
        lambda x, y: min(x, y) + x,
        lambda x, y: max(x, 0.0),
        lambda x, y: x if x == 0.0 else y,
        lambda x, y: 2.0 * x if x else y,
        lambda x, y: x**y,
        lambda x, y: np.sign(x) * y,
    ],
)
def test_a_choice_between_cases_is_refused(function):
    with pytest.raises(UnsupportedError) as told:
        derivatives(function, (0.3, 0.4))
    assert "\n" not in str(told.value)


@pytest.mark.parametrize(
    "function",
    [
        lambda x, y: 2.0**x,
        lambda x, y: math.pow(x, 2.0),
        lambda x, y: math.atanh(x),
        lambda x, y: math.log(x, 3.0) * y,
        lambda x, y: math.hypot(x, y, 1.0),
        lambda x, y: math.copysign(x, y) + x,
        lambda x, y: math.floor(x) * y,
        lambda x, y: x % 1.0,
    ],
)
def test_what_is_not_known_is_differentiated_rightly_or_refused_in_one_line(function):
    h = 1e-6
    sides = [function(0.3 + h, 0.4) - function(0.3 - h, 0.4), function(0.3, 0.4 + h) - function(0.3, 0.4 - h)]
    try:
        _, gradient = derivatives(function, (0.3, 0.4))
    except UnsupportedError as told:
        gradient, lines = None, str(told).splitlines()
    # Differences are right to h² and rounding/h.
    assert len(lines) == 1 if gradient is None else np.allclose(gradient, np.divide(sides, 2.0 * h), atol=1e-8)


# Models of a user's own.


@dataclass(frozen=True, slots=True)
class Plain(sb.Slender):
    """The slender column with equations of another form, by what stands in its place."""

    name: ClassVar[str] = "plain"
    planar_rates = None


def unit(x, y):
    length = sqrt(x**2 + np.square(y))
    return x / length, y / length


def helped_rates(x, y, vx, vy, ax, ay, az, c, eta, _kappa):
    ux, uy = unit(x, y)
    weight = 1.0 + az
    return vx, vy, weight * (x - c * ux) - eta * vx - ax, weight * (y - c * uy) - eta * vy - ay


class Helped(Plain):
    rates = staticmethod(helped_rates)


def choosing_rates(x, y, vx, vy, ax, ay, az, c, eta, _kappa):
    length = math.hypot(x, y)
    lean = (1.0 + az) * (1.0 - c / length) if length > 0.0 else 0.0
    return vx, vy, lean * x - eta * vx - ax, lean * y - eta * vy - ay


class Choosing(Plain):
    name = "choosing"
    rates = staticmethod(choosing_rates)


def own_jacobian(x, y, vx, vy, ax, ay, az, c, eta, _kappa):
    """Derivatives of (1), by hand."""
    length = math.hypot(x, y)
    weight, ux, uy = 1.0 + az, x / length, y / length
    stiff, cross = weight * (1.0 - c / length), weight * c / length
    gx, gy = x - c * ux, y - c * uy
    return (
        (0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        (stiff + cross * ux * ux, cross * ux * uy, -eta, 0.0, -1.0, 0.0, gx, -weight * ux, -vx, 0.0),
        (cross * ux * uy, stiff + cross * uy * uy, 0.0, -eta, 0.0, -1.0, gy, -weight * uy, -vy, 0.0),
    )


class Told(Choosing):
    name = "told"
    jacobian = staticmethod(own_jacobian)


@pytest.mark.parametrize("model_type", [sb.Slender, Helped])
def test_the_derivatives_of_1_are_those_by_hand(model_type):
    at = (*STATE, 0.03, -0.04, 0.2, 0.1, 0.15, 0.75)
    by_hand = own_jacobian(*at)
    for row, expected in enumerate(by_hand):
        _, found = derivatives(model_type.rates, at, row)
        assert found == pytest.approx(expected, rel=16 * EPS, abs=8 * EPS)


@pytest.mark.parametrize("model_type", [Helped, Told])
def test_one_flow_however_the_equations_are_written(model_type):
    usual = PeriodicSystem(sb.Slender(COLUMN, 0.1), CIRCLE)
    other = PeriodicSystem(model_type(COLUMN, 0.1), CIRCLE)
    expected, found = usual.carry(STATE, 0.0, 0.7), other.carry(STATE, 0.0, 0.7)
    # Steps of the same length but for rounding: what differs is rounding, times the growth of the flow.
    size = np.abs(expected.by_start).max()
    np.testing.assert_allclose(found.end, expected.end, rtol=0.0, atol=100 * EPS * size)
    np.testing.assert_allclose(found.by_start, expected.by_start, rtol=0.0, atol=1e-11 * size)


def test_a_model_that_compares_is_refused_unless_it_gives_its_jacobian():
    with pytest.raises(UnsupportedError, match="jacobian") as told:
        PeriodicSystem(Choosing(COLUMN, 0.1), CIRCLE).carry(STATE, 0.0, 0.5)
    assert "\n" not in str(told.value)
    orbit = sb.orbits.periodic_orbit(Told(COLUMN, 0.1), CIRCLE, guess=[0.045, 0.0, 0.0, 0.08])
    expected = sb.orbits.periodic_orbit(sb.Slender(COLUMN, 0.1), CIRCLE)
    np.testing.assert_allclose(orbit.state, expected.state, rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(
        np.sort_complex(orbit.multipliers), np.sort_complex(expected.multipliers), rtol=0.0, atol=1e-9
    )


def test_a_model_without_equations_in_a_plane_has_no_flow_there():
    system = PeriodicSystem(
        Helped(COLUMN, 0.1), sb.Harmonic.straight(acceleration=0.1, angular_frequency=2.0), line=(1.0, 0.0)
    )
    with pytest.raises(UnsupportedError, match="no equations of planar motion"):
        system.carry(np.array([0.03, 0.0]), 0.0, 0.1)
