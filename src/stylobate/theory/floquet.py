"""Floquet multipliers of a periodic solution of (7) given on equally spaced points."""

import numpy as np

from stylobate.theory.arguments import ComplexArray, FloatArray
from stylobate.theory.rotating_frame import STATE_LENGTH, rotating_frame_jacobian
from stylobate.theory.spectral import interpolated

_STEPS_PER_POINT = 4

# Gauss–Legendre with three stages, order 6: E. Hairer, S. P. Nørsett, G. Wanner, Solving ODEs I, table II.7.4
_ROOT = np.sqrt(15.0)
_NODES = np.array([0.5 - _ROOT / 10.0, 0.5, 0.5 + _ROOT / 10.0])
_WEIGHTS = np.array([5.0, 8.0, 5.0]) / 18.0
_STAGES = np.array(
    [
        [5.0 / 36.0, 2.0 / 9.0 - _ROOT / 15.0, 5.0 / 36.0 - _ROOT / 30.0],
        [5.0 / 36.0 + _ROOT / 24.0, 2.0 / 9.0, 5.0 / 36.0 - _ROOT / 24.0],
        [5.0 / 36.0 + _ROOT / 30.0, 2.0 / 9.0 + _ROOT / 15.0, 5.0 / 36.0],
    ]
)


def floquet_multipliers(state: FloatArray, period: float, a0: float, eta: float) -> ComplexArray:
    """Compute the Floquet multipliers of a periodic solution of (7), the largest first.

    Parameters
    ----------
    state
        (θ̇, β̇, θ, ψ) on equally spaced points of one period, shape (4, points).
    period
        Period of the solution.
    a0
        Acceleration amplitude of the base [g].
    eta
        Damping η.

    Returns
    -------
    numpy.ndarray
        Four complex multipliers; one is 1, the shift along the solution.

    Notes
    -----
    The variational equation is integrated with the Gauss–Legendre method of order 6 along the trigonometric
    interpolant. The product of the multipliers is e^{−2ηT} (Liouville): base motion and weight do not contract the
    state space.
    """
    steps = _STEPS_PER_POINT * state.shape[-1]
    fraction = ((np.arange(steps)[:, np.newaxis] + _NODES) / steps).ravel()
    jacobian = rotating_frame_jacobian(interpolated(state, fraction), a0, eta=eta)
    monodromy = np.eye(STATE_LENGTH)
    for factor in _step_matrices(jacobian.reshape(steps, -1, STATE_LENGTH, STATE_LENGTH), period / steps):
        monodromy = factor @ monodromy
    multipliers = np.linalg.eigvals(monodromy).astype(np.complex128)
    return multipliers[np.argsort(-np.abs(multipliers), kind="stable")]


def _step_matrices(jacobian: FloatArray, step: float) -> FloatArray:
    """Return the propagation matrix of each step, from the Jacobian at its stages (steps, 3, 4, 4)."""
    stages = _WEIGHTS.size
    size = stages * STATE_LENGTH
    coupling = np.einsum("ij,nipq->nipjq", _STAGES, jacobian).reshape(-1, size, size)
    slopes = np.linalg.solve(np.eye(size) - step * coupling, jacobian.reshape(-1, size, STATE_LENGTH))
    slopes = slopes.reshape(-1, stages, STATE_LENGTH, STATE_LENGTH)
    increments: FloatArray = np.einsum("i,nipq->npq", _WEIGHTS, slopes)
    return np.eye(STATE_LENGTH) + step * increments
