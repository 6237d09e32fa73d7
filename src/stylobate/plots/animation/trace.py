"""The path that the contact point leaves on the base."""

from dataclasses import dataclass
from typing import Self

import numpy as np
import numpy.typing as npt
from PIL import ImageDraw

from stylobate.plots.animation.canvas import FINE, line
from stylobate.plots.animation.lens import Lens
from stylobate.plots.animation.motion import DrawnMotion
from stylobate.plots.animation.palette import CONTACT, CONTACT_OLD
from stylobate.plots.pose import Floats

# A contact that can change moves less than this between instants, in radii, unless it leaps.
_LEAP = 0.5
# Between instants the contact point runs along the footprint circle, drawn in chords no wider than this [rad].
_CHORD = 0.1
# Of the path the latest part is drawn bold, this part of what is shown of the motion; older ones are pale.
_LATEST = 0.08


@dataclass(frozen=True, slots=True, kw_only=True)
class Trace:
    """Pieces of a path in pixels, for a base where it is when not displaced.

    Attributes
    ----------
    times
        Of the points of each piece [s].
    points
        Shape (n, 2) each [fine pixels].
    latest
        How long the bold part is [s].
    """

    times: tuple[Floats, ...]
    points: tuple[Floats, ...]
    latest: float

    @classmethod
    def of(cls, motion: DrawnMotion, turned: Floats, lens: Lens) -> Self:
        """Return the path in `motion`, with gaps where nothing of the rim touches and where the contact leapt.

        Parameters
        ----------
        motion
            The motion, finely sampled.
        turned
            Matrix from the frame of the plane to space, shape (3, 3).
        lens
            Through which it is seen.
        """
        pieces = [_on_arcs(motion, piece) for piece in _touching(motion)]
        space = [np.concatenate([path, np.zeros((len(path), 1))], axis=1) @ turned.T for _, path in pieces]
        return cls(
            times=tuple(times for times, _ in pieces),
            points=tuple(lens.pixels(path) for path in space),
            latest=_LATEST * float(motion.time[-1]),
        )

    def draw(self, draw: ImageDraw.ImageDraw, time: float, shift: Floats) -> None:
        """Draw what there is of the path at `time`, moved by `shift` with the base."""
        begun = [(times, points) for times, points in zip(self.times, self.points, strict=True) if times[0] < time]
        for times, points in begun:
            line(draw, points[: np.searchsorted(times, time, side="right")] + shift, CONTACT_OLD, FINE)
        for times, points in begun:
            first, last = np.searchsorted(times, [time - self.latest, time], side="right")
            line(draw, points[first:last] + shift, CONTACT, 2 * FINE)


def _touching(motion: DrawnMotion) -> list[npt.NDArray[np.intp]]:
    """Return the places of instants in which the rim touches, in pieces along which its contact does not leap."""
    absent = ~motion.on_rim
    moved = np.hypot(*np.diff(motion.contact_point, axis=0).T)
    # A contact that cannot change races round the rim past the upright; one that can leaps there, as the base strikes.
    leaps = (moved > _LEAP * motion.shape.radius) & (motion.clearance is not None)
    breaks = np.flatnonzero(leaps | (absent[1:] != absent[:-1])) + 1
    pieces = np.split(np.arange(motion.time.size), breaks)
    return [piece for piece in pieces if piece.size > 1 and not absent[piece[0]]]


def _on_arcs(motion: DrawnMotion, piece: npt.NDArray[np.intp]) -> tuple[Floats, Floats]:
    """Return times and points of a path, with points between those instants that lie far apart on the circle."""
    rim = motion.contact_point[piece] - motion.footprint[piece]
    azimuth = np.unwrap(np.arctan2(rim[:, 1], rim[:, 0]))
    parts = np.ceil(np.abs(np.diff(azimuth)) / _CHORD).astype(int).clip(1)
    fine = np.append(np.concatenate([at + np.arange(n) / n for at, n in enumerate(parts)]), piece.size - 1)
    own = np.arange(piece.size)
    angle, time, x, y = (
        np.interp(fine, own, values) for values in (azimuth, motion.time[piece], *motion.footprint[piece].T)
    )
    path = np.stack([x + motion.shape.radius * np.cos(angle), y + motion.shape.radius * np.sin(angle)], axis=-1)
    return time, path
