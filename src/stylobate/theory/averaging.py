"""The column in the frame that turns with the base (7), steady rolling by averaging (10), and its limit of fast motion.

With a0 = a1/2 the equations (7) of a circling base are the averaged slow flow of straight-line base motion (10). The
error of averaging depends on a1/c alone and does not shrink with frequency.

With θ = c y/ν² and s = ντ, (1) becomes y″ = y/ν² − ŷ − (η/ν) y′ − (a1/c) cos s e1. The limit omits the overturning part
of the weight and the damping and keeps the full base motion: a higher ν does not make averaging more accurate.
"""

from dataclasses import dataclass

import numpy as np

from stylobate.errors import ParameterError
from stylobate.theory.arguments import (
    ComplexArray,
    FloatArray,
    Real,
    Truths,
    Values,
    finite,
    not_negative,
    plain_results,
    positive,
)
from stylobate.theory.rolling import SteadyRolling, steady_rolling

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
        raise ParameterError(
            f"state must have the four entries (θ̇, β̇, θ, ψ) along its first axis, got the shape {array.shape}"
        )
    return array[0], array[1], array[2], array[3]


@dataclass(frozen=True, slots=True, kw_only=True)
class AveragedRolling:
    """Steady rolling in both senses, by averaging.

    Parameters
    ----------
    forward
        Anticlockwise rolling, driven by the circular part p e^{iντ}.
    backward
        Clockwise rolling, driven by the circular part q e^{−iντ}.
    """

    forward: SteadyRolling
    backward: SteadyRolling


def circular_components(a1: Real, a2: Real, phi2: Real) -> tuple[ComplexArray, ComplexArray]:
    """Split harmonic base motion into two circular motions of opposite sense.

    Parameters
    ----------
    a1, a2
        Acceleration amplitudes along the two horizontal axes [g].
    phi2
        Phase φ2 of axis 2 against axis 1 [rad].

    Returns
    -------
    tuple of numpy.ndarray
        p and q, complex, of the broadcast shape, such that
        a1 cos ντ + i a2 cos(ντ + φ2) = p e^{iντ} + q e^{−iντ}. The peak acceleration is abs(p) + abs(q).

    Raises
    ------
    ParameterError
        If an argument is not finite.

    Examples
    --------
    A circle has one component, a straight line two of half its amplitude.

    >>> p, q = circular_components(0.065, 0.065, -np.pi / 2)
    >>> print(abs(p).round(12), abs(q).round(12))
    0.065 0.0
    >>> p, q = circular_components(0.13, 0.0, 0.0)
    >>> print(abs(p), abs(q))
    0.065 0.065
    """
    a1, a2, phi2 = np.broadcast_arrays(finite("a1", a1), finite("a2", a2), finite("phi2", phi2))
    turn = np.exp(1.0j * phi2)
    return 0.5 * (a1 + 1.0j * a2 * turn), 0.5 * (a1 + 1.0j * a2 * turn.conj())


@plain_results
def averaged_rolling(nu: Real, a1: Real, a2: Real = 0.0, phi2: Real = 0.0, *, c: Real, eta: Real) -> AveragedRolling:
    """Compute steady rolling under straight-line or elliptic base motion by averaging.

    Parameters
    ----------
    nu
        Frequency ratio ν = Ω/ω0 of the base motion, positive.
    a1, a2
        Acceleration amplitudes along the two horizontal axes [g]. By default the base moves along axis 1.
    phi2
        Phase φ2 of axis 2 against axis 1 [rad].
    c
        Slenderness.
    eta
        Damping η.

    Returns
    -------
    AveragedRolling
        Rolling in both senses, arrays of the broadcast shape. The mean azimuth of the contact point is
        β = sense · (ντ + ψ) + azimuth_offset.

    Raises
    ------
    ParameterError
        If `nu` or `c` is not positive, `eta` is negative, or an amplitude or phase is not finite.

    Notes
    -----
    (10): (8) with a0 = abs(p) forward and a0 = abs(q) backward; both are a1/2 for straight-line motion. Exact for
    circular motion. The small parameter is a1/c at every frequency. For a1 ≪ c the undamped exact motion from these
    initial conditions deviates from the averaged tilt by about 2.3 a1/c of the tilt. At a1 = 0.4c and 1.3c the exact
    critical frequency lies 11 and 16 per cent above the averaged critical frequency (c = η = 0.1).

    Examples
    --------
    >>> rolling = averaged_rolling(3.0, 0.13, c=0.1, eta=0.1)
    >>> print(round(rolling.forward.upper.amplitude, 4), round(rolling.backward.upper.amplitude, 4))
    0.0165 0.0165
    """
    nu, c, eta = positive("nu", nu), positive("c", c), not_negative("eta", eta)
    p, q = circular_components(a1, a2, phi2)
    return AveragedRolling(
        forward=_rolling(nu, p, c, eta, sense=1),
        backward=_rolling(nu, q, c, eta, sense=-1),
    )


def _rolling(nu: Real, component: ComplexArray, c: Real, eta: Real, *, sense: int) -> SteadyRolling:
    rolling = steady_rolling(nu, np.abs(component), c=c, eta=eta)
    offset = np.broadcast_to(np.angle(component), np.shape(rolling.azimuth_offset)).copy()
    return SteadyRolling(upper=rolling.upper, lower=rolling.lower, sense=sense, azimuth_offset=offset)


@dataclass(frozen=True, slots=True, kw_only=True)
class HighFrequencyRolling:
    """Averaged steady rolling in the limit of fast base motion, arrays of one shape.

    Parameters
    ----------
    upper, lower
        Tilt angle y = θν²/c of the two branches; NaN where the lower does not exist.
    frequencies
        The two frequencies, per unit of s, of small oscillations about the upper branch, along a last axis of length 2,
        the slower first.
    stable
        Whether the upper branch is neutrally stable: no deviation grows and none decays.
    """

    upper: Values
    lower: Values
    frequencies: FloatArray
    stable: Truths


def high_frequency_rates(
    s: Real, state: Real, ratio: Real, transverse_ratio: Real = 0.0, phi2: Real = 0.0
) -> FloatArray:
    """Evaluate the right-hand side of the equations of motion in the limit of fast base motion.

    Parameters
    ----------
    s
        Time in units of the base motion, s = ντ.
    state
        (y1, y2, y1′, y2′) along the first axis: tilt vector y = θν²/c and its derivative in s, shape (4, ...).
    ratio
        a1/c, acceleration amplitude of the base along axis 1 against the slenderness.
    transverse_ratio
        a2/c, the same along axis 2.
    phi2
        Phase φ2 of axis 2 against axis 1 [rad].

    Returns
    -------
    numpy.ndarray
        Derivatives of the state in s, shape (4, ...). Not defined at y = 0.

    Raises
    ------
    ParameterError
        If the first axis of `state` does not have four entries.

    Notes
    -----
    y″ = −ŷ − (a1 cos s, a2 cos(s + φ2))/c, from (1). Valid for y ≪ ν²: no column overturns in this limit.
    """
    y = np.asarray(state, dtype=np.float64)
    if y.ndim == 0 or len(y) != STATE_LENGTH:
        raise ParameterError(
            f"state must have the four entries (y1, y2, y1', y2') along its first axis, got the shape {y.shape}"
        )
    s, ratio, transverse_ratio, phi2 = (np.asarray(v, dtype=np.float64) for v in (s, ratio, transverse_ratio, phi2))
    lean = np.hypot(y[0], y[1])
    first = -y[0] / lean - ratio * np.cos(s)
    second = -y[1] / lean - transverse_ratio * np.cos(s + phi2)
    return np.stack(np.broadcast_arrays(y[2], y[3], first, second))


@plain_results
def high_frequency_rolling(ratio: Real) -> HighFrequencyRolling:
    """Compute averaged steady rolling in the limit of fast straight-line base motion.

    Parameters
    ----------
    ratio
        a1/c, acceleration amplitude of the base against the slenderness. For circular motion of amplitude a0 pass
        2a0/c; the result is then exact.

    Returns
    -------
    HighFrequencyRolling
        Both branches and the small oscillations about the upper one, of the shape of `ratio`.

    Raises
    ------
    ParameterError
        If `ratio` is negative.

    Notes
    -----
    The limit of (8), (10) for ν → ∞: y± = 1 ± a1/2c. Deviations e^{σs} obey σ⁴ + (2 + ξ)σ² + 1 − ξ = 0, ξ = 1/y, so
    σ² = −½[2 + ξ ± √(ξ² + 8ξ)]: both negative on the upper branch, ξ < 1, and of opposite sign on the lower. The
    critical frequency is below √(1 + 2a0/c), so every amplitude is stable in the limit. The damping factor e^{−ητ/2} =
    e^{−ηs/2ν} tends to 1.

    Examples
    --------
    >>> rolling = high_frequency_rolling([0.4, 1.3, 2.5])
    >>> print(rolling.upper, rolling.lower.round(12))
    [1.2  1.65 2.25] [0.8  0.35  nan]
    """
    half = 0.5 * not_negative("ratio", ratio)
    upper = 1.0 + half
    xi = 1.0 / upper
    faster = 0.5 * (2.0 + xi + np.sqrt(xi * (xi + 8.0)))
    slower = (half / upper) / faster  # their product is 1 − ξ
    return HighFrequencyRolling(
        upper=upper,
        lower=np.where(half < 1.0, 1.0 - half, np.nan),
        frequencies=np.sqrt(np.stack([slower, faster], axis=-1)),
        stable=slower > 0.0,
    )
