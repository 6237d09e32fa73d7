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
from stylobate.studies.sweeps import Sweep, computing, run_sweep

model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
motion = sb.Harmonic.circular(acceleration=0.15, angular_frequency=1.0)
one = sb.simulate_ensemble(model, motion, duration=1.0)
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

def repeated(model, motion, *, tilt, **options):
    return one.isel(run=np.zeros(len(tilt), int))

computing.simulate_ensemble = repeated
over = {"angular_frequency": np.linspace(0.5, 5.0, 1000), "acceleration": np.linspace(0.05, 0.5, 1000)}
data = run_sweep(Sweep.grid(model, motion, over=over, periods=20.0), store=sys.argv[1] if sys.argv[1:] else None)
assert data["outcome"].shape == (1000, 1000) and int(data["outcome"].min()) >= 0
after = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
print((after - before) / 1024, sum(array.nbytes for array in data.data_vars.values()) / 1024**2)
"""


def peak_of_a_million_runs(*arguments):
    command = [sys.executable, "-c", LARGE, *arguments]
    told = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    grown, results = (float(word) for word in told.split())
    return grown, results


def test_a_map_of_a_million_runs_needs_its_results_and_little_more():
    grown, results = peak_of_a_million_runs()
    assert grown < results + 100.0 < 500.0  # MiB


@pytest.mark.slow
def test_a_stored_map_of_a_million_runs_needs_a_few_chunks(tmp_path):
    grown, _ = peak_of_a_million_runs(str(tmp_path / "map.zarr"))
    assert grown < 100.0  # MiB
