"""A small picture from above of a base too narrow to show how the contact point runs round it."""

import math
from dataclasses import dataclass
from typing import Self

import numpy as np
from PIL import ImageDraw

from stylobate.plots.animation import palette
from stylobate.plots.animation.body import MARK
from stylobate.plots.animation.canvas import FINE, circle, disc, letters, line
from stylobate.plots.animation.lens import Lens
from stylobate.plots.animation.motion import DrawnMotion
from stylobate.plots.animation.trace import Trace
from stylobate.plots.axonometry import View
from stylobate.plots.pose import Floats

SIDE = 132
"""Of the square it fills [pixels as shown]."""

_FONT, _MARGIN, _CORNER = 11, 14, 6
# The mark on the column is drawn from this part of the radius outwards.
_INWARDS = 0.55


@dataclass(frozen=True, slots=True, kw_only=True)
class Plan:
    """The footprint circle, the contact point and its path in the frame of the base, from above.

    Attributes
    ----------
    low, high
        Corners of the square [fine pixels].
    lens, trace
        How it is seen, and the path.
    """

    low: Floats
    high: Floats
    lens: Lens
    trace: Trace

    @classmethod
    def of(cls, history: DrawnMotion, azimuth: float, corner: tuple[float, float]) -> Self:
        """Return the picture of a motion for one who looks from this `azimuth` [rad].

        Parameters
        ----------
        history
            The motion, finely sampled.
        azimuth
            Of the eye.
        corner
            Where its upper right corner is [pixels as shown].
        """
        high = FINE * np.array([corner[0], corner[1] + SIDE])
        low = FINE * np.array([corner[0] - SIDE, corner[1]])
        view = View(azimuth, math.pi / 2.0)
        least, most = history.footprint.min(axis=0), history.footprint.max(axis=0)
        around = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
        circle_points = history.shape.radius * np.stack([np.cos(around), np.sin(around)], axis=-1)
        points = np.concatenate([circle_points + end for end in (least, most)])
        room = FINE * _MARGIN
        lens = Lens.fitting(view, _flat(points), tuple(low + room), tuple(high - room))
        return cls(low=low, high=high, lens=lens, trace=Trace.of(history, np.eye(3), lens))

    def draw_behind(self, draw: ImageDraw.ImageDraw) -> None:
        """Draw the square."""
        corners = (*self.low.tolist(), *self.high.tolist())
        draw.rounded_rectangle(corners, radius=FINE * _CORNER, fill=palette.SLAB, outline=palette.SLAB_SIDE, width=1)

    def draw(self, draw: ImageDraw.ImageDraw, motion: DrawnMotion, index: int) -> None:
        """Draw one instant of `motion`."""
        radius, centre = motion.shape.radius, motion.footprint[index]
        colour = palette.CONTACT if motion.resting[index] else palette.FOOTPRINT
        line(draw, self.lens.pixels(_flat(circle(centre, radius))), colour, FINE)
        turn = motion.twist[index] + MARK
        marked = np.array([math.cos(turn), math.sin(turn)]) * radius
        ends = np.stack([centre + _INWARDS * marked, centre + marked])
        line(draw, self.lens.pixels(_flat(ends)), palette.MARK, 3 * FINE)
        self.trace.draw(draw, float(motion.time[index]), np.zeros(2))
        if motion.on_rim[index]:
            at = self.lens.pixels(_flat(motion.contact_point[index][None]))[0]
            disc(draw, at, 4.5 * FINE, palette.CONTACT_POINT, palette.SLAB)

    def write(self, draw: ImageDraw.ImageDraw) -> None:
        """Write what it is below it; `draw` is of the picture as it is shown."""
        middle = float(self.low[0] + self.high[0]) / 2.0 / FINE
        at = (middle, float(self.high[1]) / FINE + 4)
        draw.text(at, "from above", fill=palette.PALE, font=letters(_FONT), anchor="ma")


def _flat(points: Floats) -> Floats:
    return np.concatenate([points, np.zeros((len(points), 1))], axis=-1)
