"""Figures of contact maps and of mean transport velocities."""

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from stylobate.plots.cells import cell_edges, contact_classes
from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import axis_label
from stylobate.plots.maps import draw_classes
from stylobate.plots.result_figure import WIDTH, beside_or_below
from stylobate.plots.style import BLACK, BLUE, GREY, VERMILION, new_figure, styled
from stylobate.results.contact_classes import ContactClass, knife_edge_remarks

Floats = npt.NDArray[np.float64]

_HEIGHT, _TALL, _LOW, _WIDE = 4.6, 5.4, 3.6, 10.0
_PLANE = 2
# Minimum mean twist rate of a column that counts as turning [rad/s].
_STILL = 1e-9


@figure_of("contact map")
@styled
def plot_contact_map(found: xr.Dataset) -> Figure:
    """Draw a contact map: the kinds of contact over two parameters, and the peak tilt if a column tilted."""
    x, y = (str(dim) for dim in found["outcome"].dims)
    ordered = found.sortby([x, y]).transpose(y, x, ...)
    stands = (ordered["contact_class"] != ContactClass.OVERTURNS) & (ordered["peak_tilt"] > 0.0)
    peak = np.ma.masked_invalid(ordered["peak_tilt"].where(stands).to_numpy())
    figure = new_figure(_HEIGHT, width=_WIDE if peak.count() else WIDTH)
    panels = figure.subplots(1, 2 if peak.count() else 1, sharex=True, sharey=True, squeeze=False)[0]
    handles = draw_classes(panels[0], found, found["contact_class"], contact_classes(found))
    panels[0].set_title("\n".join(knife_edge_remarks(found)), loc="left", fontsize="small")
    if not peak.count():
        figure.legend(handles=handles, loc="outside right upper")
        return figure
    figure.legend(handles=handles, loc="outside lower center", ncols=3)
    look = {"cmap": "viridis", "norm": LogNorm(), "rasterized": True}
    drawn = panels[1].pcolormesh(cell_edges(ordered[x]), cell_edges(ordered[y]), peak, **look)
    panels[1].grid(visible=False)
    panels[1].set_xlabel(axis_label(found[x]))
    panels[1].set_title("white: never tilted, or overturned", fontsize="small")
    figure.colorbar(drawn, ax=panels[1], label=axis_label(found["peak_tilt"]))
    return figure


@figure_of("drift")
@styled
def plot_drift(found: xr.Dataset) -> Figure:
    """Draw mean transport velocity and rate of rotation over one parameter, or the speed over two.

    A dotted line marks the throw number 1, above which a standing column leaves the base.
    """
    if found["outcome"].ndim == _PLANE:
        figure = new_figure(_HEIGHT)
        _draw_speed(figure, figure.subplots(), found)
        return figure
    name = str(found["outcome"].dims[0])
    ordered = found.sortby(name)
    x, turning = ordered[name].to_numpy(), ordered["mean_twist_rate"].to_numpy()
    turns = bool(np.any(np.abs(np.nan_to_num(turning)) > _STILL))
    figure = new_figure(_TALL if turns else _LOW)
    panels = list(figure.subplots(2 if turns else 1, 1, sharex=True, squeeze=False)[:, 0])
    _draw_velocity(panels[0], x, ordered["mean_velocity"])
    if turns:
        panels[1].plot(x, turning, color=BLACK, marker=".")
        panels[1].set_ylabel(axis_label(found["mean_twist_rate"], "mean twist rate"))
    panels[-1].set_xlabel(axis_label(found[name]))
    panels[0].set_title("\n".join(knife_edge_remarks(found)), loc="left", fontsize="small")
    thrown = _where_thrown(x, ordered["throw_number"].to_numpy())
    for axes in panels:
        axes.axhline(0.0, color=BLACK, linewidth=0.5)
        if thrown is not None:
            axes.axvline(thrown, color=GREY, linewidth=0.9, linestyle=":")
    if thrown is not None:
        panels[0].annotate(
            "throw number 1",
            (thrown, 1.0),
            xycoords=("data", "axes fraction"),
            xytext=(3, 0),
            textcoords="offset points",
            va="top",
            fontsize="small",
            color=GREY,
        )
    return figure


def _draw_velocity(axes: Axes, x: Floats, mean: xr.DataArray) -> None:
    velocity = mean.to_numpy()
    axes.plot(x, velocity[:, 0], color=BLUE, marker=".", label="along x")
    axes.plot(x, velocity[:, 1], color=VERMILION, linestyle="--", marker=".", label="along y")
    if np.isnan(velocity).any():
        axes.plot([], [], linestyle="none", label="gaps: motion ends before the last period")
    axes.set_ylabel(axis_label(mean, "mean velocity"))
    axes.legend()


def _where_thrown(x: Floats, throw: Floats) -> float | None:
    """Return the first x at which the throw number passes 1, or None."""
    passed = np.flatnonzero((throw[:-1] < 1.0) & (throw[1:] >= 1.0))
    if not passed.size:
        return None
    k = int(passed[0])
    return float(np.interp(1.0, throw[k : k + 2], x[k : k + 2]))


def _draw_speed(figure: Figure, axes: Axes, found: xr.Dataset) -> None:
    x, y = (str(dim) for dim in found["outcome"].dims)
    ordered = found.sortby([x, y]).transpose(y, x, ...)
    speed = np.ma.masked_invalid(ordered["transport_speed"].to_numpy())
    axes.grid(visible=False)
    axes.patch.set(facecolor="white", hatch="////", edgecolor="#b0b0b0")
    drawn = axes.pcolormesh(cell_edges(ordered[x]), cell_edges(ordered[y]), speed, cmap="viridis", rasterized=True)
    figure.colorbar(
        drawn,
        ax=axes,
        location=beside_or_below(figure),
        label=axis_label(found["transport_speed"], "mean transport speed"),
    )
    titles = knife_edge_remarks(found)
    throw = ordered["throw_number"].to_numpy()
    if throw.min() < 1.0 < throw.max():
        axes.contour(ordered[x], ordered[y], throw, levels=[1.0], colors="white", linestyles=":")
        titles.append("dotted: throw number 1")
    if speed.mask.any():
        titles.append("hatched: motion ends before the last period")
    axes.set_title("\n".join(titles), loc="left", fontsize="small")
    axes.set_xlabel(axis_label(found[x]))
    axes.set_ylabel(axis_label(found[y]))
