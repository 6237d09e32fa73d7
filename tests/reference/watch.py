"""What can end a stretch of motion: seen on samples inside each step, located on its dense output."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy.optimize import brentq

from stylobate.engine.tolerances import STILL, SWINGS_APART
from stylobate.models import Model

from .following import Reason
from .forcing import Floats, Forcing
from .thresholds import Thresholds

# Points of each step at which conditions are looked at; a step of the integrator resolves the motion.
_SAMPLES = 5
# For lift-off, which depends on the base motion alone and may be short.
_LIFT_SAMPLES = 65


@dataclass(frozen=True, slots=True)
class Watch:
    """Looks for the first event inside a step."""

    model: Model
    forcing: Forcing
    thresholds: Thresholds

    def first_event(
        self, start: float, end: float, states: Callable[[Floats], Floats], *, rests: bool = True
    ) -> tuple[float, Reason] | None:
        """Return the time and kind of the first event in (start, end], or None.

        Parameters
        ----------
        start, end
            The step, in dimensionless time; the two may be equal to ask about one instant.
        states
            Full states, shape (number of states, n), at n times inside.
        rests
            Whether to look for rest; motion in a plane comes to rest at its passages of the upright, see `is_rest`.
        """
        tau = np.linspace(start, end, _SAMPLES) if end > start else np.array([start])
        sampled = states(tau)
        tilt = np.hypot(*self.model.tilt(sampled))
        found = []
        for reason, condition, suspected in (
            (Reason.LIFTED, self._pull, self.forcing.minimum_vertical(start) <= -1.0),
            (Reason.OVERTURNED, self._beyond_return, tilt[-1] > self._no_return_tilt(end)),
            (Reason.LIMIT, self._beyond_limit, tilt.max() > self.thresholds.tilt_limit),
            (Reason.RESTED, self._below_rest_energy, rests and tilt.min() < self._rest_tilt),
        ):
            if suspected:
                looked_at = np.linspace(start, end, _LIFT_SAMPLES) if reason is Reason.LIFTED else tau
                time = _first_positive(partial(condition, states), looked_at)
                if time is not None:
                    found.append((time, reason))
        return min(found, key=lambda event: event[0], default=None)

    def is_rest(self, tau: float, tilt: float, speed: float) -> bool:
        """Return whether a column of this tilt [rad] and (dimensionless) speed comes to rest at the time `tau`."""
        return self._rest_margin(tau, tilt, speed) > 0.0

    def is_slow(self, speed: float) -> bool:
        """Return whether the energy of a motion of this speed is no more than that at which rest is entered."""
        c = self.model.column.slenderness
        energy = self._rest_energy(0.0, c, 0.0)
        return 0.0 < energy < math.inf and speed * speed <= self.thresholds.rest_energy * c**4 / energy

    @property
    def _rest_tilt(self) -> float:
        return max(self.thresholds.rest_energy, self.thresholds.rest_energy_for_good) * self.model.column.slenderness

    def _rest_margin(self, tau: float, tilt: float, speed: float) -> float:
        # Positive where the energy is below ε c² and what is left of the motion dies as small hops: a hop of speed v
        # against the force F takes 2v/F, in which F itself must change by a small part only.
        ax, ay, az = self.forcing.at(tau)
        energy = self._rest_energy(tilt, speed, az)
        square = self.model.column.slenderness**2
        change = 2.0 * math.sqrt(2.0 * max(energy, 0.0)) * self.forcing.largest_rate(tau, self.model.column.slenderness)
        hop = math.sqrt(SWINGS_APART * change)
        if not self._holds_from(tau):
            force = self.model.rest_capacity * (1.0 + az) - math.hypot(ax, ay)
            return min(self.thresholds.rest_energy * square - energy, force - hop)
        # For good: a little motion that is left needs no proof that it dies.
        share, dies = self.thresholds.rest_energy_for_good, self._least_force(tau) - hop
        return max(min(share, STILL) * square - energy, min(share * square - energy, dies))

    def _rest_energy(self, tilt: float, speed: float, vertical: float) -> float:
        energy = self.model.rest_energy
        return math.inf if energy is None else energy(tilt, speed, vertical, *self.model.parameters)

    def _holds_from(self, tau: float) -> bool:
        return self._least_force(tau) >= 0.0

    def _least_force(self, tau: float) -> float:
        weight = 1.0 + self.forcing.minimum_vertical(tau)
        return self.model.rest_capacity * weight - self.forcing.peak_horizontal(tau)

    def _no_return_tilt(self, tau: float) -> float:
        limit = self.model.least_safe_tilt(self.forcing.peak_horizontal(tau), self.forcing.minimum_vertical(tau))
        return limit if math.isfinite(limit) else self.thresholds.overturned_tilt

    def _motion(self, states: Callable[[Floats], Floats], tau: float) -> tuple[float, float, float]:
        # |α|, α·α̇ and |α̇| at one time
        state = states(np.array([tau]))
        (x, y), (vx, vy) = self.model.tilt(state)[:, 0], self.model.tilt_rate(state)[:, 0]
        return math.hypot(x, y), x * vx + y * vy, math.hypot(vx, vy)

    def _pull(self, states: Callable[[Floats], Floats], tau: float) -> float:
        del states
        return -(1.0 + self.forcing.at(tau)[2])

    def _beyond_return(self, states: Callable[[Floats], Floats], tau: float) -> float:
        tilt, radial, _ = self._motion(states, tau)
        return min(tilt - self._no_return_tilt(tau), radial)

    def _beyond_limit(self, states: Callable[[Floats], Floats], tau: float) -> float:
        return self._motion(states, tau)[0] - self.thresholds.tilt_limit

    def _below_rest_energy(self, states: Callable[[Floats], Floats], tau: float) -> float:
        tilt, _, speed = self._motion(states, tau)
        return self._rest_margin(tau, tilt, speed)


def _first_positive(condition: Callable[[float], float], tau: Floats) -> float | None:
    before = float(tau[0])
    if condition(before) > 0.0:
        return before
    for time in map(float, tau[1:]):
        if condition(time) > 0.0:
            return float(brentq(condition, before, time, xtol=4e-15 * max(1.0, abs(time))))
        before = time
    return None
