"""Linear equations in the arrays of a kernel."""

import numpy as np
import pytest

from stylobate.engine.elementary import factor, solve


@pytest.mark.parametrize("zeros", [0.0, 0.7])
def test_the_solution_fulfils_the_equations(zeros):
    rng = np.random.default_rng(3)
    for n in (1, 2, 7, 20):
        matrix = rng.normal(size=(n, n)) * (rng.random((n, n)) >= zeros) + np.diag(10.0 ** rng.uniform(-3.0, 3.0, n))
        right = rng.normal(size=n)
        factors, pivots, x = matrix.copy(), np.zeros(n), right.copy()
        assert factor(factors, pivots, n)
        solve(factors, pivots, x, n)
        np.testing.assert_allclose(matrix @ x, right, atol=1e-11 * np.abs(matrix).max() * np.abs(x).max())


def test_a_zero_in_the_corner_is_exchanged():
    factors, pivots, x = np.array([[0.0, 2.0], [4.0, 0.0]]), np.zeros(2), np.array([6.0, 8.0])
    assert factor(factors, pivots, 2)
    solve(factors, pivots, x, 2)
    np.testing.assert_array_equal(x, [2.0, 3.0])


@pytest.mark.parametrize("corner", [4.0, np.inf, np.nan])
def test_a_matrix_that_is_singular_or_not_finite_is_refused(corner):
    assert not factor(np.array([[1.0, 2.0], [2.0, corner]]), np.zeros(2), 2)
