"""A small sweep, and who counts what is computed."""

import json

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate.studies.sweeps import Sweep, Threads, run_sweep

MODEL = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
MOTION = sb.Harmonic.circular(acceleration=0.15, angular_frequency=1.0)


@pytest.fixture
def grid():
    over = {"angular_frequency": np.linspace(0.5, 3.0, 4), "acceleration": np.linspace(0.09, 0.4, 5)}
    return Sweep.grid(MODEL, MOTION, over=over, periods=1.5, strobes=2)


@pytest.fixture
def random():
    over = {"tilt_x": (-0.06, 0.06), "tilt_rate_y": (-0.02, 0.02), "damping": (0.0, 0.2)}
    return Sweep.random(MODEL, MOTION, over=over, count=13, rng=5, duration=4.0)


@pytest.fixture
def points():
    at = {"duration": [1.0, 2.0, 3.0, 4.0], "tilt_y": [0.05, -0.02, 0.0, 0.01], "start_phase": [0.0, 1.0, 2.0, 3.0]}
    return Sweep.points(MODEL, MOTION, at=at, tilt=(0.03, 0.0), rtol=1e-6)


@pytest.fixture(scope="session")
def undisturbed():
    """The results of a sweep computed serially in one go, each once."""
    known = {}

    def result(sweep):
        name = json.dumps(sweep.describe())
        if name not in known:
            known[name] = run_sweep(sweep, executor=Threads(1))
        return known[name]

    return result


@pytest.fixture(params=["grid", "random", "points"])
def sweep(request):
    return request.getfixturevalue(request.param)


class Counting:
    """An executor that keeps the indices of the blocks it computed."""

    def __init__(self, inner=None):
        self.inner = inner or Threads(1)
        self.blocks = []

    def results(self, work, tasks, progress=None):
        for task, result in self.inner.results(work, tasks, progress):
            self.blocks.append(task.block.index)
            yield task, result


@pytest.fixture
def counting():
    return Counting


@pytest.fixture
def assert_same_arrays():
    """Equal bit for bit, NaN included, with the same names, coordinates and attributes of variables."""

    def check(first, second):
        xr.testing.assert_identical(first.drop_attrs(deep=False), second.drop_attrs(deep=False))
        assert list(first.data_vars) == list(second.data_vars)
        for name, array in first.data_vars.items():
            assert array.dtype == second[name].dtype
            assert array.values.tobytes() == second[name].values.tobytes(), name

    return check
