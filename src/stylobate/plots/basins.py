"""Basins of attraction, attractors and their fractions."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import to_hex, to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from stylobate.plots.cells import fill_options, percent
from stylobate.plots.classes import attractor_classes
from stylobate.plots.kinds import figure_of
from stylobate.plots.maps import draw_classes
from stylobate.plots.style import BLACK, GREY, new_figure, styled
from stylobate.text import plural

_MAP_HEIGHT, _TABLE_HEIGHT = 4.6, 3.4
_COMPONENTS = {"tilt_x": ("attractor_tilt", "x"), "tilt_y": ("attractor_tilt", "y")} | {
    "tilt_rate_x": ("attractor_tilt_rate", "x"),
    "tilt_rate_y": ("attractor_tilt_rate", "y"),
}
_AT_REST = "at rest"
# Dashes with gaps that show other lines, and the fraction of brightness by which two of a kind differ.
_GAPS = (0.0, (3.0, 2.2))
_DARKER = 0.4
# Sizes of circles at stroboscopic samples [points].
_LARGEST, _SMALLEST = 8.0, 4.0
# Height of an entry of the legend below the orbits [inches], and number of entries in the minimum height.
_ENTRY, _ENTRIES = 0.17, 2
_MARKER: dict[str, Any] = {"marker": "o", "linestyle": "none", "markerfacecolor": "white", "markeredgecolor": BLACK}


@figure_of("attractors", "basins")
@styled
def plot_basins(found: xr.Dataset) -> Figure:
    """Return a figure of basins: on a grid a map of the attractor of each initial condition, else fractions and orbits.

    Circles mark the stroboscopic samples of attractors that repeat, at phase zero of the base motion. Error bars are
    the intervals of the fractions. The first orbit that repeats and the first that does not have solid lines; other
    orbits have dashed lines, whose gaps show orbits on the same path.

    Parameters
    ----------
    found
        Result of `stylobate.studies.maps.basins` or `attractors`, finished or not.
    """
    dims = found["attractor"].dims if "attractor" in found else ()
    if len(dims) == 2:  # noqa: PLR2004  a plane
        return _plot_grid(found)
    figure = new_figure(_TABLE_HEIGHT + _ENTRY * max(found.sizes["attractor_index"] - _ENTRIES, 0))
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
    marked = found.isel(attractor_index=_has_states(found))
    x, y = (marked[name].sel(axis=axis).to_numpy().ravel() for name, axis in map(_COMPONENTS.__getitem__, dims))
    inside = np.isfinite(x) & np.isfinite(y)
    if not inside.any():
        return []
    limits = axes.get_xlim(), axes.get_ylim()
    axes.plot(x[inside], y[inside], markersize=6.5, zorder=3, **_MARKER)
    axes.set(xlim=limits[0], ylim=limits[1])
    return [Line2D([], [], label="attractors (stroboscopic samples)", markersize=6.5, **_MARKER)]


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
            fontsize="small",
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
    title = plural(int(found["computed"]), "start")
    return f"{title}, {unsettled} of them not settled" if unsettled else title


def _draw_orbits(axes: Axes, found: xr.Dataset) -> None:
    """Draw the path of each attractor's tilt, with the stroboscopic samples of attractors that repeat."""
    classes, drawn, marks, used = attractor_classes(found), [0, 0], 0, [BLACK]
    for place, marked in enumerate(_has_states(found)):
        one, path = classes[place], found["orbit_tilt"].isel(attractor_index=place)
        strobes = found["attractor_tilt"].isel(attractor_index=place)
        colour = _colour(one.look.colour, used)
        if bool(path.notnull().all()) and bool((path != 0.0).any()):
            repeats = bool(found["attractor_period"][place])
            gaps = drawn[repeats] > 0
            _draw_orbit(axes, path.sel(axis="x"), path.sel(axis="y"), colour, repeats=repeats, gaps=gaps)
            axes.lines[-1].set_label(one.name)
            used.append(colour)
            drawn[repeats] += 1
        if marked:  # smaller circles on top, so that coincident circles are all visible
            look = _MARKER | {"markerfacecolor": colour, "markersize": max(_LARGEST - 2.0 * marks, _SMALLEST)}
            axes.plot(strobes.sel(axis="x"), strobes.sel(axis="y"), zorder=3, **look)
            marks += 1
    if sum(drawn) > 1:
        figure = axes.get_figure(root=True)
        assert figure is not None
        figure.legend(*axes.get_legend_handles_labels(), loc="outside lower right", ncols=2, handlelength=3.2)
    axes.set_aspect("equal", adjustable="datalim")
    axes.locator_params(nbins=5)
    axes.set_xlabel(r"tilt $\theta_x$ [rad]")
    axes.set_ylabel(r"tilt $\theta_y$ [rad]")
    axes.set_title("orbits, ○ stroboscopic samples")


def _draw_orbit(axes: Axes, x: xr.DataArray, y: xr.DataArray, colour: str, *, repeats: bool, gaps: bool) -> None:
    """Draw a path, with `gaps` dashed, so that another orbit on the same path is visible."""
    style: Any = _GAPS if gaps else "-"
    if not repeats:
        axes.plot(x, y, color=colour, linewidth=0.7, linestyle=style, zorder=1.5)
        return
    if not gaps:  # a dark edge makes pale colours visible on white
        axes.plot(x, y, color=BLACK, linewidth=2.8)
    axes.plot(x, y, color=colour, linewidth=1.7, linestyle=style)


def _colour(colour: str, used: Sequence[str]) -> str:
    """Return `colour`, darkened until it differs from all `used`."""
    while colour in used and colour != BLACK:
        red, green, blue = to_rgb(colour)
        colour = to_hex((_DARKER * red, _DARKER * green, _DARKER * blue))
    return colour


def _has_states(found: xr.Dataset) -> npt.NDArray[np.bool_]:
    """Return whether each attractor has stroboscopic samples of its own: orbits that repeat, and standing."""
    repeats, stands = found["attractor_period"].to_numpy() > 0, found["attractor_kind"].to_numpy() == _AT_REST
    return np.asarray(repeats | stands, dtype=bool)
