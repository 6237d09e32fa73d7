"""Figures of the slip of columns that slide before they rock: slip over the scale, and paths in plan."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle
from matplotlib.ticker import LogLocator, NullFormatter

from stylobate.earthquakes.fragility.displacement_limits import Response
from stylobate.errors import ParameterError
from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import axis_label, literal
from stylobate.plots.style import BLACK, DASHES, GREY, PALETTE, new_figure, styled
from stylobate.text import plural

Floats = npt.NDArray[np.float64]

_HEIGHT, _PLAN = 4.2, 4.6
# Maximum number of records with a colour and a name; more are grey.
_NAMED = 6
_MILLIMETRES = 1000.0
# Slips below this [mm] are not drawn.
_SMALLEST = 1.0
# Free space around the paths in plan.
_AROUND = 1.1


@figure_of("slip analysis")
@styled
def plot_slip(found: xr.Dataset) -> Figure:
    """Draw the largest slip against the intensity, a line for each record and property sample, with the limits.

    Slips below 1 mm are not drawn. Limits of the residual position have no line: they limit another displacement.

    Raises
    ------
    ParameterError
        If the runs have no dimension `scale`.
    """
    if "scale" not in found.dims:
        raise ParameterError("found: lacks the dimension scale (got one scale). Take runs.isel(scale=[0]).")
    slip = found["peak_slip"]
    level = found["intensity"].broadcast_like(slip)
    figure = new_figure(_HEIGHT)
    axes = figure.subplots()
    _draw_slips(axes, slip, level)
    _draw_limits(axes, found)
    axes.set_xlabel(axis_label(found["intensity"]))
    samples = ", of all property samples" if "property_sample" in found.dims else ""
    axes.set_title(f"slip under {plural(_records(slip), 'record')}{samples}")
    figure.legend(loc="outside right upper")
    return figure


@styled
def plot_slip_margins(found: xr.Dataset, limits: Sequence[tuple[str, str, float]]) -> Figure:
    """Draw the largest slip of one column against the scale, a line for each record, with the limits.

    Parameters
    ----------
    found
        Margins of slip of one column, over `record` and `margin_scale`.
    limits
        Name, response and limit [m] of each limit state.
    """
    figure = new_figure(_HEIGHT)
    axes = figure.subplots()
    _draw_slips(axes, found["peak_slip"].rename(margin_scale="scale"), None)
    names, responses, values = zip(*limits, strict=True) if limits else ((), (), ())
    stated = xr.Dataset(coords={"limit_state": list(names)}).assign_coords(
        limit=("limit_state", np.array(values, dtype=float)), response=("limit_state", np.array(responses, dtype=str))
    )
    _draw_limits(axes, stated)
    axes.set_xlabel("scale factor of the record")
    figure.legend(loc="outside right upper")
    return figure


@figure_of("slip paths")
@styled
def plot_slip_paths(found: xr.Dataset) -> Figure:
    """Draw the path of the base in plan under each record, its end, and the limits as circles about the start."""
    figure = new_figure(_PLAN)
    axes = figure.subplots()
    names = [str(name) for name in found["record"].to_numpy()]
    farthest = 0.0
    for place, name in enumerate(names):
        x, y = (_MILLIMETRES * found[one].isel(record=place).to_numpy() for one in ("slip_x", "slip_y"))
        known = np.isfinite(x)
        if not known.any():
            continue
        farthest = max(farthest, float(np.hypot(x[known], y[known]).max()))
        colour = _colour(place, len(names))
        label = literal(name) if len(names) <= _NAMED else None
        axes.plot(x[known], y[known], color=colour, linewidth=1.1, label=label)
        axes.plot(x[known][-1], y[known][-1], "o", color=colour, markersize=4.0)
    axes.plot(0.0, 0.0, "+", color=BLACK, markersize=9.0, label="start")
    axes.plot([], [], "o", color=GREY, markersize=4.0, linestyle="none", label="end")
    for place, (name, limit) in enumerate(_lines(found, residual=True)):
        dashes = DASHES[(place + 1) % len(DASHES)]
        axes.add_patch(Circle((0.0, 0.0), limit, fill=False, color=BLACK, linewidth=1.2, linestyle=dashes))
        axes.plot([], [], color=BLACK, linewidth=1.2, linestyle=dashes, label=literal(name))
        farthest = max(farthest, limit)
    reach = _AROUND * (farthest or _SMALLEST)
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal")
    axes.set(xlabel="slip along x [mm]", ylabel="slip along y [mm]")
    axes.set_title(f"path of the base in plan, scale {float(found.attrs.get('scale', 1.0)):g}")
    figure.legend(loc="outside right upper")
    return figure


def _draw_slips(axes: Axes, slip: xr.DataArray, level: xr.DataArray | None) -> None:
    """Draw the slips over a level, by default the scale, with one line for each record and sample."""
    dims = [dim for dim in slip.dims if dim not in ("record", "scale")]
    if "record" not in slip.dims:
        slip = slip.expand_dims("record")
        level = None if level is None else level.expand_dims("record")
    shown = slip.transpose("record", *dims, "scale")
    names = [str(name) for name in np.atleast_1d(slip["record"].to_numpy())]
    values = _MILLIMETRES * shown.to_numpy().reshape(len(names), -1, shown.sizes["scale"])
    along = slip["scale"].broadcast_like(shown) if level is None else level
    levels = along.transpose("record", *dims, "scale").to_numpy().reshape(values.shape)
    for place, name in enumerate(names):
        colour = _colour(place, len(names))
        for series, (x, y) in enumerate(zip(levels[place], values[place], strict=True)):
            label = literal(name) if series == 0 and len(names) <= _NAMED else None
            axes.plot(x, np.where(y >= _SMALLEST, y, np.nan), color=colour, linewidth=1.2, label=label)
    if len(names) > _NAMED:
        axes.plot([], [], color=GREY, linewidth=1.2, label=plural(len(names), "record"))
    axes.set(xscale="log", yscale="log", ylabel="largest distance from the start [mm]")
    axes.set_xlim(float(levels.min()), float(levels.max()))
    axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.yaxis.set_major_locator(LogLocator())
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter(NullFormatter())


def _draw_limits(axes: Axes, found: xr.Dataset) -> list[Line2D]:
    return [
        axes.axhline(
            limit, color=BLACK, linewidth=1.2, linestyle=DASHES[(place + 1) % len(DASHES)], label=literal(name)
        )
        for place, (name, limit) in enumerate(_lines(found, residual=False))
    ]


def _lines(found: xr.Dataset, *, residual: bool) -> list[tuple[str, float]]:
    """Return name and limit [mm] of the limit states that are drawn."""
    if "limit" not in found.coords:
        return []
    rows = zip(*(found[name].to_numpy().tolist() for name in ("limit_state", "response", "limit")), strict=True)
    return [
        (str(name), _MILLIMETRES * limit)
        for name, response, limit in rows
        if residual or response != Response.RESIDUAL.value
    ]


def _records(slip: xr.DataArray) -> int:
    return int(slip.sizes.get("record", 1))


def _colour(place: int, records: int) -> str:
    return GREY if records > _NAMED else PALETTE[place % len(PALETTE)]
