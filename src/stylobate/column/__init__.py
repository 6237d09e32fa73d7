"""The column: its numbers, its named constructors, and the shapes by which files describe it."""

from stylobate.column.column import Column
from stylobate.column.numbers import STANDARD_GRAVITY, Density, Height, MassHeight, Radius, Slenderness, TopRadius
from stylobate.column.profiles import PROFILES, Profile
from stylobate.column.shapes import SHAPES, SHAPES_IN_FILES, SHAPES_OF_PROFILES, SHAPES_WITH_OPTIONS

__all__ = [
    "PROFILES",
    "SHAPES",
    "SHAPES_IN_FILES",
    "SHAPES_OF_PROFILES",
    "SHAPES_WITH_OPTIONS",
    "STANDARD_GRAVITY",
    "Column",
    "Density",
    "Height",
    "MassHeight",
    "Profile",
    "Radius",
    "Slenderness",
    "TopRadius",
]
