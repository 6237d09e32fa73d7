"""Levels of damping beside Housner's damping of a column."""

import pytest

import stylobate as sb
from stylobate.results.run_rows import damping_rows
from stylobate.results.verdict import AMPLITUDES, damping_yardstick, side_of_yardstick

COLUMN = sb.Column.solid(radius=0.3, height=3.0, density=2700.0)
LOWEST, HIGHEST = COLUMN.housner_damping(0.75), COLUMN.housner_damping(0.25)


def levels(*dampings):
    return [{"damping": eta} for eta in dampings]


def test_the_yardstick_falls_with_the_amplitude():
    found = damping_yardstick(COLUMN)
    assert tuple(found) == tuple(AMPLITUDES) == (0.25, 0.5, 0.75)
    assert list(found.values()) == sorted(found.values(), reverse=True)
    assert (found[0.25], found[0.75]) == (HIGHEST, LOWEST)


@pytest.mark.parametrize(
    ("given", "side"),
    [
        (levels(0.01, 0.03, 0.999 * LOWEST), "below"),
        (levels(0.01, 0.03, LOWEST), "among"),
        (levels(HIGHEST, 0.3), "among"),
        (levels(1.001 * HIGHEST, 0.3), "above"),
        (levels(0.01, 0.3), "among"),  # on both sides
        (levels(COLUMN.housner_damping()), "among"),
        ([{"damping": 0.01, "spin_damping": 0.3}], "below"),
        ([{"damping": 0.01, "rolling_resistance": 0.1}], "not compared"),
        ([{"restitution": 0.9}], "not compared"),
        ([], "not compared"),
    ],
)
def test_levels_lie_below_the_yardstick_above_it_or_among_its_values(given, side):
    assert side_of_yardstick(COLUMN, given) == side


def test_the_rows_of_a_run_show_its_damping_beside_that_of_housner():
    yardstick = ("damping of Housner's impacts", "η = 0.12, 0.08, 0.064 at a peak tilt of ¼, ½, ¾ α_c")
    assert damping_rows(COLUMN, 0.02) == [("damping", "η = 0.02"), yardstick]
    assert damping_rows(COLUMN, None) == [yardstick]
