"""Maps of what a column that can slip does, and where a vibrating base walks it to."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stylobate.plots.cells import cell_edges
from stylobate.plots.classes import contact_classes
from stylobate.plots.labels import axis_label
from stylobate.plots.maps import draw_classes
from stylobate.plots.style import BLACK, new_figure, styled

_HEIGHT, _TALL = 4.6, 5.4
_PLANE = 2


@styled
def plot_contact_map(found: xr.Dataset) -> Figure:
    """Return a figure of a contact map: what the column did over two parameters."""
    figure = new_figure(_HEIGHT)
    axes = figure.subplots()
    figure.legend(
        handles=draw_classes(axes, found, found["contact_class"], contact_classes(found)), loc="outside right upper"
    )
    return figure


@styled
def plot_drift(found: xr.Dataset) -> Figure:
    """Return a figure of a drift: velocity and rate of turn over one parameter, or the speed over two."""
    if found["outcome"].ndim == _PLANE:
        figure = new_figure(_HEIGHT)
        _draw_speed(figure, figure.subplots(), found)
        return figure
    figure = new_figure(_TALL)
    upper, lower = figure.subplots(2, 1, sharex=True)
    name = str(found["outcome"].dims[0])
    ordered = found.sortby(name)
    x = ordered[name].to_numpy()
    velocity = ordered["mean_velocity"].to_numpy()
    upper.plot(x, velocity[:, 0], color=BLACK, label="along x")
    upper.plot(x, velocity[:, 1], color=BLACK, linestyle="--", label="along y")
    upper.set_ylabel("mean velocity [m/s]")
    upper.legend()
    lower.plot(x, ordered["mean_twist_rate"].to_numpy(), color=BLACK)
    lower.set_ylabel("mean rate of twist [rad/s]")
    lower.set_xlabel(axis_label(found[name]))
    for axes in (upper, lower):
        axes.axhline(0.0, color=BLACK, linewidth=0.5)
    return figure


def _draw_speed(figure: Figure, axes: Axes, found: xr.Dataset) -> None:
    x, y = (str(dim) for dim in found["outcome"].dims)
    ordered = found.sortby([x, y]).transpose(y, x, ...)
    speed = np.ma.masked_invalid(ordered["transport_speed"].to_numpy())
    drawn = axes.pcolormesh(cell_edges(ordered[x]), cell_edges(ordered[y]), speed, cmap="cividis", rasterized=True)
    axes.set_facecolor("#d9d9d9")
    figure.colorbar(drawn, ax=axes, label="mean transport speed [m/s] (grey: it does not move on to the end)")
    axes.set_xlabel(axis_label(found[x]))
    axes.set_ylabel(axis_label(found[y]))
