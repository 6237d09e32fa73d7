"""Shake-table tests of two granite specimens, run by run, beside a planar block whose numbers are learnt from others.

The files of 582 tests are in the repository of Z. Chen's "Virtual Shake Robot" (Seismica 3(1), 2024, doi
10.26443/seismica.v3i1.692), under the GPL, and not part of this project:

    git clone https://github.com/ZhiangChen/virtual_shake_robot_pybullet
    STYLOBATE_SHAKE_TABLE=virtual_shake_robot_pybullet python -m validation shake_table
"""

import os
import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd
import xarray as xr
from matplotlib.figure import Figure
from scipy.signal import butter, sosfiltfilt
from scipy.spatial import ConvexHull

import stylobate as sb
from stylobate.earthquakes import reliability, scores
from stylobate.plots.style import BLUE, GREY, VERMILION, new_figure, styled

from .finding import FOLDER, Finding, Kind

VARIABLE = "STYLOBATE_SHAKE_TABLE"
"""Environment variable with the folder of the clone."""

SOURCE = "github.com/ZhiangChen/virtual_shake_robot_pybullet (9f239e7)"
# Rate of the files [Hz], corner of the low-pass filter, every so many samples kept, g, corner of a high-pass filter.
_RATE, _CORNER, _KEPT, _G, _HIGHPASS = 800.0, 40.0, 4, 9.80665, 0.1
# The recorded displacement [m] of a unit of its column (NOTES.docx), and the corner above which it is noise [Hz].
_DISPLACEMENT, _SMOOTH = 5.9797e-4 * 0.0254, 20.0
# Columns of the outcomes, and of the models of distinct elements by the authors of the tests.
SPECIMENS = {"specimen 1": (1, range(3, 8)), "specimen 2": (2, range(8, 16))}
RANGES = {
    "slenderness": (0.03, 0.25),
    "size": (0.08, 1.0),  # p from 2.7 to 9.5 rad/s
    "restitution": (0.7, 1.0),
    "offset_x": (-0.8, 0.8),  # ± 0.08 rad between the tipping angles and their mean
}
BLOCK = sb.PlanarRocking.block(width=0.3, height=2.0, density=2700.0)
LEARNING: dict[str, Any] = {"ranges": RANGES, "count": 128, "rounds": 6, "samples": 4000}
REPEATS, BINS = 5, 10
_EVEN, _SURE = 0.5, 0.9
_RESAMPLED = 4000


@dataclass(frozen=True, slots=True)
class Tests:
    """The tests whose files are present.

    Parameters
    ----------
    motions
        Motion of the table in each test.
    pgv
        Peak velocity of the table in each test, from its recorded displacement [m/s], shape (n,).
    events
        Name of the earthquake of each test; tests with one name differ in scale.
    overturned
        Outcomes by specimen, shape (n,).
    others
        Outcomes by the authors' model that has most of them right, by specimen, shape (n,).
    """

    motions: list[sb.Record]
    pgv: npt.NDArray[np.float64]
    events: list[str]
    overturned: dict[str, npt.NDArray[np.bool_]]
    others: dict[str, npt.NDArray[np.bool_]]

    def intensities(self, period: float = 1.0) -> xr.Dataset:
        """Return intensity measures of the motions: PGV from displacements, the others from accelerations above 0.1 Hz.

        Parameters
        ----------
        period
            Period of the oscillator of spectral measures [s].
        """
        motions = [motion.filtered(highpass=_HIGHPASS) for motion in self.motions]
        found = sb.records.intensity_table(motions, period=period).drop_vars("record")
        pgv = found["pgv"].copy(data=self.pgv)
        return found.assign(pgv=pgv, pgv_over_pga=found["pgv_over_pga"].copy(data=pgv / found["pga"]))


def clone() -> Path | None:
    """Return the folder of the clone, or None with a line that says where to find it."""
    folder = os.environ.get(VARIABLE)
    if folder:
        return Path(folder)
    print(f"shake-table tests: left out; name the folder of a clone of {SOURCE.partition(' ')[0]} in ${VARIABLE}")
    return None


def findings() -> Iterator[Finding]:
    """Yield the fraction of outcomes predicted in tests that were not used, beside that of the authors' own models."""
    folder = clone()
    if folder is None:
        return
    known = tests(folder)
    predicted = {}
    for name, fell in known.overturned.items():
        learnt = sb.calibrate(BLOCK, known.motions, fell, **LEARNING)
        predicted[name] = learnt.held_out(folds=5, repeats=REPEATS)
        yield _fraction(known, name, predicted[name], "predicted from four fifths of the tests")
        by_event = learnt.held_out(folds=5, repeats=REPEATS, groups=known.events)
        text = f"predicted from four fifths of the {len(set(known.events))} earthquakes"
        yield _fraction(known, name, by_event, text)
        print(name, learnt.numbers().to_dataframe().to_string())
        numbers = learnt.numbers()["mean"]
        if name == "specimen 1":
            angles = np.arctan(numbers.sel(number="slenderness")), numbers.sel(number="offset_x") / _G
            least = angles[0].sel(quantile=0.5) - abs(angles[1].sel(quantile=0.5))
            yield Finding(
                source=SOURCE,
                compared=f"{name}: smaller tipping angle [rad]; theirs the smallest of the scanned shape",
                theirs=scanned_angle(folder),
                ours=round(float(least), 2),
                kind=Kind.EXPERIMENT,
                remark="the learnt angle is effective: it also stands for what the planar block leaves out",
            )
    (FOLDER / "shake_table_errors.txt").write_text(errors(known, predicted), encoding="utf-8")
    draw(known, predicted).savefig(FOLDER / "shake_table.png", dpi=150)


def _fraction(known: Tests, name: str, predicted: npt.NDArray[np.float64], how: str) -> Finding:
    fell, theirs = known.overturned[name], known.others[name] == known.overturned[name]
    each = [scores(one, fell) for one in predicted]
    same = np.array([one["same_outcome"] for one in each])
    brier, rate = np.mean([one["brier"] for one in each]), fell.mean()
    low, high = _resampled(((predicted > _EVEN) == fell).mean(axis=0) - theirs, known.events)
    return Finding(
        source=SOURCE,
        compared=f"{name}: fraction of {len(fell)} tests with the measured outcome; theirs by distinct elements",
        theirs=float(theirs.mean()),
        ours=float(same.mean()),
        kind=Kind.EXPERIMENT,
        remark=f"{how}, {REPEATS} times: {same.min():.3f} to {same.max():.3f}; lead {low:.3f} to {high:.3f} in 95 % of "
        f"resampled sets of earthquakes; Brier score {brier:.3f}, {rate * (1.0 - rate):.3f} by the rate of overturning",
    )


def _resampled(values: npt.NDArray[np.float64], events: list[str]) -> tuple[float, float]:
    """Return the 95 % interval of the mean of values of tests if earthquakes are drawn again."""
    which = np.unique(events, return_inverse=True)[1]
    sums, counts = np.bincount(which, values), np.bincount(which)
    drawn = np.random.default_rng(0).integers(len(counts), size=(_RESAMPLED, len(counts)))
    means = sums[drawn].sum(axis=1) / counts[drawn].sum(axis=1)
    low, high = np.quantile(means, [0.025, 0.975])
    return float(low), float(high)


def errors(known: Tests, predicted: dict[str, npt.NDArray[np.float64]]) -> str:
    """Return a table in Markdown of what tests that end against the odds have in common."""
    measures = known.intensities()
    lines = [
        "| specimen | group of tests | tests | against the odds | … although predicted above 0.9 |",
        "|---|---|---|---|---|",
    ]
    for name, probability in predicted.items():
        fell = known.overturned[name]
        mean = probability.mean(axis=0)
        wrong, sure = (mean > _EVEN) != fell, np.maximum(mean, 1.0 - mean) > _SURE
        groups = {"all": np.ones(len(fell), dtype=bool), "predicted between 0.1 and 0.9": ~sure}
        groups |= {"stood": ~fell, "overturned": fell} | _thirds(measures)
        for group, chosen in groups.items():
            among = int(chosen.sum())
            lines.append(
                f"| {name} | {group} | {among} | {int((wrong & chosen).sum())} ({(wrong & chosen).sum() / among:.0%}) "
                f"| {int((wrong & sure & chosen).sum())} |"
            )
    return "\n".join(lines) + "\n"


def _thirds(measures: xr.Dataset) -> dict[str, npt.NDArray[np.bool_]]:
    """Return tests by thirds of PGV/PGA and of the duration."""
    found = {}
    for name, text, units in (("pgv_over_pga", "PGV/PGA", "s"), ("duration_5_95", "duration", "s")):
        values = measures[name].to_numpy()
        low, high = np.quantile(values, [1 / 3, 2 / 3])
        found[f"{text} below {low:.2g} {units}"] = values < low
        found[f"{text} from {low:.2g} to {high:.2g} {units}"] = (values >= low) & (values < high)
        found[f"{text} above {high:.2g} {units}"] = values >= high
    return found


@styled
def draw(known: Tests, predicted: dict[str, npt.NDArray[np.float64]]) -> Figure:
    """Draw the fraction of tests that overturned over the probability predicted, with numbers of tests below."""
    figure = new_figure(4.4)
    shares, counts = figure.subplots(2, 1, sharex=True, height_ratios=(3, 1))
    shares.plot([0.0, 1.0], [0.0, 1.0], color=GREY, linewidth=1.0, label="as predicted")
    width = 1.0 / BINS
    for place, (name, colour, marker) in enumerate(zip(predicted, (BLUE, VERMILION), ("o", "s"), strict=True)):
        found = reliability(predicted[name], known.overturned[name], bins=BINS)
        tests_a_bin = found["tests"] / REPEATS
        error = np.sqrt(found["overturned"] * (1.0 - found["overturned"]) / tests_a_bin)
        shift = 0.006 * (2 * place - 1)
        shares.errorbar(
            found["predicted"] + shift, found["overturned"], yerr=error, color=colour, marker=marker, linestyle="none",
            capsize=2.0, label=name,
        )  # fmt: skip
        middle = width * (np.arange(BINS) + 0.25 + 0.5 * place)
        counts.bar(middle, tests_a_bin, width=0.45 * width, color=colour)
    shares.set(ylabel="fraction that overturned", ylim=(-0.03, 1.03))
    counts.set(
        xlabel="probability of overturning, predicted from other tests", ylabel="tests", yscale="log", xlim=(0, 1)
    )
    counts.set_ylim(bottom=1)
    counts.set_axisbelow(True)
    shares.legend(loc="upper left")
    return figure


def scanned_angle(folder: Path) -> float:
    """Return the smallest angle by which the scanned shape of the first specimen tips over, in any direction [rad].

    The pose is that of the authors' simulation (config/sp1.yaml turns the mesh back to the axes of the scan). The body
    turns in a vertical plane and always stands on its lowest point, until its centre of mass is highest.
    """
    vertices, faces = _mesh(folder / "models" / "SP1_PBRmodel" / "final_sp1.obj")
    a, b, c = (vertices[faces[:, corner]] for corner in range(3))
    volumes = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6.0
    centre = ((a + b + c) / 4.0 * volumes[:, np.newaxis]).sum(axis=0) / volumes.sum()
    hull = vertices[ConvexHull(vertices).vertices] - centre
    turned = np.linspace(0.0, 0.6, 601)
    least = np.inf
    for direction in np.radians(np.arange(0.0, 360.0, 5.0)):
        along = hull[:, :2] @ [np.cos(direction), np.sin(direction)]
        points = np.outer(hull[:, 2], np.cos(turned)) - np.outer(along, np.sin(turned))
        least = min(least, turned[int(np.argmax(-points.min(axis=0)))])
    return float(least)


def _mesh(path: Path) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int64]]:
    """Read the vertices, relative to their mean, and the triangles of a mesh in the format OBJ."""
    words = [line.split() for line in path.read_text("utf-8").splitlines()]
    vertices = np.array([one[1:4] for one in words if one[:1] == ["v"]], dtype=float)
    faces = [[int(corner.split("/")[0]) - 1 for corner in one[1:4]] for one in words if one[:1] == ["f"]]
    return vertices - vertices.mean(axis=0), np.array(faces)


def tests(folder: Path) -> Tests:
    """Read the tests whose files are in a clone."""
    data = folder / "data" / "Shake_Table_Response"
    files = {int(re.findall(r"\d+", path.name)[0]): path for path in sorted(data.glob("Test*.txt"))}
    rows = [row for row in _rows(data / "Results_Granite.xlsx", 2) if int(row[0]) in files]
    table = np.array(rows, dtype=float)
    named = {int(row[0]): str(row[3]) for row in _rows(data / "Earthquake_Records_Info.xlsx", 3)}
    fell = {name: table[:, column] > _EVEN for name, (column, _) in SPECIMENS.items()}
    motions, pgv = zip(*(_motion(files[int(row[0])]) for row in rows), strict=True)
    return Tests(
        motions=list(motions),
        pgv=np.array(pgv),
        events=[_event(named[int(row[0])]) for row in rows],
        overturned=fell,
        others={
            name: max((table[:, model] > _EVEN for model in models), key=lambda one: np.mean(one == fell[name]))
            for name, (_, models) in SPECIMENS.items()
        },
    )


def _event(name: str) -> str:
    """Return the number of a record of the NGA database, or the name without what differs between scales."""
    number = re.search(r"RSN\s*(\d+)", name)
    return number[1] if number else name.strip("' ").removesuffix(".xlsx").lower()


def _rows(path: Path, first: int) -> list[tuple[float, ...]]:
    try:
        from openpyxl import load_workbook
    except ModuleNotFoundError:
        sys.exit("tables of outcomes: openpyxl reads them. Install it: pip install --group validation")
    sheet = load_workbook(path, data_only=True).worksheets[0]
    return [row for row in sheet.iter_rows(min_row=first, values_only=True) if row[0] is not None]


def _motion(path: Path) -> tuple[sb.Record, float]:
    """Read the acceleration of the table, below 40 Hz, at 200 samples a second, and the peak of its velocity [m/s]."""
    lines = pd.read_csv(path, sep="\t", skiprows=1, header=None, usecols=[1, 5], on_bad_lines="skip")
    acceleration, displacement = (
        pd.to_numeric(lines[column], errors="coerce").dropna().to_numpy(dtype=float) for column in (1, 5)
    )
    samples = np.zeros((len(acceleration[::_KEPT]), 3))
    samples[:, 0] = _G * _below(_CORNER, acceleration)[::_KEPT]
    velocity = np.gradient(_DISPLACEMENT * _below(_SMOOTH, displacement), 1.0 / _RATE)
    return sb.Record(samples=samples, step=_KEPT / _RATE), float(np.abs(velocity).max())


def _below(corner: float, values: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    return np.asarray(sosfiltfilt(butter(4, corner, fs=_RATE, output="sos"), values - np.median(values)))


def even_tests(name: str) -> tuple[list[sb.Record], npt.NDArray[np.bool_]] | None:
    """Return motions and outcomes of every second test of a specimen, which the numbers of its folder do not know."""
    folder = clone()
    if folder is None:
        return None
    known = tests(folder)
    return known.motions[::2], known.overturned[name.replace("granite_", "specimen ")][::2]


def learn_from_odd_tests() -> None:
    """Print the numbers that the other half of the tests teaches, as `validation/objects` states them."""
    folder = clone()
    if folder is None:
        return
    known = tests(folder)
    for name, fell in known.overturned.items():
        learnt = sb.calibrate(BLOCK, known.motions[1::2], fell[1::2], **LEARNING)
        print(learnt.numbers().to_dataframe().to_string())
        numbers = learnt.numbers().sel(quantile=0.5)
        print(name, f"lapse = {float(numbers['lapse']):.3f}")
        for number, ends in RANGES.items():
            mean, spread = (float(numbers[part].sel(number=number)) for part in ("mean", "spread"))
            print(f"{number} = {{mean = {mean:.4g}, spread = {spread:.3g}, range = {list(ends)}}}")


if __name__ == "__main__":
    learn_from_odd_tests()
