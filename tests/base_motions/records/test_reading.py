"""Files to records: every format, and what is said of broken ones."""

import gzip
import math
import re
import sys

import numpy as np
import pytest

import stylobate as sb
from stylobate.column.numbers import STANDARD_GRAVITY
from stylobate.errors import FileError, ParameterError, UnlikelyInputWarning, UnsupportedError
from stylobate.records import RecordFormat, write_at2, write_csv

VALUES = np.array([0.0, 0.1, -0.25, 0.03125, 1e-4, -2e-5, 0.5])
NEW = """PEER NGA STRONG MOTION DATABASE RECORD
Some Quake, 1/2/1990, Some Site, 90
ACCELERATION TIME SERIES IN UNITS OF G
NPTS=      7, DT=   .0050 SEC,
   .0000000E+00   .1000000E+00  -.2500000E+00   .3125000E-01   .1000000E-03
  -.2000000E-04   .5000000E+00
"""
OLD = NEW.replace("NPTS=      7, DT=   .0050 SEC,", "      7    0.0050    NPTS, DT").replace("SERIES", "HISTORY")
TABLE = "".join(f"{0.02 * i:.4f} {value}\n" for i, value in enumerate(VALUES))


def written(folder, name, content):
    path = folder / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


@pytest.mark.parametrize(
    "content", [NEW, OLD, NEW.replace("\n", "\r\n"), "\ufeff" + NEW], ids=["new", "old", "crlf", "bom"]
)
@pytest.mark.parametrize("packed", [False, True])
def test_at2_files_of_both_kinds_are_read(tmp_path, content, packed):
    raw = content.encode()
    path = written(tmp_path, "a.AT2.gz" if packed else "a.AT2", gzip.compress(raw) if packed else raw)
    record = sb.read_record(path)
    np.testing.assert_allclose(record.samples[:, 0], VALUES * STANDARD_GRAVITY, rtol=1e-15)
    assert (record.step, record.start, record.name, record.axes) == (0.005, 0.0, "a", ("x",))
    assert record.provenance[0].endswith("in g as the file states: Some Quake, 1/2/1990, Some Site, 90")


def test_a_vertical_component_acts_along_z(tmp_path):
    up = sb.read_record(written(tmp_path, "a.at2", NEW.replace("Site, 90", "Site, UP")))
    down = sb.read_record(written(tmp_path, "b.at2", NEW.replace("Site, 90", "Site, DWN")))
    assert up.axes == ("z",)
    np.testing.assert_array_equal(down.samples, -up.samples)
    assert sb.read_record(tmp_path / "a.at2", axis="y").axes == ("y",)


@pytest.mark.parametrize(
    ("units", "factor"),
    [
        ("g", STANDARD_GRAVITY),
        ("m/s²", 1.0),
        ("m/s2", 1.0),
        ("cm/s²", 0.01),
        ("cm/s2", 0.01),
        ("Gal", 0.01),
        ("mm/s2", 0.001),
    ],
)
def test_units_are_those_that_are_given(tmp_path, units, factor):
    record = sb.read_record(written(tmp_path, "a.txt", TABLE), units)
    np.testing.assert_allclose(record.samples[:, 0], VALUES * factor, rtol=1e-15)
    assert record.step == 0.02


def test_units_are_never_guessed(tmp_path):
    path = written(tmp_path, "a.txt", TABLE)
    with pytest.raises(FileError, match=r'a\.txt: the file names no unit: state units, "g", "m/s²"'):
        sb.read_record(path)
    with pytest.raises(ParameterError, match=r"units must be .* got 'furlong'"):
        sb.read_record(path, "furlong")
    with pytest.raises(ParameterError, match=r"units must be left out or 'g', which the file states, got 'm/s2'"):
        sb.read_record(written(tmp_path, "a.at2", NEW), "m/s2")


def test_a_single_column_needs_its_step(tmp_path):
    path = written(tmp_path, "a.txt", "# remark\n" + "\n".join(map(str, VALUES)))
    assert sb.read_record(path, "g", step=0.01).duration == pytest.approx(0.06)
    with pytest.raises(FileError, match=r"a\.txt, line 2: a single column has no time step: state step, in s"):
        sb.read_record(path, "g")


def test_csv_columns_are_found_by_name(tmp_path):
    rows = "\n".join(f"{0.1 * i},{i},{-i},{2 * i}" for i in range(5))
    path = written(tmp_path, "a.csv", f"Time (s),North (cm/s2),West (cm/s2),Up (cm/s2)\n{rows}\n")
    columns = {"time": "Time", "x": "North", "z": "Up"}
    record = sb.read_record(path, columns=columns)
    np.testing.assert_allclose(record.samples, 0.01 * np.outer(np.arange(5), [1.0, 0.0, 2.0]), rtol=1e-15)
    assert record.step == 0.1
    # x north, y west: columns that are called by directions need no `columns`
    np.testing.assert_allclose(
        sb.read_record(path).samples, 0.01 * np.outer(np.arange(5), [1.0, -1.0, 2.0]), rtol=1e-15
    )
    unnamed = written(tmp_path, "b.csv", f"Time (s),One (cm/s2),Two (cm/s2),Three (cm/s2)\n{rows}\n")
    with pytest.raises(
        FileError, match=r"b\.csv, line 1: which of Time, One, Two, Three is the acceleration\? state columns"
    ):
        sb.read_record(unnamed)
    with pytest.raises(FileError, match=r"line 1: no column 'East' for 'x': the columns are Time, North, West, Up"):
        sb.read_record(path, columns={"x": "East"})


def test_a_csv_file_with_one_acceleration_needs_no_names(tmp_path):
    path = written(tmp_path, "a.csv", "t;accel\n0.0;1.0\n0.5;2.0\n1.0;3.0\n")
    np.testing.assert_array_equal(sb.read_record(path, "m/s2").samples[:, 0], [1.0, 2.0, 3.0])


@pytest.mark.parametrize("names", ["t,a,v,d", "time,acc,L,T", "time,Acceleration,x,V", "t,a,x,y"])
def test_a_column_that_is_called_acceleration_wins_over_single_letters(tmp_path, names):
    columns = names.split(",")
    rows = "\n".join(
        ",".join(f"{0.01 * at}" if at_column == 0 else f"{at + 10.0 * at_column}" for at_column in range(len(columns)))
        for at in range(3)
    )
    record = sb.read_record(written(tmp_path, "a.csv", f"{names}\n{rows}\n"), "m/s2")
    np.testing.assert_array_equal(record.samples[:, 0], [10.0, 11.0, 12.0])
    assert not record.samples[:, 1:].any()


@pytest.mark.parametrize(
    ("names", "filled"),
    [
        ("t,N,E,Z", (0, 1, 2)),
        ("t,L,T,V", (0, 1, 2)),
        ("t,L,T", (0, 1)),
        ("t,NS,V", (0, 2)),
        ("t,V", (2,)),
        ("t,N,E,Z,V", (0, 1, 2)),
    ],
)
def test_single_letters_that_fit_together_are_directions(tmp_path, names, filled):
    rows = "\n".join(",".join(f"{0.01 * at}" for _ in names.split(",")) for at in range(3))
    record = sb.read_record(written(tmp_path, "a.csv", f"{names}\n{rows}\n"), "m/s2")
    assert tuple(np.flatnonzero(record.samples.any(axis=0))) == filled


OPEN = (
    "t,v,d",
    "t,accel_g,v,d",
    "t,acc,NS,EW",
    "t,acc,acc_NS",
    "t,a,ax,ay",
    "t,acc,acceleration",
    "t,x,y,UD",
    "t,x,NS",
    "t,N,E,Z,UD",
)


@pytest.mark.parametrize("names", OPEN)
def test_columns_that_leave_the_acceleration_open_are_refused(tmp_path, names):
    rows = "\n".join(",".join(f"{0.01 * at}" for _ in names.split(",")) for at in range(3))
    with pytest.raises(FileError, match=r"line 1: which of .* is the acceleration\? state columns"):
        sb.read_record(written(tmp_path, "a.csv", f"{names}\n{rows}\n"), "m/s2")


@pytest.mark.parametrize(
    ("names", "same", "remedy"),
    [
        ("time,x,x", "'x', 'x'", "Rename or remove one"),
        ("time,x,X,y", "'x', 'X'", "State columns, or rename or remove one"),
        ("time,x,ax", "'x', 'ax'", "State columns, or rename or remove one"),
        ("time,y,z,z", "'z', 'z'", "Rename or remove one"),
        ("time,z,z", "'z', 'z'", "Rename or remove one"),
        ("time,NS,NS", "'NS', 'NS'", "Rename or remove one"),
        ("time,NS,N", "'NS', 'N'", "State columns, or rename or remove one"),
        ("time,N,S", "'N', 'S'", "State columns, or rename or remove one"),
        ("time,N,N", "'N', 'N'", "Rename or remove one"),
        ("time,NS,EW,acc_EW", "'EW', 'acc_EW'", "State columns, or rename or remove one"),
        ("time,L,T,L", "'L', 'L'", "Rename or remove one"),
        ("time,a_090,a_270", "'a_090', 'a_270'", "State columns, or rename or remove one"),
    ],
)
def test_no_component_is_dropped_for_another_column_of_the_same_meaning(tmp_path, names, same, remedy):
    rows = "\n".join(",".join(f"{0.01 * at}" for _ in names.split(",")) for at in range(3))
    path = written(tmp_path, "a.csv", f"{names}\n{rows}\n")
    with pytest.raises(FileError) as raised:
        sb.read_record(path, "m/s2")
    assert str(raised.value) == f"{path}, line 1: columns for one component: {same}. {remedy}"


def test_stated_columns_choose_between_columns_of_the_same_meaning(tmp_path):
    path = written(tmp_path, "a.csv", "time,NS,N,N\n0,1,2,3\n0.01,1,2,3\n")
    assert sb.read_record(path, "m/s2", columns={"time": "time", "x": "NS"}).samples[:, 0].tolist() == [1.0, 1.0]
    with pytest.raises(FileError, match=r"columns for one component: 'N', 'N'\. Rename or remove one"):
        sb.read_record(path, "m/s2", columns={"time": "time", "x": "N"})


@pytest.mark.parametrize("names", ["time,x,y,disp_x,disp_y", "time,x,v,v_x", "time,NS,UD,V", "time,acc,v,v"])
def test_columns_of_other_quantities_leave_the_components_alone(tmp_path, names):
    rows = "\n".join(",".join(f"{0.01 * at}" for _ in names.split(",")) for at in range(3))
    assert len(sb.read_record(written(tmp_path, "a.csv", f"{names}\n{rows}\n"), "m/s2").samples) == 3


def test_writing_and_reading_csv_restores_every_number(tmp_path):
    samples = np.random.default_rng(3).normal(size=(50, 3))
    record = sb.Record(samples=samples, step=0.02, start=1.0)
    back = sb.read_record(write_csv(record, tmp_path / "r.csv"))
    np.testing.assert_array_equal(back.samples, samples)
    assert (back.step, back.start) == (0.02, 1.0)


@pytest.mark.parametrize("axis", ["x", "z"])
def test_writing_and_reading_at2_restores_eight_digits(tmp_path, axis):
    record = sb.Record(samples=np.random.default_rng(3).normal(size=(52, 3)), step=0.004)
    back = sb.read_record(write_at2(record, tmp_path / "r.at2", axis=axis))
    index = "xyz".index(axis)
    np.testing.assert_allclose(back.samples[:, index], record.samples[:, index], rtol=1e-7)
    assert back.axes == (axis,)
    assert back.step == 0.004


BROKEN = {
    "short": (
        NEW.replace("  -.2000000E-04   .5000000E+00\n", ""),
        None,
        r"line 5: the header states 7 samples, the file has 5\. Download the file again, or correct the count in",
    ),
    "long": (NEW + " .1 .2\n", None, r"line 7: the header states 7 samples, the file has 9"),
    "token": (NEW.replace("-.2000000E-04", "-.2oo0000E-04"), None, r"line 6: not a number: '-.2oo0000E-04'"),
    "nan": (NEW.replace(".5000000E+00", "NaN"), None, r"line 6: not a finite number: 'NaN'\. Replace it by"),
    "count": (NEW.replace("NPTS=      7", "NPTS=    7.5"), None, r"line 4: NPTS must be a whole number, got '7.5'"),
    "none": (
        NEW.replace("NPTS=      7", "NPTS=      1"),
        None,
        r"line 4: NPTS must be at least 2 samples, got 1",
    ),
    "no step": (NEW.replace(".0050", ""), None, r"line 4: the time step DT is missing"),
    "step": (NEW.replace(".0050", "0.000"), None, r"line 4: the time step DT must be positive, got 0.0"),
    "velocity": (NEW.replace("ACCELERATION", "VELOCITY"), None, r"line 3: the file holds velocity, not acceleration"),
    "unit": (NEW.replace("OF G", "OF STONE"), None, r"line 3: unknown unit 'STONE'"),
    "empty": ("\n \n", "g", r": the file is empty"),
    "remarks": ("# nothing\n", "g", r": the file has no numbers"),
    "uneven": (
        TABLE.replace("0.0800", "0.0850"),
        "g",
        r"line 5: unequal time steps: 0.06 s to 0.085 s is 0.025 s, most are 0.02 s",
    ),
    "backwards": ("0 1\n0 2\n0 3\n", "g", r"line 2: unequal time steps"),
    "ragged": (TABLE + "0.14\n", "g", r"line 8: 1 columns, the lines before have 2"),
    "wide": (
        "0 1 2 3 4\n1 2 3 4 5\n",
        "g",
        r"line 1: 5 columns: one \(acceleration\) to four \(time, x, y, z\) are expected",
    ),
    "word": (TABLE.replace("-0.25", "minus"), "g", r"line 3: not a number: 'minus'"),
    "one": ("0.0 1.0\n", "g", r"line 1: the file is too short: one sample"),
    "csv": ("time,x\n0,1\n1,2,3\n", "g", r"line 3: 3 columns, the first line names 2"),
    "csv units": ("time,x [g],y [m/s2]\n0,1,1\n1,2,2\n", None, r"line 1: columns of different units"),
    "csv unit": (
        "time,x [stone]\n0,1\n1,2\n",
        None,
        r"line 1: unknown unit 'stone'\. Give accelerations in .g., .m/s²",
    ),
    "csv time": ("x [g],y [g]\n0,1\n1,2\n", None, r"line 1: no column of times: state step"),
    "csv milli": (
        "time,x [mg],y [g]\n0,1,1\n1,2,1\n",
        None,
        r"line 1: unknown unit 'mg'\. Give accelerations in .g., ",
    ),
    "huge": (
        TABLE.replace("0.5", "1e300"),
        "g",
        r": a peak must be between 0 and 1e\+30, got 1e\+300. Check the numbers",
    ),
    "huge step": (
        NEW.replace(".0050", "1e200"),
        None,
        r": a time step \[s\] must be between 1e-09 and 1e\+06, got 1e\+200. Check",
    ),
    "csv token": ("time,x [g]\n0,1\n1,two\n", None, r"line 3: not a number: 'two'"),
}


# A sentence of its own, which begins with a verb, or "state" what is missing.
REMEDY = re.compile(r"\. [A-Z][a-z]+ |[:?] state ")


@pytest.mark.parametrize(("content", "units", "message"), BROKEN.values(), ids=BROKEN)
def test_a_broken_file_gets_one_clear_line(tmp_path, content, units, message):
    path = written(tmp_path, "broken.txt", content)
    with pytest.raises(FileError, match=message) as raised:
        sb.read_record(path, units)
    assert str(raised.value).startswith(str(path))
    assert "\n" not in str(raised.value)
    assert REMEDY.search(str(raised.value).removeprefix(str(path)))


def test_files_that_cannot_be_opened_are_named(tmp_path):
    with pytest.raises(FileError, match=r"\*\.AT2: cannot be read.*Read folders and patterns with read_records"):
        sb.read_record(tmp_path / "*.AT2")
    with pytest.raises(
        FileError, match=r"cannot be read: Is a directory\. Read folders and patterns with read_records"
    ):
        sb.read_record(tmp_path)
    with pytest.raises(FileError, match=r"none\.txt: cannot be read: No such file"):
        sb.read_record(tmp_path / "none.txt", "g")
    cut = written(tmp_path, "cut.gz", gzip.compress(NEW.encode())[:60])
    with pytest.raises(FileError, match=r"cut\.gz: cannot be read: .*\. Download the file again$"):
        sb.read_record(cut)


@pytest.mark.parametrize("name", ["quake.AT2", "quake.at2.gz"])
@pytest.mark.parametrize("asked", [None, RecordFormat.AT2])
def test_bytes_that_are_called_at2_are_told_to_be_none(tmp_path, name, asked):
    noise = np.random.default_rng(5).bytes(5000)
    path = written(tmp_path, name, gzip.compress(noise) if name.endswith("gz") else noise)
    with pytest.raises(FileError) as raised:
        sb.read_record(path, "g", format=asked)
    assert (
        str(raised.value)
        == f"{path}: no AT2 file: it is no text, and has no header with NPTS and DT. Download it again"
    )


# Messages are read on the command line and on the page too, where nothing is written name=value.
AS_ARGUMENT = re.compile(r"\b(units|step|columns|axis|directions|lengths|steps|format) ?=")


@pytest.mark.parametrize(
    ("name", "content", "remedy"),
    [
        ("a.txt", TABLE, "state units"),
        ("a.csv", "time,x\n0,1\n1,2\n", "state units"),
        ("a.txt", "1\n2\n3\n", "state step, in s"),
        ("a.csv", "x [g],y [g]\n0,1\n1,2\n", "state step, the time step in s"),
        ("a.csv", "t,one,two\n0,1,2\n1,2,3\n", "state columns, or name it x or acceleration"),
    ],
)
def test_what_is_not_told_is_asked_for_in_words_that_hold_for_every_reader(tmp_path, name, content, remedy):
    with pytest.raises(FileError, match=remedy) as raised:
        sb.read_record(written(tmp_path, name, content))
    assert not AS_ARGUMENT.search(str(raised.value))


def test_a_given_step_must_be_that_of_the_times(tmp_path):
    path = written(tmp_path, "a.txt", TABLE)
    with pytest.raises(FileError, match=r"line 2: the times are in steps of 0.02 s, not of the step given, 0.05 s"):
        sb.read_record(path, "g", step=0.05)


def test_a_format_that_is_asked_for_is_the_format(tmp_path):
    path = written(tmp_path, "a.txt", TABLE)
    with pytest.raises(FileError, match=r"line 1: no header of an AT2 file"):
        sb.read_record(path, "g", format=RecordFormat.AT2)
    binary = written(tmp_path, "b.bin", bytes(range(64)))
    with pytest.raises(FileError, match=r"b\.bin: a binary file"):
        sb.read_record(binary, "g", format=RecordFormat.TABLE)


def test_without_obspy_its_formats_name_the_extra(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "obspy", None)
    monkeypatch.setitem(sys.modules, "obspy.io.mseed.core", None)
    path = written(tmp_path, "a.mseed", b"000001D \x00\x01\x02")
    with pytest.raises(
        UnsupportedError, match=r'a\.mseed: a waveform.* install ObsPy: pip install "stylobate\[records\]"'
    ):
        sb.read_record(path, "g")


@pytest.mark.filterwarnings("ignore")  # ObsPy's own
def test_miniseed_and_sac_are_read_through_obspy(tmp_path):
    import obspy

    for kind, name in (("MSEED", "a.mseed"), ("SAC", "a.sac")):
        trace = obspy.Trace(VALUES.astype("float32"), {"delta": 0.01, "channel": "HNE", "station": "AB"})
        trace.write(str(tmp_path / name), format=kind)
        record = sb.read_record(tmp_path / name, "m/s2")
        np.testing.assert_allclose(record.samples[:, 0], VALUES, rtol=1e-6)
        assert record.step == pytest.approx(0.01, rel=1e-6)
        assert "azimuth 90° along x" in record.provenance
    with pytest.raises(FileError, match="names no unit"):
        sb.read_record(tmp_path / "a.mseed")


@pytest.mark.filterwarnings("ignore")  # ObsPy's own
@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("noise.bin", bytes(range(64))),
        ("first.bin", bytes(range(256)) * 10),
        ("random.bin", np.random.default_rng(5).bytes(3000)),
        ("quality.mseed", b"000001D \x00\x01\x02"),
    ],
)
def test_a_file_that_is_no_waveform_is_refused_in_our_own_words(tmp_path, name, content):
    path = written(tmp_path, name, content)
    with pytest.raises(FileError) as raised:
        sb.read_record(path, "g")
    problem = (
        "ObsPy cannot read it as miniSEED: its content is damaged. Download the file again, or export the record as "
        if name == "quality.mseed"
        else "neither a text nor a waveform of a known format (miniSEED, SAC, Kinemetrics EVT, K-NET, GSE2, GSE1, "
        "SLIST, TSPAIR). Export the record as "
    )
    assert str(raised.value) == f"{path}: {problem}text or miniSEED"


KNET = """Origin Time       1996/08/11 03:12:00
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
    4194304   -4194304    2097152          0    1048576   -2097152          0          0
"""


@pytest.mark.filterwarnings("ignore")  # ObsPy's own
def test_knet_files_tell_their_unit_and_direction(tmp_path):
    record = sb.read_record(written(tmp_path, "AKT0239608110312.UD", KNET))
    # the scale is 20 m/s² over 2^23 counts
    expected = np.array([10.0, -10.0, 5.0, 0.0, 2.5, -5.0, 0.0, 0.0])
    np.testing.assert_allclose(record.samples[:, 2], expected, rtol=1e-12)
    assert (record.axes, record.step) == (("z",), 0.01)


def test_the_sample_is_the_record_of_its_source():
    record = sb.sample_record("El Centro 1940")
    assert (len(record.samples), record.step, record.axes) == (2674, 0.02, ("x", "y", "z"))
    # the file says 0.34873739 g, 0.21413699 g and 0.21005819 g: 342.0, 210.0 and 206.0 cm/s²
    peaks = np.abs(record.samples).max(axis=0)
    np.testing.assert_allclose(peaks, np.array([0.34873739, 0.21413699, 0.21005819]) * STANDARD_GRAVITY, rtol=1e-12)
    assert math.isclose(record.times[np.abs(record.samples[:, 0]).argmax()], 2.12)
    with pytest.raises(
        ParameterError, match=r"name must be one of 'el centro 1940', 'el centro 1940 corrected', got 'kobe'"
    ):
        sb.sample_record("kobe")


def test_a_record_in_another_unit_than_it_is_read_in_is_remarked_on(tmp_path):
    path = tmp_path / "gal.txt"
    path.write_text("0.0\n-250.0\n120.0\n")
    with pytest.warns(UnlikelyInputWarning, match=r"gal\.txt: its peak is 250 g, read in g as given; .* such as cm/s²"):
        sb.read_record(path, "g", step=0.01)
    assert sb.read_record(path, "gal", step=0.01).peak_horizontal() == pytest.approx(2.5)
    path.write_text("0.0\n-3.0\n")
    sb.read_record(path, "g", step=0.01)
