"""Mathematical functions in the language of the compiler, beside those of C."""

import math

import numpy as np
import pytest

from stylobate.compiler import mathematics

RNG = np.random.default_rng(7)
WIDE = np.concatenate(
    [RNG.uniform(-10, 10, 3000), np.exp(RNG.uniform(-300, 300, 2000)), -np.exp(RNG.uniform(-40, 5, 1000))]
)
ANGLES = np.concatenate([RNG.uniform(-10, 10, 4000), RNG.uniform(-1e6, 1e6, 2000), np.pi / 4 * np.arange(-40, 41)])
CASES = {
    "sin": ANGLES,
    "cos": ANGLES,
    "tan": ANGLES,
    "atan": WIDE,
    "exp": RNG.uniform(-700, 700, 5000),
    "expm1": np.concatenate([RNG.uniform(-50, 50, 4000), WIDE[np.abs(WIDE) < 700.0]]),
    "log": np.abs(WIDE),
    "asinh": np.concatenate([WIDE, RNG.uniform(-1, 1, 2000)]),
}
SPECIAL = [0.0, -0.0, 1.0, -1.0, 5e-324, 1.7976931348623157e308, math.inf, -math.inf, math.nan]
TWO = {"atan2": np.arctan2, "hypot": np.hypot, "pow": np.power}


def units_apart(found, known):
    """Return differences in units in the last place of the known values, 0 where both are equal or NaN."""
    found, known = np.asarray(found), np.asarray(known)
    with np.errstate(all="ignore"):
        apart = np.abs(found - known) / np.spacing(np.abs(known))
    return np.where((found == known) | (np.isnan(found) & np.isnan(known)), 0.0, apart)


@pytest.mark.parametrize("name", CASES)
def test_functions_of_one_number_are_within_two_units_in_the_last_place(name):
    own, _ = mathematics.FUNCTIONS[name]
    known = getattr(np, {"atan": "arctan", "asinh": "arcsinh"}.get(name, name))(CASES[name].astype(np.longdouble))
    assert units_apart([own(x) for x in CASES[name].tolist()], known.astype(float)).max() <= 2.0


@pytest.mark.parametrize("name", ["sin", "cos", "tan", "atan", "exp", "expm1", "log", "asinh"])
def test_zeros_infinities_and_nan_are_those_of_c(name):
    own, _ = mathematics.FUNCTIONS[name]
    values = np.array([x for x in SPECIAL if name not in ("sin", "cos", "tan") or abs(x) < 2.0])
    with np.errstate(all="ignore"):
        known = getattr(np, {"atan": "arctan", "asinh": "arcsinh"}.get(name, name))(values)
    found = np.array([own(x) for x in values.tolist()])
    assert units_apart(found, known).max() <= 2.0
    np.testing.assert_array_equal(np.signbit(found)[~np.isnan(known)], np.signbit(known)[~np.isnan(known)])


@pytest.mark.parametrize("name", TWO)
def test_functions_of_two_numbers_are_near_those_of_c(name):
    own, _ = mathematics.FUNCTIONS[name]
    first = np.concatenate([RNG.choice(WIDE, 3000), np.repeat(SPECIAL[:8], 8)])
    second = np.concatenate([RNG.choice(WIDE, 3000), np.tile(SPECIAL[:8], 8)])
    if name == "pow":
        first = np.exp(RNG.uniform(-5, 5, 3000))
        second = RNG.uniform(-4, 4, 3000)
    with np.errstate(all="ignore"):
        known = TWO[name](first, second)
        exact = TWO[name](first.astype(np.longdouble), second.astype(np.longdouble)).astype(float)
    found = [own(a, b) for a, b in zip(first.tolist(), second.tolist(), strict=True)]
    kept = np.abs(known) > 1e-300  # denormal quotients have fewer digits
    assert units_apart(np.array(found)[kept], exact[kept]).max() <= (5.0 if name == "pow" else 2.0)
    np.testing.assert_allclose(np.array(found)[~kept], known[~kept], atol=1e-300)


@pytest.mark.parametrize(
    ("x", "y"), [(0.0, 2.0), (0.0, -2.0), (-2.0, 3.0), (-2.0, 2.0), (-2.0, 0.5), (3.0, 0.0), (1.0, 9.0)]
)
def test_powers_of_zero_and_negative_numbers_are_those_of_c(x, y):
    with np.errstate(all="ignore"):
        known = np.power(x, y)
    assert units_apart(mathematics.power(x, y), known) <= 2.0


def test_exponentials_of_the_largest_and_least_exponents_are_those_of_c():
    for x in (709.7, 709.79, -708.5, -744.0, -745.2):
        assert mathematics.exp(x) == pytest.approx(
            np.exp(np.float64(x)) if x < 709.78 else math.inf, rel=1e-14, abs=1e-323
        )
