"""The coefficients of Radau IIA fulfil its conditions, and are those of SciPy's method."""

import numpy as np
from scipy.integrate._ivp import radau as scipys

from stylobate.engine.kernel.driver import implicit_step

NODES, SLOPES = np.array(implicit_step.NODES), np.array(implicit_step.SLOPES)


def test_the_stages_are_collocation_of_order_five():
    stages = np.linalg.inv(SLOPES)
    for power in range(1, 4):
        np.testing.assert_allclose(stages @ NODES ** (power - 1), NODES**power / power, rtol=1e-12)
    # The end of the step is the last stage: its weights integrate polynomials of degree 4.
    for power in range(1, 6):
        np.testing.assert_allclose(stages[-1] @ NODES ** (power - 1), 1.0 / power, rtol=1e-14)


def test_the_modes_are_the_eigenvectors():
    real, one, two = implicit_step.MODES.T
    np.testing.assert_allclose(SLOPES @ real, scipys.MU_REAL * real, rtol=1e-13)
    turned = one + 1j * two
    value = complex(implicit_step.TURNED_REAL, implicit_step.TURNED_IMAGINARY)
    np.testing.assert_allclose(value, np.conj(scipys.MU_COMPLEX), rtol=1e-14)
    np.testing.assert_allclose(SLOPES @ turned, value * turned, rtol=1e-13)


def test_the_error_is_estimated_as_by_scipy():
    np.testing.assert_allclose(implicit_step.NODES, scipys.C, rtol=1e-15)
    np.testing.assert_allclose(implicit_step.ERROR, scipys.E, rtol=1e-15)
