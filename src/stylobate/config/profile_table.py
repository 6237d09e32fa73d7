"""Tables of profiles: heights and radii of the corners of an outline, in a text file or in a description."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from stylobate.column import Column
from stylobate.column.profiles import PROFILES
from stylobate.errors import FileError, ParameterError
from stylobate.text import did_you_mean
from stylobate.units import UnitError, read

_SEPARATORS = "/\\"
_HEIGHT, _RADIUS, _INNER, _WALL = "height", "radius", "inner_radius", "wall"
_LENGTHS = {_HEIGHT: 1.0, _RADIUS: 1.0, "diameter": 0.5, _INNER: 1.0, "inner_diameter": 0.5, _WALL: 1.0}
"""Columns of a table, with the factor of a radius in them."""


def is_table(profile: str) -> bool:
    """Return whether a profile is the name of a file, and not a kind of profile."""
    named = any(sign in profile for sign in _SEPARATORS) or Path(profile).suffix != ""
    return profile not in PROFILES and named


@dataclass(frozen=True, slots=True)
class Corners:
    """Corners of a profile from the base up: heights, outer radii and inner radii [m]; None for a solid body."""

    heights: tuple[float, ...]
    radii: tuple[float, ...]
    inner_radii: tuple[float, ...] | None = None

    @classmethod
    def read(cls, path: Path) -> "Corners":
        """Read a table of corners.

        Parameters
        ----------
        path
            Text file, separated by commas, semicolons or tabs, with the columns height and radius (or diameter), and
            for a hollow body inner_radius (or inner_diameter) or wall, the horizontal thickness. Units stand in the
            headings, such as radius [mm]; numbers without a unit are in m.

        Raises
        ------
        FileError
            If the file cannot be read, or lacks a column.
        """
        # Imported here: a command line without a table needs no reader.
        from stylobate.records.contents import read_bytes
        from stylobate.records.tables import NAME_AND_UNIT, TextTable
        from stylobate.records.text_files import Text

        table = TextTable.of(Text.of(path, read_bytes(path)), named=True)
        found: dict[str, tuple[float, ...]] = {}
        for place, heading in enumerate(table.names or []):
            match = NAME_AND_UNIT.fullmatch(heading)
            name, unit = (match["name"], match["unit"] or "m") if match else (heading, "m")
            name = "_".join(name.lower().split())
            if name not in _LENGTHS:
                remedy = did_you_mean(name, _LENGTHS) or f"Use {', '.join(_LENGTHS)}."
                raise FileError(f"{path}, heading {heading!r}: unknown column; {remedy}")
            own = _INNER if name.startswith("inner") else _WALL if name == _WALL else name
            found["radius" if own == "diameter" else own] = tuple(
                _LENGTHS[name] * _length(path, at, cells, place, unit) for at, cells in table.rows
            )
        for name in (_HEIGHT, _RADIUS):
            if name not in found:
                raise FileError(
                    f"{path}: the column {name} is missing. Write it in the first line, such as {name} [mm]."
                )
        inner = found.get(_INNER)
        if _WALL in found:
            inner = tuple(max(0.0, one - wall) for one, wall in zip(found[_RADIUS], found[_WALL], strict=True))
        return cls(found[_HEIGHT], found[_RADIUS], inner)

    def constructor(self, name: str) -> Callable[..., Column]:
        """Return the constructor of columns of this profile; the density or mass is left open."""
        return partial(Column.from_profile, self.heights, self.radii, inner_radii=self.inner_radii, profile=name)


def _length(path: Path, at: int, cells: list[str], place: int, unit: str) -> float:
    cell = cells[place] if place < len(cells) else ""
    try:
        return read(f"{cell} {unit}", "m")
    except (UnitError, ParameterError) as error:
        raise FileError(f"{path}, line {at + 1}: {error}. Correct the cell.") from None
