"""The column that can slip, pivot, lift off and land: level 3 of the ladder of models."""

from stylobate.models.sliding.model import Sliding
from stylobate.models.sliding.phases import Contact, State

__all__ = ["Contact", "Sliding", "State"]
