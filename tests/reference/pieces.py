"""A computed motion: pieces of dense output, each in its own phase, evaluated as one."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Piece:
    """A stretch of motion between two events.

    Parameters
    ----------
    start, end
        Dimensionless times.
    states
        Evaluates the state at times inside, shape (number of states, n).
    resting
        Whether the column stands on its base throughout.
    nodes, azimuths
        Times and azimuths of the lean along the piece [rad], unwrapped: the true angle lies within ±π of the last
        node before it. Empty while the column stands.
    steps
        Integration steps taken.
    """

    start: float
    end: float
    states: Callable[[Floats], Floats]
    resting: bool
    nodes: Floats
    azimuths: Floats
    steps: int = 0


@dataclass(frozen=True, slots=True)
class Trajectory:
    """Consecutive pieces."""

    pieces: Sequence[Piece]
    n_states: int

    @property
    def end(self) -> float:
        """Dimensionless time of the end."""
        return self.pieces[-1].end

    @property
    def steps(self) -> int:
        """Integration steps taken in all."""
        return sum(piece.steps for piece in self.pieces)

    def states(self, tau: Floats) -> Floats:
        """Return the states, shape (number of states, n), at times between the start and the end."""
        out = np.empty((self.n_states, tau.size))
        which = self._piece_at(tau)
        for index in np.unique(which):
            here = which == index
            out[:, here] = self.pieces[index].states(tau[here])
        return out

    def resting(self, tau: Floats) -> npt.NDArray[np.bool_]:
        """Return where the column stands on its base, shape (n,)."""
        return np.array([piece.resting for piece in self.pieces])[self._piece_at(tau)]

    def azimuth(self, tau: Floats, tilt: Floats) -> Floats:
        """Return the unwrapped azimuth of the lean [rad] of the `tilt` vectors, shape (2, n), at `tau`.

        NaN where the column stands upright.
        """
        out = np.full(tau.size, np.nan)
        which = self._piece_at(tau)
        for index in np.unique(which):
            piece, here = self.pieces[index], which == index
            if piece.resting:
                continue
            left = np.clip(np.searchsorted(piece.nodes, tau[here], side="right") - 1, 0, None)
            known = piece.azimuths[left]
            x, y = tilt[:, here]
            turned = (np.arctan2(y, x) - known + np.pi) % (2.0 * np.pi) - np.pi
            out[here] = np.where(np.hypot(x, y) > 0.0, known + turned, np.nan)
        return out

    def _piece_at(self, tau: Floats) -> npt.NDArray[np.intp]:
        starts = np.array([piece.start for piece in self.pieces])
        return np.clip(np.searchsorted(starts, tau, side="right") - 1, 0, None)


def unwrapped_azimuths(tilt: Floats, first: float) -> Floats:
    """Return the azimuths of consecutive `tilt` vectors, shape (2, n), counted on from the azimuth `first` [rad]."""
    x, y = tilt
    cross = x[:-1] * y[1:] - y[:-1] * x[1:]
    dot = x[:-1] * x[1:] + y[:-1] * y[1:]
    return first + np.concatenate([[0.0], np.cumsum(np.arctan2(cross, dot))])


def nearest_turn(angle: float, to: float | None) -> float:
    """Return `angle` plus the whole turns that bring it nearest to the angle `to`, where there is one."""
    return angle if to is None else angle + 2.0 * np.pi * round((to - angle) / (2.0 * np.pi))
