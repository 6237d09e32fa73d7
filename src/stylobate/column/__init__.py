"""The column: its numbers, its named constructors, and the shapes by which files describe it."""

from stylobate.column.column import Column
from stylobate.column.profiles import Profile

__all__ = ["Column", "Profile"]
