"""Basins of attraction, attractors and their fractions."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from stylobate.plots.cells import fill_options, percent
from stylobate.plots.classes import MapClass, attractor_classes
from stylobate.plots.maps import draw_classes
from stylobate.plots.style import BLACK, GREY, new_figure, styled

_MAP_HEIGHT, _TABLE_HEIGHT = 4.6, 3.4
_COMPONENTS = {"tilt_x": ("attractor_tilt", "x"), "tilt_y": ("attractor_tilt", "y")} | {
    "tilt_rate_x": ("attractor_tilt_rate", "x"),
    "tilt_rate_y": ("attractor_tilt_rate", "y"),
}
_MARKER: dict[str, Any] = {"marker": "o", "linestyle": "none", "markerfacecolor": "white", "markeredgecolor": BLACK}


@styled
def plot_basins(found: xr.Dataset) -> Figure:
    """Return a figure of basins: on a grid a map of which start leads where, else fractions and orbits.

    On a map circles mark the strobed states of the attractors, at phase zero of the base motion. Error bars are the
    intervals of the fractions.

    Parameters
    ----------
    found
        Result of `stylobate.studies.basins` or `attractors`, finished or not.
    """
    dims = found["attractor"].dims if "attractor" in found else ()
    if len(dims) == 2:  # noqa: PLR2004  a plane
        return _plot_grid(found)
    figure = new_figure(_TABLE_HEIGHT)
    bars, orbits = figure.subplots(1, 2, width_ratios=(1.25, 1.0))
    _draw_fractions(bars, found)
    _draw_orbits(orbits, found)
    return figure


def _plot_grid(found: xr.Dataset) -> Figure:
    figure = new_figure(_MAP_HEIGHT)
    axes = figure.subplots()
    legend = draw_classes(axes, found, found["attractor"], attractor_classes(found))
    legend += _mark_attractors(axes, found)
    figure.legend(handles=legend, loc="outside right upper")
    return figure


def _mark_attractors(axes: Axes, found: xr.Dataset) -> list[Artist]:
    dims = [str(dim) for dim in found["attractor"].dims]
    if any(dim not in _COMPONENTS for dim in dims):
        return []
    x, y = (found[name].sel(axis=axis).to_numpy().ravel() for name, axis in map(_COMPONENTS.__getitem__, dims))
    inside = np.isfinite(x) & np.isfinite(y)
    if not inside.any():
        return []
    limits = axes.get_xlim(), axes.get_ylim()
    axes.plot(x[inside], y[inside], markersize=6.5, zorder=3, **_MARKER)
    axes.set(xlim=limits[0], ylim=limits[1])
    return [Line2D([], [], label="attractors, at the strobe", markersize=6.5, **_MARKER)]


def _draw_fractions(axes: Axes, found: xr.Dataset) -> None:
    """Draw a bar for each attractor, from the top, with the interval of its fraction."""
    classes = attractor_classes(found)[: found.sizes["attractor_index"]]
    fraction = found["fraction"].to_numpy()
    low, high = found["fraction_low"].to_numpy(), found["fraction_high"].to_numpy()
    for place, one in enumerate(classes):
        axes.barh(place, fraction[place], height=0.62, zorder=2, **fill_options(one.look))
        axes.annotate(
            percent(int(found["count"][place]), int(found["computed"])),
            (high[place], place),
            xytext=(4, 0),
            textcoords="offset points",
            va="center",
            fontsize=8.5,
        )
    bounds = np.maximum([fraction - low, high - fraction], 0.0)
    axes.errorbar(fraction, np.arange(len(classes)), xerr=bounds, fmt="none", ecolor=GREY, capsize=3, zorder=3)
    axes.set_yticks(range(len(classes)), [one.name for one in classes])
    axes.invert_yaxis()
    axes.grid(visible=False, axis="y")
    axes.set_xlim(0.0, 1.18 * max(float(high.max(initial=0.0)), 0.05))
    axes.set_xlabel(f"fraction of {_runs(found)}")
    confidence = 100.0 * float(found.attrs["confidence"])
    axes.set_title(f"basin fractions, {confidence:g} % intervals")


def _runs(found: xr.Dataset) -> str:
    unsettled = int(found["unsettled"])
    told = f"{int(found['computed'])} starts"
    return f"{told}, {unsettled} of them unsettled" if unsettled else told


def _draw_orbits(axes: Axes, found: xr.Dataset) -> None:
    """Draw the path of each attractor's tilt, with its strobed states."""
    for place, one in enumerate(attractor_classes(found)[: found.sizes["attractor_index"]]):
        path = found["orbit_tilt"].isel(attractor_index=place)
        strobes = found["attractor_tilt"].isel(attractor_index=place)
        if bool(path.notnull().all()):
            _draw_orbit(
                axes, path.sel(axis="x"), path.sel(axis="y"), one, repeats=bool(found["attractor_period"][place])
            )
        axes.plot(strobes.sel(axis="x"), strobes.sel(axis="y"), markersize=5.0, zorder=3, **_MARKER)
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel("tilt α₁ [rad]")
    axes.set_ylabel("tilt α₂ [rad]")
    axes.set_title("orbits, ○ at the strobe")


def _draw_orbit(axes: Axes, x: xr.DataArray, y: xr.DataArray, one: MapClass, *, repeats: bool) -> None:
    if repeats:
        # A dark edge carries pale colours on white paper.
        axes.plot(x, y, color=BLACK, linewidth=2.4)
        axes.plot(x, y, color=one.look.colour, linewidth=1.3)
    else:
        axes.plot(x, y, color=one.look.colour, linewidth=0.7, zorder=1.5)
