"""Files of an animation: GIF, MP4, and a self-contained web page that fetches nothing."""

import base64
import hashlib
import json
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from html import escape
from importlib.resources import files
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.colors import to_rgb
from PIL import Image

from stylobate.errors import FileError, ParameterError, UnsupportedError, require_extra
from stylobate.plots.body import BACKGROUND, CONTACT, CONTACT_POINT, MARK, mixed
from stylobate.progress import Report, silent
from stylobate.text import printable

# Number of colours that all frames share.
_COLOURS = 96
# Levels between the colours for which Pillow finds the nearest one.
_MESH = 4
# Colours of dots and lines, and the fractions of these colours along smoothed edges.
_STRONG, _PARTS = (MARK, CONTACT, CONTACT_POINT), (1.0, 0.7, 0.4)
# Number of frames from which the colours are taken.
_SAMPLED = 8
# Duration of the last frame [s] of a GIF and of an MP4.
_PAUSE_OF_GIF, _PAUSE_OF_MP4 = 2.5, 1.5


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
    sampled = sorted({round(part * (count - 1)) for part in np.linspace(0.0, 1.0, _SAMPLED)})
    palette = _palette([picture(number) for number in sampled])

    def frames() -> Iterator[Image.Image]:
        for number in range(count):
            yield picture(number).quantize(palette=palette, dither=Image.Dither.NONE)
            progress(number + 1, count)

    rest, file = frames(), BytesIO()
    first = next(rest)
    durations = _durations(count, frames_per_second)
    # of each frame Pillow writes the rectangle that changes, with the unchanged pixels transparent
    first.save(file, "GIF", save_all=True, append_images=rest, duration=durations, loop=0, disposal=1, optimize=True)
    return file.getvalue()


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


def _durations(count: int, frames_per_second: float) -> list[int]:
    """Return the duration of each frame [ms], in whole hundredths of a second with the right sum."""
    ends = [math.floor(100.0 * (number + 1) / frames_per_second + 0.5) for number in range(count)]
    shown = [10 * (end - begin) for begin, end in zip([0, *ends], ends, strict=False)]
    return [*shown[:-1], round(1000.0 * _PAUSE_OF_GIF)]


# x264's quality: lower is finer.
_FACTOR = "20"


def write_mp4(path: Path, pictures: Iterable[Image.Image], size: tuple[int, int], frames_per_second: float) -> None:
    """Write frames of one `size` [pixels] as H.264 video to `path`.

    Raises
    ------
    UnsupportedError
        If imageio-ffmpeg is not installed, or has no ffmpeg for this machine.
    ParameterError
        If width or height is odd, which H.264 does not support.
    FileError
        If the file cannot be written.
    """
    if size[0] % 2 or size[1] % 2:
        raise ParameterError(f"size must have even numbers for an MP4, got {size!r}")
    writer = _encoder()(
        str(path),
        size,
        fps=frames_per_second,
        codec="libx264",
        quality=None,
        macro_block_size=2,
        output_params=["-crf", _FACTOR, "-preset", "medium", "-movflags", "+faststart"],
        ffmpeg_log_level="error",
    )
    try:
        writer.send(None)
        last = b""
        for picture in pictures:
            last = picture.tobytes()
            writer.send(last)
        for _ in range(round(_PAUSE_OF_MP4 * frames_per_second)):
            writer.send(last)
    except OSError as error:
        raise FileError(f"cannot write {path}: {str(error).strip().splitlines()[-1]}") from None
    finally:
        writer.close()


def _encoder() -> Any:
    """Return the function that writes frames to ffmpeg."""
    message = "an MP4 needs ffmpeg, which is not installed: pip install 'stylobate[video]', or write a .gif"
    library = require_extra("imageio_ffmpeg", message)
    try:
        library.get_ffmpeg_exe()
    except RuntimeError:
        raise UnsupportedError(message) from None
    return library.write_frames


_STYLE = """
:root { color-scheme: light dark; }
html, body { height: 100%; margin: 0; }
#viewer { height: 100%; }
noscript { display: block; padding: 2rem; font: 16px/1.5 system-ui, sans-serif; }
"""

_START = """
stylobateViewer.mount(document.getElementById("viewer"), JSON.parse(document.getElementById("motion").textContent));
"""


def page_of(motion: Mapping[str, Any]) -> str:
    """Return the HTML of a page that shows a motion in three dimensions, with controls to turn and stop it.

    The page may run only its own two scripts, identified by their hashes, and may not load anything.

    Raises
    ------
    UnsupportedError
        If the viewer was not built.
    """
    viewer, title = _viewer(), escape(printable(str(motion["title"])))
    numbers = json.dumps(motion, ensure_ascii=False, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
    policy = (
        f"default-src 'none'; script-src {_hash(viewer)} {_hash(_START)}; style-src {_hash(_STYLE)}; "
        "img-src data: blob:; base-uri 'none'; form-action 'none'"
    )
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        f'<meta http-equiv="Content-Security-Policy" content="{policy}">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{title}</title><style>{_STYLE}</style></head>"
        f'<body><div id="viewer"></div><noscript>{title}. The animation needs scripts, which are in this file.'
        f'</noscript><script type="application/json" id="motion">{numbers}</script>'
        f"<script>{viewer}</script><script>{_START}</script></body></html>\n"
    )


def _viewer() -> str:
    """Return the viewer's script, escaped so that no part of the script ends its element."""
    try:
        text = files("stylobate.plots.animation").joinpath("viewer.js").read_text(encoding="utf-8")
    except FileNotFoundError:
        raise UnsupportedError(
            "an HTML animation needs viewer.js, which wheels of stylobate hold; from sources make it by "
            "'npm ci && npm run build' in src/stylobate/lab/web, or write a .gif"
        ) from None
    # Line ends as browsers read them; otherwise the hash would not match.
    return text.replace("\r\n", "\n").replace("</script", "<\\/script").replace("<!--", "<\\!--")


def _hash(text: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"
