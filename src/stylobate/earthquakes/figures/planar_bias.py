"""Figures of three-dimensional and planar (Housner) columns: peak tilts, and overturning by direction."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.projections.polar import PolarAxes
from matplotlib.ticker import MaxNLocator

from stylobate.earthquakes.figures.incremental import Floats
from stylobate.errors import ParameterError
from stylobate.plots.kinds import figure_of
from stylobate.plots.result_figure import beside_or_below
from stylobate.plots.style import BLACK, BLUE, DASHES, GREY, VERMILION, new_figure, styled
from stylobate.text import plural

_BIAS_HEIGHT, _POLAR_HEIGHT = 5.4, 3.4
_MOST_PANELS = 3
# Distance of the marks of overturned columns beyond the end of the axis, as a fraction of the axis.
_MARGIN = 0.07


@figure_of("planar bias")
@styled
def plot_planar_bias(found: xr.Dataset) -> Figure:
    """Draw the peak tilts of the three-dimensional column over those of the worst planar column.

    Each record and scale has a point. Points in the margins are overturned columns: the planar column on the right, the
    three-dimensional column at the top, both in the corner. Above the diagonal the planar column is unconservative.
    """
    figure = new_figure(_BIAS_HEIGHT, width=6.4)
    axes = figure.subplots()
    flat, space = (found[name].to_numpy().ravel() for name in ("worst_planar_tilt_ratio", "tilt_ratio"))
    scale = found["scale"].broadcast_like(found["tilt_ratio"]).transpose(*found["tilt_ratio"].dims).to_numpy().ravel()
    finite = np.concatenate([flat[np.isfinite(flat)], space[np.isfinite(space)], [0.5]])
    end = 1.04 * float(finite.max())
    beyond = end * (1.0 + _MARGIN)
    known = ~(np.isnan(flat) | np.isnan(space))
    x, y = (np.where(np.isinf(values), beyond, values) for values in (flat, space))
    points = axes.scatter(x[known], y[known], c=scale[known], s=16.0, cmap="cividis", zorder=3, linewidths=0.0)
    if np.ptp(scale) > 0.0:
        figure.colorbar(points, ax=axes, location=beside_or_below(figure), label="scale of the record", shrink=0.8)
    axes.plot([0.0, end], [0.0, end], color=BLACK, linewidth=1.0)
    for line in (axes.axvline, axes.axhline):
        line(end, color=GREY, linewidth=0.8, linestyle=DASHES[1])
    limits = (-0.02 * end, end * (1.0 + 2.0 * _MARGIN))
    axes.set(xlim=limits, ylim=limits, aspect="equal")
    axes.set_xlabel(r"peak tilt $\theta/\alpha_c$, worst of the planes")
    axes.set_ylabel(r"peak tilt $\theta/\alpha_c$, three-dimensional")
    ticks = [float(tick) for tick in MaxNLocator(5).tick_values(0.0, end) if 0.0 <= tick < 0.97 * end]
    names = [*(f"{tick:g}" for tick in ticks), "overturned"]
    axes.set_xticks([*ticks, beyond], names)
    axes.set_yticks([*ticks, beyond], names)
    axes.set_title(f"{_bias(found)}\n{_overturned(flat, space)}", fontsize="small")
    return figure


def _overturned(flat: Floats, space: Floats) -> str:
    falls, falls_in_space = np.isinf(flat), np.isinf(space)
    both = np.count_nonzero(falls & falls_in_space)
    only_space = np.count_nonzero(falls_in_space & np.isfinite(flat))
    only_flat = np.count_nonzero(falls & np.isfinite(space))
    return f"runs that overturn in three dimensions only: {only_space}, planar only: {only_flat}, both: {both}"


def _bias(found: xr.Dataset) -> str:
    number = int(found["overall_compared"])
    bias, scatter, error = (float(found[f"overall_{name}"]) for name in ("bias", "scatter", "standard_error"))
    if not np.isfinite(bias):
        return f"{plural(number, 'record')} in which both rock and neither overturns: too few for a mean ratio"
    return (
        f"peak tilt, three-dimensional/planar: geometric mean {np.exp(bias):.2f} over {number} records\n"
        f"(ln {bias:+.2f} ± {error:.2f} standard error, scatter {scatter:.2f}; where both rock and neither overturns)"
    )


@styled
def plot_directions(found: xr.Dataset) -> Figure:
    """Draw the smallest overturning scale over the direction, or the peak tilt over α if there is one scale.

    For a planar bias, the polar figures show the planar column in each direction, and the three-dimensional column,
    which has no direction. For an incremental dynamic analysis they show each rotation of the record. Open marks on the
    rim mean that no scale overturned the column. Each plane is drawn in both senses, because the response of a
    symmetric column is the same.

    Raises
    ------
    ParameterError
        If `found` has no directions, or more than three records: choose some by `found.sel`.
    """
    turned = "planar_tilt_ratio" not in found
    name = "rotation" if turned else "direction"
    if name not in found.dims:
        raise ParameterError(f"found must have the dimension {name}, got {', '.join(map(str, found.dims))}")
    found = found if "record" in found.dims else found.expand_dims("record")
    if found.sizes["record"] > _MOST_PANELS:
        raise ParameterError(
            f"a figure over directions has up to {_MOST_PANELS} records, got {found.sizes['record']}: "
            "choose some by found.sel(record=[...])"
        )
    figure = new_figure(_POLAR_HEIGHT)
    panels = figure.subplots(1, found.sizes["record"], subplot_kw={"projection": "polar"}, squeeze=False)[0]
    for place, axes in enumerate(panels):
        _draw_polar(axes, found.isel(record=place), name, turned=turned)
        axes.set_title(str(found["record"][place].item()), fontsize="small", loc="center")
    if not turned:
        figure.legend(
            handles=[
                Line2D([], [], color=VERMILION, marker="o", markersize=4.0, label="planar, in this direction"),
                Line2D([], [], color=BLUE, linewidth=1.8, label="three-dimensional, the whole record"),
            ],
            loc="outside lower center",
            ncols=2,
        )
    figure.suptitle(_quantity(found), fontsize="medium")
    return figure


def _quantity(found: xr.Dataset) -> str:
    if found.sizes["scale"] > 1:
        return "smallest overturning scale"
    return rf"peak tilt $\theta/\alpha_c$ at scale {found['scale'].item():g}"


def _draw_polar(axes: PolarAxes, one: xr.Dataset, name: str, *, turned: bool) -> None:
    tilt = one["tilt_ratio" if turned else "planar_tilt_ratio"].transpose(name, "scale").to_numpy()
    angle, scale = one[name].to_numpy(), one["scale"].to_numpy()
    radius, rim = _radius(tilt, scale)
    shown = np.where(np.isfinite(radius), radius, rim)
    if not turned:
        angle, shown, radius = (np.concatenate(both) for both in ((angle, angle + np.pi), [shown] * 2, [radius] * 2))
    order = np.argsort(angle % (2.0 * np.pi))
    angle, shown, radius = angle[order], shown[order], radius[order]
    colour = BLUE if turned else VERMILION
    axes.plot(np.append(angle, angle[0]), np.append(shown, shown[0]), color=colour, linewidth=1.2)
    known = np.isfinite(radius)
    axes.plot(angle[known], shown[known], "o", color=colour, markersize=3.5)
    axes.plot(angle[~known], shown[~known], "o", color=colour, mfc="white", markersize=4.5)
    if not turned:
        whole, other_rim = _radius(one["tilt_ratio"].to_numpy()[np.newaxis], scale)
        rim = max(rim, other_rim) if np.isfinite(whole[0]) else rim
        if np.isfinite(whole[0]):
            axes.plot(np.linspace(0.0, 2.0 * np.pi, 181), np.full(181, whole[0]), color=BLUE, linewidth=1.8)
    axes.set_ylim(0.0, 1.05 * rim)
    axes.yaxis.set_major_locator(MaxNLocator(4))
    axes.set_rlabel_position(22.5)
    axes.tick_params(labelsize="x-small")


def _radius(tilt: Floats, scale: Floats) -> tuple[Floats, float]:
    """Return the radius for each row of `tilt`, not finite if no scale overturned, and the radius of the rim."""
    if scale.size > 1:
        radius = np.where(np.isinf(tilt), scale, np.inf).min(axis=1)
        end = scale.max() if np.isinf(radius).any() else radius.max()
        return radius, 1.08 * float(end)
    finite = tilt[np.isfinite(tilt)]
    return tilt[:, 0], 1.1 * max(1.0, float(finite.max(initial=0.0)))
