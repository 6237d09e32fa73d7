"""What is drawn on: pictures twice as fine as they are shown, and letters."""

from functools import lru_cache
from pathlib import Path

import matplotlib as mpl
import numpy as np
from PIL import ImageDraw, ImageFont
from PIL.ImageFont import FreeTypeFont

from stylobate.plots.pose import Floats

FINE = 2
"""Pixels that are drawn for each that is shown, along either side: their mean smooths edges."""

Colour = tuple[int, ...]


def rgb(colour: str) -> Colour:
    """Return a colour of the palette, such as "#0072B2", as numbers."""
    return tuple(int(colour[place : place + 2], 16) for place in (1, 3, 5))


@lru_cache(maxsize=8)
def letters(size: int, *, bold: bool = False) -> FreeTypeFont:
    """Return the letters that Matplotlib brings along, `size` pixels high."""
    name = "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf"
    return ImageFont.truetype(str(Path(mpl.get_data_path()) / "fonts" / "ttf" / name), size)


def polygon(draw: ImageDraw.ImageDraw, corners: Floats, fill: Colour, outline: Colour | None = None) -> None:
    """Fill a polygon; corners of shape (n, 2), none of them drawing nothing."""
    if len(corners) > 2:  # noqa: PLR2004  a line covers nothing
        draw.polygon(corners.ravel().tolist(), fill=fill, outline=outline)


def line(draw: ImageDraw.ImageDraw, points: Floats, fill: Colour, width: int) -> None:
    """Draw a line through points, shape (n, 2)."""
    if len(points) > 1:
        draw.line(points.ravel().tolist(), fill=fill, width=width, joint="curve")


def disc(draw: ImageDraw.ImageDraw, centre: Floats, radius: float, fill: Colour | None, outline: Colour) -> None:
    """Draw a disc of this radius in pixels, or a bold ring where it is not filled."""
    x, y = np.asarray(centre, dtype=float).tolist()
    width = 2 * FINE if fill is None else FINE
    draw.ellipse((x - radius, y - radius, x + radius, y + radius), fill=fill, outline=outline, width=width)


_AROUND = np.linspace(0.0, 2.0 * np.pi, 73)


def circle(centre: Floats, radius: float) -> Floats:
    """Return points round a circle in a plane, closed, shape (n, 2)."""
    return np.asarray(centre + radius * np.stack([np.cos(_AROUND), np.sin(_AROUND)], axis=-1))
