"""Workloads of all engines: two sets of runs of equations (1), c = η = 0.1.

The base moves as a_i(τ) = cos_i cos ντ + sin_i sin ντ. A run ends with its duration, or at the point of no return, the
tilt c + sup|a_h|.
"""

import math
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import numpy.typing as npt

import stylobate as sb

Array = npt.NDArray[np.float64]

C = ETA = 0.1
RTOL, ATOL = 1e-8, 1e-10
PERIODS = 200
COLUMN = sb.Column.dimensionless(C)
"""SI numbers equal the dimensionless numbers."""

ROLLING_ACCELERATION = 0.065
MIX_DISTINCT = 512
MIX_AXIS_RATIO = 0.7


@dataclass(frozen=True, slots=True, kw_only=True)
class Workload:
    """Set of runs, one per row of each array.

    Parameters
    ----------
    name
        "rolling" or "mix".
    nu, duration
        Frequency and length of each run.
    start
        x, y and their rates, shape (n, 4); then the spin for models with spin.
    cos, sin
        Coefficients of the base acceleration along x and y [g], shape (n, 2).
    no_return
        Tilt at the point of no return.
    exact
        End states, if known in closed form.
    motion, parameters
        The same base motion for stylobate.
    """

    name: str
    nu: Array
    duration: Array
    start: Array
    cos: Array
    sin: Array
    no_return: Array
    exact: Array | None
    motion: sb.Harmonic
    parameters: dict[str, Array] = field(repr=False)

    def __len__(self) -> int:
        return len(self.nu)

    @property
    def circular(self) -> bool:
        """Whether the base moves in the same circle (a0 cos ντ, a0 sin ντ) in all runs."""
        return self.name == "rolling"

    def take(self, index: Any) -> "Workload":
        """Return the runs of this index."""
        rows = {name: getattr(self, name)[index] for name in ("nu", "duration", "start", "cos", "sin", "no_return")}
        exact = None if self.exact is None else self.exact[index]
        return replace(self, **rows, exact=exact, parameters={k: v[index] for k, v in self.parameters.items()})


def rolling(count: int) -> Workload:
    """Create runs on the exact steady rolling under circular motion: ν even on 3…6, in random order (seed 1)."""
    nu = 3.0 + 3.0 * (np.random.default_rng(1).permutation(count) + 0.5) / count
    branch = sb.theory.steady_rolling(nu, ROLLING_ACCELERATION, c=C, eta=ETA).upper
    start = on_circle(branch.amplitude, branch.phase, nu)
    circle = np.full(count, ROLLING_ACCELERATION)
    none = np.zeros(count)
    return Workload(
        name="rolling",
        nu=nu,
        duration=PERIODS * 2.0 * math.pi / nu,
        start=start,
        cos=np.stack([circle, none], axis=1),
        sin=np.stack([none, circle], axis=1),
        no_return=np.full(count, C + ROLLING_ACCELERATION),
        exact=start,  # the state repeats after whole periods
        motion=sb.Harmonic.circular(acceleration=ROLLING_ACCELERATION, angular_frequency=3.0),
        parameters={"angular_frequency": nu},
    )


def on_circle(amplitude: Array, psi: Array, nu: Array) -> Array:
    """Return x, y and their rates on a circle of this amplitude, at the angle `psi` and the rate ν."""
    x, y = amplitude * np.cos(psi), amplitude * np.sin(psi)
    return np.stack([x, y, -nu * y, nu * x], axis=1)


def mix(count: int) -> Workload:
    """Create `count` runs, copies of 512 random runs (seed 2) in random order, so that every engine has the same mix.

    Uniform and independent: initial tilt in a disc of radius 0.09, tilt rate in a disc of radius 0.1; the base on an
    ellipse of axis ratio 0.7 with peak acceleration 0.15…0.3, direction of the long axis 0…π, start phase 0…2π, ν =
    1…6. The acceleration is always above c: no run comes to rest, which equations (1) alone do not describe.
    """
    rng = np.random.default_rng(2)
    tilt, rate = (_in_disc(rng, radius) for radius in (0.09, 0.1))
    largest = rng.uniform(0.15, 0.3, MIX_DISTINCT)
    rotation = rng.uniform(0.0, math.pi, MIX_DISTINCT)
    phase = rng.uniform(0.0, 2.0 * math.pi, MIX_DISTINCT)
    nu = rng.uniform(1.0, 6.0, MIX_DISTINCT)
    # R(rotation) (s cos ξ, q s sin ξ), ξ = ντ + phase
    long = np.stack([np.cos(rotation), np.sin(rotation)], axis=1) * largest[:, None]
    short = MIX_AXIS_RATIO * np.stack([-np.sin(rotation), np.cos(rotation)], axis=1) * largest[:, None]
    cos_phase, sin_phase = np.cos(phase)[:, None], np.sin(phase)[:, None]
    distinct = Workload(
        name="mix",
        nu=nu,
        duration=PERIODS * 2.0 * math.pi / nu,
        start=np.concatenate([tilt, rate], axis=1),
        cos=long * cos_phase + short * sin_phase,
        sin=short * cos_phase - long * sin_phase,
        no_return=C + largest,
        exact=None,
        motion=sb.Harmonic.elliptic(amplitude=(0.2, 0.2 * MIX_AXIS_RATIO), phase=-math.pi / 2.0, angular_frequency=3.0),
        parameters={
            "angular_frequency": nu,
            "acceleration": largest,
            "rotation": rotation,
            "start_phase": phase,
        },
    )
    return distinct.take(mix_order(count))


def mix_order(count: int) -> npt.NDArray[np.intp]:
    """Return the index of the distinct run for each run of the mix; the first 512 runs are all distinct."""
    rng = np.random.default_rng(3)
    rounds = -(-count // MIX_DISTINCT)
    return np.concatenate([rng.permutation(MIX_DISTINCT) for _ in range(rounds)])[:count]


WORKLOADS = {"rolling": rolling, "mix": mix}


def _in_disc(rng: np.random.Generator, radius: float) -> Array:
    size, angle = radius * np.sqrt(rng.random(MIX_DISTINCT)), rng.uniform(0.0, 2.0 * math.pi, MIX_DISTINCT)
    return np.stack([size * np.cos(angle), size * np.sin(angle)], axis=1)
