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


def test_the_eigenvector_belongs_to_the_real_eigenvalue():
    vector = np.array(implicit_step.EIGENVECTOR)
    np.testing.assert_allclose(SLOPES @ vector, scipys.MU_REAL * vector, rtol=1e-14)


def test_the_error_is_estimated_as_by_scipy():
    np.testing.assert_allclose(implicit_step.NODES, scipys.C, rtol=1e-15)
    np.testing.assert_allclose(implicit_step.ERROR, scipys.E, rtol=1e-15)
