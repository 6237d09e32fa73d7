"""Processor time that maps and basins save if converged runs end early: `python -m benchmarks.early_ends`.

Both computations alternate on one core. The saved fraction is the median of the turns, with minimum and maximum.
"""

import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np
import xarray as xr

import stylobate as sb

TARGET = Path("docs/_static/benchmarks/early-ends.txt")
TURNS, SIDE = 3, 40
COLUMN = sb.Column.dimensionless(slenderness=0.1)
MODELS = {
    "Slender": sb.Slender(COLUMN, damping=0.1),
    "Wobbling": sb.Wobbling(COLUMN, damping=0.1),
    "Rolling": sb.Rolling(COLUMN, damping=0.1, spin_damping=0.3),
}
CIRCLE = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8)
LINE = sb.Harmonic.straight(acceleration=0.13, angular_frequency=4.0)
FROM_REST = {"angular_frequency": np.linspace(0.5, 6.0, SIDE), "acceleration": np.linspace(0.05, 0.6, SIDE)}
NEAR_ROLLING = {"angular_frequency": np.linspace(1.0, 5.0, SIDE), "acceleration": np.linspace(0.02, 0.3, SIDE)}
TILTS = dict.fromkeys(("tilt_x", "tilt_y"), np.linspace(-0.08, 0.08, SIDE))
PAYS = (*(f"map from a tilt of 0.03 | `{model}` | 1000" for model in MODELS), "basin, straight | `Wobbling` | 300")
"""Studies in which early ends must not take longer."""
Study = Callable[..., xr.Dataset]


def main() -> None:
    """Time all studies and write the table."""
    rows = [f"| {' | '.join(map(str, case))} | {_measured(study, **early)} |" for case, study, early in _studies()]
    head = "| study | model | periods | runs that end early | saved (minimum to maximum) |\n|---|---|---|---|---|\n"
    TARGET.write_text(head + "\n".join(rows) + "\n", encoding="utf-8")
    print(TARGET.read_text(encoding="utf-8"))
    slower = [row for row in rows if row.startswith(tuple(f"| {name} |" for name in PAYS)) and "% | −" in row]
    if slower:
        raise SystemExit("early ends take longer where many runs converge:\n" + "\n".join(slower))


def _studies() -> Iterator[tuple[tuple[str, str, int], Study, dict[str, Any]]]:
    closed = {"end_converged": True}
    for name, over, tilt in (("map from rest", FROM_REST, 0.0), ("map from a tilt of 0.03", NEAR_ROLLING, 0.03)):
        for model, own in MODELS.items():
            for periods in (100, 300, 1000):
                study = partial(sb.studies.overturning_map, own, CIRCLE, over=over, tilt=(tilt, 0.0))
                yield (name, f"`{model}`", periods), partial(study, periods=periods), closed
    for model in ("Slender", "Rolling"):
        study = partial(sb.studies.basins, MODELS[model], CIRCLE, over=TILTS, periods=200)
        yield ("basin, circular", f"`{model}`", 200), study, closed
    for model in ("Slender", "Wobbling"):
        orbits = [sb.orbits.periodic_orbit(MODELS[model], LINE, sense=sense) for sense in (1, -1)]
        study = partial(sb.studies.basins, MODELS[model], LINE, over=TILTS, periods=300)
        yield ("basin, straight", f"`{model}`", 300), study, {"orbits": orbits}


def _measured(study: Study, **early: Any) -> str:
    """Return the share of the runs that end early, and the saved fraction of the processor time, as cells."""
    full, ended = study(), study(**early)  # compiles
    assert (full["outcome"] == ended["outcome"]).all()
    saved = [1.0 - _time(partial(study, **early)) / _time(study) for _ in range(TURNS)]
    share = float((ended["end_time"] < full["end_time"]).mean())
    low, middle, high = (str(round(100.0 * one)).replace("-", "−") for one in (min(saved), median(saved), max(saved)))
    return f"{100.0 * share:.0f} % | {middle} % ({low} to {high})"


def _time(study: Study) -> float:
    begun = time.process_time()
    study()
    return time.process_time() - begun


if __name__ == "__main__":
    main()
