"""Figures of incremental dynamic analyses, and of their comparison with planar columns."""

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.projections.polar import PolarAxes
from matplotlib.ticker import MaxNLocator

from stylobate.errors import ParameterError
from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import axis_label
from stylobate.plots.result_figure import beside_or_below
from stylobate.plots.style import BLACK, BLUE, DASHES, GREY, PALETTE, STABLE_WIDTH, VERMILION, new_figure, styled
from stylobate.text import plural

Floats = npt.NDArray[np.float64]

_HEIGHT = 4.6
# Maximum number of records with a colour and a name; more are grey.
_NAMED = 6
_MARKS = "osD^vP"
# Height of the strip of overturned runs: frame, and row of each record [fractions of the panel of tilts].
_STRIP, _ROW = 0.06, 0.035
_MOST_ROWS = 24
_QUANTILES = (0.16, 0.5, 0.84)
# Intensities that differ by less than this fraction count as equal.
_ONE_LEVEL = 1e-6
_NUMBERS_TO_SPAN = 20.0


@figure_of("incremental dynamic analysis")
@styled
def plot_incremental(found: xr.Dataset) -> Figure:
    """Draw peak tilts over α_c against the intensity, with one line for each record and a strip of overturned runs.

    Lines end where the column overturns and continue where it survives again. The strip above shows the intensities at
    which each record overturned the column. If all records have the same intensities, the figure shows the median and,
    dashed, the 16 and 84 % quantiles; overturned runs count as above all tilts, so these lines end at overturning.

    Raises
    ------
    ParameterError
        If the runs have no dimension `scale`.
    """
    if "scale" not in found.dims:
        raise ParameterError(
            "found must have the dimension scale to be drawn over the intensity; take runs.isel(scale=[0])"
        )
    names, level, tilt = _series(found)
    order = list(dict.fromkeys(names))
    figure = new_figure(_HEIGHT)
    rows = min(len(order), _MOST_ROWS)
    strip, tilts = figure.subplots(2, 1, sharex=True, height_ratios=(_STRIP + _ROW * rows, 1.0))
    for name, *one in zip(names, level, tilt, strict=True):
        _draw(tilts, strip, *one, place=order.index(name), records=len(order))
    handles = _legend(order)
    drawn = _draw_quantiles(tilts, level, tilt)
    handles += drawn
    tilts.set(ylabel=r"peak tilt $\theta/\alpha_c$", ylim=(0.0, None))
    tilts.set_xlabel(axis_label(found["intensity"]))
    _axis_of(tilts, level)
    strip.set(ylim=(-0.7, len(order) - 0.3), yticks=[])
    strip.set_ylabel("over-\nturned", rotation=0, ha="right", va="center")
    strip.grid(visible=False)
    strip.set_title(_title(found, quantiles=bool(drawn)), fontsize="small")
    figure.legend(handles=handles, loc="outside right upper")
    return figure


def _series(found: xr.Dataset) -> tuple[list[str], Floats, Floats]:
    """Return the record of each series of runs, with its intensities and peak tilts over α_c: (series, scale)."""
    others = [dim for dim in found["tilt_ratio"].dims if dim != "scale"]
    tilt = found["tilt_ratio"].transpose(*others, "scale")
    level = found["intensity"].broadcast_like(tilt).transpose(*others, "scale")
    number = found.sizes["scale"]
    record = found["record"] if "record" in found.coords else xr.DataArray("record")
    record = xr.DataArray(record.to_numpy(), dims=record.dims)
    names = record.broadcast_like(tilt.isel(scale=0, drop=True).drop_vars(list(tilt.coords), errors="ignore"))
    listed = names.transpose(*others).to_numpy().ravel()
    return [str(name) for name in listed], level.to_numpy().reshape(-1, number), tilt.to_numpy().reshape(-1, number)


def _look(place: int, records: int) -> tuple[str, str, float]:
    """Return colour, mark and width of the lines of a record."""
    if records > _NAMED:
        return GREY, "o", 0.7
    return PALETTE[place % len(PALETTE)], _MARKS[place % len(_MARKS)], 1.3


def _draw(tilts: Axes, strip: Axes, level: Floats, tilt: Floats, *, place: int, records: int) -> None:
    colour, mark, width = _look(place, records)
    order = np.argsort(level)
    level, tilt = level[order], tilt[order]
    shown = np.where(np.isfinite(tilt), tilt, np.nan)
    tilts.plot(level, shown, color=colour, marker=mark, markersize=3.0, linewidth=width, alpha=0.9)
    fallen = np.isinf(tilt)
    row = records - 1 - place
    strip.plot(level[fallen], np.full(np.count_nonzero(fallen), row), "x", color=colour, markersize=3.5)
    back = ~fallen & (level > np.min(level, where=fallen, initial=np.inf)) & np.isfinite(tilt)
    strip.plot(level[back], np.full(np.count_nonzero(back), row), "o", color=colour, markersize=3.5, mfc="white")


def _draw_quantiles(axes: Axes, level: Floats, tilt: Floats) -> list[Line2D]:
    """Draw quantiles over the series at common intensities; return the legend entries, none without quantiles."""
    if len(level) < 3 or np.any(np.ptp(level, axis=0) > _ONE_LEVEL * level.max(axis=0)):  # noqa: PLR2004
        return []
    quantiles = _quantiles(tilt)
    for share, line in zip(_QUANTILES, quantiles, strict=True):
        shown = np.where(np.isfinite(line), line, np.nan)
        middle = share == _QUANTILES[1]
        axes.plot(
            level[0],
            shown,
            color=BLACK,
            dashes=(None, None) if middle else (4, 2),
            linewidth=STABLE_WIDTH if middle else 1.4,
            zorder=4,
        )
    return [
        Line2D([], [], color=BLACK, linewidth=STABLE_WIDTH, label="median"),
        Line2D([], [], color=BLACK, linewidth=1.4, linestyle="--", label="16 and 84 %"),
    ]


def _quantiles(tilt: Floats) -> Floats:
    """Compute quantiles over the first axis, with overturned runs above all; NaN where a run is undecided."""
    known = ~np.isnan(tilt).any(axis=0)
    found = np.quantile(np.where(known, tilt, 0.0), _QUANTILES, axis=0, method="inverted_cdf")
    return np.where(known, found, np.nan)


def _axis_of(axes: Axes, level: Floats) -> None:
    low, high = float(level.min()), float(level.max())
    if low > 0.0 and high / low > _NUMBERS_TO_SPAN:
        axes.set_xscale("log")


def _legend(names: list[str]) -> list[Line2D]:
    if len(names) > _NAMED:
        handles = [Line2D([], [], color=GREY, marker="o", markersize=3.0, linewidth=0.7, label=f"{len(names)} records")]
    else:
        looks = [_look(place, len(names)) for place in range(len(names))]
        handles = [
            Line2D([], [], color=colour, marker=mark, markersize=3.5, linewidth=width, label=name)
            for name, (colour, mark, width) in zip(names, looks, strict=True)
        ]
    handles.append(Line2D([], [], color=GREY, marker="x", markersize=4.0, linestyle="none", label="overturned"))
    again = Line2D(
        [], [], color=GREY, marker="o", mfc="white", markersize=4.0, linestyle="none", label="survives again"
    )
    return [*handles, again]


def _title(found: xr.Dataset, *, quantiles: bool) -> str:
    others = [plural(found.sizes[dim], str(dim).replace("_", " ")) for dim in found["tilt_ratio"].dims]
    note = f"runs: {', '.join(others)}"
    return note if quantiles else f"{note}; no quantiles: the records have different intensities"


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
