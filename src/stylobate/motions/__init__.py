"""Base motions: the acceleration of the base against time."""

from stylobate.motions.base import BaseMotion
from stylobate.motions.combined import BASE_AT_REST, Delayed, Rotated, Scaled, Sum, as_harmonic
from stylobate.motions.harmonic import Harmonic

__all__ = ["BASE_AT_REST", "BaseMotion", "Delayed", "Harmonic", "Rotated", "Scaled", "Sum", "as_harmonic"]
