"""The search for all zeros of a function."""

import numpy as np

from stylobate.theory.finite_tilt import zeros

PLACES = np.array([[0.2, 0.5, 0.7], [0.1, 0.30001, 0.30002], [0.4, 0.6, 0.60000001]])


def cubic(x, rows):
    a, b, c = (PLACES[rows, i] for i in range(3))
    return (x - a) * (x - b) * (x - c)


def test_pairs_between_two_points_of_the_grid_are_found():
    grid = np.tile(np.linspace(0.0, 1.0, 20), (3, 1))
    rows, places = zeros(cubic, grid)
    np.testing.assert_array_equal(rows, np.repeat([0, 1, 2], 3))
    np.testing.assert_allclose(places, PLACES.ravel(), rtol=0.0, atol=2e-16)


def test_a_function_that_only_comes_near_zero_has_none():
    rows, places = zeros(lambda x, _: (x - 0.37) ** 2 + 1e-20, np.linspace(0.0, 1.0, 20)[np.newaxis])
    assert rows.size == places.size == 0
