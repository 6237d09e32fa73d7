"""Files of random content: every reader refuses them in its own words, and none asks a library what they are."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("obspy")
pytest.importorskip("openpyxl")

PROGRAM = Path(__file__).with_name("fuzzed_files.py")
# Those of other formats, among them the readers of Python objects.
OTHERS_OF_OBSPY = ("ah", "css", "gcf", "pdas", "reftek", "rg16", "seg2", "segy", "seisan", "sh", "wav", "win", "y")


@pytest.mark.parametrize(("number", "seed"), [(200, 1), pytest.param(5000, 2, marks=pytest.mark.slow)])
def test_random_files_are_refused_without_a_foreign_error_a_connection_or_another_library(number, seed):
    # In a process of its own: damaged files can leave the HDF5 library with open objects.
    command = [sys.executable, str(PROGRAM), str(number), str(seed)]
    ended = subprocess.run(command, capture_output=True, text=True, check=False)
    assert ended.returncode == 0, ended.stderr[-2000:]
    report = json.loads(ended.stdout)
    assert report["foreign"] == []
    assert report["connections"] == []
    other = {f"obspy.io.{name}" for name in OTHERS_OF_OBSPY} | {"pyogrio", "dask", "distributed", "zarr"}
    assert not other & {".".join(one.split(".")[:3]) for one in report["imported"]}
    # The whole files among them are read, so that the program tests more than refusals.
    assert report["outcomes"]["records: read"] >= 7
    assert report["outcomes"]["inventory: read"] >= 1
    assert report["outcomes"]["response: read"] >= 1
