"""Check that the members of a model agree with each other and with its equations."""

from stylobate.models.consistency.check import check

__all__ = ["check"]
