"""Basins of attraction: maps, orbits, fractions along a parameter, integrity, uncertainty exponent."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Literal

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import to_hex, to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Ellipse, Patch

from stylobate.plots.cells import (
    Floats,
    Look,
    MapClass,
    attractor_classes,
    cell_edges,
    fill_options,
    is_geometric,
    percent,
    set_scale,
)
from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import axis_label
from stylobate.plots.maps import draw_classes, draw_outcomes
from stylobate.plots.style import BLACK, BLUE, GREY, VERMILION, new_figure, styled
from stylobate.text import plural

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
_LINE, _ENTRIES = 0.17, 2
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
        Result of `stylobate.studies.basins` or `attractors`, finished or not.
    """
    dims = found["attractor"].dims if "attractor" in found else ()
    if len(dims) == 2:  # noqa: PLR2004  a plane
        return _plot_grid(found)
    figure = new_figure(3.4 + _LINE * max(found.sizes["attractor_index"] - _ENTRIES, 0))
    bars, orbits = figure.subplots(1, 2, width_ratios=(1.25, 1.0))
    _draw_fractions(bars, found)
    _draw_orbits(orbits, found)
    return figure


def _plot_grid(found: xr.Dataset) -> Figure:
    figure = new_figure(4.6)
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


# Height of a line of the legend [inches]; number of lines besides those of the bands: two for intervals, and edges.
_ENTRY = 0.19
# Bands thinner than this fraction of the height have no error bar: the bar would look like a line.
_SEEN = 0.005
# If there are more bands than this, bands of one kind that stay narrower than this fraction are drawn as one.
_MOST, _NARROW = 10, 0.06
# Margin beside the first and last value, in widths of the bands.
_BESIDE = 0.015


@figure_of("basin fractions")
@styled
def plot_fractions(found: xr.Dataset) -> Figure:
    """Return a figure of basin fractions along a parameter, stacked.

    A single value has one stacked bar. The line on the upper edge of a band is the interval of the height of this
    band. Runs that have not settled are the topmost band; values not computed stay white. If there are many
    attractors, narrow bands of one kind are drawn as one, labelled with their number.
    """
    (name,) = found["computed"].dims
    ordered = found.sortby(str(name)).isel({str(name): found.sortby(str(name))["computed"].to_numpy() > 0})
    x, classes = ordered[str(name)].to_numpy(), attractor_classes(found)[:-1]
    fraction, low, high = (
        ordered[key].transpose(name, "attractor_index").to_numpy()
        for key in ("fraction", "fraction_low", "fraction_high")
    )
    bands = _bands(fraction, [str(kind) for kind in found["attractor_kind"].to_numpy()], classes)
    figure = new_figure(max(4.2, _ENTRY * (len(bands) + 3)))
    axes = figure.subplots()
    legend: list[Patch | Line2D] = []
    bottom, errors = np.zeros(x.size), []
    for label, look, places in bands:
        top = bottom + fraction[:, places].sum(axis=1)
        _draw_band(axes, x, bottom, top, look)
        legend.append(Patch(label=label, **fill_options(look)))
        if len(places) == 1:
            errors.append((places[0], top))
        bottom = top
    for place, top in errors:
        shown = (fraction[:, place] > _SEEN) & (top < 1.0 - _SEEN)
        below, above = fraction[shown, place] - low[shown, place], high[shown, place] - fraction[shown, place]
        spread = np.maximum([below, above], 0.0)
        for colour, width in (("white", 2.6), (BLACK, 1.0)):
            axes.errorbar(x[shown], top[shown], yerr=spread, ecolor=colour, elinewidth=width, **_BAR)
    confidence = 100.0 * float(found.attrs["confidence"])
    legend.append(Line2D([], [], color=BLACK, marker="|", markersize=9, linestyle="none", label=_interval(confidence)))
    set_scale(axes, "x", x)
    axes.set(xlim=_limits(x), ylim=(0.0, 1.0))
    if x.size == 1:
        axes.set_xticks(x)
    axes.set_ylabel(f"fraction of {plural(int(found.attrs['starts']), 'start')}")
    axes.grid(visible=False)
    axes.set_xlabel(axis_label(found[str(name)]))
    figure.legend(handles=legend[::-1], loc="outside right upper")
    return figure


def _bands(fraction: Floats, kinds: list[str], classes: Sequence[MapClass]) -> list[tuple[str, Look, list[int]]]:
    """Return name, look and attractors of each band, from below; of many bands, narrow ones of a kind are joined."""
    present = [place for place in range(len(classes)) if fraction[:, place].any()]
    narrow = [place for place in present if fraction[:, place].max() < _NARROW] if len(present) > _MOST else []
    alike = {kind: [place for place in narrow if kinds[place] == kind] for kind in kinds}
    bands: list[tuple[str, Look, list[int]]] = []
    for place in present:
        together = alike[kinds[place]]
        if place not in together or len(together) == 1:
            bands.append((classes[place].name, classes[place].look, [place]))
        elif place == together[0]:
            alone = not any(kinds[one] == kinds[place] for one in set(present) - set(together))
            look = replace(classes[place].look, texture="" if alone else "....", ink="#333333")
            bands.append((f"{kinds[place]}, {len(together)}{'' if alone else ' others'}", look, together))
    return bands


def _draw_band(axes: Axes, x: Floats, low: Floats, high: Floats, look: Look) -> None:
    if x.size == 1:
        axes.bar(x, high - low, width=np.diff(cell_edges(x)), bottom=low, **fill_options(look))
    else:
        axes.fill_between(x, low, high, **fill_options(look))


def _limits(x: Floats) -> tuple[float, float] | None:
    """Return the limits of the axis, with margins for the intervals of the first and last values."""
    if not x.size:
        return None
    geometric, edges = is_geometric(x), cell_edges(x) if x.size == 1 else x[[0, -1]]
    low, high = np.log(edges) if geometric else edges
    ends = np.array([low, high]) + _BESIDE * (high - low) * np.array([-1.0, 1.0])
    first, last = np.exp(ends) if geometric else ends
    return float(first), float(last)


_BAR: dict[str, Any] = {"fmt": "none", "capsize": 0.0, "zorder": 3}


def _interval(confidence: float) -> str:
    return f"{confidence:g} % interval\nof the band below"


_NEAREST: dict[str, Any] = {"marker": "X", "color": VERMILION, "markeredgecolor": "white", "markersize": 8}


@figure_of("integrity")
@styled
def plot_integrity(found: xr.Dataset) -> Figure:
    """Draw the outcomes over two initial conditions, with the largest safe ellipse about the reference.

    The ellipse is the circle of the distance in units of c and cω0; dashed if nothing overturned within the grid.
    """
    figure = new_figure(4.6)
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
    figure = new_figure(3.8, width=5.6)
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


# If the share of dropped starts is larger, the figure states it.
_MANY_DROPPED = 0.1
# Factor by which the axis extends below the lowest mark, for the arrow there.
_BELOW = 2.5


@figure_of("uncertainty exponent")
@styled
def plot_exponent(found: xr.Dataset) -> Figure:
    """Draw the share of uncertain initial conditions against the shift ε, on logarithmic axes, with the fit.

    Hollow circles are too near saturation for the fit. An arrow points down from the upper end of the interval if no
    initial condition was uncertain. If more than a tenth of the runs are dropped as undecided, the title states it.
    """
    figure = new_figure(3.8, width=5.4)
    axes = figure.subplots()
    epsilon, fraction = found["epsilon"].to_numpy(), found["fraction"].to_numpy()
    low, high = found["fraction_low"].to_numpy(), found["fraction_high"].to_numpy()
    counted, fitted = fraction > 0.0, found["fitted"].to_numpy()
    for part, fill, name in (
        (counted & fitted, BLUE, f"counted, {100.0 * float(found.attrs['confidence']):g} % interval"),
        (counted & ~fitted, "white", "near saturation, not fitted"),
    ):
        if part.any():
            spread = np.maximum([fraction[part] - low[part], high[part] - fraction[part]], 0.0)
            axes.errorbar(
                epsilon[part], fraction[part], yerr=spread, fmt="o", color=BLUE, mfc=fill, capsize=2.5, label=name
            )
    none = (fraction == 0.0) & (found["pairs"].to_numpy() > 0)
    if none.any():
        axes.plot(epsilon[none], high[none], linestyle="none", marker="v", color=GREY, label="none found: upper bound")
    if np.isfinite(float(found["uncertainty_exponent"])):
        axes.plot(
            epsilon,
            found["fit"].where(found["fit"] <= 1.0),
            color=VERMILION,
            linestyle="--",
            label=r"fit $\varepsilon^{\upsilon}$",
        )
    axes.set(xscale="log", yscale="log", ylabel="fraction of uncertain initial conditions")
    axes.set_xlabel(f"shift ε of {axis_label(found['epsilon'])}")
    axes.set_ylim(_lowest(found) / _BELOW, 1.3)
    axes.set_title(_title(found))
    axes.legend()
    return figure


def _title(found: xr.Dataset) -> str:
    return "\n".join([_law(found), *_dropped(found)])


def _law(found: xr.Dataset) -> str:
    exponent, error = float(found["uncertainty_exponent"]), float(found["standard_error"])
    if not np.isfinite(exponent):
        return "too few uncertain starts for an exponent"
    dimension = float(found["boundary_dimension"])
    return rf"$\upsilon$ = {exponent:.3f} ± {error:.3f}, dimension of the boundary {dimension:.3f}"


def _dropped(found: xr.Dataset) -> list[str]:
    dropped = int(found["dropped"].sum())
    total = dropped + int(found["pairs"].sum())
    if dropped <= _MANY_DROPPED * total:
        return []
    return [f"dropped: {100.0 * dropped / total:.0f} % of {total} starts, undecided at the end of their runs"]


def _lowest(found: xr.Dataset) -> float:
    """Return the lowest fraction that is marked."""
    marks = np.concatenate([found[name].to_numpy() for name in ("fraction", "fraction_low")])
    marks = np.append(marks, found["fraction_high"].where(found["fraction"] == 0.0))
    return float(np.min(marks, where=marks > 0.0, initial=1.0))
