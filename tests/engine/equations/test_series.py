"""Taylor coefficients of recorded expressions: those of series in forty digits, and of exact solutions."""

import itertools
import math
from dataclasses import dataclass
from typing import ClassVar

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import stylobate as sb
from stylobate.engine.expressions import Expression, Recording, recorded
from stylobate.engine.kernel.expansion import Expansion, Series, series_integrals
from stylobate.engine.kernel.shape import SERIES_ORDER
from stylobate.errors import UnsupportedError

COUNT = SERIES_ORDER + 1
EPS = float(np.finfo(float).eps)
DIGITS = mpmath.MPContext()
DIGITS.dps = 40


def padded(coefficients):
    return [*coefficients, *[0.0] * (COUNT - len(coefficients))]


def coefficients(function, moving, fixed):
    """Return the coefficients, shape (results, orders), by the source that the expressions leave behind.

    `moving` tells those of the inputs that change with time by name, `fixed` the values of the others.
    """
    record = Recording()
    made = function(*(record.input(name) for name in (*moving, *fixed)))
    results = [record.known(one) for one in (made if isinstance(made, tuple) else (made,))]
    series = Series(record, results, moving)
    space = {"math": math, **fixed}
    space |= {f"{name}_{k}": value for name, values in moving.items() for k, value in enumerate(padded(values))}
    for k in range(COUNT):
        exec("\n".join(series.lines(k)), space)  # noqa: S102  the text is what is tested
    return np.array([[eval(series.result(j, k), space) for k in range(COUNT)] for j in range(len(results))])  # noqa: S307


# An independent route: series in forty digits, quotients and roots by Newton's iteration, errors followed beside them.


def times(a, b):
    return np.convolve(a, b)[:COUNT]


def reciprocal(a):
    found = np.array([1 / a[0], *[DIGITS.mpf(0)] * (COUNT - 1)])
    for _ in range(COUNT.bit_length()):  # the correct terms double in number
        found = 2 * found - times(found, times(found, a))
    return found


def growth(a):
    """Return the series by which an error of a quotient's terms grows: 1/(|a0| − |a1| t − …)."""
    return np.abs(reciprocal(np.array([abs(a[0]), *(-abs(one) for one in a[1:])]))).astype(float)


@dataclass(frozen=True, eq=False)
class Known:
    """The first terms of a series in forty digits, and how far floats may lie from them."""

    terms: np.ndarray
    error: np.ndarray

    @classmethod
    def of(cls, values):
        return cls(np.array([DIGITS.mpf(value) for value in padded(values)]), np.zeros(COUNT))

    @property
    def size(self):
        return np.abs(self.terms).astype(float)

    def __add__(self, other):
        other = known(other)
        return Known(self.terms + other.terms, self.error + other.error + EPS * (self.size + other.size))

    def __neg__(self):
        return Known(-self.terms, self.error)

    def __pos__(self):
        return self

    def __pow__(self, exponent):
        return math.prod([self] * exponent, start=known(1.0))

    def __mul__(self, other):
        other = known(other)
        carried = times(self.size, other.error) + times(self.error, other.size)
        return Known(times(self.terms, other.terms), carried + COUNT * EPS * times(self.size, other.size))

    def __sub__(self, other):
        return self + -known(other)

    def __truediv__(self, other):
        other = known(other)
        terms = times(self.terms, reciprocal(other.terms))
        size = np.abs(terms).astype(float)
        defect = self.error + times(size, other.error) + 2.0 * COUNT * EPS * (self.size + times(size, other.size))
        return Known(terms, times(growth(other.terms), defect))

    def sqrt(self):
        terms = np.array([DIGITS.sqrt(self.terms[0]), *[DIGITS.mpf(0)] * (COUNT - 1)])
        for _ in range(COUNT.bit_length()):
            terms = (terms + times(self.terms, reciprocal(terms))) / 2
        size = np.abs(terms).astype(float)
        defect = self.error + 2.0 * COUNT * EPS * (self.size + times(size, size))
        return Known(terms, times(growth(terms), defect))

    def __radd__(self, other):
        return self + other

    def __rsub__(self, other):
        return -self + other

    def __rmul__(self, other):
        return self * other

    def __rtruediv__(self, other):
        return known(other) / self


def known(value):
    return value if isinstance(value, Known) else Known.of([value])


def root(value):
    return value.record.applied("sqrt", value) if isinstance(value, Expression) else known(value).sqrt()


def expect_known(function, moving, fixed):
    found = coefficients(function, moving, fixed)
    made = function(*map(Known.of, moving.values()), *(Known.of([value]) for value in fixed.values()))
    for row, one in zip(found, map(known, made if isinstance(made, tuple) else (made,)), strict=True):
        # Errors are followed to the first order in rounding: what is left is its square.
        assert np.all(np.abs(row - one.terms.astype(float)) <= one.error * (1.0 + 1e-6) + EPS * one.size + 1e-300)


MOVING = {"x": [1.3, 0.4, -0.7, 0.2, 0.05], "y": [-0.8, 0.9, 0.3, 0.0, 0.1, -0.6]}
FIXED = {"c": 0.3, "d": -1.7}


@pytest.mark.parametrize(
    "function",
    [
        lambda x, y, c, d: x + y,
        lambda x, y, c, d: x - y,
        lambda x, y, c, d: (x + c, c + x, x - d, d - x, 2.0 - x, x - 2.0, x + -2.0),
        lambda x, y, c, d: (-x, +x, -(x + y), -(2.0 * -x)),
        lambda x, y, c, d: (x * y, x * c, c * x, x * -2.5, x * 0.0, c * d * x),
        lambda x, y, c, d: (x * x, (x + y) * (x + y), x**5 + y**3, x**0),
        lambda x, y, c, d: (x / y, c / y, x / d, 1.0 / x, x / 0.7, -x / y, y / (-x)),
        lambda x, y, c, d: (x / x, (x + y) / (x * y), x / y / y, y / (c + x / y)),
        lambda x, y, c, d: (root(x), root(x * x + y * y), 1.0 / root(x + c), root(root(x) + 3.0)),
        lambda x, y, c, d: (c + d, c * d, c / d, root(c), c - root(c) * d, c / root(c)),
        lambda x, y, c, d: (root(c) * x, x / root(c), (c - d) / x, root(x) / (c * d)),
        lambda x, y, c, d: (x - x, (x - x) * y, (x * 0.0 + c) * y, (y - y + c) / x, x / (y - y + d)),
        lambda x, y, c, d: (x, c, 3.0, -1.5, x),
        lambda x, y, c, d: (x + c, (x + c) * y, (x + c) / (y * y), root((x + c) * (y * y))),
    ],
)
def test_coefficients_are_those_of_series_in_forty_digits(function):
    expect_known(function, MOVING, FIXED)


# Trees of operations; whatever stands below a line or a root is kept away from zero by a square and a constant.
LEAVES = st.sampled_from(["x", "y", "c", "d", 0.0, 1.0, -1.0, 2.5])
TREES = st.recursive(
    LEAVES,
    lambda inner: st.one_of(
        st.tuples(st.sampled_from(["+", "-", "*", "/"]), inner, inner),
        st.tuples(st.sampled_from(["neg", "root"]), inner),
    ),
    max_leaves=9,
)


def evaluated(tree, inputs):
    if isinstance(tree, str):
        return inputs[tree]
    if isinstance(tree, float):
        return tree
    operation, *operands = tree
    a, *others = (evaluated(operand, inputs) for operand in operands)
    if operation == "neg":
        return -a
    if operation == "root":
        return root(a * a + inputs["one"])
    (b,) = others
    if operation == "/":
        return a / (b * b + inputs["one"])
    return a + b if operation == "+" else a - b if operation == "-" else a * b


STARTS = st.floats(-1.5, 1.5)
TERMS = st.lists(st.floats(-1.0, 1.0), min_size=1, max_size=COUNT)


@settings(max_examples=60)
@given(tree=TREES, x=TERMS, y=TERMS, c=STARTS, d=STARTS)
def test_coefficients_of_any_arithmetic_are_those_of_series_in_forty_digits(tree, x, y, c, d):
    def function(*values):
        made = evaluated(tree, dict(zip(("x", "y", "c", "d", "one"), values, strict=True)))
        return made if isinstance(made, (Expression, Known)) else (made,)

    expect_known(function, {"x": x, "y": y}, {"c": c, "d": d, "one": 1.0})


# Closed forms, in which no recurrence stands.


def test_a_geometric_series_is_a_quotient():
    found = coefficients(lambda t: 1.0 / (1.0 - t), {"t": [0.0, 1.0]}, {})
    np.testing.assert_array_equal(found, np.ones((1, COUNT)))


def test_the_binomial_series_is_a_root():
    found = coefficients(lambda t: root(1.0 + t), {"t": [0.0, 1.0]}, {})[0]
    # All numbers are fractions of a power of two.
    exact = [math.prod((0.5 - j) / (j + 1) for j in range(k)) for k in range(COUNT)]
    np.testing.assert_allclose(found, exact, rtol=8 * EPS, atol=0.0)


def test_cos2_and_sin2_make_one():
    cos = [math.cos(k * math.pi / 2.0) / math.factorial(k) for k in range(COUNT)]
    sin = [math.sin(k * math.pi / 2.0) / math.factorial(k) for k in range(COUNT)]
    found = coefficients(lambda x, y: x * x + y * y, {"x": cos, "y": sin}, {})[0]
    assert np.all(np.abs(found - np.eye(1, COUNT)[0]) < COUNT * EPS * exponential(2.0))


@given(x=TERMS.filter(lambda terms: abs(terms[0]) > 0.1))
def test_a_square_takes_back_its_root(x):
    square = coefficients(lambda v: v * v, {"x": x}, {})[0]
    found = coefficients(root, {"s": square}, {})[0] * math.copysign(1.0, x[0])
    terms = Known.of(x)
    # What the square lacks grows by 1/(2 x0 + …).
    allowed = times(growth(terms.terms), 4.0 * COUNT * EPS * times(terms.size, terms.size))
    underflow = COUNT * np.finfo(float).tiny
    assert np.all(np.abs(found - padded(x)) <= allowed + underflow)


# What the source holds.


def series_of(function, moving, fixed):
    record = Recording()
    made = function(*(record.input(name) for name in (*moving, *fixed)))
    return Series(record, [record.known(made)], moving)


def test_what_does_not_change_is_computed_once_and_has_no_further_terms():
    series = series_of(lambda x, c: root(c) / (1.0 + c) + 0.0 * x, ["x"], ["c"])
    assert len(series.lines(0)) >= 3
    assert [series.lines(k) for k in range(1, 5)] == [[]] * 4
    assert [series.result(0, k) for k in range(1, 5)] == ["0.0"] * 4


def test_one_division_and_one_root_serve_all_orders():
    series = series_of(lambda x, y: root(x) / y + x / root(x) + 1.0 / y, ["x", "y"], [])
    first = "\n".join(series.lines(0))
    assert (first.count("math.sqrt"), first.count("1.0 / ")) == (1, 2)
    later = "\n".join(line for k in range(1, COUNT) for line in series.lines(k))
    assert "/" not in later
    assert "sqrt" not in later


@pytest.mark.parametrize("k", [2, 7, 16])
def test_a_square_takes_half_the_products(k):
    def products(function):
        series = series_of(function, ["x", "y"], [])
        return [series.lines(order) for order in range(k + 1)][k][0].count("_") // 2

    assert products(lambda x, y: x * y + 0.0) == k + 1
    assert products(lambda x, y: x * x + 0.0 * y) == k // 2 + 1


@pytest.mark.parametrize(
    "function",
    [
        lambda x, y: math.sin(x) * y,
        lambda x, y: math.exp(x) + y,
        lambda x, y: abs(x) + y,
        lambda x, y: x**1.5 + y,
        lambda x, y: math.atan2(x, y) + y,
        lambda x, y: x + np.tanh(y),
        lambda x, y: x if x < y else 2.0 * y,
        lambda x, y: max(x, y) + x,
    ],
)
def test_what_has_no_recurrence_is_refused_in_one_line(function):
    record = Recording()
    x, y = record.input("x"), record.input("y")
    with pytest.raises(UnsupportedError) as told:
        Series(record, [record.known(recorded(function, (x, y)))], ["x", "y"])
    assert "\n" not in str(told.value)


# The equations of the slender column, along solutions known in closed form.

C, ETA = 0.1, 0.1


def expanded(model, state, parameters, pushes, *, vertical=False):
    """Return the coefficients of the states along the motion from `state`, shape (states, orders), and the square's."""
    expansion = Expansion(model, len(state), len(parameters), vertical=vertical)
    space = {"math": math, **{f"p{j}": value for j, value in enumerate(parameters)}}
    space |= {f"{name}_{k}": value for name, values in pushes.items() for k, value in enumerate(padded(values))}
    for j, integral in enumerate(expansion.integrals):
        space[f"s{j}_0"] = state[j]
        if integral != j:
            space[f"s{integral}_1"] = state[j]
    for k in range(COUNT):
        exec("\n".join(expansion.coefficient_lines(k)), space)  # noqa: S102
    square = [eval(expansion.square(k), space) for k in range(COUNT)]  # noqa: S307
    return np.array([[space[f"s{j}_{k}"] for k in range(COUNT)] for j in range(len(state))]), np.array(square)


def cosine(size, frequency, angle):
    """Return the coefficients of size · cos(frequency · t + angle)."""
    cos, sin = math.cos(angle), math.sin(angle)
    return [
        size * frequency**k / math.factorial(k) * part
        for k, part in zip(range(COUNT), itertools.cycle([cos, -sin, -cos, sin]), strict=False)
    ]


def exponential(rate):
    """Return the coefficients of exp(rate · t)."""
    return np.array([rate**k / math.factorial(k) for k in range(COUNT)])


@settings(max_examples=40)
@given(nu=st.floats(1.6, 6.0), azimuth=st.floats(-math.pi, math.pi), sense=st.sampled_from([1.0, -1.0]))
def test_steady_rolling_has_the_coefficients_of_cosines(nu, azimuth, sense):
    a0 = 0.065
    upper = sb.theory.steady_rolling(nu, a0, c=C, eta=ETA).upper
    amplitude, lead = float(upper.amplitude), azimuth + float(upper.phase)
    exact = [
        cosine(amplitude, nu, lead),
        cosine(sense * amplitude, nu, lead - math.pi / 2.0),
        cosine(nu * amplitude, nu, lead + math.pi / 2.0),
        cosine(sense * nu * amplitude, nu, lead),
    ]
    pushes = {"ax": cosine(a0, nu, azimuth), "ay": cosine(sense * a0, nu, azimuth - math.pi / 2.0)}
    found, square = expanded(sb.Slender, [one[0] for one in exact], (C, ETA, 0.75), pushes)
    # x² + y² is a sum of terms of size A² (2ν)^k/k! that cancel; what is lost there the equations carry on, with c/A.
    allowed = EPS * (1.0 + nu) * (amplitude + C) * exponential(2.0 * nu + C / amplitude)
    assert np.all(np.abs(found - exact) <= allowed)
    assert np.all(np.abs(square - amplitude**2 * np.eye(1, COUNT)[0]) <= allowed * amplitude)


# In a plane x = c + (x0 − c) cosh wt + (v0/w) sinh wt, w² = 1 + a_z; y stays zero exactly.
@settings(max_examples=40)
@given(x=st.floats(0.01, 0.3), v=st.integers(-20, 20).map(lambda n: 0.01 * n), az=st.floats(-0.9, 2.0))
def test_free_motion_in_a_plane_has_the_coefficients_of_hyperbolic_functions(x, v, az):
    weight = math.sqrt(1.0 + az)
    parts = [x - C if k % 2 == 0 else v / weight for k in range(COUNT)]
    exact = np.array(parts) * weight ** np.arange(COUNT) * exponential(1.0)
    exact[0] = x
    pushes = {"ax": [], "ay": [], "az": [az]}
    found, square = expanded(sb.Slender, [x, 0.0, v, 0.0], (C, 0.0, 0.75), pushes, vertical=True)
    np.testing.assert_array_equal(found[[1, 3]], 0.0)
    # In x/√(x²) a series stands below the line: what rounding leaves there grows with it, twice.
    known_x = Known.of(exact)
    grown = times(growth(known_x.terms), known_x.size)
    allowed = 8.0 * EPS * (x + C + abs(v)) * times(grown, grown)
    assert np.all(np.abs(found[0] - exact) <= allowed)
    np.testing.assert_allclose(found[2, :-1], found[0, 1:] * np.arange(1, COUNT), rtol=4 * EPS, atol=0.0)
    assert np.all(np.abs(square - times(found[0], found[0])) <= COUNT * EPS * times(abs(found[0]), abs(found[0])))


def test_the_rates_of_the_slender_column_are_states_and_told_by_one_series_each():
    assert series_integrals(sb.Slender, 4, 3, vertical=False) == (0, 1, 0, 1)


@dataclass(frozen=True, slots=True)
class Own(sb.Slender):
    """Equations of a user's own."""

    name: ClassVar[str] = "own"


class Comparing(Own):
    @staticmethod
    def rates(x, y, vx, vy, ax, ay, az, c, eta, _kappa):
        return vx, vy, x if x > c else -x, y


class Waving(Own):
    @staticmethod
    def rates(x, y, vx, vy, ax, ay, az, c, eta, _kappa):
        return vx, vy, math.sin(x) - ax, math.sin(y) - ay


@pytest.mark.parametrize("model", [Comparing, Waving])
def test_a_model_without_series_is_refused_in_one_line_that_tells_what_to_do(model):
    with pytest.raises(UnsupportedError, match=r"model own .* method='dop853'") as told:
        series_integrals(model, 4, 3, vertical=False)
    assert "\n" not in str(told.value)


class Chained(Own):
    """Its third state is the rate of the second, and that of the first: no series tells two others."""

    @staticmethod
    def rates(x, y, vx, vy, ax, ay, az, c, eta, _kappa):
        return y, vx, -y, -vy

    @staticmethod
    def tilt_of(x, y, vx, vy, *_):
        return x, vy, y, 0.0


def test_states_that_are_rates_of_rates_keep_their_own_series():
    # y″ = −y and x′ = y: x = sin, y = cos, vx = −sin from x = vx = 0, y = 1; the last one decays.
    found, square = expanded(Chained, [0.0, 1.0, 0.0, 1.0], (C, ETA, 0.75), {"ax": [], "ay": []})
    decay = exponential(-1.0)
    exact = [cosine(1.0, 1.0, -math.pi / 2.0), cosine(1.0, 1.0, 0.0), cosine(1.0, 1.0, math.pi / 2.0), decay]
    assert np.all(np.abs(found - exact) < COUNT * EPS * exponential(1.0))
    sums = times(np.array(exact[0]), np.array(exact[0])) + times(decay, decay)
    assert np.all(np.abs(square - sums) < 3 * COUNT * EPS * exponential(2.0))


def test_functions_of_what_is_fixed_need_no_recurrence():
    record = Recording()
    x, c = record.input("x"), record.input("c")
    (result,) = (record.known(recorded(lambda x, c: math.exp(c) * x + c**1.5, (x, c))),)
    series = Series(record, [result], ["x"])
    space = {"math": math, "c": 0.3, "x_0": 2.0, "x_1": 5.0}
    for k in range(2):
        exec("\n".join(series.lines(k)), space)  # noqa: S102  the text is what is tested
    assert eval(series.result(0, 0), space) == pytest.approx(2.0 * math.exp(0.3) + 0.3**1.5, rel=1e-15)  # noqa: S307
    assert eval(series.result(0, 1), space) == pytest.approx(5.0 * math.exp(0.3), rel=1e-15)  # noqa: S307
