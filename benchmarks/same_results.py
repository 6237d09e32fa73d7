"""Bitwise comparison of results before and after a change of code: digests of 200 single runs and 12 studies.

    python -m benchmarks.same_results save before.json
    python -m benchmarks.same_results compare before.json

Digests cover numbers only, without names of variables, so that names may change. They are valid on one machine and for
one environment, since another processor compiles other kernels.
"""

import hashlib
import json
import sys
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import numpy as np
import xarray as xr

import stylobate as sb

COLUMN = sb.Column.solid(radius=0.15, height=1.2, density=1000.0)
SLENDER = sb.Slender(COLUMN, damping=0.1)
SLIDING = sb.Sliding(COLUMN, friction_coefficient=0.4, damping=0.1)
WOBBLING = sb.Wobbling(COLUMN, rolling_resistance=0.002, restitution=0.9)
STRAIGHT = sb.Harmonic.straight(acceleration=2.2, angular_frequency=5.0)
CIRCLE = sb.Harmonic.circular(acceleration=2.2, angular_frequency=5.0)
AXES = {"angular_frequency": np.linspace(3.0, 12.0, 9), "acceleration": np.linspace(1.0, 3.0, 7)}
STARTS = {"tilt_x": np.linspace(-0.1, 0.1, 9), "tilt_rate_y": np.linspace(-0.4, 0.4, 9)}
BOX = {"tilt_x": (-0.1, 0.1), "tilt_rate_y": (-0.4, 0.4)}


def digest(data: xr.Dataset) -> str:
    """Return a digest of all numbers of `data`, independent of names and order."""
    arrays = (np.asarray(array) for array in data.variables.values())
    numbers = (str(array.shape).encode() + array.tobytes() for array in arrays if array.dtype.kind in "fiub")
    return hashlib.sha256(b"".join(sorted(hashlib.sha256(one).digest() for one in numbers))).hexdigest()


def models(rng: np.random.Generator) -> Iterator[tuple[str, sb.Model]]:
    """Yield one model of each kind, with random numbers."""
    while True:
        damping, loss = rng.uniform(0.0, 0.3), rng.uniform(0.7, 1.0)
        column = sb.Column.solid(radius=rng.uniform(0.05, 0.3), height=rng.uniform(0.8, 2.5), density=1000.0)
        yield "slender", sb.Slender(column, damping=damping)
        yield "slender rolling", sb.SlenderRolling(column, damping=damping, spin_damping=damping)
        yield "rolling", sb.Rolling(column, damping=damping, spin_damping=damping, restitution=loss)
        yield "wobbling", sb.Wobbling(column, rolling_resistance=0.02 * damping, restitution=loss)
        yield "planar", sb.PlanarRocking(column, restitution=loss)
        yield "sliding", sb.Sliding(column, friction_coefficient=rng.uniform(0.2, 0.9), damping=damping)


def motions(rng: np.random.Generator) -> Iterator[sb.BaseMotion]:
    """Yield one base motion of each kind, with random numbers."""
    record = sb.sample_record()
    while True:
        acceleration, frequency = rng.uniform(0.5, 5.0), rng.uniform(2.0, 15.0)
        yield sb.Harmonic.straight(acceleration=acceleration, angular_frequency=frequency)
        yield sb.Pulse.one_sine(acceleration=2.0 * acceleration, angular_frequency=0.5 * frequency)
        yield sb.SineSweep(amplitude=acceleration, frequencies=(2.0, 12.0), length=6.0)
        yield record.scaled(rng.uniform(0.5, 2.5))
        yield sb.Harmonic.circular(acceleration=acceleration, angular_frequency=frequency)


def runs() -> Iterator[tuple[str, Callable[[], xr.Dataset]]]:
    """Yield 200 single runs by name: six models and five base motions in turn, with random numbers."""
    rng = np.random.default_rng(20260101)
    for number, (name, model), motion in zip(range(200), models(rng), motions(rng), strict=False):
        across = 0.0 if name == "planar" else 1.0
        tilt, rate = rng.uniform(-0.05, 0.05, 2) * (1.0, across), rng.uniform(-0.2, 0.2, 2) * (1.0, across)
        base = STRAIGHT if name == "planar" and len(motion.directions()) > 1 else motion
        yield f"run {number}, {name}", partial(simulated, model, base, tilt, rate)


def simulated(model: sb.Model, motion: sb.BaseMotion, tilt: np.ndarray, rate: np.ndarray) -> xr.Dataset:
    """Return the samples of a run with its outcome and measures."""
    run = sb.simulate(model, motion, tilt=tuple(tilt), tilt_rate=tuple(rate), duration=6.0, samples=50, max_steps=20000)
    summary = {"outcome": int(run.outcome), "decided_at": run.decided_at}
    return run.data.assign(summary | {"events": ("event", [event.time for event in run.events])})


def studies() -> Iterator[tuple[str, Callable[[], xr.Dataset]]]:
    """Yield 12 small studies by name."""
    record = sb.sample_record()
    steady = {"tilt": (0.04, 0.0), "tilt_rate": (0.0, 0.2)}
    scales = np.linspace(0.4, 2.0, 9)
    yield "map", partial(sb.studies.overturning_map, SLENDER, CIRCLE, over=AXES, periods=30)
    yield "map with contact", partial(sb.studies.overturning_map, SLIDING, CIRCLE, over=AXES, periods=6)
    yield "basins", partial(sb.studies.basins, SLENDER, CIRCLE, over=STARTS, periods=60)
    yield "integrity", partial(sb.studies.integrity, SLENDER, CIRCLE, over=STARTS, periods=30)
    yield "attractors", partial(sb.studies.attractors, SLENDER, CIRCLE, over=BOX, count=64, periods=60)
    yield "response", partial(sb.studies.response_curves, SLENDER, CIRCLE, angular_frequency=(2.0, 12.0))
    yield "exact response", partial(sb.studies.exact_response, SLENDER, CIRCLE, angular_frequency=(4.0, 9.0))
    yield (
        "slow sweep",
        partial(sb.studies.slow_sweep, SLENDER, CIRCLE, values=np.linspace(4.0, 7.0, 7), periods_each=60, **steady),
    )
    yield "section", partial(sb.studies.poincare_section, SLENDER, CIRCLE, periods=60, skip=20, **steady)
    tail = 5.0 / COLUMN.frequency_parameter
    yield "intervals", partial(sb.earthquakes.overturning_intervals, WOBBLING, record, scales=scales, tail=tail)
    yield (
        "incremental analysis",
        partial(
            sb.earthquakes.incremental_dynamic_analysis, WOBBLING, record, scales=scales, rotations=(0.0, 0.5), tail=5.0
        ),
    )
    yield "models side by side", partial(sb.studies.model_hierarchy, COLUMN, CIRCLE, tilt=(0.02, 0.01), duration=5.0)


def digests() -> dict[str, str]:
    """Return the digest of each run and study, or the message of an error."""
    found = {}
    for name, compute in (*runs(), *studies()):
        try:
            found[name] = digest(compute())
        except sb.errors.StylobateError as error:
            found[name] = f"{type(error).__name__}: {error}"
        print(f"\r{len(found)} of 212", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    return found


def main() -> int:
    """Save the digests or compare them with saved digests; return the number that differ, at most 99."""
    action, path = sys.argv[1], Path(sys.argv[2])
    found = digests()
    if action == "save":
        path.write_text(json.dumps(found, indent=1))
        return 0
    saved = json.loads(path.read_text())
    differing = [name for name in saved if saved[name] != found.get(name)]
    print(f"{len(saved) - len(differing)} of {len(saved)} are the same bit for bit")
    print("\n".join(f"differs: {name}" for name in differing))
    return min(len(differing), 99)


if __name__ == "__main__":
    sys.exit(main())
