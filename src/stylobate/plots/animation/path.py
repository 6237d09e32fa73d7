"""The path that the contact point leaves on the base."""

import numpy as np
import numpy.typing as npt

from stylobate.plots.animation.motion import DrawnMotion
from stylobate.plots.pose import Floats

# Maximum distance between instants that a contact that can change moves without a jump [base radii].
_LEAP = 0.5
# Between instants the contact point moves along the footprint circle, drawn in chords no wider than this [rad].
_CHORD = 0.1


def contact_path(motion: DrawnMotion) -> tuple[Floats, Floats]:
    """Return times, shape (n,) [s], and points in the plane of the base, shape (n, 2) [m], of the contact point.

    Rows of NaN separate the pieces: no point of the rim touches there, or the contact jumps to another point.
    """
    pieces = [_on_arcs(motion, piece) for piece in _touching(motion)]
    if not pieces:
        return np.zeros(0), np.zeros((0, 2))
    gap = np.full((1, 2), np.nan)
    times = [np.append(times, times[-1]) for times, _ in pieces]
    points = [np.concatenate([points, gap]) for _, points in pieces]
    return np.concatenate(times), np.concatenate(points)


def _touching(motion: DrawnMotion) -> list[npt.NDArray[np.intp]]:
    """Return the indices of instants in which the rim touches, in pieces without jumps of the contact."""
    absent = ~motion.on_rim
    moved = np.hypot(*np.diff(motion.contact_point, axis=0).T)
    # Near the vertical, a contact that cannot change moves fast round the rim; one that can change jumps at impacts.
    leaps = (moved > _LEAP * motion.shape.radius) & (motion.clearance is not None)
    breaks = np.flatnonzero(leaps | (absent[1:] != absent[:-1])) + 1
    pieces = np.split(np.arange(motion.time.size), breaks)
    return [piece for piece in pieces if piece.size > 1 and not absent[piece[0]]]


def _on_arcs(motion: DrawnMotion, piece: npt.NDArray[np.intp]) -> tuple[Floats, Floats]:
    """Return times and points of a path, with more points between instants that lie far apart on the circle."""
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
