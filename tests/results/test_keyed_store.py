"""Data that are computed once: found under their key alone, and never half written."""

import logging
import subprocess
import sys
import time

import numpy as np
import pytest
import xarray as xr

from stylobate.errors import FileError
from stylobate.results.keyed_store import KeyedStore

DATA = xr.Dataset({"value": ("run", np.arange(3.0))}, attrs={"kind": "part"})


def test_an_entry_is_found_under_its_name_and_identity_alone(tmp_path):
    store = KeyedStore(tmp_path / "store")
    store.write("slim: margins", {"model": 0.1}, DATA)
    xr.testing.assert_identical(store.read("slim: margins", {"model": 0.1}).to_dataset(), DATA)
    assert store.read("slim: margins", {"model": 0.2}) is None
    assert store.read("slim, margins", {"model": 0.1}) is None


def test_groups_come_back_as_they_were(tmp_path):
    tree = xr.DataTree.from_dict({"/one": DATA, "/two": 2.0 * DATA})
    KeyedStore(tmp_path).write("Tree", {}, tree)
    xr.testing.assert_identical(KeyedStore(tmp_path).read("Tree", {}), tree)


def test_a_replaced_name_keeps_one_entry_and_other_names_stay(tmp_path):
    store = KeyedStore(tmp_path)
    for code in (1, 2):
        store.write("First", {"code": code}, DATA, replace=True)
        store.write("First part", {"code": code}, DATA)
    assert [store.read("First", {"code": code}) is None for code in (1, 2)] == [True, False]
    assert all(store.read("First part", {"code": code}) is not None for code in (1, 2))


def test_a_damaged_entry_counts_as_missing_and_is_named(tmp_path, caplog):
    store = KeyedStore(tmp_path)
    store.write("a", {}, DATA)
    (path,) = tmp_path.iterdir()
    path.write_bytes(path.read_bytes()[:-9])
    with caplog.at_level(logging.WARNING, "stylobate"):
        assert store.read("a", {}) is None
    assert str(path) in caplog.messages[0]
    store.write("a", {}, DATA)
    xr.testing.assert_identical(store.read("a", {}).to_dataset(), DATA)


def test_a_killed_writer_leaves_whole_entries_alone(tmp_path, caplog):
    program = (
        "import itertools, numpy as np, xarray as xr, sys\n"
        "from pathlib import Path\n"
        "from stylobate.results.keyed_store import KeyedStore\n"
        "for k in itertools.count():\n"
        "    data = xr.Dataset({'value': ('run', np.full(100_000, k % 7.0))})\n"
        "    KeyedStore(Path(sys.argv[1])).write('part', {'number': k % 7}, data)\n"
    )
    writer = subprocess.Popen([sys.executable, "-c", program, str(tmp_path)])
    while len(list(tmp_path.glob("part-*.nc"))) < 7:
        assert writer.poll() is None
        time.sleep(0.01)
    writer.kill()
    writer.wait()
    for k in range(7):
        np.testing.assert_array_equal(KeyedStore(tmp_path).read("part", {"number": k})["value"], float(k))
    assert not caplog.messages


def test_a_folder_that_cannot_be_written_is_named(tmp_path):
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(FileError, match=r"cannot write into .*file"):
        KeyedStore(tmp_path / "file").write("a", {}, DATA)
