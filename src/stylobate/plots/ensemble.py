"""Figures of ensembles: outcome and peak tilt of each run over the number that varies, or over two numbers."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from stylobate.errors import Outcome, ParameterError
from stylobate.plots.cells import percent, set_scale
from stylobate.plots.classes import outcome_classes
from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import axis_label
from stylobate.plots.maps import plot_map
from stylobate.plots.style import BLACK, new_figure, styled
from stylobate.results.outcomes import NOT_COMPUTED

_HEIGHT = 3.4
_PLANE, _PAIR = 2, 2
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
    if len(dims) == _PLANE:
        return plot_map(runs)
    if len(dims) != 1 or runs["outcome"].size == 0:
        sizes = dict(runs["outcome"].sizes)
        message = f"runs must be over one or two dimensions, got {sizes}. Choose values of the others by .isel"
        raise ParameterError(message)
    (dim,) = dims
    varied = [str(name) for name, one in runs.coords.items() if one.dims == (dim,) and one.dtype.kind in "fiu"]
    figure = new_figure(_HEIGHT)
    axes = figure.subplots()
    if dim not in varied and len(varied) == _PAIR:
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
