"""Files and folders as the strong-motion databases deliver them: PEER, and ESM and ITACA."""

import numpy as np
import pytest

import stylobate as sb
from stylobate.column.numbers import STANDARD_GRAVITY
from stylobate.errors import FileError
from stylobate.records import RecordFormat

VALUES = np.random.default_rng(11).normal(scale=0.1, size=23)
NUMBERS = "\n".join(" ".join(f"{value:.7E}" for value in VALUES[at : at + 5]) for at in range(0, len(VALUES), 5))
LINES = ("PEER NGA DATABASE RECORD", "Some Quake, 1/2/1990, Some Site, 90", "ACCELERATION TIME SERIES IN UNITS OF G")
COUNT = f"NPTS= {len(VALUES)}, DT= .0050 SEC"


def at2(*lines):
    return "\n".join((*lines, NUMBERS)) + "\n"


def asc(values, stream="HNE", **changes):
    header = {
        "EVENT_NAME": "Some Quake",
        "EVENT_DATE_YYYYMMDD": "19900102",
        "EVENT_TIME_HHMMSS": "134128",
        "MAGNITUDE_W": "",
        "NETWORK": "AB",
        "STATION_CODE": "CDE",
        "VS30_M/S": "",
        "EARTHQUAKE_BACKAZIMUTH_DEGREE": "244.0",
        "SAMPLING_INTERVAL_S": "0.005000",
        "NDATA": str(len(values)),
        "STREAM": stream,
        "UNITS": "cm/s^2",
        "PGA_CM/S^2": "1.326285",
        "HEADER_FORMAT": "DYNA 1.2",
        "DATA_TYPE": "ACCELERATION",
        "ORIGINAL_DATA_CREATOR": "network: none",
        "USER5": "",
    }
    lines = [f"{key}: {value}" for key, value in (header | changes).items() if value is not None]
    return "\n".join([*lines, *(f"{value:.8f}" for value in values)]) + "\n"


def written(folder, content, name):
    path = folder / name
    path.write_text(content)
    return path


@pytest.mark.parametrize(
    ("content", "state"), [(at2(), "no header"), (at2(*LINES), "incomplete header")], ids=["none", "no NPTS"]
)
@pytest.mark.parametrize("asked", [None, RecordFormat.AT2])
def test_an_at2_file_without_its_header_is_refused_or_read_with_the_step_that_is_given(tmp_path, content, state, asked):
    path = written(tmp_path, content, "a000.AT2")
    with pytest.raises(FileError) as raised:
        sb.read_record(path, "g", format=asked)
    what = "the line with NPTS and DT is missing. Restore it, or state step, in s, and units"
    assert str(raised.value) == f"{path}, line 1: {state} of an AT2 file: {what}"
    record = sb.read_record(path, "g", step=0.005, format=asked)
    whole = sb.read_record(written(tmp_path, at2(*LINES, COUNT), "whole.AT2"))
    assert record == whole


def test_times_and_accelerations_called_at2_are_read_as_such(tmp_path):
    rows = "\n".join(f"{0.01 * at:.2f} {value:.6f}" for at, value in enumerate(VALUES))
    record = sb.read_record(written(tmp_path, rows, "a.AT2"), "m/s2", step=0.01)
    np.testing.assert_allclose(record.samples[:, 0], VALUES, atol=1e-6)


@pytest.fixture
def download(tmp_path):
    for direction, factor in (("000", 1.0), ("090", 2.0)):
        for ending, kind, unit in (
            ("AT2", "ACCELERATION", "G"),
            ("VT2", "VELOCITY", "CM/S"),
            ("DT2", "DISPLACEMENT", "CM"),
        ):
            body = "\n".join(f"{factor * value:.7E}" for value in VALUES)
            lines = (
                LINES[0],
                f"Some Quake, 1/2/1990, Some Site, {direction}",
                f"{kind} TIME SERIES IN UNITS OF {unit}",
            )
            written(tmp_path, "\n".join((*lines, COUNT, body)) + "\n", f"RSN1_QUAKE_AB{direction}.{ending}")
    written(tmp_path, "-- Summary of Metadata of Selected Records --\nResult ID,Scale\n1,1.0\n", "_SearchResults.csv")
    return tmp_path


def test_a_peer_download_is_read_as_it_is(download):
    from stylobate.config import RecordsConfig

    (record,) = sb.read_records(download)
    assert (record.name, record.axes) == ("RSN1_QUAKE_AB", ("x", "y"))
    np.testing.assert_allclose(record.samples[:, 0], STANDARD_GRAVITY * VALUES, atol=1e-6)
    (built,) = RecordsConfig(source=str(download)).build().values()
    (pattern,) = RecordsConfig(source=str(download / "RSN1_*")).build().values()
    assert built == record == pattern


def test_velocities_alone_are_refused_with_the_remedy(download):
    path = download / "RSN1_QUAKE_AB000.VT2"
    with pytest.raises(FileError) as raised:
        sb.read_record(path)
    what = "the file holds velocity, not acceleration. Read the .AT2 file of this component"
    assert str(raised.value) == f"{path}, line 3: {what}"
    for other in download.iterdir():
        if other != path:
            other.unlink()
    with pytest.raises(FileError, match="holds velocity, not acceleration"):
        sb.read_records(download)


def test_esm_files_tell_step_unit_and_direction(tmp_path):
    values = 100.0 * VALUES
    expected = 0.01 * np.round(values, 8)
    for stream, axis, note in (("HNE", 0, "azimuth 90° along x"), ("HGZ", 2, "up along z")):
        name = f"AB.CDE..{stream}.D.EMSC-1990.ACC.MP.ASC"
        record = sb.read_record(written(tmp_path, asc(values, stream), name))
        np.testing.assert_allclose(record.samples[:, axis], expected, rtol=1e-14)
        assert (record.step, record.axes) == (0.005, ("xyz"[axis],))
        assert f"in cm/s² as the file states: Some Quake, 1990-01-02 134128, AB.CDE, {stream}" in record.provenance[0]
        assert note in record.provenance
    assert sb.read_record(tmp_path / name, format=RecordFormat.ASC) == record


def test_a_stream_without_a_compass_letter_points_nowhere(tmp_path):
    record = sb.read_record(written(tmp_path, asc(VALUES, "HN3"), "a.asc"))
    assert record.axes == ("x",)
    assert len(record.provenance) == 1


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"NDATA": "24"}, r"line 40: the header states 24 samples, the file has 23"),
        ({"NDATA": "many"}, r"line 10: NDATA must be a whole number, got 'many'"),
        ({"SAMPLING_INTERVAL_S": "0"}, r"line 9: SAMPLING_INTERVAL_S must be positive, got 0.0"),
        ({"SAMPLING_INTERVAL_S": None}, r"line 1: incomplete header of an ASC file: SAMPLING_INTERVAL_S is missing"),
        ({"UNITS": "stone"}, r"line 12: unknown unit 'stone'"),
        ({"UNITS": ""}, r"names no unit: state units"),
        ({"DATA_TYPE": "VELOCITY"}, r"line 15: the file holds velocity, not acceleration. Read the file .* with ACC"),
    ],
)
def test_a_broken_esm_file_gets_one_clear_line(tmp_path, changes, message):
    with pytest.raises(FileError, match=message):
        sb.read_record(written(tmp_path, asc(VALUES, **changes), "a.ASC"))
