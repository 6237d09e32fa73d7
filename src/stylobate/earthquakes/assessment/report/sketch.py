"""The first figure of a report: each column to one scale, its governing record, and its tilt under that record."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from stylobate.column.numbers import STANDARD_GRAVITY
from stylobate.earthquakes.assessment.report.column_verdict import slides_at
from stylobate.earthquakes.assessment.report.wording import SMALLEST_TILT, number
from stylobate.earthquakes.figures.overturning_intervals import undecided_label, undecided_reasons
from stylobate.plots.geometry import Floats, Shape
from stylobate.plots.labels import literal
from stylobate.plots.style import BLACK, BLUE, GREY, ORANGE, VERMILION, new_figure, styled
from stylobate.results.assessment import Assessment

OBJECTS = 4
"""Largest number of columns in one figure."""

_HEIGHT, _WIDTH = 4.1, 7.1
_FACE = "#dcebf5"
# Room beside and above a body [of the largest size], and length of the scale bar [m] by the largest height [m].
_ROOM = 0.12
_BARS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)
_BAR_SHARE = 0.4
# Largest tilt drawn, over α_c.
_MOST_TILT = 1.5


@styled
def objects_figure(assessment: Assessment, columns: Sequence[str], names: Sequence[str]) -> Figure:
    """Draw columns to one scale, each with its governing record and its tilt at the stated scale nearest to 1.

    The dashed outline is the column at its peak tilt, or lying if it overturned. Tilts are at central dissipation.

    Parameters
    ----------
    assessment
        The assessment.
    columns
        Columns to draw: at most `OBJECTS`, as they are called in the data.
    names
        The same columns, as they are called in the settings.
    """
    shapes = [Shape.of_column(assessment.setting["columns"][name]["column"]) for name in names]
    figure = new_figure(_HEIGHT, width=_WIDTH)
    grid = figure.subplots(3, len(columns), squeeze=False, height_ratios=(2.2, 0.75, 0.9), sharey="row")
    every = [Shape.of_column(one["column"]) for one in assessment.setting["columns"].values()]
    tallest = max(shape.height for shape in every)
    widest = max(2.0 * shape.largest_radius for shape in every)
    for place, (column, shape) in enumerate(zip(columns, shapes, strict=True)):
        run = assessment.data["histories"].sel(column=column, run="stated")
        slides = slides_at(assessment, column, float(run["scale"]))
        _sketch(grid[0, place], shape, run, slides=slides)
        grid[0, place].set_title(column, fontsize="medium", loc="center")
        record = str(assessment.data["summary"]["governing"].sel(column=column).item())
        _record(grid[1, place], _ground_motion(assessment, record, run), record, float(run["scale"]))
        _tilt(grid[2, place], run, slides=slides)
        grid[2, place].sharex(grid[1, place])
    _frame(grid[0], tallest, widest)
    grid[1, 0].set_ylabel("record [g]")
    grid[2, 0].set_ylabel(r"tilt $\theta/\alpha_c$")
    return figure


def _sketch(axes: Axes, shape: Shape, run: xr.Dataset, *, slides: bool) -> None:
    """Draw the side of a body, its centre of mass, and its outline at the peak tilt unless it slides first."""
    r, height, side = shape.radius, shape.height, shape.side
    axes.add_patch(Polygon(side, facecolor=_FACE, edgecolor=BLACK, linewidth=1.1))
    axes.plot([0.0], [shape.mass_height], marker="o", color=BLACK, markersize=3.0)
    ratio = float(run["peak_tilt_ratio"])
    fallen = math.isinf(ratio)
    if not slides and (fallen or ratio >= SMALLEST_TILT):
        angle = lying_angle(shape) if fallen else ratio * math.atan(shape.slenderness)
        outline = turned(side, r, angle)
        axes.add_patch(Polygon(outline, fill=False, edgecolor=VERMILION, linewidth=1.0, linestyle="--"))
    axes.set_xlabel(
        f"2r = {number(2.0 * r)} m, height {number(height)} m\n{_outcome(run, ratio, slides=slides)}",
        fontsize="small",
        labelpad=2.0,
    )


def lying_angle(shape: Shape) -> float:
    """Return the tilt at which a body lies on its base rim and the corner of its outline that touches first [rad]."""
    return 0.5 * math.pi - max(math.atan2(radius - shape.radius, z) for z, radius in shape.corners if z > 0.0)


def turned(points: Floats, radius: float, angle: float) -> Floats:
    """Turn points clockwise by `angle` about the right end of the base."""
    cosine, sine = math.cos(angle), math.sin(angle)
    x, z = points[:, 0] - radius, points[:, 1]
    return np.stack([radius + x * cosine + z * sine, z * cosine - x * sine], axis=-1)


def _outcome(run: xr.Dataset, ratio: float, *, slides: bool) -> str:
    if slides:
        return "slides before it rocks"
    if undecided_reasons(run["outcome"]):
        return undecided_label(run["outcome"])
    if math.isinf(ratio):
        return "overturned"
    if ratio < SMALLEST_TILT:
        return "hardly rocked" if ratio > 0.0 else "did not move"
    return rf"did not overturn: peak tilt {number(ratio)} $\alpha_c$"


def _ground_motion(assessment: Assessment, record: str, run: xr.Dataset) -> dict[str, Floats]:
    """Return time [s] and accelerations [m/s²] of a record to its end; without it, those of the run."""
    if "ground_motions" not in assessment.data:
        return {"time": run["time"].to_numpy(), **{axis: run[f"base_{axis}"].to_numpy() for axis in "xy"}}
    own = assessment.data["ground_motions"].sel(record=record)
    scaled = float(run["scale"]) * own["acceleration"]
    return {"time": own["time"].to_numpy(), **{axis: scaled.sel(axis=axis).to_numpy() for axis in "xy"}}


def _record(axes: Axes, motion: dict[str, Floats], record: str, scale: float) -> None:
    for axis, colour in (("x", BLACK), ("y", ORANGE)):
        axes.plot(motion["time"], motion[axis] / STANDARD_GRAVITY, color=colour, linewidth=0.5, label=axis)
    axes.set_title(literal(record) if scale == 1.0 else f"{scale:g} × {literal(record)}", fontsize="small", pad=2.0)
    axes.tick_params(labelbottom=False, labelsize=7.5)


def _tilt(axes: Axes, run: xr.Dataset, *, slides: bool) -> None:
    shown = run["amplitude"] * np.nan if slides else run["amplitude"]
    axes.plot(run["time"], shown, color=BLUE, linewidth=0.9)
    if slides:
        middle: dict[str, Any] = {"transform": axes.transAxes, "ha": "center", "va": "center"}
        axes.text(0.5, 0.35, "no tilt while it slides", color=GREY, fontsize="small", **middle)
    axes.axhline(1.0, color=VERMILION, linestyle="--", linewidth=0.9)
    axes.set(ylim=(0.0, _MOST_TILT), xlabel="time [s]")
    axes.tick_params(labelsize=7.5)


def _frame(row: Sequence[Axes], tallest: float, widest: float) -> None:
    """Give all sketches one scale, the ground, and a bar of a stated length in the first."""
    left, right = -0.5 * widest - _ROOM * tallest, 0.5 * widest + (1.0 + _ROOM) * tallest
    for axes in row:
        axes.plot([left, right], [0.0, 0.0], color=GREY, linewidth=1.6, zorder=0)
        axes.set(xlim=(left, right), ylim=(-0.06 * tallest, (1.0 + _ROOM) * tallest), xticks=[], yticks=[])
        axes.set_aspect("equal", adjustable="box", anchor="S")
        axes.grid(visible=False)
        for edge in axes.spines.values():
            edge.set_visible(False)
    bar = max(one for one in _BARS if one <= _BAR_SHARE * tallest or one == _BARS[0])
    end = right - 0.04 * (right - left)
    top = (1.0 + 0.5 * _ROOM) * tallest
    row[0].plot([end, end], [top - bar, top], color=GREY, linewidth=2.0, solid_capstyle="butt")
    row[0].annotate(
        f"{bar:g} m",
        (end, top - 0.5 * bar),
        xytext=(-3, 0),
        textcoords="offset points",
        ha="right",
        va="center",
        fontsize="small",
        color=GREY,
    )
