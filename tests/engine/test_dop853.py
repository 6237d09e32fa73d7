"""The coefficients of DOP853 are those of SciPy, and fulfil the conditions of their orders."""

import numpy as np
import pytest
from scipy.integrate import DOP853

from stylobate.engine import dop853


@pytest.mark.parametrize("name", ["A", "B", "C", "E3", "E5", "A_EXTRA", "C_EXTRA", "D"])
def test_coefficients_are_those_of_scipy_to_the_bit(name):
    np.testing.assert_array_equal(getattr(dop853, name), getattr(DOP853, name))


def test_weights_integrate_powers_exactly_up_to_the_order():
    np.testing.assert_allclose(np.sum(dop853.A, axis=1), dop853.C, atol=1e-14)
    np.testing.assert_allclose(np.sum(dop853.A_EXTRA, axis=1), dop853.C_EXTRA, atol=1e-14)
    for power in range(8):
        assert dop853.B @ np.array(dop853.C) ** power == pytest.approx(1.0 / (power + 1.0), abs=1e-14)
