"""The ways to describe a column in files, on the command line and in the laboratory, by name."""

from collections.abc import Callable, Mapping

from stylobate.column.column import Column

SHAPES: Mapping[str, Callable[..., Column]] = {
    "solid": Column.solid,
    "hollow": Column.hollow,
    "frustum": Column.frustum,
    "dimensionless": Column.dimensionless,
    "given": Column,
}
"""The ways to describe a column, by their name in files and on the command line."""

SHAPES_OF_PROFILES: Mapping[str, Callable[..., Column]] = {
    "estimated": Column.estimated,
    "profile": Column.from_profile,
}
"""Ways to describe a column by its profile, in files, tables and on the command line; the laboratory has none."""

SHAPES_WITH_OPTIONS: Mapping[str, Callable[..., Column]] = {**SHAPES, **SHAPES_OF_PROFILES}
"""The ways to describe a column on the command line and in tables of objects."""

SHAPES_IN_FILES: Mapping[str, Callable[..., Column]] = {
    "prism": Column.prism,
    "tank": Column.tank,
    "parts": Column.from_parts,
}
"""Further ways to describe a column in files; the command line and the laboratory have no options for them."""
