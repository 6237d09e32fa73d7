"""What stands still: paper, marks on the ground, and the lines on the slab."""

import math

import numpy as np
from PIL import Image, ImageDraw

from stylobate.plots.animation.canvas import FINE, line
from stylobate.plots.animation.lens import Lens
from stylobate.plots.animation.palette import BACKGROUND, GROUND_LINE, mixed
from stylobate.plots.animation.scene import Scene, round_length
from stylobate.plots.pose import Floats

# Least distance between marks [pixels as shown], and half their length over it.
_APART, _ARM = 34, 0.1
# Marks fade out over this part of the picture's height above the slab's middle.
_FADE = 0.55


def backdrop(size: tuple[int, int], scene: Scene, lens: Lens, above: int, below: int) -> Image.Image:
    """Return a picture of the ground, twice as fine as `size`, with marks that show how the base moves over it.

    Parameters
    ----------
    size
        Of the picture as it is shown [pixels].
    scene, lens
        What stands where, and how it is seen.
    above, below
        Strips that stay empty [pixels as shown].
    """
    width, height = (FINE * pixels for pixels in size)
    picture = Image.new("RGB", (width, height), BACKGROUND)
    draw = ImageDraw.Draw(picture)
    step = round_length(FINE * _APART / lens.scale) * 2.0
    middle = lens.pixels(np.array([0.0, 0.0, scene.ground]))
    for mark in _marks(scene.ground, step, lens, max(width, height)):
        x, y = lens.pixels(mark)
        if not (0 <= x <= width and above * FINE < y < height - below * FINE):
            continue
        strength = float(np.clip(1.0 - (middle[1] - y) / (_FADE * height), 0.0, 1.0))
        colour = mixed(BACKGROUND, GROUND_LINE, strength)
        for along in (0, 1):
            ends = np.repeat(mark[None], 2, axis=0)
            ends[:, along] += (-_ARM * step, _ARM * step)
            line(draw, lens.pixels(ends), colour, FINE)
    return picture


def _marks(ground: float, step: float, lens: Lens, reach: float) -> Floats:
    """Return points on the ground, a `step` apart, that cover a picture `reach` pixels wide and high."""
    most = math.ceil(reach / lens.scale / math.sin(max(lens.view.elevation, math.radians(10.0))) / step)
    one = step * np.arange(-most, most + 1)
    x, y = np.meshgrid(one, one)
    return np.stack([x.ravel(), y.ravel(), np.full(x.size, ground)], axis=-1)


def slab_lines(scene: Scene) -> Floats:
    """Return the ends of the lines on the slab, in its own frame, shape (n, 2, 3)."""
    found = []
    for along in (0, 1):
        first, last = math.ceil(scene.low[along] / scene.grid), math.floor(scene.high[along] / scene.grid)
        for number in range(first, last + 1):
            ends = np.zeros((2, 3))
            ends[:, along] = number * scene.grid
            ends[:, 1 - along] = scene.low[1 - along], scene.high[1 - along]
            found.append(ends)
    return np.stack(found)
