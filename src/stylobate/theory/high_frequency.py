"""High-frequency limit ν → ∞ of straight-line base motion; a1/c is the only parameter.

With θ = c y/ν² and s = ντ, (1) becomes y″ = y/ν² − ŷ − (η/ν) y′ − (a1/c) cos s e1. The limit omits the overturning part
of the weight and the damping and keeps the full base motion: a higher ν does not make averaging more accurate.
"""

from dataclasses import dataclass

import numpy as np

from stylobate.errors import ParameterError
from stylobate.theory.arguments import FloatArray, Real, Truths, Values, not_negative, plain_results

_STATE_LENGTH = 4


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
    if y.ndim == 0 or len(y) != _STATE_LENGTH:
        message = f"state must have the four entries (y1, y2, y1', y2') along its first axis, got the shape {y.shape}"
        raise ParameterError(message)
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
