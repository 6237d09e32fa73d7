"""Outcome maps over two parameters."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from stylobate.errors import ParameterError
from stylobate.plots.cells import Integers, class_legend, draw_cells
from stylobate.plots.classes import MapClass, outcome_classes
from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import axis_label
from stylobate.plots.style import BLACK, new_figure, styled
from stylobate.results.outcomes import NOT_COMPUTED
from stylobate.text import plural

_PLANE = 2
_HEIGHT = 4.6
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
    figure = new_figure(_HEIGHT)
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
    if codes.ndim != _PLANE:
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
