"""Draws the column with its symbols and axes into docs/_static/notation.svg and notation.png.

Run it with `python docs/figures/notation.py`; it takes seconds.
"""

import math
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Circle, Polygon, Rectangle
from saving import STATIC, save

TARGET = STATIC / "notation"

# Radius, height of the centre of mass and height; the tilt and the azimuth that are drawn [rad].
R, MASS_HEIGHT, H = 0.32, 1.0, 2.0
TILT, AZIMUTH = math.radians(11.0), math.radians(35.0)

STONE, EDGE, SLAB, SLAB_EDGE, INK = (
    "#f1ebde",
    "#6b6455",
    "#e3e8ef",
    "#8792a2",
    "#1d2733",
)
BLUE, VERMILION, GREEN, PURPLE = "#0072B2", "#D55E00", "#00795A", "#9A4A7E"
PALE = "#5d6b7d"
FLOOR = 0.26
SETTINGS: dict[Any, Any] = {
    "mathtext.fontset": "cm",
    "font.size": 9.5,
    "svg.fonttype": "path",
    "svg.hashsalt": "notation",
}


def arrow(
    axes: Axes,
    start: tuple[float, float],
    end: tuple[float, float],
    colour: str,
    **options: Any,
) -> None:
    """Draw an arrow between two points."""
    look = {
        "arrowstyle": "-|>",
        "color": colour,
        "lw": 1.6,
        "shrinkA": 0.0,
        "shrinkB": 0.0,
        "mutation_scale": 12,
    }
    axes.annotate("", end, start, arrowprops=look | options)


def measure(axes: Axes, start: tuple[float, float], end: tuple[float, float]) -> None:
    """Draw a line with a head at each end."""
    arrow(axes, start, end, PALE, arrowstyle="<|-|>", lw=0.9, mutation_scale=8)


def write(
    axes: Axes, x: float, y: float, text: str, colour: str = INK, **options: Any
) -> None:
    """Write a symbol or a word."""
    axes.text(
        x,
        y,
        text,
        color=colour,
        **{"ha": "center", "va": "center", "size": 13} | options,
    )


def word(
    axes: Axes, x: float, y: float, text: str, colour: str = INK, **options: Any
) -> None:
    """Write a name."""
    write(axes, x, y, text, colour, **{"size": 9} | options)


def slab(axes: Axes, left: float, right: float) -> None:
    """Draw the base, on which the column stands."""
    axes.add_patch(
        Rectangle((left, -FLOOR), right - left, FLOOR, facecolor=SLAB, edgecolor="none")
    )
    axes.plot([left, right], [0.0, 0.0], color=SLAB_EDGE, lw=1.4)


def mass(axes: Axes, x: float, y: float) -> None:
    """Mark a centre of mass."""
    axes.add_patch(
        Circle((x, y), 0.055, facecolor="white", edgecolor=INK, lw=1.2, zorder=5)
    )
    for begin in (0.0, 180.0):
        angles = np.radians(np.linspace(begin, begin + 90.0, 20))
        points = np.vstack(
            [
                [x, y],
                np.stack(
                    [x + 0.055 * np.cos(angles), y + 0.055 * np.sin(angles)], axis=-1
                ),
            ]
        )
        axes.add_patch(Polygon(points, facecolor=INK, zorder=6))


def draw_at_rest(axes: Axes) -> None:
    """The vertical column: its lengths and the tipping angle."""
    slab(axes, -0.95, 0.95)
    axes.add_patch(
        Rectangle((-R, 0.0), 2.0 * R, H, facecolor=STONE, edgecolor=EDGE, lw=1.3)
    )
    axes.plot([0.0, 0.0], [0.0, H + 0.12], color=PALE, lw=0.8, ls=(0, (8, 3, 1.5, 3)))
    axes.plot([R, 0.0], [0.0, MASS_HEIGHT], color=PURPLE, lw=1.3)
    angle = math.degrees(math.atan(R / MASS_HEIGHT))
    axes.add_patch(
        Arc((R, 0.0), 1.2, 1.2, theta1=90.0, theta2=90.0 + angle, color=PURPLE, lw=1.5)
    )
    write(axes, R + 0.2, 0.42, r"$\alpha_c$", PURPLE)
    axes.plot([R - 0.06, R + 0.1], [0.57, 0.46], color=PURPLE, lw=0.7)
    mass(axes, 0.0, MASS_HEIGHT)
    for x, top, name in ((-0.52, MASS_HEIGHT, "$h$"), (-0.8, H, "$H$")):
        measure(axes, (x, 0.0), (x, top))
        axes.plot(
            [x - 0.05, 0.0 if name == "$h$" else -R], [top, top], color=PALE, lw=0.6
        )
        write(axes, x - 0.12, 0.5 * top if name == "$h$" else 0.62 * top, name)
    measure(axes, (0.0, H + 0.1), (R, H + 0.1))
    axes.plot([R, R], [H, H + 0.15], color=PALE, lw=0.6)
    write(axes, 0.5 * R, H + 0.19, "$r$")
    word(axes, 0.42, MASS_HEIGHT + 0.28, "centre\nof mass", ha="left")
    axes.plot(
        [0.065, 0.4], [MASS_HEIGHT + 0.03, MASS_HEIGHT + 0.22], color=PALE, lw=0.7
    )
    write(axes, 0.0, -0.48, r"slenderness $c = r/h = \tan\alpha_c$", PURPLE, size=9.5)
    axes.set(xlim=(-1.02, 0.98), ylim=(-0.6, 2.35))


def draw_tilted(axes: Axes) -> None:
    """The column on its rim, in the vertical plane of its lean."""
    slab(axes, -1.0, 1.05)
    turn = np.array(
        [[math.cos(TILT), math.sin(TILT)], [-math.sin(TILT), math.cos(TILT)]]
    )
    contact = np.array([R, 0.0])

    def placed(x: float, y: float) -> np.ndarray:
        """Return the place of a point of the column, its coordinates counted from the contact point."""
        return contact + turn @ (x, y)

    axes.add_patch(
        Rectangle(
            (-R, 0.0),
            2.0 * R,
            H,
            fill=False,
            edgecolor="#b9c1cc",
            lw=0.9,
            ls=(0, (3, 2)),
        )
    )
    corners = np.array(
        [
            placed(x, y)
            for x, y in ((-2.0 * R, 0.0), (0.0, 0.0), (0.0, H), (-2.0 * R, H))
        ]
    )
    axes.add_patch(Polygon(corners, facecolor=STONE, edgecolor=EDGE, lw=1.3))
    ends = np.array([placed(-R, 0.0), placed(-R, H + 0.15)])
    axes.plot(*ends.T, color=PALE, lw=0.8, ls=(0, (8, 3, 1.5, 3)))
    axes.plot([R, R], [0.0, H + 0.32], color=BLUE, lw=1.1, ls=(0, (4, 2)))
    axes.add_patch(
        Arc(
            (R, 0.0),
            3.5,
            3.5,
            theta1=90.0 - math.degrees(TILT),
            theta2=90.0,
            color=BLUE,
            lw=1.6,
        )
    )
    middle = 0.5 * TILT
    write(axes, R + 1.53 * math.sin(middle), 1.5, r"$\theta$", BLUE)
    x, y = placed(-R, MASS_HEIGHT)
    arrow(axes, (x, y), (x, y - 0.55), INK, lw=1.2, mutation_scale=10)
    write(axes, x - 0.21, y - 0.23, "$mg$", size=10.5)
    mass(axes, x, y)
    axes.add_patch(
        Circle((R, 0.0), 0.05, facecolor=VERMILION, edgecolor="white", lw=0.8, zorder=6)
    )
    word(axes, R + 0.13, 0.13, "contact\npoint", VERMILION, ha="left", va="bottom")
    axes.plot([R + 0.05, R + 0.16], [0.04, 0.13], color=VERMILION, lw=0.7)
    arrow(
        axes,
        (-0.1, -0.5 * FLOOR),
        (-0.78, -0.5 * FLOOR),
        GREEN,
        lw=2.2,
        mutation_scale=14,
    )
    write(axes, 0.02, -0.5 * FLOOR, "$a$", GREEN)
    word(axes, 0.02, -0.48, "base acceleration", GREEN, size=9.5)
    axes.set(xlim=(-1.03, 1.1), ylim=(-0.6, 2.35))


def draw_from_above(axes: Axes) -> None:
    """The circle on the base about which the contact point runs, with axes, tilt vector and azimuth."""
    radius = 0.78
    axes.add_patch(
        Rectangle(
            (-1.13, -1.13), 2.26, 2.26, facecolor=SLAB, edgecolor=SLAB_EDGE, lw=0.8
        )
    )
    axes.add_patch(Circle((0.0, 0.0), radius, facecolor=STONE, edgecolor=EDGE, lw=1.3))
    for end, name, place in (
        ((1.38, 0.0), "$x$", (1.42, -0.14)),
        ((0.0, 1.38), "$y$", (-0.13, 1.38)),
    ):
        arrow(axes, (0.0, 0.0), end, INK, lw=1.0, mutation_scale=10)
        write(axes, *place, name)
    lean = np.array([math.cos(AZIMUTH), math.sin(AZIMUTH)])
    tip = 0.6 * lean
    axes.plot(*np.array([tip, radius * lean]).T, color=PALE, lw=0.8, ls=(0, (3, 2)))
    for foot, place, name in (
        ((tip[0], 0.0), (tip[0], -0.13), r"$\theta_x$"),
        ((0.0, tip[1]), (-0.15, tip[1]), r"$\theta_y$"),
    ):
        axes.plot(*np.array([tip, foot]).T, color=BLUE, lw=0.8, ls=(0, (1.5, 1.5)))
        write(axes, *place, name, BLUE, size=11)
    arrow(axes, (0.0, 0.0), tuple(tip), BLUE, lw=2.4, mutation_scale=14)
    write(axes, 0.2, 0.28, r"$\boldsymbol{\theta}$", BLUE)
    axes.add_patch(
        Arc(
            (0.0, 0.0),
            0.6,
            0.6,
            theta1=0.0,
            theta2=math.degrees(AZIMUTH),
            color=INK,
            lw=1.1,
        )
    )
    write(axes, 0.385, 0.12, r"$\beta$", size=11)
    axes.add_patch(
        Circle(
            radius * lean,
            0.055,
            facecolor=VERMILION,
            edgecolor="white",
            lw=0.8,
            zorder=6,
        )
    )
    turn = np.radians(
        np.linspace(math.degrees(AZIMUTH) + 9.0, math.degrees(AZIMUTH) + 52.0, 40)
    )
    path = 0.93 * np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    axes.plot(*path[:-2].T, color=VERMILION, lw=1.5)
    arrow(axes, tuple(path[-3]), tuple(path[-1]), VERMILION, lw=1.5)
    word(axes, 0.6, 0.96, "rolling", VERMILION, ha="left")
    arrow(axes, (-0.99, -0.62), (-0.67, -0.86), GREEN, lw=2.2, mutation_scale=14)
    write(axes, -0.72, -0.98, r"$\boldsymbol{a}$", GREEN)
    axes.set(xlim=(-1.2, 1.55), ylim=(-1.2, 1.55))


def draw() -> Figure:
    """Return the figure."""
    width, height, scale = (
        7.2,
        3.55,
        1.06,
    )  # inches, and inches for a unit of the first two panels
    figure = Figure(figsize=(width, height), facecolor="white")
    upright, tilted = 2.0 * scale, 2.13 * scale
    for left, size, drawing, title in (
        (0.02, (upright, 2.95 * scale), draw_at_rest, "At rest"),
        (
            0.12 + upright,
            (tilted, 2.95 * scale),
            draw_tilted,
            "Tilted: the plane of its lean",
        ),
        (0.24 + upright + tilted, (2.55, 2.55), draw_from_above, "From above"),
    ):
        axes = figure.add_axes(
            (
                left / width,
                0.44 - 0.42 * size[1] / (2.95 * scale),
                size[0] / width,
                size[1] / height,
            )
        )
        drawing(axes)
        axes.set_aspect("equal")
        axes.axis("off")
        place = axes.get_position()
        figure.text(
            place.x0 + 0.5 * place.width,
            0.945,
            title,
            size=10,
            weight="bold",
            color=INK,
            ha="center",
        )
    return figure


if __name__ == "__main__":
    TARGET.parent.mkdir(parents=True, exist_ok=True)
    with rc_context(SETTINGS):
        figure = draw()
        figure.savefig(TARGET.with_suffix(".svg"), metadata={"Date": None})
        save(figure, TARGET.with_suffix(".png"))
