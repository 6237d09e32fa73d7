"""What a motion of a `SlidingBody` is found to be: its events, and states and forces at chosen times; for tests."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np


@dataclass(frozen=True, kw_only=True)
class Limits:
    """What numbers count as nought.

    Parameters
    ----------
    rtol, atol
        Tolerances of the integration.
    still
        Speed of slip, and of arrival, that counts as none [m/s].
    resting
        Speed at which C bounces that counts as none [m/s], so that impacts pile up to rest. A bounce by it must rise
        well above `deep`, or falling that deep feeds it.
    flat
        Tilt, as sin θ, at which a touching base is flat on the plane, which ends the motion.
    deep
        Depth of C below the plane at which it has landed, per radius.
    events
        So many, and no more.
    """

    rtol: float = 1e-11
    atol: float = 1e-14
    still: float = 1e-12
    resting: float = 1e-5
    flat: float = 1e-6
    deep: float = 1e-14
    events: int = 1000


class Event(NamedTuple):
    """What happened at a time [s], the states (13,) before and after it, and the impulse (3,) [N s].

    Kinds: ``"slip"`` and ``"stick"`` begin, ``"reverse"`` is slip that ends and begins at once, ``"lift"`` and
    ``"land"``; and those that end a motion: ``"flat"`` on the base, ``"fallen"`` to θ = π/2, ``"jam"`` where
    Painlevé's denominator vanishes.
    """

    kind: str
    time: float
    before: np.ndarray
    after: np.ndarray
    impulse: np.ndarray
    phase: str


@dataclass(frozen=True, kw_only=True)
class Track:
    """A motion at the times asked for, or at all steps; the leading dimension of every array is time.

    Attributes
    ----------
    time, state, phase
        Times [s] (n,), states (G, q, v, ω) (n, 13), and the phase at each.
    slip, gap
        Slip [m/s] (n, 3) and height of C [m] (n,).
    force, couple, denominator
        Of the ground, along X, Y, Z, [N] and [N m] (n, 3); Painlevé's denominator, NaN unless slipping.
    energy
        As `SlidingBody.energy` [J], (n,).
    events
        All `Event`, in order.
    least_denominator
        Painlevé's, over all steps; infinite without slip.
    """

    time: np.ndarray
    state: np.ndarray
    phase: list
    slip: np.ndarray
    gap: np.ndarray
    force: np.ndarray
    couple: np.ndarray
    denominator: np.ndarray
    energy: np.ndarray
    events: list
    least_denominator: float

    def times_of(self, kind):
        """Return the times of the events of one kind [s]."""
        return [event.time for event in self.events if event.kind == kind]
