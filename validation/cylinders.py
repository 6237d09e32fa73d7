"""Solid cylinders under bidirectional pulse-like motions, 2450 for each motion, by another program and by `Wobbling`.

The published numbers are peak tilts, by Zhou Xun under the MIT licence:

    git clone https://github.com/XunXun-Zhou/Database-for-Manuscript
    STYLOBATE_CYLINDERS=Database-for-Manuscript python -m validation cylinders

The motions are not part of the data. STYLOBATE_CYLINDER_MOTIONS names a folder with them: the motion of
`spectraOutput/7.mat` is the folder `7` with the files of its two horizontal components, or one file of both, such as
`7.csv`. Units and directions are those that `read_records` finds in the files.
"""

import contextlib
import math
import os
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr
from scipy.io import loadmat

import stylobate as sb
from stylobate.errors import UnlikelyInputWarning

from .finding import Finding, Kind

PUBLISHED, MOTIONS = "STYLOBATE_CYLINDERS", "STYLOBATE_CYLINDER_MOTIONS"
"""Environment variables with the folder of the clone and the folder of the motions."""

SOURCE = "Zhou Xun, github.com/XunXun-Zhou/Database-for-Manuscript (f3a8c82)"
GRAVITY = 9.81
"""Gravity in the published script [m/s²]."""
SIZES, ANGLES = np.arange(1.0, 51.0), np.arange(1, 50) * math.pi / 200.0
"""Distance R from the centre of mass to the rim [m], and tipping angle α [rad], of the published grid."""
FIRST_PEAK = 3.3599
"""Peak acceleration of motion 1 [m/s²], in the published script."""
HALFWAY = 0.3
"""Peak tilt over α at which the published spectra have a contour."""
# A peak tilt is cut off at α; rounding leaves 1 − 1e-13 to 1 + 4e-12.
_FALLEN = 1.0 - 1e-9
# Relative difference of two values of standard gravity, by which the files of a motion may differ.
_GRAVITIES = 1e-3
_TAIL = 10.0  # free vibration after the motion [s]

Floats = npt.NDArray[np.float64]
Bools = npt.NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Tilts:
    """Peak tilts of the cylinders under one motion, over α, shape (sizes, angles); 1 or more for overturned ones."""

    sizes: Floats
    angles: Floats
    peak: Floats

    @property
    def uplifted(self) -> Bools:
        """Whether a cylinder tilted."""
        return self.peak > 0.0

    @property
    def overturned(self) -> Bools:
        """Whether a cylinder reached α."""
        return self.peak >= _FALLEN

    @property
    def halfway(self) -> Bools:
        """Whether the tilt exceeded 0.3 α, or α."""
        return self.peak >= HALFWAY

    @property
    def edge(self) -> tuple[float, float]:
        """The range of the peak horizontal acceleration by which the smallest cylinder uplifts as it does [m/s²]."""
        count = int(self.uplifted[0].sum())
        limits = GRAVITY * np.tan(np.array([0.0, *self.angles, math.pi / 2.0]))
        return float(limits[count]), float(limits[count + 1])

    @property
    def lawful(self) -> int:
        """Number of cylinders that uplift exactly if their g tan α is below one peak acceleration."""
        return int((self.uplifted == (GRAVITY * np.tan(self.angles) <= self.edge[0] * (1.0 + 1e-12))).sum())


def findings() -> Iterator[Finding]:
    """Yield the laws that the published peak tilts must obey and, with the motions, the outcomes by `Wobbling`."""
    folder = os.environ.get(PUBLISHED)
    if not folder:
        print(f"cylinders: outcomes left out; name the folder of a clone of {SOURCE} in ${PUBLISHED}")
        return
    published = peak_tilts(Path(folder))
    yield from laws(published)
    place = os.environ.get(MOTIONS)
    if not place:
        print(f"cylinders: simulations left out; name the folder of the motions in ${MOTIONS}")
        return
    yield from simulated(published, motions(Path(place), published))


def frequency_parameter() -> Finding:
    """Compare the frequency parameter of the published script with that of the columns."""
    sizes, angles = np.meshgrid(SIZES, ANGLES, indexing="ij")
    theirs = np.sqrt(12.0 * GRAVITY / ((15.0 + np.cos(angles) ** 2) * sizes))
    columns = cylinders(SIZES, ANGLES)
    model = _model(0.0)
    ours = np.empty_like(theirs)
    with _large():
        for i, j in np.ndindex(ours.shape):
            numbers = {name: float(values[i, j]) for name, values in columns.items()}
            ours[i, j] = replace(model.column, **numbers).frequency_parameter
    worst = np.unravel_index(np.argmax(np.abs(ours / theirs - 1.0)), ours.shape)
    return Finding(
        SOURCE,
        f"frequency parameter √(12 g/((15 + cos²α) R)) of a solid cylinder, the worst of {ours.size} [rad/s]",
        float(theirs[worst]),
        float(ours[worst]),
        Kind.MATHEMATICS,
        allowed=1e-12,
    )


def cylinders(sizes: Floats, angles: Floats) -> dict[str, xr.DataArray]:
    """Return the numbers of solid cylinders over `size` and `angle`."""
    each = [_cylinder(angle).numbers_at_size(sizes) for angle in angles]
    names = ("radius", "mass_height", "mass", "transverse_inertia", "axial_inertia")
    return {name: xr.DataArray(np.stack([one[name] for one in each], axis=1), dims=("size", "angle")) for name in names}


def _cylinder(angle: float) -> sb.Column:
    """Return the solid cylinder with R = 1 m and this tipping angle."""
    return sb.Column.solid(radius=math.sin(angle), height=2.0 * math.cos(angle), density=2500.0, gravity=GRAVITY)


@contextlib.contextmanager
def _large() -> Iterator[None]:
    """Permit radii of up to 35 m, about which the package asks."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UnlikelyInputWarning)
        yield


def _model(damping: float) -> sb.Wobbling:
    return sb.Wobbling(replace(_cylinder(0.2), height=None), damping=damping)


def peak_tilts(folder: Path) -> dict[int, Tilts]:
    """Return the published peak tilts by the number of the motion, from the files that are present.

    Raises
    ------
    ValueError
        If a file is not the table of a whole grid whose last column is the peak tilt over α.
    """
    paths = {int(path.stem): path for path in (folder / "spectraOutput").glob("*.mat")}
    return {number: _table(paths[number]) for number in sorted(paths)}


def _table(path: Path) -> Tilts:
    sizes, angles, tilt, ratio = loadmat(path)["data"].T
    grid = np.unique(sizes), np.unique(angles)
    places = tuple(np.searchsorted(axis, values) for axis, values in zip(grid, (sizes, angles), strict=True))
    peak = np.full(tuple(map(len, grid)), np.nan)
    peak[places] = ratio
    if ratio.size != peak.size or np.isnan(peak).any() or not np.allclose(ratio * angles, tilt, rtol=1e-9, atol=0.0):
        raise ValueError(f"{path}: no table of R, α, peak tilt and peak tilt/α over a grid. Clone the data again.")
    return Tilts(*grid, peak)


def laws(published: Mapping[int, Tilts]) -> Iterator[Finding]:
    """Yield the findings that need no motions."""
    total = sum(one.peak.size for one in published.values())
    counts = [sum(int(getattr(one, kind).sum()) for one in published.values()) for kind in ("uplifted", "overturned")]
    shares = ", ".join(
        f"{count} {kind} ({count / total:.2%})" for count, kind in zip(counts, ("uplifted", "overturned"), strict=True)
    )
    yield Finding(
        SOURCE,
        f"cylinders that uplift as one peak acceleration of each of {len(published)} motions demands, at any size",
        total,
        sum(one.lawful for one in published.values()),
        Kind.DATA,
        allowed=1e-6,
        remark=f"of {total} published runs {shares}",
    )
    if 1 in published:
        low, high = published[1].edge
        yield Finding(
            SOURCE,
            "peak acceleration of motion 1: published, and the nearest by which the published cylinders uplift [m/s²]",
            FIRST_PEAK,
            min(max(FIRST_PEAK, low), high),
            Kind.DATA,
            allowed=1e-6,
            remark=f"they uplift up to g tan α = {low:.4f} and not at {high:.4f}",
        )


def motions(folder: Path, published: Mapping[int, Tilts]) -> dict[int, sb.Record]:
    """Return the horizontal motions that are present, by number.

    Raises
    ------
    ValueError
        If the files of a number are not those of one motion.
    """
    found = {}
    for number in published:
        inside = folder / str(number)
        source: Any = inside if inside.is_dir() else sorted(folder.glob(f"{number}.*"))
        if not source:
            continue
        records = sb.read_records(source)
        if len(records) != 1:
            raise ValueError(f"{folder}: {len(records)} motions with number {number}. Leave the files of one.")
        found[number] = replace(records[0], samples=records[0].samples * [1.0, 1.0, 0.0])
    return found


def simulated(published: Mapping[int, Tilts], moved: Mapping[int, sb.Record]) -> Iterator[Finding]:
    """Yield the findings that need the motions."""
    if not moved:
        print("cylinders: the folder of the motions has none of the published numbers")
        return
    peaks = {number: motion.peak_horizontal() for number, motion in moved.items()}
    misfits = [number for number, peak in peaks.items() if not _fits(peak, published[number].edge)]
    yield Finding(
        SOURCE,
        "motions whose peak acceleration is that at which the published cylinders cease to uplift",
        len(peaks),
        len(peaks) - len(misfits),
        Kind.CODE,
        remark=f"not those of {', '.join(map(str, misfits))}" if misfits else "",
    )
    for name, damped in (("no damping", False), ("damping of Housner's impacts", True)):
        ours = {number: simulate(published[number], motion, damped=damped) for number, motion in moved.items()}
        for text, kind in (("uplift", "uplifted"), ("tilt by 0.3 α or more", "halfway"), ("overturning", "overturned")):
            yield _outcomes(published, ours, f"{text}, {name}", kind)


def _fits(peak: float, edge: tuple[float, float]) -> bool:
    return edge[0] * (1.0 - _GRAVITIES) < peak <= edge[1] * (1.0 + _GRAVITIES)


def simulate(published: Tilts, motion: sb.Record, *, damped: bool) -> Tilts:
    """Simulate the published cylinders under a motion."""
    angles = published.angles
    damping = [_cylinder(angle).housner_damping() if damped else 0.0 for angle in angles]
    varied = {**cylinders(published.sizes, angles), "damping": xr.DataArray(damping, dims="angle")}
    with _large():
        runs = sb.simulate_ensemble(
            _model(0.0), motion, duration=motion.duration + _TAIL, parameters=varied, progress=False
        ).transpose("size", "angle", ...)
    peak = runs["peak_tilt"].to_numpy() / angles
    overturned = runs["outcome"].to_numpy() == sb.Outcome.OVERTURNED
    return Tilts(published.sizes, angles, np.where(overturned, np.maximum(peak, 1.0), peak))


def _outcomes(published: Mapping[int, Tilts], ours: Mapping[int, Tilts], text: str, kind: str) -> Finding:
    same = {number: getattr(one, kind) == getattr(published[number], kind) for number, one in ours.items()}
    others = {number: int((~equal).sum()) for number, equal in same.items()}
    there, here = (sum(int(getattr(of[number], kind).sum()) for number in ours) for of in (published, ours))
    most = sorted((number for number in others if others[number]), key=lambda number: -others[number])[:5]
    remark = f"{there} there, {here} here"
    if most:
        remark += "; most differences: " + ", ".join(f"motion {number} {others[number]}" for number in most)
    total = sum(equal.size for equal in same.values())
    return Finding(
        SOURCE, f"cylinders with the same answer: {text}", total, total - sum(others.values()), Kind.CODE, remark=remark
    )
