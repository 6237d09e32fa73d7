"""Bitwise comparison of outcomes and measures of single runs and ensembles, for random runs of all models.

python -m benchmarks.agreement 10000
"""

import sys
from collections import Counter
from itertools import islice

import numpy as np

import stylobate as sb

from .same_results import models, motions

MEASURES = ("peak_tilt", "time_of_peak_tilt", "minimum_tilt", "turns", "steps")
DURATION = 6.0


def cases(rng: np.random.Generator):
    """Yield models, base motions and initial conditions with random numbers."""
    for (name, model), motion in zip(models(rng), motions(rng), strict=False):
        across = 0.0 if name == "planar" else 1.0
        plane = sb.Harmonic.straight(acceleration=rng.uniform(0.5, 5.0), angular_frequency=rng.uniform(2.0, 15.0))
        stands = rng.random() < 0.2
        tilt, rate = ((0.0 if stands else 1.0) * rng.uniform(-size, size, 2) * (1.0, across) for size in (0.05, 0.2))
        yield name, model, plane if name == "planar" and len(motion.directions()) > 1 else motion, tilt, rate


def differences(model: sb.Model, motion: sb.BaseMotion, tilt: np.ndarray, rate: np.ndarray) -> list[str]:
    """Return the names of values that differ between a single run and the same run of an ensemble."""
    options = {"duration": DURATION, "max_steps": 20_000}
    one = sb.simulate(model, motion, tilt=tuple(tilt), tilt_rate=tuple(rate), samples=2, recheck=False, **options)
    many = sb.simulate_ensemble(model, motion, tilt=[tilt] * 3, tilt_rate=[rate] * 3, threads=1, **options)
    found = {name: one.measures[name] for name in MEASURES}
    found |= {"outcome": int(one.outcome), "decided_at": one.decided_at, "uncertain": one.uncertain}
    return [name for name, value in found.items() if any(other != value for other in many[name].to_numpy().tolist())]


def main() -> int:
    """Compare runs; return the number that differ, at most 99."""
    count, kinds, differing = int(sys.argv[1]), Counter(), 0
    for number, (name, *case) in enumerate(islice(cases(np.random.default_rng(20261124)), count)):
        kinds[name] += 1
        wrong = differences(*case)
        if wrong:
            differing += 1
            print(f"\nrun {number}, {name}: {', '.join(wrong)}", flush=True)
        print(f"\r{number + 1} of {count}", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    words = ", ".join(f"{number} {name}" for name, number in kinds.items())
    print(f"{count - differing} of {count} have the same outcome and measures to the bit, alone and together ({words})")
    return min(differing, 99)


if __name__ == "__main__":
    sys.exit(main())
