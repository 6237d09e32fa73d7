"""Figures of an assessment: margins, tilts, contact, small variations, and histories under the governing record."""

import math
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter, NullFormatter

from stylobate.earthquakes.assessment.report.wording import number
from stylobate.earthquakes.figures.interval_regions import UNDECIDED, undecided_label, undecided_reasons
from stylobate.plots.cells import fill_options
from stylobate.plots.style import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION, new_figure, styled
from stylobate.results.assessment import Assessment
from stylobate.results.verdict import CLEAR

# Heights of a line in a figure of records, of the frame, and of the tallest figure [inches].
_ROW, _FRAME, _TALLEST = 0.17, 1.5, 9.0
_BAR = 0.8
_MARKS = ("v", "o", "^", "D", "s", "P", "X")
_COLOURS = (SKY, BLUE, BLACK, GREEN, PURPLE, ORANGE)
# Largest tilt drawn, over α_c.
_MOST_TILT = 1.5
_HISTORY_LOOKS: dict[str, dict[str, Any]] = {
    "stated": {"color": GREY, "linewidth": 1.6},
    "stands": {"color": BLUE, "linewidth": 1.0},
    "overturns": {"color": VERMILION, "linewidth": 1.0, "linestyle": "-."},
}
# Places of the marks of overturned and of undecided runs, in tilts over α_c.
_FALLEN, _UNKNOWN = 1.25, 1.5
_UNDECIDED_MARK: dict[str, Any] = {"marker": "x", "linestyle": "none", "markersize": 5.5}


@styled
def margins_figure(assessment: Assessment, column: str) -> Figure:
    """Draw the overturning intervals of each record for a column, one line for each case."""
    own = assessment.data["margins"].sel(column=column)
    cases, records = ([str(name) for name in own[dim].to_numpy()] for dim in ("case", "record"))
    lines = len(records) * (len(cases) + 1)
    figure = new_figure(min(_FRAME + _ROW * lines, _TALLEST))
    axes = figure.subplots()
    low, high, _ = assessment.setting["margin_scales"]
    heights, labels = [], []
    for place, record in enumerate(records):
        for line, case in enumerate(cases):
            height = place * (len(cases) + 1) + line
            _interval_line(axes, own.sel(record=record, case=case), height, (low, high))
            heights.append(height)
            labels.append(f"{record} · {case}" if line == 0 else case)
    axes.set_yticks(heights, labels, fontsize="small")
    axes.set(xscale="log", xlim=(low, high), xlabel="scale factor of the record [1]", ylim=(lines - 0.5, -1.0))
    _plain(axes)
    axes.grid(visible=False, axis="y")
    for scale in assessment.setting["scales"]:
        axes.axvline(scale, color=BLACK, linewidth=1.2, linestyle="-" if scale == 1.0 else "--")
    handles: list[Patch | Line2D] = [
        Patch(facecolor=SKY, label="did not overturn"),
        Patch(facecolor=VERMILION, hatch="////", edgecolor="white", label="overturned"),
    ]
    if bool(own["undecided_from"].notnull().any()):
        handles.append(Patch(label=undecided_label(own["outcome"]), **fill_options(UNDECIDED)))
    handles += [
        Line2D([], [], color=BLACK, label="as recorded"),
        Line2D([], [], linestyle="none", marker="|", color=GREY, label="scales of the scan"),
    ]
    if any(scale != 1.0 for scale in assessment.setting["scales"]):
        handles.append(Line2D([], [], color=BLACK, linestyle="--", label="other stated scales"))
    figure.legend(handles=handles, loc="outside lower center", ncols=3)
    scanned = own["margin_scale"].to_numpy()
    axes.plot(scanned, np.full(scanned.size, -0.75), "|", color=GREY, markersize=4.0)
    axes.set_title(f"{column}: scale factors that overturned it")
    return figure


def _interval_line(axes: Axes, own: xr.Dataset, height: float, ends: tuple[float, float]) -> None:
    axes.barh(height, ends[1] - ends[0], _BAR, left=ends[0], color=SKY, linewidth=0.0)
    overturned = {"color": VERMILION, "hatch": "////", "edgecolor": "white"}
    _bars(axes, own["undecided_from"], own["undecided_to"], height, fill_options(UNDECIDED))
    _bars(axes, own["interval_from"], own["interval_to"], height, overturned)
    # This mark shows an interval too narrow for its bar.
    first = own["interval_from"].to_numpy()
    axes.plot(first, np.full(first.size, height), "|", color=VERMILION, markersize=6.5)


def _bars(axes: Axes, low: xr.DataArray, high: xr.DataArray, height: float, look: dict[str, Any]) -> None:
    known = low.notnull().to_numpy()
    left, right = low.to_numpy()[known], high.to_numpy()[known]
    axes.barh(np.full(left.size, height), right - left, _BAR, left=left, **{**look, "linewidth": 0.0})


@styled
def tilts_figure(assessment: Assessment, column: str, scale: float) -> Figure:
    """Draw the peak tilts of a column under each record at each dissipation, and those of the planar column."""
    own = assessment.data["verdicts"]["tilt_ratio"].sel(column=column, scale=scale)
    records = [str(name) for name in own["record"].to_numpy()]
    figure, axes = _rows_figure(records)
    heights = np.arange(len(records), dtype=float)
    handles, undecided = [], False
    levels = [str(name) for name in own["dissipation"].to_numpy()]
    for place, level in enumerate(levels):
        values = own.sel(dissipation=level, vertical="with").to_numpy()
        undecided |= bool(np.isnan(values).any())
        look: dict[str, Any] = {"marker": _MARKS[place % len(_MARKS)], "color": _COLOURS[place % len(_COLOURS)]}
        axes.plot(_placed(values), heights + 0.18 * (place - 1), linestyle="none", markersize=5.5, **look)
        axes.plot(
            *_undecided_marks(values, heights + 0.18 * (place - 1)), **{**_UNDECIDED_MARK, "color": look["color"]}
        )
        handles.append(Line2D([], [], linestyle="none", label=f"{level} dissipation", **look))
    if "planar" in assessment.data:
        flat = assessment.data["planar"]["planar_tilt_ratio"].sel(column=column, scale=scale).to_numpy()
        axes.plot(_placed(flat), heights, linestyle="none", marker="s", mfc="none", mec=VERMILION, markersize=8.0)
        handles.append(
            Line2D([], [], linestyle="none", marker="s", mfc="none", mec=VERMILION, label="planar (Housner)")
        )
    axes.axvspan(_FALLEN - 0.12, _FALLEN + 0.12, color="#eeeeee", zorder=0)
    last = _UNKNOWN if undecided else _FALLEN
    axes.set(xlim=(-0.03, last + 0.12), xlabel=r"peak tilt $\theta/\alpha_c$")
    ticks = {0.0: "0", 0.25: "0.25", 0.5: "0.5", 0.75: "0.75", 1.0: "1", _FALLEN: "overturned"}
    ticks |= {_UNKNOWN: "not\ndecided"} if undecided else {}
    axes.set_xticks(list(ticks), list(ticks.values()))
    axes.set_title(f"{column}, scale {scale:g}: peak tilt")
    figure.legend(handles=handles, loc="outside lower center", ncols=4)
    return figure


def _undecided_marks(values: np.ndarray, heights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the coordinates of the marks of undecided runs, beyond those of overturned runs."""
    chosen = np.isnan(values)
    return np.full(int(chosen.sum()), _UNKNOWN), heights[chosen]


def _placed(values: np.ndarray) -> np.ndarray:
    """Return the abscissas of tilts: overturned runs beyond all others, large tilts limited to stay below these."""
    return np.where(np.isinf(values), _FALLEN, np.minimum(values, _FALLEN - 0.16))


@styled
def contact_figure(assessment: Assessment, column: str) -> Figure:
    """Draw the friction that the runs of each record needed, and the stated coefficient."""
    own = assessment.data["verdicts"]["friction_demand"].sel(column=column)
    records = [str(name) for name in own["record"].to_numpy()]
    figure, axes = _rows_figure(records)
    scales = own["scale"].to_numpy()
    handles = []
    for place, scale in enumerate(scales):
        values = own.sel(scale=scale).stack(run=("dissipation", "vertical")).transpose("record", "run").to_numpy()
        look: dict[str, Any] = {"marker": _MARKS[place % len(_MARKS)], "color": _COLOURS[place % len(_COLOURS)]}
        heights = np.repeat(np.arange(len(records)), values.shape[1]) + 0.15 * (place - 0.5 * (scales.size - 1))
        axes.plot(values.ravel(), heights, linestyle="none", markersize=4.5, **look)
        handles.append(Line2D([], [], linestyle="none", label=f"scale {scale:g}, each run", **look))
    stated = float(assessment.setting["friction_coefficient"][column])
    axes.axvline(stated, color=VERMILION, linestyle="--", linewidth=1.6)
    handles.append(Line2D([], [], color=VERMILION, linestyle="--", label=f"stated coefficient {stated:g}"))
    axes.set(xlim=(0.0, None), xlabel="friction force needed / normal force [1]")
    axes.set_title(f"{column}: contact demand")
    figure.legend(handles=handles, loc="outside lower center", ncols=3)
    return figure


@styled
def shares_figure(assessment: Assessment, column: str, scale: float) -> Figure:
    """Draw the share of small variations that overturn a column under each record, and that of the near scales."""
    own = assessment.data["variations"].sel(column=column, scale=scale)
    band = assessment.data["margins"]["band_share"].sel(column=column, scale=scale).transpose("record", "case")
    records = [str(name) for name in own["record"].to_numpy()]
    figure, axes = _rows_figure(records)
    heights = np.arange(len(records), dtype=float)
    low, share, high = (100.0 * own[name].to_numpy() for name in ("share_low", "share", "share_high"))
    axes.barh(heights, high - low, 0.5, left=low, color=SKY, linewidth=0.0)
    axes.plot(share, heights, linestyle="none", marker="|", color=BLUE, markersize=9.0, markeredgewidth=2.0)
    handles: list[Patch | Line2D] = [
        Patch(facecolor=SKY, label="variations, 90 % sampling interval"),
        Line2D([], [], linestyle="none", marker="|", color=BLUE, markersize=9.0, label="variations, share"),
    ]
    for place, case in enumerate(band["case"].to_numpy()):
        look: dict[str, Any] = {"marker": _MARKS[place % len(_MARKS)], "mfc": "none"}
        look["mec"] = _COLOURS[place % len(_COLOURS)]
        axes.plot(100.0 * band.to_numpy()[:, place], heights, linestyle="none", markersize=5.5, **look)
        handles.append(Line2D([], [], linestyle="none", label=f"±10 %: {case}", **look))
    for limit in (100.0 * CLEAR, 100.0 * (1.0 - CLEAR)):
        axes.axvline(limit, color=GREY, linewidth=1.0, linestyle="--")
    axes.set(xlim=(-2.0, 102.0), xlabel="share that overturns it [%]")
    axes.set_title(f"{column}, scale {scale:g}: small variations and near scales")
    figure.legend(handles=handles, loc="outside lower center", ncols=3)
    return figure


@styled
def history_figure(assessment: Assessment, column: str) -> Figure:
    """Draw the motion of a column under its governing record, at the stated scale and on both sides of the margin.

    The figure shows tilt and base acceleration against time, and the path of the tilt vector.
    """
    own = assessment.data["histories"].sel(column=column)
    figure = new_figure(4.4)
    grid = figure.add_gridspec(2, 2, width_ratios=(1.6, 1.0))
    above = figure.add_subplot(grid[0, 0])
    below = figure.add_subplot(grid[1, 0], sharex=above)
    path = figure.add_subplot(grid[:, 1])
    shown = [own.sel(run=run) for run in own["run"].to_numpy() if np.isfinite(float(own["scale"].sel(run=run)))]
    for one in shown:
        look = _HISTORY_LOOKS[str(one["run"].item())]
        above.plot(one["time"], one["amplitude"], label=_run_words(one), **look)
        path.plot(one["tilt_x"], one["tilt_y"], **{**look, "linewidth": 0.7})
    above.axhline(1.0, color=VERMILION, linestyle="--", linewidth=1.0)
    highest = min(_MOST_TILT, max(1.0, float(own["amplitude"].max())))
    above.set(ylabel=r"tilt $\theta/\alpha_c$", ylim=(0.0, 1.05 * highest))
    recorded = max(shown, key=lambda one: float(one["time"].max()))
    for axis, colour, width in (("x", BLACK, 0.6), ("y", ORANGE, 0.6)):
        below.plot(
            recorded["time"], recorded[f"base_{axis}"] / recorded["scale"], color=colour, linewidth=width, label=axis
        )
    below.set(xlabel="time [s]", ylabel="record [m/s²]")
    below.legend(loc="upper right", ncols=2)
    around = np.linspace(0.0, 2.0 * math.pi, 181)
    path.plot(np.cos(around), np.sin(around), color=VERMILION, linestyle="--", linewidth=1.0)
    path.set(xlabel=r"tilt $\theta_x/\alpha_c$", ylabel=r"tilt $\theta_y/\alpha_c$", aspect="equal")
    path.set(xlim=(-_MOST_TILT, _MOST_TILT), ylim=(-_MOST_TILT, _MOST_TILT))
    figure.legend(*above.get_legend_handles_labels(), loc="outside lower center", ncols=1)
    record = str(assessment.data["summary"]["governing"].sel(column=column).item())
    figure.suptitle(f"{column} under {record}", fontsize=10)
    return figure


def _run_words(run: xr.Dataset) -> str:
    """Describe scale, case and outcome of a run under the governing record."""
    tilt = float(run["peak_tilt_ratio"])
    if undecided_reasons(run["outcome"]):
        outcome = undecided_label(run["outcome"])
    elif math.isinf(tilt):
        outcome = "overturned"
    else:
        outcome = rf"did not overturn, peak tilt {number(tilt)} $\alpha_c$" if tilt > 0.0 else "did not move"
    case = str(run["case"].item())
    level = f"{case} dissipation" if "," not in case else case.replace(",", " dissipation,")
    return f"scale {number(float(run['scale']), 4)}, {level}: {outcome}"


def _rows_figure(records: list[str]) -> tuple[Figure, Axes]:
    figure = new_figure(min(_FRAME + 2.0 * _ROW * len(records), _TALLEST))
    axes = figure.subplots()
    axes.set_yticks(range(len(records)), records, fontsize="small")
    axes.set_ylim(len(records) - 0.5, -0.5)
    return figure, axes


def _plain(axes: Axes) -> None:
    low, high = axes.get_xlim()
    ticks = [value for value in (0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0, 7.0, 10.0) if low <= value <= high]
    axes.set_xticks(ticks)
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())
