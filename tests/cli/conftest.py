"""Saved results, and Ctrl-C in the middle of many runs."""

import logging
import signal
from importlib import import_module

import pytest
import xarray as xr

from stylobate import progress

ROOMS = (
    "config",
    "conveying",
    "earthquakes",
    "engine",
    "lab",
    "orbits",
    "paper",
    "plots",
    "results",
    "studies",
    "theory",
)


def _saved(path):
    with xr.open_dataset(path, engine="h5netcdf") as data:
        return data.load()


@pytest.fixture(autouse=True)
def _without_notices_of_compiling(monkeypatch):
    """Whether a kernel lies in the cache already shows in no output."""
    monkeypatch.setattr(logging.getLogger("stylobate.compiling"), "disabled", True)


@pytest.fixture
def saved():
    """What a netCDF file holds."""
    return _saved


@pytest.fixture
def interrupted(monkeypatch):
    """Ctrl-C as soon as some runs are done; `undo` lifts it."""

    class Stop(progress._Bar):
        def __call__(self, done, total):
            if 0 < done < total:
                signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr(progress, "_Bar", Stop)
    monkeypatch.setattr(progress, "_place", lambda: "terminal")
    return monkeypatch


@pytest.fixture(scope="session", autouse=True)
def all_public_names_are_loaded():
    """Load what is imported on first use: a module loaded during a test that replaces a function would keep that."""
    for room in ("", *(f".{name}" for name in ROOMS)):
        module = import_module(f"stylobate{room}")
        for name in module.__all__:
            getattr(module, name)
