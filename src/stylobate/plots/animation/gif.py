"""Pictures as one GIF: colours shared by all of them, and of each what changed."""

import math
import struct
from collections.abc import Callable, Sequence
from io import BytesIO

import numpy as np
from matplotlib.colors import to_rgb
from PIL import Image

from stylobate.plots.animation.palette import BACKGROUND, CONTACT, CONTACT_POINT, MARK, mixed

Progress = Callable[[int, int], None]

# Colours that all pictures share, and the number of one more, which stands for what does not change.
_COLOURS = 96
_UNCHANGED = _COLOURS
# Levels between the colours for which Pillow finds the nearest one.
_MESH = 4
# Colours that a dot or a line has, and the parts of them where its edge is smoothed.
_STRONG, _PARTS = (MARK, CONTACT, CONTACT_POINT), (1.0, 0.7, 0.4)
# The format: bytes of the header, before the shared colours, and in it the flags that hold their number; behind them a
# control block and a comma, after which the place of the picture stands; and what ends a file.
_HEADER, _FLAGS, _PLACE, _COMMA, _TRAILER = 13, 10, 9, 0x2C, b";"
# Pictures from which the colours are taken.
_SAMPLED = 8
# How long the last one is shown [s].
_HOLD = 2.5


def gif_of(
    picture: Callable[[int], Image.Image], count: int, frames_per_second: float, progress: Progress | None = None
) -> bytes:
    """Return a GIF that repeats for ever and pauses at its end.

    Parameters
    ----------
    picture
        Returns the picture with this number.
    count
        How many there are.
    frames_per_second
        How fast; a GIF counts in hundredths of a second, which are shared out so that the whole takes its time.
    progress
        Called after each picture with the number done and the total.
    """
    palette = _palette([picture(number) for number in _spread(count)])
    parts, before = [], None
    for number, duration in enumerate(_durations(count, frames_per_second)):
        now = picture(number).quantize(palette=palette, dither=Image.Dither.NONE)
        parts.append(_encoded(now, duration, loop=0) if before is None else _changes(before, now, duration))
        before = now
        if progress is not None:
            progress(number + 1, count)
    return b"".join([*parts, _TRAILER])


def _encoded(picture: Image.Image, duration: int, **options: int) -> bytes:
    """Return a GIF of one picture without its end: written each by itself, no more than two need be held."""
    buffer = BytesIO()
    picture.save(buffer, "GIF", duration=duration, transparency=_UNCHANGED, disposal=1, optimize=False, **options)
    return buffer.getvalue().removesuffix(_TRAILER)


def _changes(before: Image.Image, now: Image.Image, duration: int) -> bytes:
    """Return the blocks of a GIF that lead from one picture to the next: what changes, in the rectangle about it."""
    same = np.asarray(now) == np.asarray(before)
    rows, columns = np.flatnonzero(~same.all(axis=1)), np.flatnonzero(~same.all(axis=0))
    # Where nothing changes one pixel is written, to pass the time.
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
    """Return a picture whose palette serves all `pictures`: small things of strong colour keep theirs."""
    width, height = pictures[0].size
    sheet = Image.new("RGB", (width, height * len(pictures)))
    for row, one in enumerate(pictures):
        sheet.paste(one, (0, row * height))
    strong = [round(255 * one) for colour in _STRONG for part in _PARTS for one in mixed(BACKGROUND, colour, part)]
    left = _COLOURS - len(strong) // 3
    others = np.array(sheet.quantize(left, method=Image.Quantize.MEDIANCUT).getpalette()).reshape(-1, 3)[:left]
    # Pillow looks up the nearest of them on a grid: what lies within its mesh of the background would take its place.
    background = [round(255 * one) for one in to_rgb(BACKGROUND)]
    others[np.abs(others - background).max(axis=1) <= _MESH] = background
    found = Image.new("P", (1, 1))
    found.putpalette([*strong, *others.ravel().tolist()])
    return found


def _spread(count: int) -> list[int]:
    return sorted({round(part * (count - 1)) for part in np.linspace(0.0, 1.0, _SAMPLED)})


def _durations(count: int, frames_per_second: float) -> list[int]:
    """Return how long each picture is shown [ms], in whole hundredths of a second that add up to the right time."""
    ends = [math.floor(100.0 * (number + 1) / frames_per_second + 0.5) for number in range(count)]
    shown = [10 * (end - begin) for begin, end in zip([0, *ends], ends, strict=False)]
    return [*shown[:-1], round(1000.0 * _HOLD)]
