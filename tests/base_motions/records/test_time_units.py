"""Units of time: a record has the same step in s, whatever the unit of the times in its file."""

import warnings

import numpy as np
import pytest

import stylobate as sb
from stylobate.errors import FileError, UnlikelyInputWarning

VALUES = np.array([0.0, 0.1, -0.25, 0.03125, 1e-4, -2e-5, 0.5, 0.0])
SECONDS = {"s": 1.0, "Sec.": 1.0, "ms": 1e-3, "MSEC": 1e-3, "µs": 1e-6, "μs": 1e-6, "us": 1e-6, "min": 60.0}
AT2 = "PEER\nQuake, 1/2/1990, Site, 90\nACCELERATION IN UNITS OF G\nNPTS=  3, DT= {} {}\n .1 -.2 .3\n"


def written(folder, content, name="a.csv"):
    path = folder / name
    path.write_text(content, encoding="utf-8")
    return path


def table(times, header="", between=","):
    return header + "".join(f"{time:.10g}{between}{value}\n" for time, value in zip(times, VALUES, strict=True))


@pytest.mark.parametrize("unit", SECONDS)
@pytest.mark.parametrize("header", ["time [{}],x [g]\n", "Time ({});a (g)\n", "t [{}]\tAcceleration [g]\n"])
def test_times_in_every_unit_give_one_record(tmp_path, unit, header):
    between = next(sign for sign in ",;\t" if sign in header)
    times = 0.75 + 0.015 * np.arange(len(VALUES))
    record = sb.read_record(written(tmp_path, table(times / SECONDS[unit], header.format(unit), between)))
    # ten printed digits of the first time are 1e-10 of it
    assert (record.step, record.start) == (pytest.approx(0.015, rel=1e-8), pytest.approx(0.75, rel=1e-9))
    if SECONDS[unit] <= 1.0:
        assert (record.step, record.start) == (0.015, 0.75)


def test_a_unit_on_a_line_of_its_own_is_that_of_the_times(tmp_path):
    path = written(tmp_path, table(10.0 * np.arange(8), "Time\tAcceleration\n[ms]\t[g]\n", "\t"))
    assert sb.read_record(path).step == 0.01


def test_rounded_times_and_a_given_step_keep_to_the_stated_unit(tmp_path):
    rounded = [f"{time:.0f}" for time in 2.5 * np.arange(8)]
    path = written(tmp_path, "time [ms],x [g]\n" + "".join(f"{time},0.1\n" for time in rounded))
    assert sb.read_record(path).step == 0.0025
    assert sb.read_record(path, step=0.0025).step == 0.0025
    even = written(tmp_path, table(10.0 * np.arange(8), "time [ms],x [g]\n"))
    assert sb.read_record(even, step=0.01).step == 0.01
    with pytest.raises(FileError, match=r"steps of 10 ms, not of the step given, 10 s\. Correct step, or leave it out"):
        sb.read_record(even, step=10.0)
    uneven = written(tmp_path, "time [ms],x [g]\n0,0\n10,1\n30,0\n40,1\n")
    with pytest.raises(
        FileError, match=r"line 4: unequal time steps: 10 ms to 30 ms is 20 ms, most are 10 ms\. Resamp"
    ):
        sb.read_record(uneven)


def test_the_step_of_an_at2_file_is_in_the_unit_beside_it(tmp_path):
    for step, unit in ((".0050", "SEC"), ("5.0", "MSEC"), ("5.0", "ms,"), (".0050", "")):
        assert sb.read_record(written(tmp_path, AT2.format(step, unit), "a.AT2")).step == 0.005


@pytest.mark.parametrize("unit", ["h", "samples", "-", "m", "Hz"])
def test_other_units_of_time_are_refused_with_the_remedy(tmp_path, unit):
    path = written(tmp_path, table(np.arange(8), f"time [{unit}],x [g]\n"))
    with pytest.raises(FileError) as raised:
        sb.read_record(path)
    remedy = "Convert the times to s, ms, µs or min, and state that unit"
    assert str(raised.value) == f"{path}, line 1: unknown unit of time '{unit}'. {remedy}"


@pytest.mark.parametrize(
    ("content", "step"),
    [
        (table(10.0 * np.arange(8)), None),
        (table(10.0 * np.arange(8), "time,x\n"), None),
        ("0.1\n0.2\n", 10.0),
        ("x\n0.1\n0.2\n", 0.51),
        (AT2.format("5.0", "").replace("OF G", ""), None),
        ("0.1\n" * 14402, 0.5),  # 7200.5 s
    ],
    ids=["table", "names", "one column", "one name", "AT2", "duration"],
)
def test_unlikely_times_without_a_stated_unit_are_remarked_on(tmp_path, content, step):
    path = written(tmp_path, content)
    with pytest.warns(UnlikelyInputWarning, match=r"a\.csv: check the unit of time: the step read in s is"):
        sb.read_record(path, "g", step=step)


def test_likely_times_and_stated_units_are_not_remarked_on(tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        sb.read_record(written(tmp_path, table(0.5 * np.arange(8))), "g")
        sb.read_record(written(tmp_path, table(10.0 * np.arange(8), "time [s],x [g]\n")))
        sb.read_record(written(tmp_path, "0.1\n" * 14401), "g", step=0.5)  # 7200 s
