"""Measure how often intervals of fragility curves contain the truth. Run as `python -m benchmarks.coverage`.

The table is on the page "Earthquakes" of the results; 500 data sets take a quarter of an hour. The true curve is
lognormal; the runs of one record share a component of their capacity.
"""

import sys
from collections.abc import Callable
from typing import Any

import numpy as np
import xarray as xr
from scipy.special import ndtr

from stylobate.earthquakes import fit_fragility

MEDIAN, BETWEEN, WITHIN, SPREAD = 3.0, 0.35, 0.2, 0.6
DISPERSION = float(np.hypot(BETWEEN, WITHIN))
RESAMPLES = 300


def independent_runs(rng: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Draw intensities of `count` independent runs, and whether each run reached the limit state."""
    intensity = MEDIAN * np.exp(rng.normal(0.0, SPREAD, count))
    return intensity, rng.random(count) < ndtr(np.log(intensity / MEDIAN) / DISPERSION)


def records(rng: np.random.Generator, count: int) -> tuple[xr.DataArray, xr.DataArray]:
    """Draw intensities of `count` records at nine scales, and whether each run reached the limit state."""
    scale = np.geomspace(1.0, 9.0, 9)
    capacity = rng.normal(0.0, BETWEEN, (count, 1)) + rng.normal(0.0, WITHIN, (count, scale.size))
    reached = xr.DataArray(np.log(scale / MEDIAN) > capacity, dims=("record", "scale"))
    return xr.DataArray(scale, dims="scale"), reached


def coverage(
    draw: Callable[[np.random.Generator, int], tuple[Any, Any]], count: int, sets: int, resamples: int = 0
) -> tuple[float, float]:
    """Return the fraction of data sets whose intervals of median and dispersion contain the truth."""
    rng = np.random.default_rng(count + resamples)
    held = np.zeros(2)
    for _ in range(sets):
        found = fit_fragility(*draw(rng, count), resamples=resamples, rng=rng)
        for place, (name, true) in enumerate((("median", MEDIAN), ("dispersion", DISPERSION))):
            held[place] += found[f"{name}_low"].item() <= true <= found[f"{name}_high"].item()
    return tuple(held / sets)


def main(sets: int) -> None:
    """Print the table of the documentation."""
    cases = [(independent_runs, count, 0) for count in (15, 40, 100)]
    cases += [(records, count, 0) for count in (10, 40)]
    cases += [(records, count, RESAMPLES) for count in (10, 20, 40)]
    print(f"{sets} data sets each; standard error at most {100.0 * np.sqrt(0.25 / sets):.1f} %")
    print("| data | intervals | median | dispersion |\n|---|---|---|---|")
    for draw, count, resamples in cases:
        data = f"{count} independent runs" if draw is independent_runs else f"{count} records, 9 scales each"
        kind = "bootstrap over records" if resamples else "profile likelihood"
        median, dispersion = coverage(draw, count, sets, resamples)
        print(f"| {data} | {kind} | {100.0 * median:.0f} % | {100.0 * dispersion:.0f} % |", flush=True)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 500)
