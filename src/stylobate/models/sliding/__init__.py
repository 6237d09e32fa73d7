"""The column that can slip, pivot, lift off and land: level 3 of the model hierarchy."""

from stylobate.models.sliding.model import Sliding
from stylobate.models.sliding.phases import Contact, State

__all__ = ["Contact", "Sliding", "State"]
