"""The base motion as Taylor series: summed up they are what the kernel evaluates at one time."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stylobate.engine.kernel.forcing_source import Harmonics, Polynomials
from stylobate.engine.kernel.layout import Rows
from stylobate.engine.kernel.shape import SERIES_ORDER

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


def evaluated(lines, values, time, **more):
    """Return the names that these lines assign, rows having the given values."""
    space = {"cos_turns": lambda turns: math.cos(2.0 * math.pi * turns), "t": time, **values, **more}
    exec("\n".join(lines), space)  # noqa: S102  the text is what is tested
    return space


@pytest.mark.parametrize("kind", KINDS)
@settings(max_examples=40)
@given(data=st.data(), time=st.floats(-0.3, 0.3), ahead=st.floats(-0.2, 0.2))
def test_the_series_of_a_motion_is_the_motion(kind, data, time, ahead):
    forcing = KINDS[kind]
    rows = Rows()
    forcing.reserve(rows)
    values = {f"row{number}": data.draw(NUMBERS) for number in range(len(rows))}

    def at(name):
        return f"row{rows[name]}"

    exact = evaluated(forcing.lines(at, "t + ahead"), values, time, ahead=ahead)
    series = evaluated(forcing.series_lines(at, COUNT), values, time)
    for component in forcing.components:
        terms = [series[f"{component}_{k}"] * ahead**k for k in range(COUNT)]
        # A wave and its window together make one turn a unit of time at most: what is left out is (0.4π)^17/17! of the
        # amplitudes. Polynomials are taken within the half of their piece: all terms are of size one at most.
        allowed = (0.4 * math.pi) ** COUNT / math.factorial(COUNT) + 100.0 * EPS
        assert math.fsum(terms) == pytest.approx(exact[component], rel=0.0, abs=allowed)


def test_no_terms_are_no_motion():
    forcing = Harmonics(0, windowed=False, components=("ax", "ay"))
    series = evaluated(forcing.series_lines(str, COUNT), {}, 0.3)
    assert {series[f"{name}_{k}"] for name in forcing.components for k in range(COUNT)} == {0.0}
