"""What the contact bears while the column stands: |a_h|/(g + a_z) of friction, m (g + a_z) of normal force."""

import math
from dataclasses import dataclass

import numpy as np

from stylobate.engine.forcing import Floats, Forcing
from stylobate.engine.tolerances import SAMPLES_PER_PERIOD
from stylobate.models.contact import per_normal_force

# Samples that memory holds in any case.
_MOST = 500_000


@dataclass(frozen=True, slots=True)
class StandingLoads:
    """Loads of the contact of a standing column over time.

    Parameters
    ----------
    tau
        Dimensionless times, shape (n,).
    friction
        Friction demand |a_h|/(g + a_z), shape (n,): infinite where nothing presses on the base.
    normal
        Normal force over the weight, 1 + a_z/g, shape (n,).
    """

    tau: Floats
    friction: Floats
    normal: Floats


def loads_while_standing(forcing: Forcing, start: float, end: float) -> StandingLoads:
    """Return the loads from `start` to `end`, at times close enough to find the extremes from.

    These are the breaks of the base motion, at which the extremes of one that is linear between them lie, and 64
    samples to its shortest period; over one period only where it repeats from there on. Of more than 500 000
    samples, which only a motion without a period has, so many are taken, evenly spread.
    """
    breaks = np.array(forcing.stops(end))
    within = breaks[(breaks > start) & (breaks < end)]
    until = end
    if forcing.motion.period is not None:
        last = float(within[-1]) if within.size else start
        until = min(end, last + forcing.motion.period / forcing.time_scale)
    linear = forcing.motion.degree is not None and forcing.motion.degree <= 1
    frequency = 0.0 if linear else forcing.highest_frequency
    parts = max(1, math.ceil(min((until - start) * frequency * SAMPLES_PER_PERIOD / (2.0 * math.pi), _MOST)))
    tau = np.unique(np.concatenate([np.linspace(start, until, parts + 1), within, [end]]))
    ax, ay, az = forcing.along(tau)
    normal = 1.0 + az
    return StandingLoads(tau, per_normal_force(np.hypot(ax, ay), normal), normal)
