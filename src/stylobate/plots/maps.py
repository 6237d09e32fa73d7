"""Outcomes of runs over one number, or over two as a map."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from stylobate.errors import Outcome, ParameterError
from stylobate.plots.cells import Integers, MapClass, class_legend, draw_cells, outcome_classes, percent, set_scale
from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import axis_label
from stylobate.plots.style import BLACK, new_figure, styled
from stylobate.results.outcomes import NOT_COMPUTED
from stylobate.text import plural

# Maximum and minimum size of a dot on an uncertain run [points].
_DOTS = (1.2, 3.6)
# If more than this fraction of all runs is uncertain, dots would hide the map, and the legend states their number only.
_MOST_MARKED = 0.2
# Width of a map on its page [points].
_MAP_WIDTH = 330.0


@figure_of("overturning map")
@styled
def plot_map(runs: xr.Dataset) -> Figure:
    """Return a figure of the outcomes over two parameters.

    Runs that are not computed yet are white, finely hatched. A dot marks an outcome that is numerically
    uncertain: rounding or the rest threshold could alter it.

    Parameters
    ----------
    runs
        An overturning map, or any sweep or ensemble over two dimensions, finished or not.

    Raises
    ------
    ParameterError
        If the runs are not over two dimensions, or there are none.
    """
    figure = new_figure(4.6)
    axes = figure.subplots()
    legend = draw_outcomes(axes, runs)
    figure.legend(handles=legend, loc="outside right upper")
    return figure


def draw_outcomes(axes: Axes, runs: xr.Dataset) -> list[Artist]:
    """Draw the outcomes of `runs` over their two dimensions and return the legend's entries."""
    return draw_classes(axes, runs, runs["outcome"], outcome_classes())


def draw_classes(axes: Axes, runs: xr.Dataset, codes: xr.DataArray, classes: Sequence[MapClass]) -> list[Artist]:
    """Draw the `codes` of `runs` over their two dimensions, the first along x, and return the legend's entries."""
    if codes.size == 0:
        message = f"a map needs at least one run, got sizes {dict(codes.sizes)}. Give each dimension a value or more"
        raise ParameterError(message)
    if codes.ndim != 2:  # noqa: PLR2004  a plane
        message = f"a map needs runs over two dimensions, got {dict(codes.sizes)}"
        raise ParameterError(message)
    x, y = (str(dim) for dim in codes.dims)
    ordered = runs.assign(_codes=codes).sortby([x, y]).transpose(y, x, ...)
    cells: Integers = ordered["_codes"].to_numpy()
    draw_cells(axes, ordered[x], ordered[y], cells, classes)
    axes.set_xlabel(axis_label(runs[x]))
    axes.set_ylabel(axis_label(runs[y]))
    entries: list[Artist] = [*class_legend(cells, classes)]
    return entries + _mark_uncertain(axes, ordered, x, y)


def _mark_uncertain(axes: Axes, runs: xr.Dataset, x: str, y: str) -> list[Artist]:
    if "uncertain" not in runs or not bool(runs["uncertain"].any()):
        return []
    known = runs["uncertain"] & (runs["outcome"] != NOT_COMPUTED)
    rows, columns = np.nonzero(known.transpose(y, x).to_numpy())
    label = f"uncertain  {plural(rows.size, 'run')}"
    if rows.size > _MOST_MARKED * known.size:
        return [Line2D([], [], label=f"{label}, not marked", linestyle="none")]
    size = float(np.clip(_MAP_WIDTH / max(runs.sizes[x], runs.sizes[y]) / 2.0, *_DOTS))
    look: dict[str, Any] = {"marker": "o", "mfc": "white", "mec": BLACK, "mew": 0.4, "linestyle": "none"}
    axes.plot(runs[x].to_numpy()[columns], runs[y].to_numpy()[rows], markersize=size, rasterized=True, **look)
    return [Line2D([], [], label=label, markersize=_DOTS[1], **look)]


# Marks of the outcomes in the order of a legend, so that they are told apart without colour; sizes [points].
_MARKS = "os^Dv<>ph*XP8d"
_SIZES, _MANY, _LARGER = (4.5, 3.0), 300, 1.7
# Room above the highest peak tilt.
_ROOM = 1.06
# Runs that overturned are arrows at this height of the panel, just above it.
_ABOVE = 1.04
_ARROW = r"$\uparrow$"


@figure_of("ensemble", "sweep")
@styled
def plot_ensemble(runs: xr.Dataset) -> Figure:
    """Draw runs over one dimension as points, over two as a map of their outcomes.

    Over one dimension the peak tilt of each run stands over the number that varies. Runs that overturned have no peak
    tilt: they are arrows above the panel. Two numbers that vary together along one dimension span a plane, in which
    each run is a point. Colour and mark show the outcome; the legend states its share.

    Raises
    ------
    ParameterError
        If the runs are over no dimension or more than two.
    """
    dims = [str(dim) for dim in runs["outcome"].dims]
    if len(dims) == 2:  # noqa: PLR2004  a plane
        return plot_map(runs)
    if len(dims) != 1 or runs["outcome"].size == 0:
        sizes = dict(runs["outcome"].sizes)
        message = f"runs must be over one or two dimensions, got {sizes}. Choose values of the others by .isel"
        raise ParameterError(message)
    (dim,) = dims
    varied = [str(name) for name, one in runs.coords.items() if one.dims == (dim,) and one.dtype.kind in "fiu"]
    figure = new_figure(3.4)
    axes = figure.subplots()
    if dim not in varied and len(varied) == 2:  # noqa: PLR2004  a pair
        x, y = (runs[name] for name in varied)
    else:
        named = dim if dim in varied else varied[0] if len(varied) == 1 else None
        number = xr.DataArray(np.arange(runs.sizes[dim]), dims=dim, attrs={"long_name": "run"})
        x, y = number if named is None else runs[named], runs["peak_tilt"]
        y = y.where(~runs["outcome"].isin([int(Outcome.OVERTURNED), NOT_COMPUTED]))
    _draw_points(axes, runs, x, y)
    if y.name == "peak_tilt":
        highest = float(y.max())
        axes.set_ylim(0.0, _ROOM * highest if np.isfinite(highest) and highest > 0.0 else 1.0)
    set_scale(axes, "x", np.unique(x.to_numpy()))
    if x.name is None:
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.set(xlabel=axis_label(x), ylabel=axis_label(y))
    figure.legend(loc="outside right upper")
    return figure


def _draw_points(axes: Axes, runs: xr.Dataset, x: xr.DataArray, y: xr.DataArray) -> None:
    codes = runs["outcome"].to_numpy()
    size = _SIZES[codes.size > _MANY]
    for place, one in enumerate(outcome_classes()[:-1]):
        inside = codes == one.code
        if not inside.any():
            continue
        height = y.to_numpy()[inside]
        look: dict[str, Any] = {"marker": _MARKS[place % len(_MARKS)], "markerfacecolor": one.look.colour}
        look |= {"markeredgecolor": BLACK, "markeredgewidth": 0.4, "linestyle": "none", "markersize": size}
        if one.code == Outcome.OVERTURNED and y.name == "peak_tilt":
            height = np.full(height.shape, _ABOVE)
            look |= {"marker": _ARROW, "markerfacecolor": BLACK, "markersize": _LARGER * size}
            look |= {"transform": axes.get_xaxis_transform()}
        label = f"{one.name}  {percent(int(inside.sum()), codes.size)}"
        axes.plot(x.to_numpy()[inside], height, label=label, clip_on=False, zorder=3.0, **look)
