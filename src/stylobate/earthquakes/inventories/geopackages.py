"""GeoPackages: rows and geometries of a layer, read with SQLite from the bytes of the file; the library that writes.

GDAL finds out by itself what a file is, and its drivers open other files and addresses that a file names. A GeoPackage
is a database of SQLite with a mark; its tables are read here without GDAL, in memory, by statements that only select.
"""

import sqlite3
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from typing import Any, NamedTuple

from stylobate.errors import FileError, require_extra
from stylobate.files import file_of
from stylobate.records.contents import read_bytes

_SQLITE = b"SQLite format 3\0"
# The mark of GeoPackages of version 1.2 and later, and those of 1.0 and 1.1. OGC 12-128r18, requirement 2.
_MARKS, _MARK_AT = (b"GPKG", b"GP10", b"GP11"), 68
# Bytes that state whether changes stand in a file beside the database, and their value where they do not.
_JOURNAL, _NO_JOURNAL = slice(18, 20), b"\x01\x01"
_ALLOWED = (sqlite3.SQLITE_SELECT, sqlite3.SQLITE_READ)
# Organizations of reference systems that have a definition only.
_UNNAMED = ("NONE", "GDAL", "CUSTOM")
# Length of the envelope of a geometry by its code. OGC 12-128r18, clause 2.1.3.
_HEADER, _ENVELOPES = 8, (0, 32, 48, 48, 64)


class Layer(NamedTuple):
    """A layer: its headings, its rows, each with its geometry as well-known binary, and its reference system."""

    headings: tuple[str, ...]
    rows: list[tuple[bytes, tuple[str, ...]]]
    crs: str


def read_layer(path: Path) -> Layer:
    """Read the first layer of a GeoPackage, or FILE.gpkg/LAYER.

    Raises
    ------
    FileError
        If the file is no GeoPackage or damaged, is open in another program, or has no such layer of its own rows.
    """
    file = file_of(path)
    content = read_bytes(file)
    mark = content[_MARK_AT : _MARK_AT + len(_MARKS[0])]
    if not content.startswith(_SQLITE) or mark not in _MARKS:
        raise FileError(f"{path}: no GeoPackage: it begins otherwise. Save the table as GeoPackage or CSV.")
    journal = file.with_name(f"{file.name}-wal")
    if journal.is_file() and journal.stat().st_size:
        raise FileError(f"{path}: open in another program, which keeps changes in {journal.name}. Close it there.")
    content = content[: _JOURNAL.start] + _NO_JOURNAL + content[_JOURNAL.stop :]
    try:
        with closing(sqlite3.connect(":memory:")) as database:
            database.execute("PRAGMA trusted_schema = OFF")
            database.text_factory = lambda text: text.decode(errors="replace")
            database.deserialize(content)
            database.set_authorizer(_only_selects)
            return _layer(path, file, database)
    except (sqlite3.Error, ValueError, TypeError, IndexError, OverflowError) as error:
        raise FileError(f"{path}: cannot be read ({error}). Save it again as GeoPackage.") from error


def _only_selects(action: int, subject: str | None, *_: object) -> int:
    allowed = action in _ALLOWED or (action == sqlite3.SQLITE_PRAGMA and subject == "table_xinfo")
    return sqlite3.SQLITE_OK if allowed else sqlite3.SQLITE_DENY


def _layer(path: Path, file: Path, database: sqlite3.Connection) -> Layer:
    layers = "SELECT table_name FROM gpkg_contents WHERE data_type IN ('features', 'attributes')"
    names = [str(name) for (name,) in database.execute(layers)]
    name = path.name if path != file else next(iter(names), "")
    if name not in names:
        raise FileError(f"{path}: no such layer. Choose from {', '.join(names) or 'none: the file has no layer'}.")
    ((kind, made),) = database.execute("SELECT type, sql FROM sqlite_master WHERE name = ?", (name,)).fetchall()
    if kind != "table" or not str(made).upper().startswith("CREATE TABLE"):
        raise FileError(f"{path}: the layer {name!r} has no rows of its own. Save it as a table.")
    geometry, crs = _geometry_of(database, name)
    columns = list(_columns(database, name))
    shown = [(column, declared) for column, declared in columns if column != geometry]
    chosen = ", ".join(map(_quoted, [*([geometry] if geometry else []), *(column for column, _ in shown)])) or "NULL"
    rows = []
    for row in database.execute(f"SELECT {chosen} FROM {_quoted(name)} ORDER BY rowid"):  # noqa: S608  quoted
        shape, cells = (_well_known_binary(row[0]), row[1:]) if geometry else (b"", row)
        rows.append((shape, tuple(_text(cell, kind) for cell, (_, kind) in zip(cells, shown, strict=False))))
    return Layer(tuple(column for column, _ in shown), rows, crs)


def _geometry_of(database: sqlite3.Connection, name: str) -> tuple[str, str]:
    """Return the column of the geometries and their reference system, such as EPSG:2056; empty without one."""
    found = database.execute(
        "SELECT g.column_name, s.organization, s.organization_coordsys_id, s.definition "
        "FROM gpkg_geometry_columns AS g LEFT JOIN gpkg_spatial_ref_sys AS s ON s.srs_id = g.srs_id "
        "WHERE g.table_name = ?",
        (name,),
    ).fetchone()
    if found is None:
        return "", ""
    column, organization, number, definition = found
    if str(organization).upper() not in _UNNAMED and organization is not None:
        return str(column), f"{str(organization).upper()}:{int(number)}"
    return str(column), "" if "undefined" in str(definition or "undefined").lower() else str(definition)


def _columns(database: sqlite3.Connection, name: str) -> Iterator[tuple[str, str]]:
    """Yield the names and declared types of the columns except the numbers of the rows."""
    for _, column, declared, _, _, key, _ in database.execute(f"PRAGMA table_xinfo({_quoted(name)})"):
        if not (key and str(declared).upper() == "INTEGER"):
            yield str(column), str(declared).upper()


def _quoted(name: str) -> str:
    return '"' + name.replace('"', '""') + '"'


def _well_known_binary(geometry: Any) -> bytes:
    """Return a geometry without the header that a GeoPackage puts before it."""
    if geometry is None:
        return b""
    if geometry[:2] != b"GP":
        raise ValueError("a geometry begins otherwise")
    return bytes(geometry[_HEADER + _ENVELOPES[geometry[3] >> 1 & 7] :])


def _text(cell: Any, declared: str) -> str:
    if cell is None:
        return ""
    if declared == "BOOLEAN":
        return str(bool(cell))
    return cell.hex() if isinstance(cell, bytes) else str(cell).strip()


def geopackage_writer(path: Path) -> Any:
    """Return the library that writes GeoPackages.

    Raises
    ------
    UnsupportedError
        If pyogrio is not installed.
    """
    remedy = 'pip install "stylobate[geo]"; or save the table as CSV.'
    return require_extra("pyogrio.raw", f"{path}: a GeoPackage is written by pyogrio: {remedy}")
