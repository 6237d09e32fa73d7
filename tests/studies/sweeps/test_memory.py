"""A large sweep takes the memory of its results and little more."""

import subprocess
import sys

import pytest

# Runs that take no time, so that what is measured is the sweep's own; in a process of its own, for its peak memory.
LARGE = """
import resource, sys
import numpy as np
import xarray as xr
import stylobate as sb
from stylobate.studies.sweeps import Sweep, chunks, run_sweep

model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
motion = sb.Harmonic.circular(acceleration=0.15, angular_frequency=1.0)
one = sb.simulate_ensemble(model, motion, duration=1.0)
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

def repeated(model, motion, *, tilt, **options):
    return one.isel(run=np.zeros(len(tilt), int))

chunks.simulate_ensemble = repeated
over = {"angular_frequency": np.linspace(0.5, 5.0, 1000), "acceleration": np.linspace(0.05, 0.5, int(sys.argv[1]))}
data = run_sweep(Sweep.grid(model, motion, over=over, periods=20.0), store=sys.argv[2] if sys.argv[2:] else None)
assert data["outcome"].size == 1000 * int(sys.argv[1]) and int(data["outcome"].min()) >= 0
after = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
print((after - before) / 1024, sum(array.nbytes for array in data.data_vars.values()) / 1024**2)
"""


def peak_of_many_runs(rows, *arguments):
    """Return the memory taken by a map of `rows` times a thousand runs, and that of its results [MiB]."""
    command = [sys.executable, "-c", LARGE, str(rows), *arguments]
    told = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    grown, results = (float(word) for word in told.split())
    return grown, results


@pytest.mark.posix
@pytest.mark.slow
@pytest.mark.parametrize("rows", [300, 1000])
def test_a_large_map_needs_its_results_and_little_more(rows):
    grown, results = peak_of_many_runs(rows)
    assert grown < results + 0.1 * rows < 0.5 * rows  # MiB


@pytest.mark.posix
@pytest.mark.slow
def test_a_stored_map_of_a_million_runs_needs_a_few_chunks(tmp_path):
    grown, _ = peak_of_many_runs(1000, str(tmp_path / "map.zarr"))
    assert grown < 100.0  # MiB
