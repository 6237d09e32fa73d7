"""Known orbits in the table of a batch: columns for the kernels, and the orbit to which each run has converged."""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from stylobate.engine.kernel.columns import ORBIT, Orbit, Setup
from stylobate.engine.kernel.driver.convergence import CERTAIN, NEAR
from stylobate.results import OutcomeRules
from stylobate.results.known_orbits import OrbitsOfRuns

Floats = npt.NDArray[np.float64]

# Minimum number of periods in a window, over which the oscillations of complex multipliers average out.
LEAST_WINDOW = 4
# Factor by which the distance from the orbit must fall in a window.
FALL_OF_WINDOW = 0.5


def fill_orbits(
    table: Floats, first: int, orbits: OrbitsOfRuns, period: Floats, time_scale: Floats, rules: OutcomeRules
) -> None:
    """Set the columns of the known orbits, which begin at column `first`; `period` is in the units of the models.

    A run that is too short is not compared with an orbit, because the latest time for its approach is before its start.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        decay = -np.log(orbits.multiplier)
        window = np.fmax(LEAST_WINDOW, np.ceil(math.log(1.0 / FALL_OF_WINDOW) / decay))
        turning = 2.0 * math.pi / period[:, np.newaxis]
        judged = table[:, [Setup.END]] - (rules.periods + 1.0) * period[:, np.newaxis]
        latest = judged - math.log(NEAR / (CERTAIN * rules.repeat_tolerance)) / decay * period[:, np.newaxis]
        columns = {
            Orbit.X: orbits.tilt[..., 0],
            Orbit.Y: orbits.tilt[..., 1],
            Orbit.VX: orbits.tilt_rate[..., 0] * time_scale[:, np.newaxis],
            Orbit.VY: orbits.tilt_rate[..., 1] * time_scale[:, np.newaxis],
            Orbit.SPIN: orbits.spin * time_scale[:, np.newaxis],
            Orbit.SIZE: np.where(np.isnan(decay), np.nan, orbits.mean_tilt),
            Orbit.RATE: orbits.mean_tilt * turning,
            Orbit.WINDOW: window,
            Orbit.FALL: np.exp(-decay * window),
            Orbit.DECAY: decay * turning / (2.0 * math.pi),
            Orbit.LATEST: np.where(np.isfinite(latest) & (period[:, np.newaxis] > 0.0), latest, -np.inf),
            Orbit.REPEATS: np.broadcast_to(rules.repeat_tolerance, decay.shape),
        }
    for k in range(decay.shape[1]):
        for column, values in columns.items():
            table[:, first + k * ORBIT + column] = values[:, k]


@dataclass(frozen=True, slots=True)
class OrbitReached:
    """Runs that have converged to a known orbit, and the numbers of `KnownOrbit` for each of these runs."""

    runs: npt.NDArray[np.intp]
    tilt: Floats
    tilt_rate: Floats
    turns: Floats
    mean_tilt: Floats


def orbit_reached(table: Floats, first: int, orbits: OrbitsOfRuns, runs: npt.NDArray[np.intp]) -> OrbitReached:
    """Return the orbits to which these `runs` have converged."""
    places = first + ORBIT * np.arange(orbits.turns.shape[1]) + Orbit.REACHED
    chosen = np.argmax(table[np.ix_(runs, places)], axis=1)
    of_runs = (getattr(orbits, name)[runs, chosen] for name in OrbitReached.__slots__[1:])
    return OrbitReached(runs, *of_runs)
