"""The model of a column that can slip, pivot, lift off and land."""

from stylobate.models.sliding.balance import Contact
from stylobate.models.sliding.model import Sliding

__all__ = ["Contact", "Sliding"]
