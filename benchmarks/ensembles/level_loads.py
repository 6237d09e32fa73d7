"""Two sets of runs for each model of the hierarchy, c = η = ζ = 0.1: steady rolling, and the mix."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

import stylobate as sb

from .answers import Array
from .workloads import COLUMN, ETA, ROLLING_ACCELERATION, C, Workload, mix, on_circle, rolling

ZETA = 0.1


@dataclass(frozen=True, slots=True)
class Level:
    """A model of the hierarchy.

    Parameters
    ----------
    name
        Name in tables.
    model
        Model with damping.
    loads
        Function that creates the runs, by the name of the workload.
    beside
        Key of the slender model with the same workload.
    """

    name: str
    model: sb.Model
    loads: Mapping[str, Callable[[int], Workload]]
    beside: str = "slender"


def all_levels() -> dict[str, Level]:
    """Return the models by their keys; the last two move along a line."""
    slender = sb.Slender(COLUMN, damping=ETA)
    line = "slender on a line"
    return {
        "slender": Level("`Slender`", slender, {"rolling": rolling, "mix": mix}),
        "slender rolling": Level(
            "`SlenderRolling`",
            sb.SlenderRolling(COLUMN, damping=ETA, spin_damping=ZETA),
            {"rolling": _slender_rolling, "mix": _mix_with_spin},
        ),
        "wobbling": Level("`Wobbling`", sb.Wobbling(COLUMN, damping=ETA), {"rolling": _wobbling, "mix": mix}),
        "rolling": Level(
            "`Rolling`",
            sb.Rolling(COLUMN, damping=ETA, spin_damping=ZETA),
            {"rolling": _rolling, "mix": _mix_with_spin},
        ),
        line: Level("`Slender`, on a line", slender, {"rolling": rocking, "mix": mix_on_a_line}, line),
        "planar rocking": Level(
            "`PlanarRocking`, on a line",
            sb.PlanarRocking(COLUMN, damping=ETA),
            {"rolling": rocking_with_loss, "mix": mix_on_a_line},
            line,
        ),
    }


def rocking(count: int) -> Workload:
    """Create runs under straight motion from the exact rocking of the slender column, ν as in "rolling"."""
    base = rolling(count)
    rate, phase = sb.theory.planar_forced_response(base.nu, ROLLING_ACCELERATION, c=C, eta=ETA).fast.start()[1:]
    none = np.zeros(count)
    start = np.stack([none, none, rate, none], axis=1)
    return replace(
        base,
        start=start,
        exact=start,
        cos=np.stack([ROLLING_ACCELERATION * np.cos(phase), none], axis=1),
        sin=np.stack([-ROLLING_ACCELERATION * np.sin(phase), none], axis=1),
        motion=sb.Harmonic.straight(acceleration=ROLLING_ACCELERATION, angular_frequency=3.0),
        parameters={"angular_frequency": base.nu, "start_phase": phase},
    )


def rocking_with_loss(count: int) -> Workload:
    """Create the same runs for a model with energy loss at impacts, without closed form of the end states."""
    return replace(rocking(count), exact=None)


def mix_on_a_line(count: int) -> Workload:
    """Create the mix with initial conditions and base motion along x only."""
    base = mix(count)
    largest, phase = base.parameters["acceleration"], base.parameters["start_phase"]
    along = np.array([1.0, 0.0])
    return replace(
        base,
        start=base.start * np.array([1.0, 0.0, 1.0, 0.0]),
        cos=np.outer(largest * np.cos(phase), along),
        sin=np.outer(-largest * np.sin(phase), along),
        motion=sb.Harmonic.straight(acceleration=0.2, angular_frequency=3.0),
        parameters={name: value for name, value in base.parameters.items() if name != "rotation"},
    )


def _slender_rolling(count: int) -> Workload:
    base = rolling(count)
    found = sb.theory.free_twist_rolling(base.nu, ROLLING_ACCELERATION, c=C, eta=ETA, zeta=ZETA)
    return _steady(base, found.amplitude, found.phase, found.spin)


def _wobbling(count: int) -> Workload:
    base = rolling(count)
    found = sb.theory.wobbling_rolling(base.nu, ROLLING_ACCELERATION, c=C, eta=ETA)
    return _steady(base, found.amplitude[:, -1], found.phase[:, -1])


def _rolling(count: int) -> Workload:
    base = rolling(count)
    found = sb.theory.full_rolling(base.nu, ROLLING_ACCELERATION, c=C, eta=ETA, zeta=ZETA)
    return _steady(base, found.amplitude[:, -1], found.phase[:, -1], found.spin[:, -1])


def _steady(base: Workload, amplitude: Array, psi: Array, *spin: Array) -> Workload:
    start = np.column_stack([on_circle(amplitude, psi, base.nu), *spin])
    return replace(base, start=start, exact=start)


def _mix_with_spin(count: int) -> Workload:
    base = mix(count)
    return replace(base, start=np.column_stack([base.start, np.zeros(count)]))
