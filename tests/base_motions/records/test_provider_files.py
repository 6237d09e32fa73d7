"""Files as providers and colleagues send them: read without options, or refused in one line that states what to do."""

import gzip
import re
import tarfile
import zipfile

import numpy as np
import pytest
from tests.base_motions.records.test_agencies import THREE, cosmos, geonet, volume_1, volume_2
from tests.base_motions.records.test_containers import ROWS, WAVES, at2_files, saved, stream, workbook
from tests.base_motions.records.test_databases import asc
from tests.base_motions.records.test_reading import KNET

import stylobate as sb
from stylobate.errors import StylobateError

pytestmark = [
    pytest.mark.filterwarnings("ignore::stylobate.errors.UnlikelyInputWarning"),
    pytest.mark.filterwarnings("ignore::UserWarning"),  # ObsPy's own
]


def peer_download(folder):
    """A zip of AT2 files with velocities, search results and a readme."""
    with zipfile.ZipFile(folder / "PEERNGARecords_Unscaled.zip", "w") as archive:
        for path in at2_files(folder):
            archive.writestr(path.name, path.read_bytes())
            archive.writestr(path.with_suffix(".VT2").name, "velocities")
            path.unlink()
        archive.writestr("_SearchResults.csv", "Record,Scale\n1,1.0\n")
        archive.writestr("_readME.txt", "Records of the PEER database\n")


def esm_download(folder):
    for channel in ("HNE", "HNN", "HNZ"):
        (folder / f"AB.CDE.00.{channel}.D.X.ACC.MP.ASC").write_text(asc(WAVES[:, 0], stream=channel))


def knet_download(folder):
    with tarfile.open(folder / "AKT0239608110312.tar", "w") as archive:
        for direction, name in (("N-S", "NS"), ("E-W", "EW"), ("U-D", "UD")):
            path = folder / f"AKT0239608110312.{name}"
            path.write_text(KNET.replace("U-D", direction))
            archive.add(path, arcname=path.name)
            path.unlink()


def of_directions(*directions):
    """Return the channels of a station, each with its direction."""
    return list(zip(directions, THREE, strict=False))


def text(name, content):
    return lambda folder: (folder / name).write_text(content)


def table(header, columns, between=","):
    return "\n".join([*header, *(between.join(f"{value:.6g}" for value in row[:columns]) for row in ROWS)]) + "\n"


NAMED = [["Shaking table"], ["time [s]", "NS [g]", "EW [g]", "UD [g]"], *ROWS]
COUNTS = np.round(1e4 * WAVES)
READ = {
    "PEER: a zip of a search": (peer_download, "xyz"),
    "ESM: three ASC files": (esm_download, "xyz"),
    "K-NET: a tar of three files": (knet_download, "xyz"),
    "CESMD: COSMOS V2": (
        text("abc.V2c", "".join(cosmos(some, at) for some, at in zip(THREE, (90, 400, 180), strict=True))),
        "xyz",
    ),
    "CGS: CSMIP V1": (text("CE89146.V1", volume_1(of_directions("360 Deg", " UP", "90 Deg"))), "xyz"),
    "CGS: CSMIP V2": (text("CE89146.V2", volume_2(of_directions("360 Deg", " UP", "90 Deg"))), "xyz"),
    "GeoNet: V2A": (text("20180212_WPWS.V2A", geonet(of_directions("S16W", "S74E", "Up"), form="(10F8.3)")), "xyz"),
    "a workbook": (lambda folder: workbook(folder / "table.xlsx", {"Data": NAMED, "Notes": [["a note"]]}), "xyz"),
    "SeismoSignal: tabs and units": (
        text("export.txt", table(["Time [sec]\tAcceleration [g]"], 2, "\t")),
        "x",
    ),
    "a table packed with gzip": (
        lambda folder: (folder / "table.csv.gz").write_bytes(
            gzip.compress(table(["time [s],x [m/s²],y [m/s²]"], 3).encode())
        ),
        "xy",
    ),
}
REFUSED = {
    "miniSEED of raw counts": (
        lambda folder: saved(folder / "raw.mseed", stream(COUNTS, kind="int32")),
        r"raw\.mseed: IU\.ANMO\.00\.HNE has raw counts of a digitizer, no accelerations\. State response",
    ),
    "a headerless table without units": (
        text("table.csv", table([], 4)),
        r'table\.csv: the file names no unit: state units, "g", "m/s²"',
    ),
    "CSMIP V3: spectra": (
        text("CE89146.V3", "Response and Fourier spectra (78 periods)   for\n" + volume_2(of_directions("360 Deg"))),
        r"line 1: the file holds spectra, no accelerations\. Read the V2 file of this record",
    ),
    "COSMOS V0: counts": (
        text("raw.V0c", cosmos(np.round(1e3 * WAVES[:40, 0]).astype(int), 90, unit="counts(50)", form="(10I8)")),
        r"raw counts of a digitizer, no accelerations\. Read the V1 or V2 file of this record",
    ),
}


@pytest.mark.parametrize("name", READ)
def test_it_is_read_without_options(name, tmp_path):
    write, axes = READ[name]
    write(tmp_path)
    (record,) = sb.read_records(tmp_path)
    assert "".join(record.axes) == axes
    assert record.peak_horizontal() > 0.0
    assert record.origin.reading["file_sha256"]


@pytest.mark.parametrize("name", REFUSED)
def test_it_is_refused_in_one_line_that_states_what_to_do(name, tmp_path):
    write, line = REFUSED[name]
    write(tmp_path)
    with pytest.raises(StylobateError) as raised:
        sb.read_records(tmp_path)
    assert re.search(line, str(raised.value))
    assert "\n" not in str(raised.value)
