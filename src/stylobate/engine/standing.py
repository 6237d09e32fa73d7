"""Contact loads while the column stands: friction demand |a_h|/(g + a_z), normal force m (g + a_z)."""

import math
from dataclasses import dataclass

import numpy as np

from stylobate.engine.forcing import Floats, Forcing
from stylobate.engine.tolerances import SAMPLES_PER_PERIOD
from stylobate.models.contact import per_normal_force

# Maximum number of samples, to limit memory.
_MOST = 500_000


@dataclass(frozen=True, slots=True)
class StandingLoads:
    """Loads of the contact of a standing column over time.

    Parameters
    ----------
    tau
        Dimensionless times, shape (n,).
    friction
        Friction demand |a_h|/(g + a_z), shape (n,): infinite if the normal force is zero.
    normal
        Normal force over the weight, 1 + a_z/g, shape (n,).
    """

    tau: Floats
    friction: Floats
    normal: Floats


def loads_while_standing(forcing: Forcing, start: float, end: float) -> StandingLoads:
    """Return the loads from `start` to `end`, at times close enough to locate the extremes.

    The times are the breaks of the base motion (the extremes of a piecewise linear motion are there) and 64 samples per
    shortest period. One period is enough if the motion is periodic after its last break. The number of samples is at
    most 500 000; only a motion without a period can need more.
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
