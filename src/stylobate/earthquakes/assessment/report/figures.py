"""Figures of an assessment, each with its caption: records, margins, tilts, small variations, histories."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter, NullFormatter

from stylobate.column.numbers import STANDARD_GRAVITY
from stylobate.earthquakes.assessment.inputs import CENTRAL, OTHER_LAW
from stylobate.earthquakes.assessment.report.column_verdict import recorded_scale, rises, slides_at
from stylobate.earthquakes.assessment.report.sketch import OBJECTS, objects_figure
from stylobate.earthquakes.assessment.report.sliding_tables import slip_pictures
from stylobate.earthquakes.assessment.report.wording import OVERTURNING, SMALLEST_TILT, labels, number
from stylobate.earthquakes.figures.fragility import plot_empirical_rate, plot_fragility
from stylobate.earthquakes.figures.overturning_intervals import UNDECIDED, undecided_label, undecided_reasons
from stylobate.earthquakes.fragility.observations import LIMIT_STATE
from stylobate.plots.cells import fill_options
from stylobate.plots.labels import literal, with_literal_names
from stylobate.plots.page import Picture
from stylobate.plots.style import BLACK, BLUE, GREEN, GREY, ORANGE, PALETTE, PURPLE, SKY, VERMILION, new_figure, styled
from stylobate.results.assessment import Assessment
from stylobate.results.verdict import CLEAR

# Width of figures; heights of a line, of the frame, and of the smallest and the tallest figure [inches].
_WIDTH, _ROW, _FRAME, _SMALLEST, _TALLEST = 7.1, 0.1, 1.05, 2.3, 9.0
# Height of a record and of the frame of a figure of tilts or shares [inches].
_TILT_ROW, _TILT_FRAME = 0.34, 1.5
# With more records, a figure of margins has the central cases only.
_ALL_LEVELS = 8
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
    records = labels(own)
    cases = _drawn_cases(labels(own, "case"), len(records))
    lines = len(records) * (len(cases) + 1)
    figure = new_figure(min(max(_FRAME + _ROW * lines, _SMALLEST), _TALLEST), width=_WIDTH)
    axes = figure.subplots()
    low, high, _ = assessment.setting["margin_scales"]
    heights, lines_of = [], []
    for place, record in enumerate(records):
        for line, case in enumerate(cases):
            height = place * (len(cases) + 1) + line
            _interval_line(axes, own.sel(record=record, case=case), height, (low, high))
            heights.append(height)
            lines_of.append(f"{record} · {case}" if line == 0 else case)
    axes.set_yticks(heights, lines_of, fontsize=6.5)
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


def _drawn_cases(cases: list[str], records: int) -> list[str]:
    """Return the levels of dissipation and the central one with the other contact law; of many records the latter."""
    levels = [case for case in cases if "," not in case and (case == CENTRAL or records <= _ALL_LEVELS)]
    return [*levels, *(case for case in cases if case == f"{CENTRAL}{OTHER_LAW}")]


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
    records = labels(own)
    figure, axes = _rows_figure(records)
    heights = np.arange(len(records), dtype=float)
    handles, undecided = [], False
    levels = labels(own, "dissipation")
    for place, level in enumerate(levels):
        values = own.sel(dissipation=level, vertical="with").to_numpy()
        undecided |= bool(np.isnan(values).any())
        look, beside = _look(place), heights + 0.18 * (place - 1)
        axes.plot(_placed(values), beside, linestyle="none", markersize=5.5, **look)
        unknown = beside[np.isnan(values)]
        axes.plot(np.full(unknown.size, _UNKNOWN), unknown, **{**_UNDECIDED_MARK, "color": look["color"]})
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


def _look(place: int) -> dict[str, Any]:
    return {"marker": _MARKS[place % len(_MARKS)], "color": _COLOURS[place % len(_COLOURS)]}


def _placed(values: np.ndarray) -> np.ndarray:
    """Return the abscissas of tilts: overturned runs beyond all others, large tilts limited to stay below these."""
    return np.where(np.isinf(values), _FALLEN, np.minimum(values, _FALLEN - 0.16))


@styled
def shares_figure(assessment: Assessment, column: str, scale: float) -> Figure:
    """Draw the share of small variations that overturn a column under each record, and that of the near scales."""
    own = assessment.data["variations"].sel(column=column, scale=scale)
    band = assessment.data["margins"]["band_share"].sel(column=column, scale=scale).transpose("record", "case")
    records = labels(own)
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
    figure = new_figure(min(_TILT_FRAME + _TILT_ROW * len(records), _TALLEST))
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


_RECORDS_A_FIGURE = 6
"""Number of records in one figure of components."""
# Height of a row and of the frame [inches]; largest number of records that have a colour each.
_RECORD_ROW, _RECORD_FRAME, _COLOURED = 0.62, 0.75, 6


@styled
def _records_figure(assessment: Assessment, records: Sequence[str]) -> Figure:
    """Draw the components of records against time, one row for each record."""
    own = assessment.data["ground_motions"]
    figure = new_figure(_RECORD_FRAME + _RECORD_ROW * len(records), width=_WIDTH)
    grid = figure.subplots(len(records), 3, squeeze=False, sharey="row", sharex="row")
    for row, name in zip(grid, records, strict=True):
        one = own.sel(record=name)
        for axes, axis in zip(row, ("x", "y", "z"), strict=True):
            acceleration = one["acceleration"].sel(axis=axis) / STANDARD_GRAVITY
            axes.plot(one["time"], acceleration, color=BLACK, linewidth=0.4)
            if not bool((acceleration != 0.0).where(one["time"].notnull()).any()):
                axes.text(0.5, 0.6, "none", transform=axes.transAxes, color=GREY, ha="center", fontsize="small")
            axes.tick_params(labelsize=7.5)
        row[0].set_title(name, fontsize="small", pad=2.0)
    for axes, title in zip(grid[-1], ("along x", "along y", "up"), strict=True):
        axes.set_xlabel(f"{title}: time [s]", fontsize="small")
    figure.supylabel("ground acceleration [g]", fontsize="small")
    return figure


@styled
def spectra_figure(assessment: Assessment) -> Figure:
    """Draw the response spectra of the records, their mean, and the design spectrum if it is given."""
    own = assessment.data["spectra"]["spectral_acceleration"].transpose("record", "period") / STANDARD_GRAVITY
    period = own["period"].to_numpy()
    figure = new_figure(2.6, width=_WIDTH)
    axes = figure.subplots()
    few = own.sizes["record"] <= _COLOURED
    for place, name in enumerate(own["record"].to_numpy()):
        look = {"color": PALETTE[place], "label": str(name)} if few else {"color": GREY, "alpha": 0.6}
        axes.plot(period, own.sel(record=name), linewidth=0.9, **look)
    if own.sizes["record"] > 1:
        axes.plot(period, own.mean("record"), color=BLACK, linewidth=2.2, label="mean of the records")
    design = assessment.setting.get("details", {}).get("design_spectrum")
    if design:
        axes.plot(
            design["period"],
            np.array(design["acceleration"]) / STANDARD_GRAVITY,
            color=VERMILION,
            linestyle="--",
            linewidth=2.2,
            label=literal(str(design["name"])),
        )
    axes.set(xlim=(0.0, float(period[-1])), ylim=(0.0, None), xlabel="natural period [s]", ylabel="Sa [g]")
    axes.legend(loc="upper right", fontsize="small")
    axes.set_title("Response spectra, 5 % damping, records as recorded (scale 1)")
    return figure


Pictures = dict[str, Picture]


def report_pictures(assessment: Assessment) -> Pictures:
    """Return the pictures by file name; each name begins with the name of the section."""
    drawn = replace(assessment, data={name: with_literal_names(data) for name, data in assessment.data.items()})
    columns, called = labels(drawn.data["columns"], "column"), labels(assessment.data["columns"], "column")
    found = _of_objects(drawn, columns, called) | _of_records(drawn)
    for place, (name, column) in enumerate(zip(called, columns, strict=True)):
        found |= _of_column(drawn, str(column), str(name), place + 1)
    return found | _of_rates(drawn)


def _of_objects(assessment: Assessment, columns: Sequence[str], called: Sequence[str]) -> Pictures:
    """Return the sketches of the columns, a few in each picture."""
    caption = (
        "The objects to one scale. Dashed: at their peak tilt under the record below, or lying if it overturned them, "
        "at central dissipation. Middle: the record along x (black) and y (orange). Below: the tilt; dashed, the "
        "tipping angle α_c."
    )
    return {
        f"objects-{first // OBJECTS + 1}": Picture(
            objects_figure(assessment, columns[first : first + OBJECTS], called[first : first + OBJECTS]), caption
        )
        for first in range(0, len(columns), OBJECTS)
    }


def _of_records(assessment: Assessment) -> Pictures:
    if "ground_motions" not in assessment.data:
        return {}
    names = labels(assessment.data["ground_motions"])
    found = {}
    for first in range(0, len(names), _RECORDS_A_FIGURE):
        some = names[first : first + _RECORDS_A_FIGURE]
        found[f"records-{first // _RECORDS_A_FIGURE + 1}"] = Picture(
            _records_figure(assessment, some), "Ground accelerations as recorded (scale 1) along x, y and up."
        )
    design = assessment.setting.get("details", {}).get("design_spectrum")
    over = f" Dashed: {design['name']}, {100.0 * design['damping']:g} % damping." if design else ""
    found["spectra-1"] = Picture(
        spectra_figure(assessment),
        "Pseudo-acceleration spectra of the records and their mean. They are RotD50; the spectrum of a record along "
        f"one axis is that of its component.{over}",
    )
    return found


def _of_rates(assessment: Assessment) -> Pictures:
    """Return the figure of the annual rates of overturning by intensity, counted from the runs."""
    if "rates" not in assessment.data:
        return {}
    rates = assessment.data["rates"].sel(limit_state=OVERTURNING, drop=True)
    own = rates.sel(column=rates["annual_rate"].notnull()).rename(column=LIMIT_STATE)
    if not own.sizes[LIMIT_STATE]:
        return {}
    caption = (
        "Hazard curve of the site and, below, the intensities that contribute to the annual rate of overturning, "
        "counted from the runs at central dissipation: the area of a range is its share of the rate."
    )
    return {"rates-1": Picture(plot_empirical_rate(own), caption)}


def _of_column(assessment: Assessment, column: str, called: str, place: int) -> Pictures:
    """Return the pictures of a `column`, which is `called` otherwise outside figures."""
    found = {}
    slides = slides_at(assessment, column, recorded_scale(assessment))
    if not slides and bool((assessment.data["margins"]["intervals"].sel(column=column) > 0).any()):
        found[f"margins-{place}"] = Picture(
            margins_figure(assessment, column),
            f"{called}: scale factors of each record at which it overturned (hatched) or did not. An interval narrower "
            "than the step of the scan may have been missed.",
        )
    if bool((assessment.data["histories"]["peak_tilt_ratio"].sel(column=column) > SMALLEST_TILT).any()):
        found[f"history-{place}"] = Picture(
            history_figure(assessment, column),
            f"{called} under its governing record. Left: tilt and base acceleration against time. Right: path of the "
            "tilt. Dashed: the tipping angle α_c, at which the centre of mass stands above the rim.",
        )
    with_vertical = any(rises(assessment, name) for name in labels(assessment.data["records"]))
    vertical = " (vertical component included)" if with_vertical else ""
    for scale in assessment.setting["scales"]:
        if not _rocked(assessment, column, scale):
            continue
        found[f"tilts-{place}-scale-{scale:g}"] = Picture(
            tilts_figure(assessment, column, scale),
            f"{called} at scale {scale:g}: peak tilts at each dissipation{vertical}, and those of the planar column if "
            "it was computed.",
        )
        if "variations" in assessment.data:
            found[f"variations-{place}-scale-{scale:g}"] = Picture(
                shares_figure(assessment, column, scale),
                f"{called} at scale {scale:g}: share of small variations that overturn it, with its 90 % sampling "
                "interval (bar), and share of the scales within 10 % that do so (marks, one for each case). Between "
                "the dashed limits the case is undecided.",
            )
    found |= {f"{name}-{place}": one for name, one in slip_pictures(assessment, column).items()}
    if "fragility" in assessment.data:
        found[f"fragility-{place}"] = Picture(
            plot_fragility(assessment.data["fragility"].sel(column=column)), f"{called}: fragility."
        )
    return found


def _rocked(assessment: Assessment, column: str, scale: float) -> bool:
    """Return whether any run at a scale tilted the column, or was not decided."""
    runs = assessment.data["verdicts"].sel(column=column, scale=scale)
    return bool(np.any((runs["tilt_ratio"].to_numpy() > SMALLEST_TILT) | (runs["overturned"].to_numpy() != 0)))
