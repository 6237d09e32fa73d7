"""Shake-table tests of two granite specimens, run by run, beside a planar block whose numbers are learnt from others.

The 582 tests are of Z. Chen and others, "Virtual Shake Robot", Seismica 3(1), 2024, doi 10.26443/seismica.v3i1.692.
Their files are under the GPL and not part of this project:

    git clone https://github.com/ZhiangChen/virtual_shake_robot_pybullet
    STYLOBATE_SHAKE_TABLE=virtual_shake_robot_pybullet python -m validation shake_table
"""

import os
import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from scipy.signal import butter, sosfiltfilt

import stylobate as sb

from .finding import Finding, Kind

VARIABLE = "STYLOBATE_SHAKE_TABLE"
"""Environment variable with the folder of the clone."""

SOURCE = "Chen et al., Seismica 3(1), 2024; files at github.com/ZhiangChen/virtual_shake_robot_pybullet"
# Rate of the files [Hz], corner of the low-pass filter, every so many samples kept, and samples of g.
_RATE, _CORNER, _KEPT, _G = 800.0, 40.0, 4, 9.80665
# Columns of the outcomes, and of the models of distinct elements by the authors of the tests.
SPECIMENS = {"specimen 1": (1, range(3, 8)), "specimen 2": (2, range(8, 16))}
RANGES = {
    "slenderness": (0.08, 0.2),
    "size": (0.08, 0.5),  # p from 3.8 to 9.5 rad/s
    "restitution": (0.75, 1.0),
    "offset_x": (-0.5, 0.5),  # ± 0.05 rad between the tipping angles and their mean
}
BLOCK = sb.PlanarRocking.block(width=0.3, height=2.0, density=2700.0)
DRAWS, REPEATS = 512, 5


def findings() -> Iterator[Finding]:
    """Yield the fraction of outcomes foretold in tests that were not used, beside that of the authors' own models."""
    folder = os.environ.get(VARIABLE)
    if not folder:
        print(f"shake_table: left out; name the folder of a clone of {SOURCE.split('at ')[1]} in ${VARIABLE}")
        return
    motions, table = tests(Path(folder))
    learnt = None
    for name, (column, models) in SPECIMENS.items():
        fell = table[:, column] > 0.5
        if learnt is None:
            learnt = sb.earthquakes.calibrate(BLOCK, motions, fell, ranges=RANGES, count=DRAWS)
        else:
            learnt = learnt.relearnt(fell)
        held_out = learnt.held_out(folds=5, repeats=REPEATS)
        each = [sb.earthquakes.scores(one, fell) for one in held_out]
        same = np.array([one["same_outcome"] for one in each])
        brier = np.mean([one["brier"] for one in each])
        rate = fell.mean()
        best = max(np.mean((table[:, model] > 0.5) == fell) for model in models)
        numbers = learnt.numbers()
        print(name, numbers["mean"].sel(quantile=0.5).to_dataframe().to_string())
        print(sb.earthquakes.reliability(held_out, fell, bins=10).to_dataframe().to_string())
        yield Finding(
            source=SOURCE,
            compared=f"{name}: fraction of {len(fell)} tests with the measured outcome; theirs by distinct elements",
            theirs=best,
            ours=float(same.mean()),
            kind=Kind.EXPERIMENT,
            remark=f"foretold from four fifths of the tests, {REPEATS} times: {same.min():.3f} to {same.max():.3f}; "
            f"Brier score {brier:.3f}, {rate * (1.0 - rate):.3f} by the rate of overturning alone",
        )


def tests(folder: Path) -> tuple[list[sb.Record], np.ndarray]:
    """Return the table motions of the tests whose files are present, and the table of outcomes of these tests."""
    data = folder / "data" / "Shake_Table_Response"
    files = {int(re.findall(r"\d+", path.name)[0]): path for path in sorted(data.glob("Test*.txt"))}
    rows = [row for row in _outcomes(data / "Results_Granite.xlsx") if int(row[0]) in files]
    return [_motion(files[int(row[0])]) for row in rows], np.array(rows, dtype=float)


def _outcomes(path: Path) -> list[tuple[float, ...]]:
    from openpyxl import load_workbook

    sheet = load_workbook(path, data_only=True).worksheets[0]
    return [row for row in sheet.iter_rows(min_row=2, values_only=True) if row[0] is not None]


def _motion(path: Path) -> sb.Record:
    """Read the acceleration of the table, without its offset and what lies above 40 Hz, at 200 samples a second."""
    values = np.genfromtxt(path, skip_header=1, usecols=(0, 1), invalid_raise=False)
    acceleration = values[np.isfinite(values).all(axis=1), 1]
    filtered = sosfiltfilt(butter(4, _CORNER, fs=_RATE, output="sos"), acceleration - np.median(acceleration))[::_KEPT]
    samples = np.zeros((len(filtered), 3))
    samples[:, 0] = _G * filtered
    return sb.Record(samples=samples, step=_KEPT / _RATE)
