"""The model of a column that can slip, pivot, lift off and land."""

from stylobate.models.sliding.model import Sliding
from stylobate.models.sliding.phases import Contact, State

__all__ = ["Contact", "Sliding", "State"]
