"""Times printed in few digits are read as the even grid they were rounded from, and no others are."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import stylobate as sb
from stylobate.errors import FileError
from stylobate.records.time_steps import even_grid

COUNT = 400


def table(folder, times):
    path = folder / "a.txt"
    path.write_text("".join(f"{time} {0.001 * at}\n" for at, time in enumerate(times)))
    return path


@pytest.mark.parametrize(
    ("step", "form"),
    [
        (0.005, "{:.2f}"),
        (0.005, "{:.1f}"),
        (1 / 128, "{:.3f}"),
        (1 / 128, "{:.2f}"),
        (1 / 256, "{:.4f}"),
        (0.025, "{:.2f}"),
        (0.03, "{:.1f}"),
    ],
)
def test_rounded_times_give_the_step_that_was_meant(tmp_path, step, form):
    path = table(tmp_path, [form.format(step * at) for at in range(COUNT)])
    record = sb.read_record(path, "m/s2")
    assert (record.step, record.start, len(record.samples)) == (step, 0.0, COUNT)


def test_times_rounded_to_few_significant_digits_are_read(tmp_path):
    path = table(tmp_path, [f"{0.005 * at:.3E}" for at in range(4000)])
    assert sb.read_record(path, "m/s2").step == 0.005


@settings(max_examples=60, deadline=None)
@given(step=st.floats(1e-4, 0.1), digits=st.integers(1, 4), start=st.integers(0, 50))
def test_the_grid_that_is_found_prints_as_the_times(step, digits, start):
    times = np.array([float(f"{start + step * at:.{digits}f}") for at in range(COUNT)])
    grid = even_grid(times)
    if grid is not None:
        found = grid[0] + grid[1] * np.arange(COUNT)
        assert np.abs(found - times).max() <= 0.5 * 10.0**-digits * (1.0 + 1e-5)
        assert abs(grid[1] - step) <= 10.0**-digits / (COUNT - 1) * (1.0 + 1e-5)
    else:  # few steps differ from the commonest, two at most or all of them gaps: samples may be missing as well
        steps = np.diff(times).round(digits)
        different = steps[steps != np.median(steps)]
        gaps = different.round(digits) >= 2.0 * np.median(steps) - 0.1 * 10.0**-digits
        assert len(different) <= 2 or (gaps.all() and len(different) < 0.05 * len(steps))


@pytest.mark.parametrize("missing", [(200,), (130, 270), (50, 60, 70), (100, 200, 320)])
def test_missing_samples_do_not_pass_for_rounding(tmp_path, missing):
    times = [f"{0.01 * at:.2f}" for at in range(COUNT) if at not in missing]
    with pytest.raises(FileError) as raised:
        sb.read_record(table(tmp_path, times), "m/s2")
    first = missing[0]
    what = f"unequal time steps: {0.01 * (first - 1):g} s to {0.01 * (first + 1):g} s is 0.02 s, most are 0.01 s"
    assert f"a.txt, line {first + 1}: {what}. Resample the file, or state step, in s" in str(raised.value)


@pytest.mark.parametrize("every", [500, 100, 25])
def test_samples_that_are_missing_at_equal_distances_do_not_pass_for_rounding(tmp_path, every):
    times = [f"{0.01 * at:.2f}" for at in range(1, 2000) if at % every]
    with pytest.raises(FileError, match=rf"line {every}: unequal time steps: .* is 0\.02 s, most are 0\.01 s"):
        sb.read_record(table(tmp_path, times), "m/s2")


def test_a_given_step_decides_and_must_agree_with_the_times(tmp_path):
    # a clock that is 2·10⁻⁴ slow: one time in 5000 differs
    path = table(tmp_path, [f"{0.010002 * at:.2f}" for at in range(4000)])
    assert sb.read_record(path, "m/s2", step=0.010002).step == 0.010002
    path = table(tmp_path, [f"{0.005 * at:.2f}" for at in range(COUNT)])
    assert sb.read_record(path, "m/s2", step=0.005).step == 0.005
    for wrong in (0.0052, 0.01):
        with pytest.raises(FileError, match=r"unequal time steps|not of the step given"):
            sb.read_record(path, "m/s2", step=wrong)


def test_the_message_does_not_contradict_itself(tmp_path):
    times = ["0.01", "0.01", "0.02", "0.02", "0.09", "0.09", "0.09"]
    with pytest.raises(FileError, match=r"line 2: unequal time steps: 0\.01 s to 0\.01 s is 0 s"):
        sb.read_record(table(tmp_path, times), "m/s2")
