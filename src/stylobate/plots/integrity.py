"""Integrity of basins: the nearest overturning initial condition, and its distance along a parameter."""

from typing import Any, Literal

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Ellipse

from stylobate.plots.cells import set_scale
from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import axis_label
from stylobate.plots.maps import draw_outcomes
from stylobate.plots.style import BLACK, BLUE, VERMILION, new_figure, styled

_NEAREST: dict[str, Any] = {"marker": "X", "color": VERMILION, "markeredgecolor": "white", "markersize": 8}
_MAP_HEIGHT, _CURVE_HEIGHT = 4.6, 3.8


@figure_of("integrity")
@styled
def plot_integrity(found: xr.Dataset) -> Figure:
    """Draw the outcomes over two initial conditions, with the largest safe ellipse about the reference.

    The ellipse is the circle of the distance in units of c and cω0; dashed if nothing overturned within the grid.
    """
    figure = new_figure(_MAP_HEIGHT)
    axes = figure.subplots()
    legend = draw_outcomes(axes, found)
    names = [str(dim) for dim in found["outcome"].dims]
    distance, bound = float(found["distance"]), bool(found["at_least"])
    # A start phase adds no distance: the ellipse is then a band.
    half = [distance * float(found.attrs.get(f"unit_{name}", np.inf)) for name in names]
    centre = [float(found.attrs.get(f"reference_{name}", np.nan)) for name in names]
    if np.all(np.isfinite(half)):
        line: Literal["--", "-"] = "--" if bound else "-"
        size = {"width": 2.0 * half[0], "height": 2.0 * half[1]}
        for colour, width in (("white", 3.4), (VERMILION, 1.8)):
            axes.add_patch(Ellipse((centre[0], centre[1]), **size, fill=False, ec=colour, lw=width, ls=line, zorder=3))
        low = float(found["distance_low"])
        name = f"distance at least {low:.3g}" if bound else f"distance {low:.3g} to {distance:.3g}"
        legend.append(Line2D([], [], color=VERMILION, linewidth=1.8, linestyle=line, label=name))
    for colour, width in (("white", 3.4), (BLACK, 1.6)):
        axes.plot(*centre, marker="+", color=colour, markersize=9, markeredgewidth=width, zorder=4)
    if not bound and set(names) <= set(found["start"].to_numpy()):
        nearest = [float(found["nearest"].sel(start=name)) for name in names]
        axes.plot(*nearest, zorder=4, **_NEAREST)
        legend.append(Line2D([], [], label="nearest overturning run", linestyle="none", **_NEAREST))
    figure.legend(handles=legend, loc="outside right upper")
    return figure


@figure_of("erosion")
@styled
def plot_erosion(found: xr.Dataset) -> Figure:
    """Draw the integrity along a parameter, with the uncertainty due to the resolution of the grid.

    Hollow triangles are lower bounds, because nothing overturned within the grid.
    """
    figure = new_figure(_CURVE_HEIGHT, width=5.6)
    axes = figure.subplots()
    (name,) = found["integrity"].dims
    ordered = found.sortby(str(name))
    x, y = ordered[str(name)].to_numpy(), ordered["distance"].to_numpy()
    low, bound = ordered["distance_low"].to_numpy(), ordered["at_least"].to_numpy()
    axes.fill_between(x, low, y, color=BLUE, alpha=0.22, linewidth=0.0, label="within a cell's diagonal")
    axes.plot(x, y, color=BLUE, linewidth=1.6)
    axes.plot(x[~bound], y[~bound], "o", color=BLUE, label="nearest overturning run")
    if bound.any():
        axes.plot(x[bound], y[bound], "^", color=BLUE, mfc="white", label="lower bound: the grid ends")
    set_scale(axes, "x", x)
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel(axis_label(found[str(name)]))
    axes.set_ylabel(r"distance, in $c$ and $c\,\omega_0$")
    axes.legend()
    first = float(found["distance"][0])
    if first > 0.0:
        functions: Any = (lambda value: value / first, lambda value: value * first)
        ratio = axes.secondary_yaxis("right", functions=functions)
        ratio.set_ylabel("integrity over its first value")
        ratio.spines["right"].set_visible(True)
    return figure
