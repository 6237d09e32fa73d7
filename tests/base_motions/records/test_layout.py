"""Text tables as spreadsheets and other programs write them: decimal commas, lines of header, units in brackets."""

import numpy as np
import pytest

import stylobate as sb
from stylobate.column.numbers import STANDARD_GRAVITY
from stylobate.errors import FileError, UnlikelyInputWarning
from stylobate.records import RecordFormat

STEP = 0.005
VALUES = np.array([0.0, 0.125, -1.25, 0.0625, -0.001, 0.002, 1.5, -0.75])
TIMES = STEP * np.arange(len(VALUES))


def written(folder, content, name="a.txt"):
    path = folder / name
    path.write_text(content, encoding="utf-8")
    return path


def table(*columns, between="\t", comma=False):
    rows = (between.join(f"{value:.6f}" for value in row) for row in zip(*columns, strict=True))
    text = "\n".join(rows) + "\n"
    return text.replace(".", ",") if comma else text


@pytest.mark.parametrize("between", [";", "; ", "\t", "   "])
def test_decimal_commas_are_read_where_something_else_stands_between_the_columns(tmp_path, between):
    record = sb.read_record(written(tmp_path, table(TIMES, VALUES, between=between, comma=True)), "m/s2")
    np.testing.assert_allclose(record.samples[:, 0], VALUES, rtol=0.0, atol=1e-15)
    assert (record.step, record.start) == (STEP, 0.0)


@pytest.mark.parametrize("between", [";", "\t", "  "])
@pytest.mark.parametrize("comma", [False, True])
def test_named_columns_are_read_whatever_stands_between_and_whichever_the_decimal_sign(tmp_path, between, comma):
    header = between.join(("time [s]", "x [cm/s2]", "y [cm/s2]", "z [cm/s2]"))
    body = table(TIMES, VALUES, 2.0 * VALUES, -VALUES, between=between, comma=comma)
    record = sb.read_record(written(tmp_path, f"{header}\n{body}"))
    np.testing.assert_allclose(record.samples, 0.01 * np.outer(VALUES, [1.0, 2.0, -1.0]), rtol=0.0, atol=1e-15)


def test_a_single_column_of_decimal_commas_is_read(tmp_path):
    path = written(tmp_path, table(VALUES, comma=True))
    np.testing.assert_allclose(sb.read_record(path, "m/s2", step=STEP).samples[:, 0], VALUES, rtol=0.0, atol=1e-15)


@pytest.mark.parametrize(
    ("content", "line", "found"),
    [
        (table(TIMES, VALUES, between=",", comma=True), 1, "a decimal comma, or a comma between columns: '0,000000,0"),
        ("0,5\n0,7\n-1,2\n0,1\n", 1, "a decimal comma, or a comma between columns: '0,5'"),
        ("0.00;0,5\n0.01;0,7\n", 1, "a decimal comma beside decimal points"),
        ("0;1.234,5\n1;2.345,5\n", 1, "a decimal comma beside decimal points"),
        ("0;0.5\n1;0,5\n", 2, "a decimal comma beside decimal points"),
        ('time,x\n"0,00","0,1"\n"0,01","0,2"\n', 2, "not a number: '0,00'"),
    ],
    ids=["between columns too", "one column without leading zeros", "mixed", "thousands", "mixed rows", "quoted"],
)
def test_an_ambiguous_comma_is_named_with_its_remedy(tmp_path, content, line, found):
    with pytest.raises(FileError) as raised:
        sb.read_record(written(tmp_path, content), "m/s2")
    message = str(raised.value)
    assert f"a.txt, line {line}: {found}" in message
    assert "Write decimal points" in message


def test_commas_between_whole_numbers_stay_separators(tmp_path):
    for content in ("0,1\n1,-2\n2,4\n", "0, 1\n1, -2\n2, 4\n", "0.0,1.0,\n1.0,-2.0,\n2.0,4.0,\n"):
        with pytest.warns(UnlikelyInputWarning, match="the step read in s is 1 s"):
            record = sb.read_record(written(tmp_path, content), "m/s2")
        assert (record.samples[:, 0].tolist(), record.step) == ([1.0, -2.0, 4.0], 1.0)


SEISMOSIGNAL = {
    "units on the line of names": "Time [sec]\tAcceleration [g]\tVelocity [cm/sec]\tDisplacement [cm]\n",
    "units on a line of their own": "Time\tAcceleration\tVelocity\tDisplacement\n[sec]\t[g]\t[cm/sec]\t[cm]\n",
    "spaces": "  Time      Acceleration   Velocity    Displacement\n  (sec)     (g)    (cm/sec)    (cm)\n",
    "title and rule": "Some Quake, station AB, 1990\n\nTime (s)  Acceleration (g)  Velocity  Displacement\n----- ---\n",
}


@pytest.mark.parametrize("header", SEISMOSIGNAL.values(), ids=SEISMOSIGNAL)
@pytest.mark.parametrize("comma", [False, True])
def test_exports_with_velocity_and_displacement_give_their_acceleration(tmp_path, header, comma):
    body = table(TIMES, VALUES, 9.0 + VALUES, 99.0 + VALUES, comma=comma)
    record = sb.read_record(written(tmp_path, header + body))
    np.testing.assert_allclose(record.samples[:, 0], STANDARD_GRAVITY * VALUES, rtol=1e-14)
    assert (record.step, record.axes) == (STEP, ("x",))


@pytest.mark.parametrize("header", ["Time (s) Acceleration (m/s2)\n", "Time\tAcceleration\n[s]\t[m/s2]\n"])
def test_two_named_columns_tell_their_unit(tmp_path, header):
    record = sb.read_record(written(tmp_path, header + table(TIMES, VALUES)))
    np.testing.assert_allclose(record.samples[:, 0], VALUES, rtol=1e-15)


@pytest.mark.parametrize("title", ["El Centro\n", "A title of five words\nand, a second\n", "sep=;\nno names here\n"])
def test_titles_above_two_columns_are_passed_over(tmp_path, title):
    record = sb.read_record(written(tmp_path, title + table(TIMES, VALUES)), "m/s2")
    np.testing.assert_allclose(record.samples[:, 0], VALUES, rtol=1e-15)


def test_a_title_above_one_column_is_passed_over_and_its_unit_is_read(tmp_path):
    plain = sb.read_record(written(tmp_path, "El Centro\n" + table(VALUES)), "m/s2", step=STEP)
    named = sb.read_record(written(tmp_path, "Acceleration [m/s2]\n" + table(VALUES)), step=STEP)
    np.testing.assert_array_equal(plain.samples, named.samples)
    np.testing.assert_allclose(plain.samples[:, 0], VALUES, rtol=1e-15)


@pytest.mark.parametrize("row", ["0.0o 0.1", "***** 0.1", "0.0 *****", "***** *****", "0.0a 0.1b", "1.2x"])
def test_a_spoilt_first_row_is_no_header(tmp_path, row):
    body = table(TIMES, VALUES) if len(row.split()) > 1 else table(VALUES)
    with pytest.raises(FileError, match=r"line 1: not a number"):
        sb.read_record(written(tmp_path, f"{row}\n{body}"), "m/s2", step=STEP)


def test_lines_keep_their_numbers_below_a_header(tmp_path):
    body = table(TIMES, VALUES, comma=True).replace("1,500000", "one")
    path = written(tmp_path, f"Some title\nTime [s]\tAcceleration [g]\n{body}")
    with pytest.raises(FileError, match=r"a\.txt, line 9: not a number: 'one'"):
        sb.read_record(path)


@pytest.mark.parametrize(
    ("begin", "what"),
    [
        (b"PK\x03\x04\x14\x00", "cannot be unpacked: it is damaged, or packed in an unknown way. Unpack it"),
        (b"\xd0\xcf\x11\xe0\xa1\xb1", "an Excel workbook of the old form. Save it as xlsx"),
        (b"Rar!\x1a\x07", "a rar archive. Unpack it"),
        (b"%PDF-1.7", "a PDF document. Save its numbers as text"),
    ],
)
@pytest.mark.parametrize("asked", [None, RecordFormat.CSV, RecordFormat.WAVEFORM])
def test_archives_that_are_not_read_are_named_with_their_remedy(tmp_path, begin, what, asked):
    path = tmp_path / "a.dat"
    path.write_bytes(begin + bytes(64))
    with pytest.raises(FileError) as raised:
        sb.read_record(path, "g", format=asked)
    assert str(raised.value).startswith(f"{path}: {what}")
    assert "ObsPy" not in str(raised.value)


@pytest.mark.parametrize("coding", ["utf-16", "utf-16-be", "utf-8-sig", "latin-1"])
def test_unicode_text_of_any_coding_is_read(tmp_path, coding):
    path = tmp_path / "a.txt"
    content = ("\ufeff" if coding == "utf-16-be" else "") + "time [s];x [m/s²]\n" + table(TIMES, VALUES, between=";")
    path.write_bytes(content.encode(coding))
    np.testing.assert_allclose(sb.read_record(path).samples[:, 0], VALUES, rtol=1e-15)
