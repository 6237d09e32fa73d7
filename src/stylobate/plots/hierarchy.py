"""Comparison of the models of the hierarchy: tilt histories, contact demand, convergence with slenderness."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from stylobate.errors import Outcome
from stylobate.plots.cells import OUTCOME_LOOKS, UNFINISHED_CLASS, Look, MapClass, classes_of, fill_options, percent
from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import axis_label
from stylobate.plots.maps import draw_classes
from stylobate.plots.style import BLACK, GREY, PALETTE, new_figure, styled
from stylobate.results.outcomes import outcome_label

# Models without free axial rotation are blue and black, models with it vermilion and orange; finite tilt is dashed.
_LINES: dict[str, dict[str, Any]] = {
    "slender": {"color": PALETTE[4], "linestyle": "-", "linewidth": 2.8},
    "slender rolling": {"color": PALETTE[5], "linestyle": "-", "linewidth": 2.8},
    "wobbling": {"color": PALETTE[0], "linestyle": "--", "linewidth": 1.3},
    "rolling": {"color": PALETTE[1], "linestyle": "--", "linewidth": 1.3},
    "planar rocking": {"color": BLACK, "linestyle": ":", "linewidth": 1.3},
}
_MARKS = {"slender": "o", "slender rolling": "s", "wobbling": "D", "rolling": "^", "planar rocking": "v"}
# Pairs whose deviation is drawn against the slenderness: they differ in finite tilt, or in free axial rotation.
_PAIRS = (("slender", "rolling"), ("slender", "wobbling"), ("slender rolling", "rolling"))
# The line proportional to c² lies below the deviations by this factor.
_BELOW, _ORDER = 0.3, 2

_DIFFERENCES = (
    Look("#F6F1DA", ink="#333333"),
    Look(PALETTE[0], "///"),
    Look(PALETTE[5], "...", "#333333"),
    Look("#1B0B16"),
    OUTCOME_LOOKS[Outcome.FAILED],
)


@figure_of("model hierarchy")
@styled
def plot_hierarchy(found: xr.Dataset) -> Figure:
    """Return a figure that compares the models of the hierarchy.

    If the result has histories, the upper panels show the tilt of all models against time, and the spin if there is
    any, at the largest slenderness. The lower panels show the convergence of the models as c falls or, for a single
    slenderness, the contact demand.
    """
    if found.sizes.get("slenderness") == 1:  # no convergence to show
        found = found.isel(slenderness=0)
        found = found.assign_attrs(column_slenderness=float(found["slenderness"]))
    several = "slenderness" in found.dims
    shown = found.isel(slenderness=int(np.argmax(found["slenderness"].to_numpy()))) if several else found
    c = float(shown["slenderness"]) if several else float(found.attrs["column_slenderness"])
    kept = "amplitude" in found
    spinning = kept and bool(np.nanmax(np.abs(shown["spin"].fillna(0.0))) > 0.0)
    rows = 1.6 * kept, 1.0 * spinning, 1.5
    heights = [height for height in rows if height]
    figure = new_figure(0.5 + 1.75 * sum(heights))
    grid = figure.add_gridspec(len(heights), 2, height_ratios=heights)
    if kept:
        tilt = figure.add_subplot(grid[0, :])
        _draw_histories(tilt, shown, c)
        if spinning:
            spin = figure.add_subplot(grid[1, :], sharex=tilt)
            _draw_spin(spin, shown)
            tilt.tick_params(labelbottom=False)
            tilt.set_xlabel("")
    left, right = figure.add_subplot(grid[-1, 0]), figure.add_subplot(grid[-1, 1])
    if several:
        _draw_convergence(left, found)
        _draw_over_slenderness(right, found)
    else:
        _draw_tilts(left, found, c)
        _draw_demands(right, found)
    return figure


def _draw_histories(axes: Axes, shown: xr.Dataset, c: float) -> None:
    for model in shown["model"].to_numpy():
        axes.plot(shown["time"], shown["amplitude"].sel(model=model), label=_label(shown, model), **_LINES[str(model)])
    axes.axhline(c, color=GREY, linewidth=0.9, linestyle=(0, (4, 2)))
    axes.set_ylim(0.0, 1.05 * max(c, min(float(shown["amplitude"].max()), 3.0 * c)))
    axes.annotate(
        r"$\theta = c$",
        (1.0, c),
        xycoords=("axes fraction", "data"),
        ha="right",
        va="bottom",
        fontsize="small",
        color=GREY,
    )
    axes.set_ylabel(r"tilt $\theta$ [rad]")
    axes.set_xlabel(axis_label(shown["time"]))
    axes.margins(x=0.0)
    axes.set_title(f"$c = {c:.4g}$")
    assert isinstance(axes.figure, Figure)
    axes.figure.legend(*axes.get_legend_handles_labels(), loc="outside upper center", ncols=2)


def _label(shown: xr.Dataset, model: str) -> str:
    return f"{model}: {outcome_label(int(shown['outcome'].sel(model=model)))}"


def _draw_spin(axes: Axes, shown: xr.Dataset) -> None:
    for model in shown["model"].to_numpy():
        spin = shown["spin"].sel(model=model)
        if bool(spin.notnull().any()):
            axes.plot(shown["time"], spin, **_LINES[str(model)])
    axes.set_ylabel(axis_label(shown["spin"]))
    axes.set_xlabel(axis_label(shown["time"]))


def _draw_tilts(axes: Axes, found: xr.Dataset, c: float) -> None:
    place = np.arange(found.sizes["model"])[::-1]
    for name, label, filled in (("peak_tilt", "peak", True), ("mean_late_tilt", "late mean", False)):
        _draw_dots(axes, place, found[name].to_numpy() / c, found["model"].to_numpy(), filled=filled)
        axes.plot([], [], "o", color=GREY, markerfacecolor=GREY if filled else "white", label=label)
    axes.set_yticks(place, list(found["model"].to_numpy()))
    axes.set_ylim(-0.6, place.size - 0.1)
    axes.set_xlim(left=0.0)
    axes.set_xlabel(r"tilt $\theta/c$")
    axes.legend(loc="upper right", ncols=2, fontsize="small", borderpad=0.1, handletextpad=0.1, columnspacing=0.8)


def _draw_dots(axes: Axes, place: np.ndarray, values: np.ndarray, models: np.ndarray, *, filled: bool) -> None:
    for at, value, model in zip(place, values, models, strict=True):
        colour = _LINES[str(model)]["color"]
        axes.plot(value, at, "o", color=colour, markerfacecolor=colour if filled else "white", markersize=6)


def _draw_demands(axes: Axes, found: xr.Dataset) -> None:
    place = np.arange(found.sizes["model"])[::-1]
    for name, label, filled in (
        ("peak_friction_demand", "friction", True),
        ("peak_pivoting_demand", "pivoting", False),
    ):
        values = found[name].to_numpy()
        _draw_dots(axes, place, np.where(np.isfinite(values), values, np.nan), found["model"].to_numpy(), filled=filled)
        axes.plot([], [], "o", color=GREY, markerfacecolor=GREY if filled else "white", label=label)
    given = found.attrs.get("friction_coefficient")
    if given is not None:
        axes.axvline(given, color=GREY, linewidth=0.9, linestyle=(0, (4, 2)), label="coefficient")
    axes.set_yticks(place, [])
    axes.set_ylim(-0.6, place.size - 0.1)
    axes.set_xlim(left=0.0)
    axes.set_xlabel("peak contact demand")
    axes.legend(loc="upper left", ncols=3, fontsize="small", borderpad=0.1, handletextpad=0.1, columnspacing=0.8)


def _draw_convergence(axes: Axes, found: xr.Dataset) -> None:
    """Draw the deviations over c against c, with a line proportional to c²."""
    c = found["slenderness"].sortby("slenderness").to_numpy()
    models = set(found["model"].to_numpy())
    deviation = found["deviation"].sortby("slenderness")
    styles = ((BLACK, "v", ":"), (PALETTE[0], "o", "-"), (PALETTE[1], "^", "-"))
    for (first, second), (colour, marker, style) in zip(_PAIRS, styles, strict=True):
        if {first, second} <= models:
            relative = deviation.sel(model=first, other_model=second).to_numpy() / c
            name = f"{second} from {first}"
            axes.plot(c, relative, color=colour, marker=marker, markersize=4.5, linestyle=style, label=name)
    least = deviation.sel(model="slender", other_model="wobbling").to_numpy() / c
    guide = _BELOW * least[-1] * (c / c[-1]) ** _ORDER
    axes.plot(c, guide, color=GREY, linewidth=0.8, linestyle=(0, (4, 2)), label="proportional to $c^2$")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.legend(loc="upper left", bbox_to_anchor=(0.0, 0.93), fontsize="x-small")
    _set_slendernesses(axes, c)
    axes.set_ylabel(r"maximum distance of tilts over $c$")


def _draw_over_slenderness(axes: Axes, found: xr.Dataset) -> None:
    ordered = found.sortby("slenderness")
    c = ordered["slenderness"].to_numpy()
    top = 0.0
    for model in found["model"].to_numpy():
        line = _LINES[str(model)]
        values = ordered["mean_late_tilt"].sel(model=model).to_numpy() / c
        axes.plot(c, values, marker=_MARKS[str(model)], markersize=4.5, label=str(model), **{**line, "linewidth": 1.3})
        top = float(np.nanmax([top, *values]))
    axes.set_xscale("log")
    _set_slendernesses(axes, c)
    axes.set_ylim(0.0, 1.1 * top or 1.0)
    axes.set_ylabel(r"late mean tilt $\theta/c$")
    axes.legend(fontsize="small")


def _set_slendernesses(axes: Axes, c: np.ndarray) -> None:
    axes.set_xticks(c, [f"{value:g}" for value in c])
    axes.set_xticks([], minor=True)
    axes.set_xlabel("slenderness $c$")


@figure_of("outcome differences")
@styled
def plot_outcome_differences(found: xr.Dataset) -> Figure:
    """Draw a map of the points at which two models disagree whether the column overturns."""
    figure = new_figure(4.6)
    axes = figure.subplots()
    names = [
        str(name).replace("the first", found.attrs["first"]).replace("the second", found.attrs["second"])
        for name in found["comparison_name"].to_numpy()
    ]
    classes = classes_of(names, _DIFFERENCES)
    draw_classes(axes, found, found["comparison"], [*classes, UNFINISHED_CLASS])
    figure.legend(handles=_entries(found, classes), loc="outside upper center", ncols=2)
    return figure


def _entries(found: xr.Dataset, classes: Sequence[MapClass]) -> list[Artist]:
    codes = found["comparison"].to_numpy()
    counts = [int(np.count_nonzero(codes == one.code)) for one in classes]
    entries: list[Artist] = [
        Patch(label=f"{one.name}  {percent(count, codes.size)}", **fill_options(one.look))
        for one, count in zip(classes, counts, strict=True)
        if count
    ]
    return entries or [Line2D([], [], label="nothing computed", linestyle="none")]
