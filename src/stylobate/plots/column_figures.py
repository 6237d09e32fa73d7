"""Figures of a column: its sketch to scale, and its path in three dimensions."""

import math
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib import rcParams
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Polygon
from matplotlib.ticker import MaxNLocator

from stylobate.column import Column
from stylobate.errors import ParameterError
from stylobate.plots.body import ColumnArtists
from stylobate.plots.geometry import Floats, Shape, View, base_centres, frames, quaternions
from stylobate.plots.labels import axis_label, is_dimensionless, unit_label
from stylobate.plots.result_figure import InAxes, ResultFigure, font_ratio, heading
from stylobate.plots.style import BLACK, BLUE, GREY, VERMILION, new_figure, styled
from stylobate.results import Run

_HEIGHT, _FACE = 3.6, "#dcebf5"
# Ground beside the base and room for dimensions [of the larger of height and diameter].
_GROUND, _ROOM = 0.12, 0.16


@styled
def plot_column(column: Column) -> Figure:
    """Draw the side of a column to scale: base, height, centre of mass and the angle α of the diagonal through it.

    The title states slenderness c, the frequency parameter p of small rocking, the base acceleration c g at which it
    uplifts, and the mass. A column without a known height is drawn twice as high as its centre of mass.
    """
    shape = Shape.of_column(asdict(column))
    figure = new_figure(_HEIGHT)
    axes = figure.subplots()
    r, widest, height, centre = shape.radius, shape.largest_radius, shape.height, shape.mass_height
    size = max(height, 2.0 * widest)
    known = column.height is not None
    axes.add_patch(
        Polygon(shape.side, facecolor=_FACE, edgecolor=BLACK, linestyle="-" if known else "--", linewidth=1.2)
    )
    half = widest + _GROUND * size
    axes.plot([-half, half], [0.0, 0.0], color=GREY, linewidth=2.0)
    axes.plot([r, 0.0], [0.0, centre], color=VERMILION, linewidth=1.2)
    axes.plot([0.0], [centre], marker="o", color=VERMILION, markersize=5)
    axes.plot([r, r], [0.0, centre], color=VERMILION, linewidth=0.7, linestyle=":")
    unit = "" if _has_no_units(column) else " m"
    out = half + 0.4 * _ROOM * size
    _dimension(axes, (-r, -_ROOM * size), (r, -_ROOM * size), f"2r = {2.0 * r:.4g}{unit}", {"va": "top"})
    _dimension(axes, (out, 0.0), (out, height), f"{height:.4g}{unit}" + ("" if known else " assumed"), {})
    _dimension(axes, (-out, 0.0), (-out, centre), f"h = {centre:.4g}{unit}", {"ha": "right"}, left=True)
    corners = [(-1.4 * out, -1.6 * _ROOM * size), (1.4 * out, (1.0 + 0.3 * _ROOM) * size)]
    axes.plot(*np.transpose(corners), linestyle="none")  # room for the dimensions
    axes.set_aspect("equal", adjustable="datalim")
    axes.axis("off")
    if isinstance(figure, InAxes):
        axes.set_title("\n".join(_numbers(column)))
    else:
        heading(figure, ", ".join(_numbers(column)))
    return figure


def _dimension(
    axes: Axes,
    start: tuple[float, float],
    end: tuple[float, float],
    text: str,
    look: dict[str, Any],
    *,
    left: bool = False,
) -> None:
    """Draw a line of dimension with its text beside the middle."""
    axes.annotate("", end, xytext=start, arrowprops={"arrowstyle": "<->", "color": GREY, "shrinkA": 0, "shrinkB": 0})
    middle = 0.5 * (start[0] + end[0]), 0.5 * (start[1] + end[1])
    level = start[1] == end[1]
    shift = (0, -4) if level else (-5, 0) if left else (5, 0)
    place = {"ha": "center" if level else "left", "va": "center"} | look
    axes.annotate(text, middle, xytext=shift, textcoords="offset points", fontsize="small", **place)


def _has_no_units(column: Column) -> bool:
    return is_dimensionless({"column": asdict(column)})


def _numbers(column: Column) -> list[str]:
    first = f"c = {column.slenderness:.4g} (α = {math.degrees(column.tipping_angle):.4g}°)"
    if _has_no_units(column):
        return [first]
    uplift = column.slenderness * column.gravity
    return [
        f"{first}, p = {column.frequency_parameter:.4g} rad/s",
        f"uplifts at {uplift:.4g} m/s², mass {column.mass:.4g} kg",
    ]


_GHOSTS = 4
# Strength of the colours of the column before the last of the times.
_BEFORE = 0.4
# Margin of the base about the path [base radii].
_MARGIN = 0.35
_TICKS = 3
# Number of samples of a path; maximum number of parts of a step in which the contact point turns by more than this
# angle [rad].
_SAMPLES, _PARTS, _TURN = 1500, 64, 0.06
# Maximum distance between samples that the contact point moves without a jump [base radii]; in a loaded run.
_LEAP, _LEAP_OF_SAMPLES = 0.5, 1.0
# Parts of the figure's width and height that the column in three dimensions takes, and minimum distance between
# numbers of the ground [font sizes].
_PART, _APART = 0.42, 3.0


@styled
def plot_column_path(
    run: Run,
    *,
    times: Sequence[float] | None = None,
    until: float | None = None,
    azimuth: float = -60.0,
    elevation: float = 22.0,
) -> Figure:
    """Draw the column in three dimensions and the path of its contact point, in the frame of the base.

    The column is that of animations at chosen times, pale before the last; its marked flute turns with it. The base
    shows the paths of the contact point and of the centre of the footprint circle, which moves if the column turns
    about its axis. The right panel shows the same from above.

    Parameters
    ----------
    run
        A run of a model that has a contact point.
    times
        Times at which the column is drawn [s]: within the run, rising. By default five times along the paths.
    until
        End of the paths [s]; by default the end of the run, or the last of the `times`.
    azimuth, elevation
        Direction of view [degrees].

    Raises
    ------
    ParameterError
        If the model has no contact point, or a time lies outside the run.
    """
    if "contact_point" not in run.data:
        raise ParameterError(
            f"run must be of a model with a `contact_point`, got {sorted(map(str, run.data.data_vars))}"
        )
    data, drawn = _shown(run, times, until)
    shape = Shape.of(run)
    radius, height = shape.radius, shape.height
    view = View(np.radians(azimuth), np.radians(elevation))
    figure = new_figure(4.6)
    space, plan = figure.subplots(1, 2, width_ratios=(1.0, 1.15))
    low, high = _extent(data, radius)
    unit = unit_label(run.data["contact_point"])
    _draw_ground(space, view, low, high, unit, _font_size(figure, view, low, high, height))
    leap = (_LEAP if run.sampler is not None else _LEAP_OF_SAMPLES) * radius
    _draw_paths_in_space(space, view, data, leap)
    for at in drawn:
        _draw_column(space, view, shape, data.isel(time=at), 1.0 if at == drawn[-1] else _BEFORE)
    _draw_height(space, view, low, high, height, f"{height:.3g} {unit}")
    space.set_aspect("equal")
    space.axis("off")
    _draw_plan(plan, data, drawn, radius, leap, low, high, " s" if unit_label(run.data["time"]) == "s" else "")
    _name_plan(plan, run)
    figure.legend(*plan.get_legend_handles_labels(), loc="outside lower center", ncols=4)
    return figure


def _shown(run: Run, times: Sequence[float] | None, until: float | None) -> tuple[xr.Dataset, npt.NDArray[Any]]:
    """Return the samples up to the end of the paths, and their indices at which the column is drawn."""
    end = float(run.data["time"][-1])
    last = until if until is not None else end if times is None else max(times, default=0.0)
    chosen = np.linspace(0.0, last, _GHOSTS + 1) if times is None else np.asarray(times, dtype=float)
    if not (0.0 < last <= end and chosen.size and np.all((chosen >= 0.0) & (chosen <= last))):
        raise ParameterError(f"times and until must lie within the run, 0 to {end:.6g} s, got {times!r} and {until!r}")
    data = _path(run, last, chosen)
    return data, np.searchsorted(data["time"].to_numpy()[:-1], chosen)


def _path(run: Run, last: float, chosen: Floats) -> xr.Dataset:
    """Return samples close enough for smooth paths; for a loaded run, its own samples."""
    if run.sampler is None:
        return run.data.isel(time=run.data["time"].to_numpy() <= last)
    time = np.unique(np.concatenate([np.linspace(0.0, last, _SAMPLES), chosen]))
    turned = np.nan_to_num(np.abs(np.diff(run.sample(time)["azimuth"].to_numpy())))
    # Near the vertical the contact point moves fast round the rim.
    parts = np.clip(np.ceil(turned / _TURN), 1, _PARTS).astype(int)
    pieces = [np.linspace(a, b, n, endpoint=False) for a, b, n in zip(time[:-1], time[1:], parts, strict=True)]
    return run.sample(np.append(np.concatenate(pieces), last))


def _footprint(data: xr.Dataset) -> Floats:
    tilt = data["tilt"].to_numpy()
    return data["footprint"].to_numpy() if "footprint" in data else np.zeros_like(tilt)


def _extent(data: xr.Dataset, radius: float) -> tuple[Floats, Floats]:
    """Return the corners of the drawn ground [m], which contains the footprint circle at all times."""
    centres = _footprint(data)
    margin = (1.0 + _MARGIN) * radius
    return centres.min(axis=0) - margin, centres.max(axis=0) + margin


def _on_ground(points: Floats) -> Floats:
    return np.concatenate([points, np.zeros((*points.shape[:-1], 1))], axis=-1)


def _font_size(figure: Figure, view: View, low: Floats, high: Floats, height: float) -> float:
    """Return an estimate of the font size in the units of the projection."""
    corners = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (0.0, height)])
    narrow = isinstance(figure, ResultFigure) and figure.narrow
    inches = figure.get_size_inches() * ((2.0 * _PART, _PART) if narrow else (_PART, 2.0 * _PART))
    return float(rcParams["font.size"] / 72.0 * np.max(np.ptp(view.project(corners), axis=0) / inches))


def _draw_ground(axes: Axes, view: View, low: Floats, high: Floats, unit: str, font: float) -> None:
    """Draw the base as a board with a grid, numbered along its near edges where the numbers have room."""
    corners = np.array([[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]])
    board = view.project(_on_ground(corners))
    axes.add_patch(Polygon(board, facecolor="#f4f4f4", edgecolor=GREY, linewidth=0.8))
    centre = board.mean(axis=0)
    for along, name in ((0, "x"), (1, "y")):
        across = 1 - along
        ends = np.zeros((2, 2))
        ends[:, across] = low[across], high[across]
        near = int(np.argmin([view.project(_on_ground(_moved(corner, along, low, high)))[1] for corner in ends]))
        ticks = MaxNLocator(_TICKS, steps=[1, 2, 5, 10]).tick_values(low[along], high[along])
        shown = ticks[(ticks >= low[along]) & (ticks <= high[along])]
        direction = view.project(np.eye(3)[along])
        numbered = float(np.hypot(*direction)) * (ticks[1] - ticks[0]) > _APART * font
        for value in shown:
            ends[:, along] = value
            line = view.project(_on_ground(ends))
            axes.plot(*line.T, color="#dddddd", linewidth=0.6)
            if numbered:
                _label(axes, line[near], line[1 - near], f"{value:g}".replace("-", "−"))
        middle = _moved(ends[near], along, low, high)
        edge = view.project(_on_ground(middle))
        outwards = edge - centre
        axes.annotate(
            f"${name}$ [{unit}]" if numbered else f"${name}$",
            (float(edge[0]), float(edge[1])),
            xytext=tuple((26.0 if numbered else 9.0) * font_ratio() * outwards / np.hypot(*outwards)),
            textcoords="offset points",
            ha="center",
            va="center",
            fontsize="small",
        )


def _moved(corner: Floats, along: int, low: Floats, high: Floats) -> Floats:
    """Return `corner` moved to the middle along one axis."""
    moved = corner.copy()
    moved[along] = 0.5 * (low[along] + high[along])
    return moved


def _label(axes: Axes, at: Floats, other: Floats, text: str) -> None:
    """Write a text beside the end `at` of a line, away from its `other` end."""
    outwards = 9.0 * font_ratio() * (at - other) / np.hypot(*(at - other))
    axes.annotate(
        text,
        (float(at[0]), float(at[1])),
        xytext=tuple(outwards),
        textcoords="offset points",
        ha="center",
        va="center",
        fontsize="x-small",
    )


def _contact_path(data: xr.Dataset, leap: float) -> Floats:
    """Return the path of the contact point, with a gap at each jump of more than `leap` [m].

    After a face impact, and where the column rocks through the vertical, the contact is elsewhere.
    """
    path = data["contact_point"].to_numpy()
    leaps = np.flatnonzero(np.hypot(*np.diff(path, axis=0).T) > leap)
    return np.insert(path, leaps + 1, np.nan, axis=0)


def _draw_paths_in_space(axes: Axes, view: View, data: xr.Dataset, leap: float) -> None:
    axes.plot(*view.project(_on_ground(_contact_path(data, leap))).T, color=VERMILION, linewidth=1.0)
    centres = _footprint(data)
    if np.ptp(centres) > 0.0:
        axes.plot(*view.project(_on_ground(centres)).T, color=BLUE, linewidth=1.0)


def _draw_column(axes: Axes, view: View, shape: Shape, data: xr.Dataset, strength: float) -> None:
    """Draw the column at one instant of `data`, and make room for it."""
    tilt, twist = data["tilt"].to_numpy(), float(data["twist"]) if "twist" in data else 0.0
    centre = base_centres(tilt, _footprint(data), shape.radius)
    rims = ColumnArtists(axes, shape, view, strength).place(frames(quaternions(tilt, twist)), centre)
    axes.update_datalim(np.concatenate(rims))


def _draw_height(axes: Axes, view: View, low: Floats, high: Floats, height: float, text: str) -> None:
    """Draw a rod beside the column with the same height, and this height as text."""
    corners = [np.array([x, y]) for x in (low[0], high[0]) for y in (low[1], high[1])]
    left = min(corners, key=lambda corner: float(view.project(_on_ground(corner))[0]))
    foot, top = view.project(np.array([[*left, 0.0], [*left, height]]))
    axes.annotate("", top, xytext=foot, arrowprops={"arrowstyle": "|-|", "linewidth": 0.8, "mutation_scale": 3})
    axes.annotate(text, (foot + top) / 2.0, xytext=(-5, 0), textcoords="offset points", ha="right", va="center")


def _draw_plan(
    axes: Axes,
    data: xr.Dataset,
    drawn: npt.NDArray[Any],
    radius: float,
    leap: float,
    low: Floats,
    high: Floats,
    seconds: str,
) -> None:
    contact, centres = data["contact_point"].to_numpy(), _footprint(data)
    circles: dict[str, Any] = {"fill": False, "edgecolor": GREY, "linewidth": 0.7}
    for at in drawn[:-1]:
        axes.add_patch(Circle(tuple(centres[at]), radius, linestyle=(0, (4, 2)), **circles))
    axes.add_patch(Circle(tuple(centres[drawn[-1]]), radius, **{**circles, "edgecolor": BLACK}))
    axes.plot(*_contact_path(data, leap).T, color=VERMILION, linewidth=1.1, label="contact point")
    if np.ptp(centres) > 0.0:
        axes.plot(*centres.T, color=BLUE, linewidth=1.1, label="centre of the footprint")
    mark: dict[str, Any] = {"linestyle": "none", "markersize": 5, "color": BLACK}
    axes.plot(*contact[drawn[:1]].T, marker="o", markerfacecolor="white", label="first", **mark)
    axes.plot(*contact[drawn[-1:]].T, marker="s", label="last", **mark)
    for at in drawn:
        if np.all(np.isfinite(contact[at])):
            axes.annotate(
                f"{float(data['time'][at]):.3g}{seconds}",
                tuple(contact[at]),
                xytext=tuple(14.0 * (contact[at] - centres[at]) / radius),
                textcoords="offset points",
                ha="center",
                va="center",
                fontsize="x-small",
                bbox={"facecolor": "white", "alpha": 0.7, "linewidth": 0.0, "pad": 0.6},
            )
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    axes.set_aspect("equal")


def _name_plan(axes: Axes, run: Run) -> None:
    """Label the axes, and explain the numbers in the plan if they have no unit."""
    axes.set_xlabel(axis_label(run.data["contact_point"], "$x$"))
    axes.set_ylabel(axis_label(run.data["contact_point"], "$y$"))
    own = unit_label(run.data["time"]) != "s"
    axes.set_title(f"from above, at {axis_label(run.data['time'])}" if own else "from above")
