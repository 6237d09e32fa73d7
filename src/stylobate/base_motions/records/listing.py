"""Summary rows of records: file, peaks, energy, duration and residual velocity of each component."""

import re
from typing import NamedTuple

from stylobate.base_motions.records.intensity import intensity_measures
from stylobate.base_motions.records.record import Record
from stylobate.column import STANDARD_GRAVITY

_CLAUSE = re.compile(r"(?:^|; |: )([xyz]) (.*?from [^;]*)")
_FILE = re.compile(r"read from (.*?), in ")
_DONE = re.compile(r"trimmed to|padded with zeros to|resampled from")
# Final velocity over peak velocity above which a record has a baseline error or was cut.
_RESIDUAL = 0.05


class ComponentRow(NamedTuple):
    """Values of one component of a record in SI units, except `pga_g` [g]; `origin` is its file and direction."""

    record: str
    axis: str
    origin: str
    samples: int
    step: float
    pga: float
    pga_g: float
    pgv: float
    pgd: float
    arias: float
    duration_5_95: float
    residual_velocity: float


_MEASURES = ("pga", "pgv", "pgd", "arias", "duration_5_95", "residual_velocity")


def component_rows(record: Record) -> list[ComponentRow]:
    """Compute the values of each component of a record with acceleration.

    Examples
    --------
    >>> from stylobate.base_motions.records import sample_record
    >>> [(row.axis, round(row.pga, 2), round(row.duration_5_95, 2)) for row in component_rows(sample_record())]
    [('x', 3.42, 24.48), ('y', 2.1, 24.56), ('z', 2.06, 20.34)]
    """
    measures = intensity_measures(record)
    origins = origins_of(record)
    rows = []
    for axis in record.axes:
        own = measures.sel(axis=axis)
        one = {name: float(own[name]) for name in _MEASURES}
        rows.append(
            ComponentRow(
                record=record.name,
                axis=axis,
                origin=origins.get(axis, ""),
                samples=len(record.samples),
                step=record.step,
                pga_g=one["pga"] / STANDARD_GRAVITY,
                **one,
            )
        )
    return rows


def origins_of(record: Record) -> dict[str, str]:
    """Return file and direction of each component by axis, from the provenance of a record."""
    found = {axis: clause for line in record.provenance for axis, clause in _CLAUSE.findall(line)}
    files = files_of(record)
    return found or dict.fromkeys(record.axes, f"from {files[0]}" if files else "")


def files_of(record: Record) -> list[str]:
    """Return the names of the files of a record."""
    return [name for line in record.provenance for name in _FILE.findall(line)]


def drifts(record: Record) -> list[tuple[str, float]]:
    """Return the axes whose velocity after the last sample exceeds 5 % of PGV, with this fraction."""
    shares = [(row.axis, abs(row.residual_velocity) / row.pgv) for row in component_rows(record) if row.pgv]
    return [(axis, share) for axis, share in shares if share > _RESIDUAL]


def notes_on(record: Record) -> list[str]:
    """Return one line for each adjustment of components and for each large residual velocity."""
    notes = [f"{record.name}: {line}" for line in record.provenance if _DONE.search(line)]
    notes += [
        f"{record.name}: along {axis} the velocity after the last sample is {100.0 * share:.0f} % of PGV. Correct the "
        "baseline or filter before you use PGD"
        for axis, share in drifts(record)
    ]
    return notes
