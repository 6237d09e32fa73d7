"""Files of random content, drawn with a seed, for every reader of files; run as a program, which prints a report."""

import gzip
import io
import json
import random
import socket
import sqlite3
import sys
import tarfile
import tempfile
import traceback
import warnings
import zipfile
from collections import Counter
from pathlib import Path

import numpy as np

import stylobate as sb
from stylobate.base_motions import Record
from stylobate.earthquakes import read_inventory
from stylobate.errors import StylobateError
from stylobate.records.reading import write_at2, write_csv

STEP = 0.01
TIMES = STEP * np.arange(60)
WAVES = np.stack([np.sin(rate * TIMES) for rate in (9.0, 7.0, 31.0)], axis=-1)
OBJECTS = (
    "name,radius,height,density,damping,friction_coefficient\nurn,0.1,0.6,2100,0.05,0.6\njar,0.2,0.8,2100,0.05,0.6\n"
)
KNET = (
    """Origin Time       1996/08/11 03:12:00
Lat.              38.9
Long.             140.6
Depth. (km)       10
Mag.              5.9
Station Code      AKT023
Station Lat.      39.1
Station Long.     140.5
Station Height(m) 100
Record Time       1996/08/11 03:12:18
Sampling Freq(Hz) 100Hz
Duration Time(s)  1
Dir.              U-D
Scale Factor      2000(gal)/8388608
Max. Acc. (gal)   1.0
Last Correction   1996/08/11 03:12:18
Memo.
"""
    + "4194304 -4194304 2097152 0 1048576 -2097152 0 0\n" * 3
)
SLIST = (
    "TIMESERIES IU_ANMO_00_HNZ_D, 6 samples, 100 sps, 2020-01-01T00:00:00.000000, SLIST, FLOAT, M/S**2\n1 2 3 4 5 6\n"
)
GSE2 = "WID2 2020/01/01 00:00:00.000 ANMO  HNZ      INT        6  100.000000   1.00e+00   1.000 XXXXXX  -1.0 -1.0\n"
STATION = """<?xml version="1.0"?><FDSNStationXML xmlns="http://www.fdsn.org/xml/station/1" schemaVersion="1.1">
<Source>s</Source><Created>2020-01-01T00:00:00</Created><Network code="IU"><Station code="ANMO"><Latitude>0</Latitude>
<Longitude>0</Longitude><Elevation>0</Elevation><Site><Name>s</Name></Site>
<Channel code="HNZ" locationCode="00"><Latitude>0</Latitude>
<Longitude>0</Longitude><Elevation>0</Elevation><Depth>0</Depth><Azimuth>0</Azimuth><Dip>-90</Dip><Response>
<InstrumentSensitivity><Value>1000</Value><Frequency>1</Frequency><InputUnits><Name>M/S**2</Name></InputUnits>
<OutputUnits><Name>COUNTS</Name></OutputUnits></InstrumentSensitivity></Response></Channel></Station></Network>
</FDSNStationXML>"""
# Beginnings of kinds that are read, and of kinds that are not.
BEGINNINGS = (
    *(
        b"PK\x03\x04",
        b"PK\x05\x06",
        b"\x1f\x8b\x08\x00",
        b"\x1f\x8b",
        b"\x89HDF\r\n\x1a\n",
        b"SQLite format 3\0",
        b"GPKG",
    ),
    *(b"000001D ", b"000001V 010", b"Origin Time", b"WID2 ", b"WID1 ", b"TIMESERIES ", b"K\0\x08", b"CDF\x01"),
    *(
        b"BZh9",
        b"\xfd7zXZ\x00",
        b"Rar!",
        b"7z\xbc\xaf",
        b"%PDF-1.7",
        b"\xd0\xcf\x11\xe0",
        b"\x89PNG\r\n\x1a\n",
        b"RIFF",
    ),
    *(
        b"\xff\xfe",
        b"\xfe\xff",
        b"\xef\xbb\xbf",
        b"<?xml version='1.0'?>",
        b"<FDSNStationXML>",
        b"{",
        b"[",
        b"\x93NUMPY",
    ),
    *(
        b"NPTS= 10, DT= .01",
        b"SAMPLING_INTERVAL_S: 0.01",
        b"\0",
        b"\n",
        b";",
        b"ustar",
        b"time [s],x [g]\n0,",
        b"II*\0",
    ),
)
ENDINGS = (".csv", ".xlsx", ".gpkg", ".nc", ".AT2", ".mseed", ".zip", ".gz", "")


def whole_files(folder: Path) -> list[bytes]:
    """Return the contents of small files of all kinds that are read."""
    import obspy
    import openpyxl
    import xarray as xr

    quake = Record(samples=WAVES, step=STEP, name="quake")
    texts = [write_at2(quake, folder / "a.at2", axis="x"), write_csv(quake, folder / "a.csv")]
    begin = obspy.UTCDateTime("2020-01-01T00:00:00")
    stats = {"network": "IU", "station": "ANMO", "location": "00", "channel": "HNZ", "delta": STEP, "starttime": begin}
    for form, kind in (("MSEED", "float64"), ("MSEED", "int32"), ("SAC", "float32")):
        trace = obspy.Trace(np.ascontiguousarray((100.0 * WAVES[:, 2]).astype(kind)), stats)
        texts.append(folder / f"{form}-{kind}")
        trace.write(str(texts[-1]), format=form)
    book = openpyxl.Workbook()
    for row in (["time [s]", "x [g]"], [0.0, 0.1], [0.01, 0.2], [0.02, 0.1]):
        book.active.append(row)
    book.save(folder / "a.xlsx")
    xr.Dataset({"tilt": ("run", np.linspace(0.0, 1.0, 5))}).to_netcdf(folder / "a.nc", engine="h5netcdf")
    found = [path.read_bytes() for path in (*texts, folder / "a.xlsx", folder / "a.nc")]
    found += [text.encode() for text in (OBJECTS, KNET, SLIST, GSE2 + "DAT2\n1 2 3 4 5 6\nCHK2 21\n\n", STATION)]
    return [*found, geopackage(), zipped(found[1:3]), tarred(found[1:3]), gzip.compress(found[0], mtime=0)]


def geopackage() -> bytes:
    """Return a GeoPackage with two objects, without geometry."""
    database = sqlite3.connect(":memory:")
    database.executescript("""
        PRAGMA application_id = 0x47504b47;
        CREATE TABLE gpkg_contents (table_name TEXT, data_type TEXT);
        CREATE TABLE gpkg_geometry_columns (table_name TEXT, column_name TEXT, srs_id INTEGER);
        CREATE TABLE gpkg_spatial_ref_sys (srs_id INTEGER, organization TEXT, organization_coordsys_id, definition);
        CREATE TABLE objects (fid INTEGER PRIMARY KEY, name TEXT, radius REAL);
        INSERT INTO gpkg_contents VALUES ('objects', 'attributes');
        INSERT INTO objects VALUES (1, 'urn', 0.1), (2, 'jar', 0.2);
    """)
    content = database.serialize()
    database.close()
    return content


def zipped(contents: list[bytes]) -> bytes:
    """Return a zip archive of these files."""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for place, content in enumerate(contents):
            archive.writestr(zipfile.ZipInfo(f"{place}{ENDINGS[place % len(ENDINGS)]}"), content)
    return packed.getvalue()


def tarred(contents: list[bytes]) -> bytes:
    """Return a tar archive of these files."""
    packed = io.BytesIO()
    with tarfile.open(fileobj=packed, mode="w") as archive:
        for place, content in enumerate(contents):
            member = tarfile.TarInfo(f"{place}.txt")
            member.size = len(content)
            archive.addfile(member, io.BytesIO(content))
    return packed.getvalue()


def body(draw: random.Random, whole: list[bytes]) -> bytes:
    """Return the content of a file: random, or one that is cut, changed, begun otherwise or packed."""
    kind = draw.random()
    if kind < 0.15:
        content = draw.randbytes(draw.choice((0, 1, 7, 64, 700, 5000)))
    elif kind < 0.25:
        content = "".join(draw.choices("0123456789.,;- eE\t\n\"'#azNPTS=", k=draw.choice((5, 60, 900)))).encode()
    else:
        content = changed(draw, draw.choice(whole))
    if draw.random() < 0.3:
        content = draw.choice(BEGINNINGS) + content[draw.choice((0, 4, 8, 12)) :]
    for _ in range(draw.choice((0, 0, 0, 0, 1, 2))):
        pack = draw.choice(
            (lambda one: gzip.compress(one, mtime=0), lambda one: zipped([one]), lambda one: tarred([one]))
        )
        content = pack(content) if draw.random() < 0.7 else changed(draw, pack(content))
    return content


def changed(draw: random.Random, content: bytes) -> bytes:
    """Return a content of which a part is missing, or some bytes differ."""
    if draw.random() < 0.3:
        return content[: draw.randrange(len(content) + 1)]
    found = bytearray(content)
    for _ in range(draw.choice((1, 1, 3, 20))):
        if found:
            place = draw.randrange(len(found))
            found[place : place + draw.choice((0, 1, 1, 4))] = draw.randbytes(draw.choice((0, 1, 1, 4)))
    return bytes(found)


def of_netcdf(path: Path) -> object:
    """Read a saved result."""
    return sb.load(path)


def of_response(path: Path) -> object:
    """Read a waveform with the file as its response."""
    return sb.read_record(path.with_name("counts.mseed"), response=path)


READERS = {
    "records": lambda path: sb.read_records(path, "m/s2"),
    "response": of_response,
    "inventory": read_inventory,
    "result": of_netcdf,
}


def main(number: int, seed: int) -> dict[str, object]:
    """Read `number` files by every reader; return counts, foreign exceptions, connections, and imported modules."""
    outcomes: Counter[str] = Counter()
    foreign: list[str] = []
    connections: list[str] = []
    socket.socket.connect = lambda _, address: connections.append(str(address))  # type: ignore[method-assign]
    warnings.simplefilter("ignore")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        whole = whole_files(folder)
        before = set(sys.modules)
        (folder / "counts.mseed").write_bytes(whole[3])
        for place in range(number):
            draw = random.Random(1000 * seed + place)  # noqa: S311  not for secrets
            content = whole[place] if place < len(whole) else body(draw, whole)  # first those that are whole
            ending = ".gpkg" if content.startswith(b"SQLite") else draw.choice(ENDINGS)
            path = folder / f"file{ending}"
            path.write_bytes(content)
            for reader, read in READERS.items():
                try:
                    read(path)
                    outcomes[f"{reader}: read"] += 1
                except StylobateError as error:
                    outcomes[f"{reader}: refused"] += 1
                    if "\n" in str(error).strip() and reader != "inventory":
                        foreign.append(f"{place} {reader}: several lines: {str(error)[:300]!r}")
                except Exception:  # noqa: BLE001  any other is a fault
                    foreign.append(f"{place} {reader}: {traceback.format_exc()[-600:]}")
            path.unlink()
    return {
        "outcomes": dict(sorted(outcomes.items())),
        "foreign": foreign,
        "connections": connections,
        "imported": sorted(set(sys.modules) - before),
    }


if __name__ == "__main__":
    print(json.dumps(main(int(sys.argv[1]), int(sys.argv[2])), indent=1))  # noqa: T201
