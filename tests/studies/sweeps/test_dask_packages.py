"""A worker computes with the package of the process that asks, or refuses; missing workers are reported in seconds."""

import os
import shutil
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path
from time import monotonic

import pytest

import stylobate
from stylobate.errors import StylobateError
from stylobate.studies.sweeps import Dask, run_sweep
from stylobate.studies.sweeps.dask_executor import package_identity, source_digest

PACKAGE = Path(stylobate.__file__).parent


@pytest.fixture(scope="module")
def client():
    """Connect to a scheduler without workers."""
    import distributed

    with (
        distributed.LocalCluster(
            n_workers=0, dashboard_address="127.0.0.1:0", processes=False, protocol="tcp"
        ) as cluster,
        distributed.Client(cluster, set_as_default=False) as client,
    ):
        yield client


@contextmanager
def worker_with(packages, client):
    """Start a worker of `client` that finds packages first in the folder `packages`."""
    environment = {**os.environ, "PYTHONPATH": str(packages), "PYTHONDONTWRITEBYTECODE": "1"}
    command = [sys.executable, "-m", "dask", "worker", client.scheduler.address, "--no-nanny", "--no-dashboard"]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    with subprocess.Popen([*command, "--nthreads", "1"], env=environment, cwd=packages, **quiet) as worker:
        try:
            client.wait_for_workers(1, timeout=60)
            yield
        finally:
            worker.kill()
    while client.nthreads():
        pass


def changed_package(folder, *, version=None):
    """Copy the package with another coefficient in one formula, which no signature and no message shows."""
    shutil.copytree(PACKAGE, folder / "stylobate", ignore=shutil.ignore_patterns("__pycache__", "web", "page"))
    formula = folder / "stylobate" / "models" / "slender.py"
    formula.write_text(formula.read_text(encoding="utf-8") + "# another\n", encoding="utf-8")
    if version is not None:
        metadata = folder / f"stylobate-{version}.dist-info"
        metadata.mkdir()
        (metadata / "METADATA").write_text(f"Metadata-Version: 2.1\nName: stylobate\nVersion: {version}\n")


@pytest.mark.slow
def test_a_worker_with_another_version_and_source_refuses_every_task(points, client, tmp_path):
    changed_package(tmp_path, version="0.0.9")
    theirs, here = source_digest(tmp_path / "stylobate")[:8], package_identity()
    line = (
        rf"a Dask worker has stylobate 0\.0\.9 \(source {theirs}\), but this process has "
        rf"stylobate {here.version} \(source {here.source[:8]}\)\. Install the same version for both"
    )
    with worker_with(tmp_path, client), pytest.raises(StylobateError, match=line):
        run_sweep(points, executor=Dask(client=client))


@pytest.mark.parametrize("missing", ["package", pytest.param("module", marks=pytest.mark.slow)])
def test_a_worker_without_the_package_is_reported_within_ten_seconds(points, client, tmp_path, missing):
    if missing == "package":
        text = "raise ModuleNotFoundError(\"No module named 'stylobate'\", name='stylobate')\n"
        (tmp_path / "stylobate.py").write_text(text)
    else:  # a version from before these tasks
        changed_package(tmp_path)
        (tmp_path / "stylobate" / "studies" / "sweeps" / "dask_executor.py").unlink()
    with worker_with(tmp_path, client):
        begin = monotonic()
        with pytest.raises(
            StylobateError, match=r"a Dask worker lacks stylobate .* Install this version for the workers"
        ):
            run_sweep(points, executor=Dask(client=client))
        assert monotonic() - begin < 10.0


def test_missing_workers_are_reported_with_the_address_of_the_scheduler(points, client):
    address = client.scheduler.address
    with pytest.raises(StylobateError, match=rf"at {address} has had no workers for 0\.3 s\. Start some by .* wait="):
        run_sweep(points, executor=Dask(client=client, wait=0.3))
    assert Dask(client=client).wait <= 10.0


def test_a_digest_shows_each_change_of_source_but_not_of_line_ends(tmp_path):
    (tmp_path / "part").mkdir()
    file = tmp_path / "part" / "law.py"
    file.write_bytes(b"a = 1\nb = 2\n")
    before = source_digest(tmp_path)
    file.write_bytes(b"a = 1\r\nb = 2\r\n")
    assert source_digest(tmp_path) == before
    file.write_bytes(b"a = 1\nb = 3\n")
    assert source_digest(tmp_path) != before
    file.write_bytes(b"a = 1\nb = 2\n")
    file.rename(tmp_path / "law.py")
    assert source_digest(tmp_path) != before
