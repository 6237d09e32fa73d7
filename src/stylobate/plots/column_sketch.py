"""Sketch of a column to scale, with the numbers that decide."""

import math
from dataclasses import asdict
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from stylobate.column import Column
from stylobate.plots.labels import is_dimensionless
from stylobate.plots.result_figure import InAxes, heading
from stylobate.plots.shape import Shape
from stylobate.plots.style import BLACK, GREY, VERMILION, new_figure, styled

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
    r, top, height, centre = shape.radius, shape.top_radius, shape.height, shape.mass_height
    size = max(height, 2.0 * max(r, top))
    known = column.height is not None
    side = [(-r, 0.0), (r, 0.0), (top, height), (-top, height)]
    axes.add_patch(Polygon(side, facecolor=_FACE, edgecolor=BLACK, linestyle="-" if known else "--", linewidth=1.2))
    half = max(r, top) + _GROUND * size
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
