"""Description of a design spectrum: points of period and spectral acceleration, or a file of two columns."""

import re
from pathlib import Path

from stylobate.config.description import Config
from stylobate.errors import ParameterError
from stylobate.records.tables import Table
from stylobate.records.text_files import KNOWN, Text, in_si, read_bytes, unit_of
from stylobate.results.report_details import DesignSpectrum

_BRACKETED = re.compile(r"[\[(]([^\])]*)[\])]")
_COLUMNS = 2
_SECONDS = ("s", "sec", "second", "seconds")


class DesignSpectrumConfig(Config):
    """A design spectrum for the report: points, or a file of two columns.

    The first line of a file may state the unit: `period [s], Sa [g]`. Commas are decimal if semicolons or tabs
    separate the columns.

    Parameters
    ----------
    points
        Pairs of period [s] and spectral acceleration.
    file
        File of these two columns, in place of `points`.
    units
        Unit of the accelerations, such as "g" or "m/s²", if the file does not state it.
    name
        Name of the spectrum in the report.
    damping
        Damping ratio of the spectrum.
    """

    points: tuple[tuple[float, float], ...] = ()
    file: str | None = None
    units: str | None = None
    name: str = "design spectrum"
    damping: float = 0.05

    def build(self) -> DesignSpectrum:
        """Build the spectrum in SI units.

        Raises
        ------
        ParameterError
            If both or neither of points and file are given, or the unit is missing.
        FileError
            If the file cannot be read.
        """
        if (self.file is None) == (not self.points):
            raise ParameterError("design_spectrum: give either points or file.")
        points, stated = (self.points, None) if self.file is None else _read(self.file)
        given = None if self.units is None else unit_of(self.units)
        if self.units is not None and given is None:
            raise ParameterError(f"design_spectrum.units: unknown unit (got {self.units!r}). Use {KNOWN}.")
        if given and stated and given != stated:
            raise ParameterError(
                f"design_spectrum.units: {given!r} contradicts {stated!r} in {self.file}. Remove one of them."
            )
        units = given or stated
        if units is None:
            raise ParameterError(
                'design_spectrum.units: the unit of the accelerations is missing. Add units = "g" or "m/s²".'
            )
        return DesignSpectrum(
            period=tuple(float(period) for period, _ in points),
            acceleration=tuple(float(value) * in_si(units) for _, value in points),
            name=self.name,
            damping=self.damping,
        )


def _read(path: str) -> tuple[tuple[tuple[float, float], ...], str | None]:
    """Read the points of a file, and the unit of accelerations in its first line."""
    table = Table.of(Text.of(Path(path), read_bytes(Path(path))))
    text = table.text
    units = None if table.names is None else _stated_unit(text, table.names_at, table.names)
    points: list[tuple[float, float]] = []
    for at, row in table.rows:
        cells = " ".join(row).replace(";", " ").split()
        if len(cells) != _COLUMNS:
            plain = text.lines[at].strip()
            remedy = ". Write decimal points" if "," in plain else ""
            raise text.fault(
                at, f"two numbers are needed, period [s] and spectral acceleration (got {plain!r}){remedy}"
            )
        points.append((text.number(at, cells[0]), text.number(at, cells[1])))
    return tuple(points), units


def _stated_unit(text: Text, at: int, names: list[str]) -> str | None:
    """Return the unit of the accelerations in the names; periods must be in seconds."""
    period, *_, acceleration = (_BRACKETED.findall(name) for name in names)
    if period and period[-1].strip().lower() not in _SECONDS:
        raise text.fault(at, f"the first column must be the period in s (got [{period[-1]}]). Convert it")
    return unit_of(acceleration[-1]) if acceleration else None
