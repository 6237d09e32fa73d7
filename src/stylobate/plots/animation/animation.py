"""Animations of a run: shown in a notebook, or saved as GIF, MP4 or web page."""

import base64
import math
import sys
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path

from PIL import Image

from stylobate.errors import (
    ParameterError,
    UnlikelyInputWarning,
    require_finite,
    require_positive,
    require_vector,
    require_whole,
)
from stylobate.files import written_aside
from stylobate.plots.animation.drawing import Drawing, Look
from stylobate.plots.animation.formats import gif_of, page_of, write_mp4
from stylobate.plots.animation.motion import DrawnMotion
from stylobate.plots.geometry import View
from stylobate.progress import Progress, Report, report_of, shows_progress, silent
from stylobate.results import Run

# Maximum number of frames in an animation: a minute at the usual rate.
_MOST = 1500
# A GIF counts time in hundredths of a second, and viewers slow down frames shorter than two hundredths.
_FASTEST = 50.0
# With fewer frames per period of the base the animation shows another motion.
_FEWEST_IN_A_PERIOD = 4.0
# Width and height of frames [pixels]: smaller frames have no room for their text.
_SMALLEST, _LARGEST = (320, 280), (3840, 2160)
_SUFFIXES = (".gif", ".mp4", ".html")


@dataclass(frozen=True, slots=True, kw_only=True)
class Animation:
    """An animation of a run; a notebook shows it as a GIF.

    Attributes
    ----------
    motion
        The motion, sampled at the frames.
    history
        The same motion with finer samples, for paths and curves.
    look
        Size, view, title.
    frames_per_second
        Frames per second.
    """

    motion: DrawnMotion
    history: DrawnMotion
    look: Look
    frames_per_second: float

    def __len__(self) -> int:
        """Return the number of frames."""
        return int(self.motion.time.size)

    def pictures(self, progress: Report = silent) -> Iterator[Image.Image]:
        """Yield the frames in order; call `progress` after each with the number done and the total."""
        drawing = Drawing(self.motion, self.history, self.look)
        for index in range(len(self)):
            yield drawing.picture(index)
            progress(index + 1, len(self))

    @shows_progress("frames")
    def gif(self, *, progress: Progress = None) -> bytes:
        """Render a GIF and return its bytes.

        `progress` is a function that is called after each frame with the number done and the total; a bar by default,
        False for none.
        """
        drawing = Drawing(self.motion, self.history, self.look)
        return gif_of(drawing.picture, len(self), self.frames_per_second, report_of(progress))

    def html(self) -> str:
        """Return the HTML of a web page in which one can turn, stop and slow down the motion.

        Raises
        ------
        UnsupportedError
            If the viewer was not built. Wheels contain it.
        """
        return page_of(self.history.as_dict())

    @shows_progress("frames")
    def save(self, path: str | Path, *, progress: Progress = None) -> Path:
        """Save the animation as .gif, .mp4 or .html, by the suffix of `path`, and return the path.

        `progress` is as for `gif`.

        Raises
        ------
        ParameterError
            If the suffix is none of these.
        UnsupportedError
            If an MP4 is asked for without the extra `video`, or a page without its viewer.
        FileError
            If the file cannot be written.
        """
        path = checked_path(path)
        with written_aside(path) as beside:
            beside.touch()  # raises before the first frame is drawn if the folder is not writable
            match path.suffix.lower():
                case ".gif":
                    beside.write_bytes(self.gif(progress=progress))
                case ".mp4":
                    write_mp4(beside, self.pictures(report_of(progress)), self.look.size, self.frames_per_second)
                case _:
                    beside.write_text(self.html(), encoding="utf-8", newline="\n")
        return path

    def _repr_html_(self) -> str:
        data = base64.b64encode(self.gif()).decode("ascii")
        return f'<img alt="{escape(self.motion.title)}" src="data:image/gif;base64,{data}">'

    def __repr__(self) -> str:
        width, height = self.look.size
        return f"Animation({len(self)} pictures, {width} × {height}: {self.motion.title})"


def animate(
    run: Run,
    path: str | Path | None = None,
    *,
    size: Sequence[int] = (640, 480),
    frames_per_second: float = 25.0,
    speed: float | None = None,
    title: str | None = None,
    azimuth: float = -68.0,
    elevation: float = 20.0,
) -> Animation:
    """Animate a run, and save the animation if a `path` is given.

    The column has flutes, one of them marked, so that rolling and spin can be told apart. It stands on a slab that
    moves with the base over marks on the ground; the path of the contact point stays on the slab. The history of the
    tilt is drawn below. The scale is true, and each frame shows a computed state: a column that overturns is shown
    until overturning is certain.

    Parameters
    ----------
    run
        A run. The samples of a loaded run are interpolated linearly.
    path
        File to write: .gif, .mp4 (needs the extra `video`), or .html, a web page in which one can turn, stop and slow
        down the motion.
    size
        Width and height of the frames [pixels].
    frames_per_second
        Frames per second, at most 50.
    speed
        Seconds of the run per second of the animation; by default 1 or, for a run that would need more than 1500
        frames, the next of 2, 5, 10, 20, … that suffices.
    title
        A line in the frames, or the heading of a web page; by default the outcome.
    azimuth, elevation
        Direction of view [degrees].

    Returns
    -------
    Animation
        A notebook shows it; `save` writes it.

    Raises
    ------
    ParameterError
        If an argument is out of range, the suffix of `path` is not one of these, or a stated speed needs more than
        1500 frames.
    UnsupportedError
        If an MP4 is asked for without the extra `video`, or a page without its viewer.
    FileError
        If the file cannot be written.

    Warns
    -----
    UnlikelyInputWarning
        If there are fewer than four frames per period of the base: the animation would show another motion.

    Examples
    --------
    >>> import stylobate as sb
    >>> model = sb.Rolling(sb.Column.solid(radius=0.1, height=0.6, density=2700.0), damping=0.02)
    >>> sb.animate(sb.simulate(model, tilt=(0.2, 0.0), tilt_rate=(0.0, 0.3), duration=2.0))
    Animation(51 pictures, 640 × 480: still moving: ...)
    """
    path = None if path is None else checked_path(path)
    rate = require_positive("frames_per_second", frames_per_second, "1/s")
    if rate > _FASTEST:
        raise ParameterError(f"frames_per_second must be at most {_FASTEST:g}, got {rate!r}")
    history = DrawnMotion.of(run, title=title)
    end = float(history.time[-1])
    pace = max(1.0, _fitting_speed(end, rate)) if speed is None else require_positive("speed", speed)
    look = Look(size=_size(size), view=_view(azimuth, elevation), title=title, pace=pace)
    _require_few(end, rate, pace)
    _remark_on_few(run, rate / pace)
    motion = DrawnMotion.of(run, frames_per_second=rate / pace, title=title, most=_MOST)
    animation = Animation(motion=motion, history=history, look=look, frames_per_second=rate)
    if path is not None:
        animation.save(path)
    return animation


def _remark_on_few(run: Run, pictures: float) -> None:
    """Warn if there are too few `pictures` per second of the run to show the motion of its base."""
    frequency = run.provenance["motion"].get("angular_frequency")
    if not isinstance(frequency, float) or pictures * 2.0 * math.pi >= _FEWEST_IN_A_PERIOD * frequency:
        return
    least = pictures * 2.0 * math.pi / (_FEWEST_IN_A_PERIOD * frequency)
    message = (
        f"speed: {pictures:.4g} frames per second of the run are too few for a base frequency of "
        f"{frequency / (2.0 * math.pi):.4g} Hz. Multiply speed by {least:.2g} or less"
    )
    warnings.warn(message, UnlikelyInputWarning, stacklevel=3)


def checked_path(path: str | Path) -> Path:
    """Return `path` as a Path, or raise ParameterError unless it ends with .gif, .mp4 or .html."""
    found = Path(path)
    if found.suffix.lower() not in _SUFFIXES:
        raise ParameterError(f"path must end with .gif, .mp4 or .html, got {str(path)!r}")
    return found


def _size(size: Sequence[int]) -> tuple[int, int]:
    given = require_vector("size", size, 2, "pixels")
    width, height = (
        require_whole(f"size[{at}]", number, least=least)  # type: ignore[arg-type]
        for at, (number, least) in enumerate(zip(given, _SMALLEST, strict=True))
    )
    if width > _LARGEST[0] or height > _LARGEST[1]:
        raise ParameterError(f"size must be at most {_LARGEST[0]} × {_LARGEST[1]} pixels, got {width} × {height}")
    return width, height


def _view(azimuth: float, elevation: float) -> View:
    around, above = require_finite("azimuth", azimuth, "degrees"), require_positive("elevation", elevation, "degrees")
    if above > 90.0:  # noqa: PLR2004  from straight above
        raise ParameterError(f"elevation must be at most 90 degrees, got {above!r}")
    return View(math.radians(around), math.radians(above))


def _fitting_speed(end: float, rate: float) -> float:
    """Return the least of …, 0.5, 1, 2, 5, 10, … at which a run up to the time `end` has few enough frames."""
    least = max(end * rate / (_MOST - 1), sys.float_info.min)
    power = 10.0 ** math.floor(math.log10(least))
    return next(step * power for step in (1.0, 2.0, 5.0, 10.0) if step * power >= least)


def _require_few(end: float, rate: float, pace: float) -> None:
    if end * rate / pace > _MOST - 1:
        raise ParameterError(
            f"speed: {end:.6g} s at {rate:g} frames per second need more than {_MOST} frames (got {pace!r}). "
            f"Pass speed={_fitting_speed(end, rate):g}."
        )
