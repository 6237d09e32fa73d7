"""Archives, workbooks and waveform files: read like folders, in which a path names each component."""

import gzip
import io
import tarfile
import warnings
import zipfile

import numpy as np
import pytest
from numpy.testing import assert_allclose

import stylobate as sb
from stylobate.base_motions import Record
from stylobate.config.records import RecordMotion, relocated
from stylobate.errors import FileError, UnlikelyInputWarning, UnsupportedError
from stylobate.records.reading import write_at2

obspy = pytest.importorskip("obspy")
openpyxl = pytest.importorskip("openpyxl")

pytestmark = pytest.mark.filterwarnings("ignore:.*one horizontal component")

STEP = 0.01
TIMES = STEP * np.arange(400)
WAVES = np.stack([np.exp(-TIMES) * np.sin(rate * TIMES) for rate in (9.0, 7.0, 31.0)], axis=-1)
QUAKE = Record(samples=WAVES, step=STEP, name="quake")


def at2_files(folder):
    """Write the three components of a record and return their paths."""
    names = {"x": "RSN1_QUAKE_CLS000.AT2", "y": "RSN1_QUAKE_CLS090.AT2", "z": "RSN1_QUAKE_CLS-UP.AT2"}
    return [write_at2(QUAKE, folder / name, axis=axis) for axis, name in names.items()]


def zipped(path, members):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return path


def same_motion(record, samples=WAVES, rtol=1e-6):
    assert record.step == pytest.approx(STEP)
    assert_allclose(record.samples, samples, rtol=rtol, atol=1e-6)


@pytest.fixture
def archive(tmp_path):
    files = {f"download/{path.name}": path.read_bytes() for path in at2_files(tmp_path)}
    others = {
        "download/readme.txt": "About these records\nSee the page of the database.\n",
        "download/_SearchResults.csv": "1,2\n",
        "download/RSN1_QUAKE_CLS000.VT2": "velocities",
        "download/map.png": b"\x89PNG\r\n\x1a\n" + bytes(50),
        "__MACOSX/download/._RSN1_QUAKE_CLS000.AT2": b"\x00\x05",
    }
    return zipped(tmp_path / "peer.zip", files | others)


def test_an_archive_is_read_like_a_folder_and_other_files_in_it_are_listed(archive):
    with pytest.warns(UnlikelyInputWarning, match="2 files hold no record and are left out: map.png, readme.txt"):
        (record,) = sb.read_records(archive)
    same_motion(record, WAVES)
    assert record.name == "RSN1_QUAKE_CLS"
    assert record.provenance[0].startswith("read from peer.zip/download/RSN1_QUAKE_CLS000.AT2, in g as the file states")


def test_a_file_in_an_archive_has_a_path(archive):
    record = sb.read_record(archive / "download" / "RSN1_QUAKE_CLS090.AT2", axis="y")
    assert_allclose(record.samples[:, 1], WAVES[:, 1], rtol=1e-6, atol=1e-6)
    with pytest.raises(FileError, match=r"other\.AT2: peer\.zip has no such part\. It has download/RSN1_"):
        sb.read_record(archive / "other.AT2")
    part = archive / "download" / "RSN1_QUAKE_CLS000.AT2"
    (listed,) = sb.read_records([[part, archive / "download" / "RSN1_QUAKE_CLS090.AT2"]])
    assert listed.axes == ("x", "y")


def test_an_archive_in_an_archive_and_a_packed_file_in_it_are_read(tmp_path):
    inner = io.BytesIO()
    with tarfile.open(fileobj=inner, mode="w") as tar:
        for path in at2_files(tmp_path):
            tar.add(path, arcname=path.name)
    outer = zipped(tmp_path / "outer.zip", {"inner.tar.gz": gzip.compress(inner.getvalue())})
    (record,) = sb.read_records(outer)
    same_motion(record, WAVES)
    plain = tmp_path / "knet.tar.gz"
    plain.write_bytes(gzip.compress(inner.getvalue()))
    same_motion(sb.read_record(plain), WAVES)


def test_a_damaged_archive_and_one_of_empty_files_are_refused_in_one_line(tmp_path):
    files = {path.name: path.read_bytes() for path in at2_files(tmp_path)}
    whole = zipped(tmp_path / "whole.zip", files).read_bytes()
    damaged = tmp_path / "damaged.zip"
    damaged.write_bytes(whole[: len(whole) // 2])
    with pytest.raises(FileError, match=r"damaged\.zip: cannot be unpacked: it is damaged, .* read the folder$"):
        sb.read_records(damaged)
    with pytest.raises(FileError, match=r"empty\.zip.a\.txt: the file is empty"):
        sb.read_record(zipped(tmp_path / "empty.zip", {"a.txt": "", "b.txt": ""}))


def test_a_saved_record_of_an_archive_is_read_again_wherever_that_lies(archive, tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        (record,) = sb.read_records(archive)
    values = {"kind": "record", **record.origin.reading, "path": list(record.origin.reading["path"])}
    assert set(values["file_sha256"]) == {str(archive)}
    assert [*RecordMotion.parse(values).build().samples[:, 0]] == [*record.samples[:, 0]]
    elsewhere = tmp_path / "moved"
    elsewhere.mkdir()
    moved = archive.rename(elsewhere / archive.name)
    found = relocated(values, elsewhere)
    assert found["path"][0].startswith(str(moved))
    same_motion(RecordMotion.parse(found).build(), WAVES)
    zipped(moved, {"other": "1"})
    with pytest.raises(sb.errors.ParameterError, match="has changed since the result was saved"):
        RecordMotion.parse(found).build()


# Workbooks


def workbook(path, sheets):
    book = openpyxl.Workbook()
    book.remove(book.active)
    for title, rows in sheets.items():
        sheet = book.create_sheet(title)
        for row in rows:
            sheet.append(row)
    book.save(path)
    return path


ROWS = np.column_stack([TIMES, WAVES]).tolist()


def test_a_sheet_of_a_workbook_is_a_table(tmp_path):
    sheets = {"Data": [["Shaking table, run 7"], [], ["time [s]", "x [m/s²]", "y [m/s²]", "z [m/s²]"], *ROWS]}
    path = workbook(tmp_path / "book.xlsx", sheets)
    same_motion(sb.read_record(path), rtol=1e-15)
    notes = {"Notes": [["Date", "2026-11-28"], ["Sensor", "EpiSensor"]]}
    with pytest.warns(UnlikelyInputWarning, match=r"book\.xlsx: 1 file holds no record and is left out: Notes"):
        (record,) = sb.read_records(workbook(path, notes | sheets))
    same_motion(record, rtol=1e-15)
    same_motion(sb.read_record(path / "Data"), rtol=1e-15)


def test_a_cell_that_is_no_number_is_named_by_sheet_and_row(tmp_path):
    rows = [["", "time [s]", "x [m/s²]"], *([None, *row[:2]] for row in ROWS)]
    rows[5][2] = "broken"
    path = workbook(tmp_path / "book.xlsx", {"Run": [[None, *row[1:]] for row in rows]})
    with pytest.raises(FileError, match=r"book\.xlsx.Run, line 6: not a number: 'broken'"):
        sb.read_record(path)


def test_several_sheets_are_several_records(tmp_path):
    rows = [["time [s]", "x [g]"], *(row[:2] for row in ROWS)]
    path = workbook(tmp_path / "book.xlsx", {"first": rows, "second": rows})
    assert [one.name for one in sb.read_records(path)] == ["first", "second"]
    with pytest.raises(FileError, match=r"must hold one record, got 2: first, second\. Read them by read_records, or"):
        sb.read_record(path)


def test_without_openpyxl_a_workbook_names_the_extra(tmp_path, monkeypatch):
    path = workbook(tmp_path / "book.xlsx", {"a": ROWS})
    monkeypatch.setitem(__import__("sys").modules, "openpyxl", None)
    with pytest.raises(UnsupportedError, match=r'install openpyxl: pip install "stylobate\[excel\]"; or save its'):
        sb.read_record(path)


# Tables without names


def test_columns_without_names_are_time_and_components(tmp_path):
    path = tmp_path / "table.csv"
    for width in (3, 4):
        np.savetxt(path, np.array(ROWS)[:, :width], delimiter=",")
        record = sb.read_record(path, "m/s2")
        same_motion(record, WAVES * ([1.0, 1.0, 0.0] if width == 3 else 1.0))
        assert f"columns 2 to {width} as {'x, y' if width == 3 else 'x, y, z'}" in record.provenance[0]


def test_velocities_beside_an_acceleration_are_no_component(tmp_path):
    velocity = np.cumsum(WAVES[:, 0]) * STEP
    np.savetxt(tmp_path / "table.txt", np.column_stack([TIMES, WAVES[:, 0], velocity]))
    with pytest.raises(FileError, match=r"line 1: column 3 looks like the integral of column 2, a velocity"):
        sb.read_record(tmp_path / "table.txt", "m/s2")


# Waveforms

OF_COMPASS = WAVES * [1.0, -1.0, 1.0]  # x north, y west

BEGIN = obspy.UTCDateTime("2020-01-01T00:00:00")
CHANNELS = ("HNN", "HNE", "HNZ")


def stream(samples=WAVES, station="ANMO", kind="float64", begin=BEGIN):
    stats = {"network": "IU", "station": station, "location": "00", "delta": STEP, "starttime": begin}
    return obspy.Stream(
        [
            obspy.Trace(np.ascontiguousarray(column.astype(kind)), {**stats, "channel": name})
            for name, column in zip(CHANNELS, samples.T, strict=True)
        ]
    )


def saved(path, of):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # ObsPy's own
        of.write(str(path), format="MSEED")
    return path


def test_the_channels_of_a_station_are_one_record(tmp_path):
    path = saved(tmp_path / "event.mseed", stream())
    record = sb.read_record(path, "m/s2")
    same_motion(record, OF_COMPASS)
    assert record.name == "event"
    (again,) = sb.read_records(path, "m/s2")
    same_motion(again, OF_COMPASS)
    single = sb.read_record(path / "IU.ANMO.00.HNE", "m/s2")
    assert_allclose(single.samples[:, 0], WAVES[:, 1])
    with pytest.raises(sb.errors.ParameterError, match="axis must be left out for a file of several components"):
        sb.read_record(path, "m/s2", axis="x")


def test_several_stations_are_several_records(tmp_path):
    path = saved(tmp_path / "event.mseed", stream() + stream(2.0 * WAVES, "TUC"))
    first, second = sb.read_records(path, "m/s2")
    assert (first.name, second.name) == ("event IU.ANMO.00.HN", "event IU.TUC.00.HN")
    same_motion(second, 2.0 * OF_COMPASS)
    with pytest.raises(FileError, match=r"must hold one record, got 2: event IU\.ANMO\.00\.HN, event IU\.TUC"):
        sb.read_record(path, "m/s2")


def test_channels_that_begin_later_are_cut_to_the_common_time(tmp_path):
    later = stream()
    later[1].trim(BEGIN + 5 * STEP)
    record = sb.read_record(saved(tmp_path / "event.mseed", later), "m/s2")
    assert_allclose(record.samples, OF_COMPASS[5:], atol=1e-12)


def test_pieces_that_follow_one_another_are_joined_and_gaps_are_named(tmp_path):
    whole = stream()
    pieces = whole.slice(BEGIN, BEGIN + 1.0) + whole.slice(BEGIN + 1.0 + STEP, BEGIN + 10.0)
    same_motion(sb.read_record(saved(tmp_path / "pieces.mseed", pieces), "m/s2"), OF_COMPASS)
    gap = whole.slice(BEGIN, BEGIN + 1.0) + whole.slice(BEGIN + 3.0, BEGIN + 10.0)
    path = saved(tmp_path / "gap.mseed", gap)
    with pytest.raises(FileError) as raised:
        sb.read_record(path, "m/s2")
    where = "after 2020-01-01T00:00:01.000000Z. Fill it, or cut the record beside it"
    assert str(raised.value) == f"{path}: IU.ANMO.00.HNE has a gap of 1.99 s {where}"


def station_xml(path, units="M/S**2", sensitivity=1000.0, azimuths=(10.0, 100.0)):
    """Write the responses of the channels, the horizontal ones at these azimuths."""
    from obspy.core.inventory import Channel, Inventory, Network, Response, Station
    from obspy.core.inventory.response import InstrumentSensitivity

    channels = []
    for name in CHANNELS:
        overall = InstrumentSensitivity(sensitivity, 1.0, units, "COUNTS")
        place = {"latitude": 0.0, "longitude": 0.0, "elevation": 0.0, "depth": 0.0}
        azimuth, dip = {"HNN": (azimuths[0], 0.0), "HNE": (azimuths[1], 0.0), "HNZ": (0.0, -90.0)}[name]
        response = Response(instrument_sensitivity=overall)
        channels.append(Channel(name, "00", **place, azimuth=azimuth, dip=dip, response=response))
    station = Station("ANMO", 0.0, 0.0, 0.0, channels=channels)
    Inventory(networks=[Network("IU", stations=[station])], source="test").write(str(path), format="STATIONXML")
    return path


def test_counts_are_no_acceleration_without_a_response(tmp_path):
    counts = np.round(1000.0 * WAVES)
    path = saved(tmp_path / "raw.mseed", stream(counts, kind="int32"))
    with pytest.raises(
        FileError, match=r"IU\.ANMO\.00\.HNE has raw counts of a digitizer, no accelerations\. State resp"
    ):
        sb.read_record(path, "g")
    response = station_xml(tmp_path / "station.xml")
    record = sb.read_record(path, response=response)
    assert record.provenance[-1].startswith("x at azimuth 10°, from IU.ANMO.00.HNN; y at azimuth 280°")
    same_motion(record, np.array(counts * [1e-3, -1e-3, 1e-3]))
    (again,) = sb.read_records(path, response=response)
    same_motion(again, record.samples)
    rebuilt = RecordMotion.parse({"kind": "record", **record.origin.reading}).build()
    same_motion(rebuilt, record.samples)


def test_responses_of_other_stations_and_of_velocities_are_refused(tmp_path):
    path = saved(tmp_path / "raw.mseed", stream(np.round(1000.0 * WAVES), kind="int32"))
    velocity = station_xml(tmp_path / "velocity.xml", units="M/S")
    with pytest.raises(FileError, match=r"velocity\.xml: IU\.ANMO\.00\.HNE responds to m/s, not to acceleration\."):
        sb.read_record(path, response=velocity)
    other = saved(tmp_path / "other.mseed", stream(np.round(1000.0 * WAVES), "TUC", "int32"))
    with pytest.raises(FileError, match=r"station\.xml: no response of IU\.TUC\.00\.HNE at 2020-01-01"):
        sb.read_record(other, response=station_xml(tmp_path / "station.xml"))
    with pytest.raises(FileError, match=r"missing\.xml: no response can be read: it is missing"):
        sb.read_record(path, response=tmp_path / "missing.xml")


@pytest.mark.parametrize("stated", ["INF", "1e400", "NaN", "0", "", "x"])
def test_a_sensitivity_that_is_no_number_is_refused(tmp_path, stated):
    path = saved(tmp_path / "raw.mseed", stream(np.round(1000.0 * WAVES), kind="int32"))
    response = station_xml(tmp_path / "station.xml")
    text = response.read_text()
    assert text.count("<Value>1000.0</Value>") == 3
    response.write_text(text.replace("<Value>1000.0</Value>", f"<Value>{stated}</Value>"))
    with pytest.raises(
        FileError, match=r"station\.xml: the sensitivity of IU\.ANMO\.00\.HN. must be a finite number oth"
    ):
        sb.read_record(path, response=response)


@pytest.mark.parametrize("begin", ["<!DOCTYPE FDSNStationXML>", "<other>", "", "made up"])
def test_a_response_is_read_from_station_xml_only(tmp_path, begin):
    path = saved(tmp_path / "raw.mseed", stream(np.round(1000.0 * WAVES), kind="int32"))
    response = station_xml(tmp_path / "station.xml")
    first, rest = response.read_text().partition("<FDSNStationXML")[::2]
    response.write_text(first + begin + "<FDSNStationXML" * begin.startswith("<!") + rest)
    with pytest.raises(FileError, match=r"station\.xml: no StationXML: it does not begin with FDSNStationXML"):
        sb.read_record(path, response=response)


# Folders


def test_what_is_no_record_in_a_folder_is_left_out_with_a_list_and_a_damaged_record_is_not(tmp_path):
    folder = tmp_path / "quakes"
    folder.mkdir()
    at2_files(folder)
    (folder / "readme.txt").write_text("Three components\nof a record, 1990\n")
    (folder / "stations.csv").write_text("station,latitude,longitude\n1,37.0,-122.0\n2,38.0,-121.0\n")
    (folder / "report.pdf").write_bytes(b"%PDF-1.7\x00\x01")
    (folder / "old.xls").write_bytes(b"\xd0\xcf\x11\xe0" + bytes(40))
    with pytest.warns(
        UnlikelyInputWarning, match=r"quakes: 4 files .* left out: old\.xls, readme\.txt, report\.pdf, stations\.csv$"
    ):
        (record,) = sb.read_records(folder)
    same_motion(record, WAVES)
    cut = folder / "RSN2_QUAKE_ABC000.AT2"
    cut.write_text((folder / "RSN1_QUAKE_CLS000.AT2").read_text()[:3000])
    with (
        pytest.warns(UnlikelyInputWarning, match="left out"),
        pytest.raises(FileError, match="the header states 400 samples"),
    ):
        sb.read_records(folder)
    for path in folder.iterdir():
        if path.suffix.lower() == ".at2":
            path.unlink()
    with pytest.raises(FileError, match=r"old\.xls: an Excel workbook of the old form"):
        sb.read_records(folder)
    with pytest.raises(FileError, match=r"report\.pdf: a PDF document"):
        sb.read_records([folder / "report.pdf"])
