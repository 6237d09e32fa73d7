"""What is written in a picture: the instant, the tilt, the outcome, and scales."""

import math

import numpy as np
from PIL import ImageDraw

from stylobate.errors import Outcome
from stylobate.plots.animation.canvas import FINE, letters, rgb
from stylobate.plots.animation.lens import Lens
from stylobate.plots.animation.motion import DrawnMotion, verdict_of
from stylobate.plots.animation.palette import INK, PALE
from stylobate.plots.animation.scene import round_length
from stylobate.plots.style import VERMILION

# Sizes of letters, the lines on which texts stand [pixels from above], and room between two in a line.
_TEXT, _NOTE, _SMALL = 15, 12, 11
_LINE, _BELOW, _GAP = 27, 45, 14
# Longest scale bar, over the width of the picture.
_BAR = 0.2
_ROUNDING = 1e-9
_FALLS = (Outcome.OVERTURNED, Outcome.FAILED, Outcome.LIMIT_REACHED, Outcome.LIFTED_OFF)


def write_lines(
    draw: ImageDraw.ImageDraw, motion: DrawnMotion, index: int, ends: tuple[int, int], *, pace: float, title: str | None
) -> None:
    """Write time and tilt of one instant, the title below, and at the right the outcome, or how fast it is shown.

    Parameters
    ----------
    motion, index
        The motion and the number of the instant.
    ends
        Where the lines begin and end [pixels].
    pace
        Seconds of the motion in a second of the animation.
    title
        A line below time and tilt.
    """
    left, right = ends
    state = _write_state(draw, motion, index, left)
    below = left
    if title:
        text = _shortened(draw, title, _NOTE, right - left)
        draw.text((left, _BELOW), text, fill=PALE, font=letters(_NOTE), anchor="ls")
        below = left + round(draw.textlength(text, font=letters(_NOTE)))
    if index == motion.time.size - 1:
        _write_outcome(draw, motion.outcome, state, below, right)
    elif not math.isclose(pace, 1.0):
        draw.text((right, _LINE), f"speed × {pace:.3g}", fill=PALE, font=letters(_NOTE), anchor="rs")


def _write_state(draw: ImageDraw.ImageDraw, motion: DrawnMotion, index: int, left: int) -> float:
    """Write time and tilt, and return where they end."""
    tilt = math.hypot(*motion.tilt[index])
    # Three digits of the time at the end, and no less than seconds.
    digits = max(0, 2 - math.floor(math.log10(motion.time[-1])))
    text = f"{motion.time[index]:.{digits}f} s    tilt {tilt / motion.shape.slenderness:.2f} c"
    draw.text((left, _LINE), text, fill=INK, font=letters(_TEXT), anchor="ls")
    at = left + draw.textlength(f"{text}   ", font=letters(_TEXT))
    degrees = f"{math.degrees(tilt):.1f}°"
    draw.text((at, _LINE), degrees, fill=PALE, font=letters(_NOTE), anchor="ls")
    return at + draw.textlength(degrees, font=letters(_NOTE))


def _write_outcome(draw: ImageDraw.ImageDraw, outcome: Outcome, state: float, title: float, right: int) -> None:
    """Write what became of the column in the first line that has room for it, behind state or title, or else below."""
    text, font = verdict_of(outcome), letters(_TEXT, bold=True)
    needed = right - draw.textlength(text, font=font) - _GAP
    line = _LINE if needed > state else _BELOW if needed > title else 2 * _BELOW - _LINE
    colour = rgb(VERMILION) if outcome in _FALLS else INK
    draw.text((right, line), text, fill=colour, font=font, anchor="rs")


def _shortened(draw: ImageDraw.ImageDraw, text: str, size: int, room: float) -> str:
    """Return as much of a text as there is room for."""
    if draw.textlength(text, font=letters(size)) <= room:
        return text
    kept = len(text)
    while kept and draw.textlength(f"{text[:kept]}…", font=letters(size)) > room:
        kept -= 1
    return f"{text[:kept].rstrip()}…"


def write_scales(draw: ImageDraw.ImageDraw, lens: Lens, grid: float, ends: tuple[int, int], floor: int) -> None:
    """Draw a scale bar at the right, and write how far apart the lines of the grid are at the left.

    Parameters
    ----------
    lens
        Through which the scene is seen.
    grid
        Distance between lines [m].
    ends
        Where left and right are, and `floor` where the bar is [pixels as shown].
    """
    scale = lens.scale / FINE
    length = round_length(_BAR * (ends[1] - ends[0]) / scale)
    left, right = ends[1] - length * scale, ends[1]
    font = letters(_SMALL)
    draw.line((left, floor, right, floor), fill=INK, width=2)
    for end in (left, right):
        draw.line((end, floor - 4, end, floor + 4), fill=INK, width=1)
    draw.text((float(np.mean([left, right])), floor - 6), _metres(length), fill=INK, font=font, anchor="mb")
    draw.text((ends[0], floor + 4), f"grid {_metres(grid)}", fill=PALE, font=font, anchor="lb")


def _metres(length: float) -> str:
    """Return a length in the unit in which it reads well.

    >>> _metres(0.02), _metres(0.5), _metres(0.002)
    ('2 cm', '0.5 m', '2 mm')
    """
    units = ((0.1, 1.0, "m"), (0.01, 100.0, "cm"), (0.0, 1000.0, "mm"))
    factor, unit = next((factor, unit) for least, factor, unit in units if length * (1.0 + _ROUNDING) >= least)
    return f"{factor * length:g} {unit}"
