"""Floquet multipliers within rounding: stability, damping, and where rounding dominates."""

import numpy as np
import numpy.typing as npt

Complexes = npt.NDArray[np.complex128]

# A multiplier this near to the unit circle cannot be distinguished from one on it.
_NEUTRAL = 1e-9
# Rounding of the product of all multipliers, as measured without damping, is this times the square of the largest;
# beyond the last number it says nothing about it.
_ROUNDING, _UNKNOWN = 1e-14, 0.1


def without_damping(multipliers: Complexes) -> bool:
    """Return whether volumes of states keep their size: the product of all multipliers is 1.

    Each of them is known to 1e-9, and a large one leaves its rounding in the least.
    """
    allowed = len(multipliers) * _NEUTRAL + min(_rounding_of_product(multipliers), _UNKNOWN)
    return bool(abs(np.prod(multipliers) - 1.0) <= allowed)


def least_are_rounding(multipliers: Complexes) -> bool:
    """Return whether the least multiplier is no more than the rounding of the largest, and their product too."""
    return _rounding_of_product(multipliers) > _UNKNOWN


def _rounding_of_product(multipliers: Complexes) -> float:
    return _ROUNDING * float(np.abs(multipliers).max()) ** 2


def is_stable(multipliers: Complexes) -> bool:
    """Return whether all multipliers lie inside the unit circle; without damping, whether none lies outside it."""
    margin = _NEUTRAL if without_damping(multipliers) else -_NEUTRAL
    return bool(np.abs(multipliers).max() < 1.0 + margin)
