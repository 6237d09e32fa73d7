"""Circular base motion in the rotating frame: autonomous system of four equations (7).

With a0 = a1/2 the same equations are the averaged slow flow of straight-line base motion (10).
"""

import numpy as np

from stylobate.errors import ParameterError
from stylobate.theory.arguments import FloatArray, Real

STATE_LENGTH = 4


def rotating_frame_rates(state: Real, nu: Real, a0: Real, *, c: Real, eta: Real) -> FloatArray:
    """Evaluate the right-hand side of (7), the column on a circling base.

    Parameters
    ----------
    state
        Tilt rate θ̇, rolling rate β̇, tilt angle θ > 0 and phase ψ = β − ντ, along the first axis: shape (4, ...).
    nu
        Frequency ratio ν = Ω/ω0 of the base motion.
    a0
        Acceleration amplitude of the base [g].
    c
        Slenderness.
    eta
        Damping η.

    Returns
    -------
    numpy.ndarray
        Rates of the state in the same order, shape (4, ...). Only the length of the first axis is checked, since
        integrators call this function. Not defined at θ = 0.

    Raises
    ------
    ParameterError
        If the first axis of `state` does not have four entries.

    Examples
    --------
    >>> print(rotating_frame_rates([0.0, 1.0, 0.05, 0.0], 1.0, 0.0, c=0.1, eta=0.0))
    [0. 0. 0. 0.]
    """
    mu, omega, tilt, psi = _components(state)
    nu, a0, c, eta = (np.asarray(value, dtype=np.float64) for value in (nu, a0, c, eta))
    rates = (
        tilt * (1.0 + omega**2) - c - eta * mu - a0 * np.cos(psi),  # (7)
        -2.0 * mu * omega / tilt - eta * omega + a0 / tilt * np.sin(psi),
        mu,
        omega - nu,
    )
    return np.stack(np.broadcast_arrays(*rates))


def rotating_frame_jacobian(state: Real, a0: Real, *, eta: Real) -> FloatArray:
    """Evaluate the Jacobian of (7) with respect to the state (θ̇, β̇, θ, ψ), at any state.

    Parameters
    ----------
    state
        As for `rotating_frame_rates`, shape (4, ...).
    a0
        Acceleration amplitude of the base [g].
    eta
        Damping η.

    Returns
    -------
    numpy.ndarray
        Matrices along the last two axes, shape (..., 4, 4), as `numpy.linalg` takes them. ν and c do not enter.

    Raises
    ------
    ParameterError
        If the first axis of `state` does not have four entries.
    """
    mu, omega, tilt, psi = _components(state)
    a0, eta = (np.asarray(value, dtype=np.float64) for value in (a0, eta))
    push, drive = a0 * np.cos(psi), a0 * np.sin(psi)
    rows = (
        (-eta, 2.0 * tilt * omega, 1.0 + omega**2, drive),
        (-2.0 * omega / tilt, -2.0 * mu / tilt - eta, (2.0 * mu * omega - drive) / tilt**2, push / tilt),
        (1.0, 0.0, 0.0, 0.0),
        (0.0, 1.0, 0.0, 0.0),
    )
    entries = np.broadcast_arrays(*(entry for row in rows for entry in row))
    matrices = np.stack(entries, axis=-1)
    return matrices.reshape(*matrices.shape[:-1], STATE_LENGTH, STATE_LENGTH)


def _components(state: Real) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    array = np.asarray(state, dtype=np.float64)
    if array.ndim == 0 or len(array) != STATE_LENGTH:
        message = f"state must have the four entries (θ̇, β̇, θ, ψ) along its first axis, got the shape {array.shape}"
        raise ParameterError(message)
    return array[0], array[1], array[2], array[3]
