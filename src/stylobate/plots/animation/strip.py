"""The history of the tilt below the picture, with the instant that is shown."""

from dataclasses import dataclass
from typing import Self

import numpy as np
from PIL import ImageDraw

from stylobate.plots.animation.canvas import FINE, disc, letters, line, rgb
from stylobate.plots.animation.motion import DrawnMotion
from stylobate.plots.animation.palette import INK, PALE
from stylobate.plots.pose import Floats
from stylobate.plots.style import BLUE

_AHEAD = (198, 198, 194)
# The tilt at which a column left alone falls is shown where the tilt comes to this part of it.
_NEAR = 0.4
# Dashes of that line, and how far apart [pixels].
_DASH, _STEP = 5, 9
_FONT = 11
# Names of the two lines apart [pixels as shown].
_APART = 14


@dataclass(frozen=True, slots=True, kw_only=True)
class Strip:
    """A curve in a band across the picture.

    Attributes
    ----------
    time
        Of its points [s].
    curve
        Those points, shape (n, 2) [fine pixels].
    left, right, floor
        Where the band lies [fine pixels].
    level
        Where the line |tilt| = c lies, if it is shown [fine pixels].
    top, highest
        Where the largest tilt lies [fine pixels], and how large it is over c.
    """

    time: Floats
    curve: Floats
    left: float
    right: float
    floor: float
    level: float | None
    top: float
    highest: float

    @classmethod
    def of(cls, motion: DrawnMotion, low: tuple[float, float], high: tuple[float, float]) -> Self:
        """Return the history of |tilt|/c between two corners [fine pixels]."""
        size = np.hypot(*motion.tilt.T) / motion.shape.slenderness
        highest = float(size.max())
        shown = highest >= _NEAR
        span = max(highest, 1.0) if shown else (highest or 1.0)
        x = low[0] + (high[0] - low[0]) * motion.time / motion.time[-1]
        rise = high[1] - low[1]
        return cls(
            time=motion.time,
            curve=np.stack([x, high[1] - rise * size / span], axis=-1),
            left=low[0],
            right=high[0],
            floor=high[1],
            level=high[1] - rise / span if shown else None,
            top=high[1] - rise * highest / span,
            highest=highest,
        )

    def draw_behind(self, draw: ImageDraw.ImageDraw) -> None:
        """Draw what stays: the whole curve, its floor, and the tilt from which a column left alone falls."""
        draw.line((self.left, self.floor, self.right, self.floor), fill=_AHEAD, width=FINE)
        if self.level is not None:
            for x in np.arange(self.left, self.right, _STEP * FINE):
                draw.line((x, self.level, min(x + _DASH * FINE, self.right), self.level), fill=PALE, width=FINE)
        line(draw, self.curve, _AHEAD, FINE)

    def write(self, draw: ImageDraw.ImageDraw) -> None:
        """Write what the curve is, beside it; `draw` is of the picture as it is shown."""
        font, right = letters(_FONT), self.right / FINE + 6
        level, label = (self.top, f"{self.highest:.2g} c") if self.level is None else (self.level, "c")
        draw.text((right, level / FINE), label, fill=PALE, font=font, anchor="lm")
        if self.floor - (self.top if self.level is None else self.level) >= _APART * FINE:
            draw.text((right, self.floor / FINE), "0", fill=PALE, font=font, anchor="lm")
        draw.text((self.left / FINE - 6, (self.top + self.floor) / 2 / FINE), "tilt", fill=PALE, font=font, anchor="rm")

    def draw(self, draw: ImageDraw.ImageDraw, time: float) -> None:
        """Draw the curve up to `time`."""
        at = np.array([np.interp(time, self.time, self.curve[:, 0]), np.interp(time, self.time, self.curve[:, 1])])
        past = self.curve[: np.searchsorted(self.time, time, side="right")]
        line(draw, np.concatenate([past, at[None]]), rgb(BLUE), 2 * FINE)
        disc(draw, at, 4.0 * FINE, rgb(BLUE), INK)
