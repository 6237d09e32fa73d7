"""The base motion as Taylor series: summed up they are what the kernel evaluates at one time."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stylobate.compiler.programs import Bound
from stylobate.engine.kernel.bound import Rows
from stylobate.engine.kernel.driver import equations
from stylobate.engine.kernel.shape import SERIES_ORDER, Harmonics, Polynomials

EPS = float(np.finfo(float).eps)
COUNT = SERIES_ORDER + 1
KINDS = {
    "one": Harmonics(1, windowed=False, components=("ax", "ay")),
    "windowed": Harmonics(1, windowed=True, components=("ax", "ay")),
    "two, windowed, vertical": Harmonics(2, windowed=True, components=("ax", "ay", "az")),
    "polynomials": Polynomials(15, ("ax", "ay")),
    "polynomials, vertical": Polynomials(4, ("ax", "ay", "az")),
}
NUMBERS = st.floats(-0.5, 0.5)


def bound_to(forcing):
    """Return the functions of a kernel that evaluate a kind of base motion, and the number of its rows."""
    rows = Rows()
    forcing.reserve(rows)
    names = {"COMPONENTS": len(forcing.components), "VERTICAL": "az" in forcing.components, "PLANAR": False}
    program = Bound((equations,), {**forcing.constants(rows), **names, "R": SimpleNamespace()})
    return program.module("push", {}), len(rows)


@pytest.mark.parametrize("kind", KINDS)
@settings(max_examples=40)
@given(data=st.data(), time=st.floats(-0.3, 0.3), ahead=st.floats(-0.2, 0.2))
def test_the_series_of_a_motion_is_the_motion(kind, data, time, ahead):
    functions, count = bound_to(KINDS[kind])
    buf = np.array([[data.draw(NUMBERS)] for _ in range(count)])
    exact = functions.accelerations(buf, 0, time + ahead)
    series = functions.push_series(buf, 0, time, COUNT)
    assert len(series) == len(KINDS[kind].components)
    for value, coefficients in zip(exact, series, strict=False):
        terms = [coefficient * ahead**k for k, coefficient in enumerate(coefficients)]
        # A wave and its window together make one turn a unit of time at most: what is left out is (0.4π)^17/17! of the
        # amplitudes. Polynomials are taken within the half of their piece: all terms are of size one at most.
        allowed = (0.4 * math.pi) ** COUNT / math.factorial(COUNT) + 100.0 * EPS
        assert math.fsum(terms) == pytest.approx(value, rel=0.0, abs=allowed)


def test_no_terms_are_no_motion():
    functions, _ = bound_to(Harmonics(0, windowed=False, components=("ax", "ay")))
    assert functions.push_series(np.zeros((0, 1)), 0, 0.3, COUNT) == ((0.0,) * COUNT,) * 2
    assert functions.accelerations(np.zeros((0, 1)), 0, 0.3) == (0.0, 0.0, 0.0)
