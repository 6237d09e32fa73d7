"""Periodic orbits in stroboscopic samples: detection of repetition, period and identical orbits."""

from dataclasses import dataclass
from typing import Self

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import BaseMotion
from stylobate.errors import require_positive
from stylobate.models import Model

Complexes = npt.NDArray[np.complex128]
Floats = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]


@dataclass(frozen=True, slots=True, kw_only=True)
class AttractorRules:
    """Tolerances by which attractors are identified from stroboscopic samples.

    The first two are fractions of the tilt c/(1 + ν²) and the tilt rate cν/(1 + ν²) of free rolling (5) at the
    frequency ratio ν of the forcing. This is the size of the motions at every frequency.

    Parameters
    ----------
    repeat_tolerance
        A run repeats every k periods if all its samples differ from the last k by less than this.
    match_tolerance
        Two runs are on the same orbit if their samples differ by less than this. Samples of one orbit must differ by
        more. It must be well above `repeat_tolerance`: a slowly converging run is farther from its orbit than it moves
        during the samples, and a run that spirals in must not count as an orbit of several periods.
    branch_tolerance
        Along a parameter, a periodic orbit continues one at an earlier value if their samples differ by less than
        this. Otherwise it begins a branch. Increase it if the values are far apart.

    Raises
    ------
    ParameterError
        If a tolerance is not positive.
    """

    repeat_tolerance: float = 1e-3
    match_tolerance: float = 3e-2
    branch_tolerance: float = 0.5

    def __post_init__(self) -> None:
        for name in self.__slots__:
            object.__setattr__(self, name, require_positive(f"attractor_rules.{name}", getattr(self, name)))


@dataclass(frozen=True, slots=True)
class OrbitScales:
    """Units for comparing stroboscopic samples: `tilt` [rad], `tilt_rate` [rad/s]; and the forcing's `period` [s]."""

    tilt: float
    tilt_rate: float
    period: float | None

    @classmethod
    def of(cls, model: Model, motion: BaseMotion | None) -> Self:
        """Return the tilt and rate of free rolling (5) at the frequency of `motion`; c and cω0 without a frequency."""
        c, scale = model.column.slenderness, 1.0 / model.time_scale
        period = None if motion is None else motion.period
        if period is None:
            return cls(c, c * scale, None)
        nu = 2.0 * np.pi / (period * scale)
        return cls(c / (1.0 + nu**2), c * nu * scale / (1.0 + nu**2), period)

    def states(self, tilt: Floats, tilt_rate: Floats) -> Complexes:
        """Return vectors (..., 2) of tilt and rate as dimensionless states (..., 2): tilt and rate, each x + iy."""
        return np.stack(
            [
                (tilt[..., 0] + 1j * tilt[..., 1]) / self.tilt,
                (tilt_rate[..., 0] + 1j * tilt_rate[..., 1]) / self.tilt_rate,
            ],
            axis=-1,
        )

    def vectors(self, states: Complexes) -> tuple[Floats, Floats]:
        """Return the vectors of tilt [rad] and rate [rad/s] of dimensionless `states`: the inverse of `states`."""
        parts = np.stack([states.real, states.imag], axis=-1)
        return parts[..., 0, :] * self.tilt, parts[..., 1, :] * self.tilt_rate


def repeating_periods(strobes: Complexes, rules: AttractorRules) -> tuple[Integers, Floats]:
    """Determine the number of periods after which stroboscopic samples repeat.

    Parameters
    ----------
    strobes
        Dimensionless states of n runs in m successive samples, shape (n, m, 2), the newest last.
    rules
        Maximum difference from the last samples, and minimum difference between samples of an orbit.

    Returns
    -------
    tuple
        The smallest such number up to m/2, shape (n,), 0 if there is none, and the remaining difference.
    """
    runs, window = strobes.shape[:2]
    periods, left = np.zeros(runs, dtype=np.int64), np.full(runs, np.inf)
    place = np.arange(window) - window
    for k in range(1, window // 2 + 1):
        open_runs = periods == 0
        # The last k states, repeated backwards through the window; NaN (no sample) never repeats.
        difference = np.abs(strobes[open_runs] - strobes[open_runs][:, window - k + place % k]).max(axis=(1, 2))
        repeats = difference < rules.repeat_tolerance
        for divisor in (d for d in range(1, k) if k % d == 0):
            cycle = strobes[open_runs][:, -k:]
            apart = np.abs(cycle - np.roll(cycle, divisor, axis=1)).max(axis=(1, 2))
            repeats &= apart > rules.match_tolerance
        found = np.flatnonzero(open_runs)[repeats]
        periods[found], left[found] = k, difference[repeats]
    return periods, left


def is_flat(cycle: Complexes, tolerance: float) -> bool:
    """Return whether an orbit is planar: no angular momentum about the vertical at any sample.

    Parameters
    ----------
    cycle
        Dimensionless states, shape (k, 2).
    tolerance
        Tolerance of the angular momentum, as a fraction of the peak tilt times the peak rate.
    """
    tilt, rate = cycle.T
    return bool(np.abs(np.imag(np.conj(tilt) * rate)).max() < tolerance * np.abs(tilt).max() * np.abs(rate).max())


def cycle_distance(cycles: Complexes, cycle: Complexes) -> Floats:
    """Return the distances of orbits of k states from another orbit, shape (n,), for any first state.

    Parameters
    ----------
    cycles
        Shape (n, k, 2).
    cycle
        Shape (k, 2).
    """
    shifted = [np.abs(cycles - np.roll(cycle, shift, axis=0)).max(axis=(1, 2)) for shift in range(len(cycle))]
    return np.asarray(np.min(shifted, axis=0))


def group_cycles(cycles: Complexes, left: Floats, tolerance: float) -> tuple[Integers, Integers]:
    """Gather orbits of k states into groups.

    The leader of each group is the run that repeats best among the remaining runs, and the group holds all runs closer
    to the leader than `tolerance`: the order of the runs does not matter.

    Parameters
    ----------
    cycles
        Shape (n, k, 2).
    left
        Remaining difference of each run from repetition, shape (n,).

    Returns
    -------
    tuple
        The group of each run, shape (n,), and the leader of each group.
    """
    flat = cycles.reshape(len(cycles), -1)
    # If runs repeat equally well, the state decides, not the order.
    order = np.lexsort((*flat.real.T, *flat.imag.T, left))
    groups, leaders = np.full(len(cycles), -1, dtype=np.int64), list[int]()
    for candidate in order:
        if groups[candidate] < 0:
            open_runs = np.flatnonzero(groups < 0)
            close = cycle_distance(cycles[open_runs], cycles[candidate]) < tolerance
            groups[open_runs[close]] = len(leaders)
            leaders.append(int(candidate))
    return groups, np.array(leaders, dtype=np.int64)
