"""Tasks for Dask workers: each carries the version and source digest of stylobate, and a worker compares them."""

import hashlib
import pickle
from dataclasses import dataclass
from functools import cache, lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stylobate.errors import StylobateError
from stylobate.studies.sweeps.computing import Computed, Task

if TYPE_CHECKING:
    from stylobate.studies.sweeps.executors import Work


@dataclass(frozen=True, slots=True)
class PackageIdentity:
    """Version of stylobate and digest of its source: equal on two machines only if both compute the same."""

    version: str
    source: str

    def __str__(self) -> str:
        return f"stylobate {self.version} (source {self.source[:8]})"


@cache
def package_identity() -> PackageIdentity:
    """Return the identity of the package in this process, computed once."""
    from stylobate import __version__

    return PackageIdentity(__version__, source_digest(Path(__file__).parents[2]))


def source_digest(package: Path) -> str:
    """Return a digest of the paths and contents of all Python files in a package, whatever ends their lines."""
    digest = hashlib.sha256()
    for path in sorted(package.rglob("*.py"), key=lambda path: path.relative_to(package).parts):
        digest.update("/".join(path.relative_to(package).parts).encode() + b"\0")
        digest.update(path.read_bytes().replace(b"\r\n", b"\n") + b"\0")
    return digest.hexdigest()


class SealedTask:
    """A task that becomes its result when it is loaded with `pickle.loads`.

    Loading imports stylobate inside the task, so that a worker without the package raises ImportError there and
    the scheduler needs no package. What the task computes is opened only after `perform` has compared the packages.
    """

    def __init__(self, package: PackageIdentity, work: bytes, task: Task) -> None:
        self.parts = (package.version, package.source, work, pickle.dumps(task))

    def __reduce__(self) -> tuple[Any, ...]:
        return perform, self.parts


def perform(version: str, source: str, work: bytes, task: bytes) -> Computed:
    """Compute a task on one thread.

    Raises
    ------
    StylobateError
        If version or source of the package differ from those of the process that made the task.
    """
    theirs, here = PackageIdentity(version, source), package_identity()
    if here != theirs:
        message = (
            f"a Dask worker has {here}, but this process has {theirs}. "
            "Install the same version for both, and start the workers again."
        )
        raise StylobateError(message)
    return _opened(work)(pickle.loads(task), threads=1, progress=None)  # noqa: S301  as below


@lru_cache(maxsize=1)
def _opened(work: bytes) -> "Work":
    """Return the function of a sweep, the same object for all its tasks, so that what it has prepared is kept."""
    function: Work = pickle.loads(work)  # noqa: S301  from the scheduler, which can run any code
    return function
