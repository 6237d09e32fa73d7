"""Floquet multipliers within rounding: stability, damping and limits of accuracy."""

import numpy as np
import numpy.typing as npt

Complexes = npt.NDArray[np.complex128]

# A multiplier within this distance of the unit circle cannot be distinguished from a multiplier on the circle.
_NEUTRAL = 1e-9
# Rounding error of the product of all multipliers, as measured without damping, over the square of the largest; and the
# error above which the product is unknown.
_ROUNDING, _UNKNOWN = 1e-14, 0.1


def without_damping(multipliers: Complexes) -> bool:
    """Return whether the flow preserves volumes of states: the product of all multipliers is 1.

    Multipliers are accurate to 1e-9, and the smallest contains the rounding error of a large one.
    """
    allowed = len(multipliers) * _NEUTRAL + min(_rounding_of_product(multipliers), _UNKNOWN)
    return bool(abs(np.prod(multipliers) - 1.0) <= allowed)


def least_are_rounding(multipliers: Complexes) -> bool:
    """Return whether rounding of the largest multiplier dominates the smallest one and the product of all."""
    return _rounding_of_product(multipliers) > _UNKNOWN


def _rounding_of_product(multipliers: Complexes) -> float:
    return _ROUNDING * float(np.abs(multipliers).max()) ** 2


def is_stable(multipliers: Complexes) -> bool:
    """Return whether all multipliers lie inside the unit circle; without damping, whether none lies outside it."""
    margin = _NEUTRAL if without_damping(multipliers) else -_NEUTRAL
    return bool(np.abs(multipliers).max() < 1.0 + margin)
