"""GIF encoder: one palette for all frames, and only the changed rectangle of each frame."""

import math
import struct
from collections.abc import Callable, Sequence
from io import BytesIO

import numpy as np
from matplotlib.colors import to_rgb
from PIL import Image

from stylobate.plots.animation.palette import BACKGROUND, CONTACT, CONTACT_POINT, MARK, mixed
from stylobate.progress import Report, silent

# Number of colours that all frames share, and the index of one more colour, for unchanged pixels.
_COLOURS = 96
_UNCHANGED = _COLOURS
# Levels between the colours for which Pillow finds the nearest one.
_MESH = 4
# Colours of dots and lines, and the fractions of these colours along smoothed edges.
_STRONG, _PARTS = (MARK, CONTACT, CONTACT_POINT), (1.0, 0.7, 0.4)
# The format: length of the header before the shared colours, and position of the flags with their number; then a
# control block and a comma, followed by the position of the frame; and the byte that ends a file.
_HEADER, _FLAGS, _PLACE, _COMMA, _TRAILER = 13, 10, 9, 0x2C, b";"
# Number of frames from which the colours are taken.
_SAMPLED = 8
# Duration of the last frame [s].
_HOLD = 2.5


def gif_of(
    picture: Callable[[int], Image.Image], count: int, frames_per_second: float, progress: Report = silent
) -> bytes:
    """Encode a GIF that repeats forever and pauses at its end.

    Parameters
    ----------
    picture
        Function that returns the frame with a given index.
    count
        Number of frames.
    frames_per_second
        Frames per second; a GIF counts in hundredths of a second, distributed so that the total time is right.
    progress
        Called after each frame with the number done and the total.
    """
    palette = _palette([picture(number) for number in _spread(count)])
    parts, before = [], None
    for number, duration in enumerate(_durations(count, frames_per_second)):
        now = picture(number).quantize(palette=palette, dither=Image.Dither.NONE)
        parts.append(_encoded(now, duration, loop=0) if before is None else _changes(before, now, duration))
        before = now
        progress(number + 1, count)
    return b"".join([*parts, _TRAILER])


def _encoded(picture: Image.Image, duration: int, **options: int) -> bytes:
    """Encode one frame as a GIF without its trailer, so that memory holds at most two frames."""
    buffer = BytesIO()
    picture.save(buffer, "GIF", duration=duration, transparency=_UNCHANGED, disposal=1, optimize=False, **options)
    return buffer.getvalue().removesuffix(_TRAILER)


def _changes(before: Image.Image, now: Image.Image, duration: int) -> bytes:
    """Return the GIF blocks from one frame to the next: the changes and their bounding rectangle."""
    same = np.asarray(now) == np.asarray(before)
    rows, columns = np.flatnonzero(~same.all(axis=1)), np.flatnonzero(~same.all(axis=0))
    # If nothing changes, one pixel is written, which carries the duration.
    left, upper, right, lower = (columns[0], rows[0], columns[-1], rows[-1]) if rows.size else (0, 0, 0, 0)
    changed = now.copy()
    changed.paste(_UNCHANGED, mask=Image.fromarray(same.view(np.uint8) * 255))
    alone = _encoded(changed.crop((int(left), int(upper), int(right) + 1, int(lower) + 1)), duration)
    colours = 3 * 2 ** ((alone[_FLAGS] & 0b111) + 1)
    blocks = bytearray(alone[_HEADER + colours :])
    assert blocks[_PLACE - 1] == _COMMA
    blocks[_PLACE : _PLACE + 4] = struct.pack("<HH", int(left), int(upper))
    return bytes(blocks)


def _palette(pictures: Sequence[Image.Image]) -> Image.Image:
    """Return an image with a palette for all `pictures`; small objects keep their strong colours."""
    width, height = pictures[0].size
    sheet = Image.new("RGB", (width, height * len(pictures)))
    for row, one in enumerate(pictures):
        sheet.paste(one, (0, row * height))
    strong = [round(255 * one) for colour in _STRONG for part in _PARTS for one in mixed(BACKGROUND, colour, part)]
    left = _COLOURS - len(strong) // 3
    others = np.array(sheet.quantize(left, method=Image.Quantize.MEDIANCUT).getpalette()).reshape(-1, 3)[:left]
    # Pillow finds the nearest colour on a grid: a colour within a mesh of the background would replace the background.
    background = [round(255 * one) for one in to_rgb(BACKGROUND)]
    others[np.abs(others - background).max(axis=1) <= _MESH] = background
    found = Image.new("P", (1, 1))
    found.putpalette([*strong, *others.ravel().tolist()])
    return found


def _spread(count: int) -> list[int]:
    return sorted({round(part * (count - 1)) for part in np.linspace(0.0, 1.0, _SAMPLED)})


def _durations(count: int, frames_per_second: float) -> list[int]:
    """Return the duration of each frame [ms], in whole hundredths of a second with the right sum."""
    ends = [math.floor(100.0 * (number + 1) / frames_per_second + 0.5) for number in range(count)]
    shown = [10 * (end - begin) for begin, end in zip([0, *ends], ends, strict=False)]
    return [*shown[:-1], round(1000.0 * _HOLD)]
