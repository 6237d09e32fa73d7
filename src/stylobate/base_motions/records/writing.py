"""Writing of records to CSV and AT2 files."""

import os
from pathlib import Path

from stylobate.base_motions.records.record import AXES, Record
from stylobate.column import STANDARD_GRAVITY
from stylobate.errors import ParameterError
from stylobate.files import write_whole

_ON_A_LINE = 5


def write_csv(record: Record, path: str | os.PathLike[str]) -> Path:
    """Write time [s] and the accelerations along x, y and z [m/s²] and return the path; reading restores each number.

    Raises
    ------
    FileError
        If the file cannot be written.
    """
    rows = zip(record.times.tolist(), *record.samples.T.tolist(), strict=True)
    header = ",".join(["time [s]", *(f"{axis} [m/s²]" for axis in AXES)])
    return _write_lines(path, [header, *(",".join(map(repr, row)) for row in rows)])


def write_at2(record: Record, path: str | os.PathLike[str], *, axis: str) -> Path:
    """Write the accelerations along one `axis` as a PEER AT2 file, in g with eight digits, and return the path.

    Raises
    ------
    FileError
        If the file cannot be written.
    ParameterError
        If the axis is not "x", "y" or "z".
    """
    if axis not in AXES:
        message = f'axis must be "x", "y" or "z", got {axis!r}'
        raise ParameterError(message)
    values = [f"{value:15.7E}" for value in (record.samples[:, AXES.index(axis)] / STANDARD_GRAVITY).tolist()]
    header = [
        "PEER format, written by stylobate",
        f"{record.name}, {'UP' if axis == 'z' else axis}",
        "ACCELERATION TIME SERIES IN UNITS OF G",
        f"NPTS= {len(values):6d}, DT= {record.step!r} SEC",
    ]
    lines = ["".join(values[at : at + _ON_A_LINE]) for at in range(0, len(values), _ON_A_LINE)]
    return _write_lines(path, [*header, *lines])


def _write_lines(path: str | os.PathLike[str], lines: list[str]) -> Path:
    return write_whole(Path(path), "\n".join(lines) + "\n")
