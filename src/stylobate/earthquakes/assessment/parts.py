"""Store of the parts of an assessment: one file for each computed part, so that an assessment can resume."""

import hashlib
import json
import logging
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeAlias

import xarray as xr

from stylobate.base_motions import BaseMotion, Record
from stylobate.errors import FileError
from stylobate.progress import Report
from stylobate.quantities import exact_repr
from stylobate.results.storage import read_dataset, write_netcdf
from stylobate.studies.sweeps.fingerprint import identity_of

_log = logging.getLogger("stylobate")

Announce: TypeAlias = Callable[[str, int, int], None]
"""Called with the name of the part, the runs done and the total number of runs."""


@dataclass(frozen=True, slots=True)
class Parts:
    """Parts of an assessment, computed or read from the folder `store`.

    Parameters
    ----------
    store
        Folder of the parts; None stores nothing.
    total
        Approximate number of runs of all parts.
    announce
        Called with the progress while a part is computed; runs of stored parts count as done.
    """

    store: Path | None
    total: int
    announce: Announce
    _done: list[int] = field(default_factory=list, init=False)
    _known: list[str] = field(default_factory=list, init=False)

    def get(
        self, name: str, runs: int, identity: Mapping[str, Any], compute: Callable[[Report], xr.Dataset]
    ) -> xr.Dataset:
        """Return the part `name` of about `runs` runs; compute it if the store has none of the same `identity`.

        Raises
        ------
        FileError
            If the store cannot be written.
        """
        before = sum(self._done)
        path = None if self.store is None else self.store / f"{_digest({'part': name, **identity})}.nc"
        found = None if path is None else _kept(path)
        if found is not None:
            self._known.append(name)
        else:
            self._report_what_is_reused()
            self.announce(name, before, self.total)
            found = compute(
                lambda done, total: self.announce(name, before + round(runs * done / max(total, 1)), self.total)
            )
            if path is not None:
                _keep(found, path)
            self.announce(name, before + runs, self.total)
        self._done.append(runs)
        return found

    def report(self) -> None:
        """Log the number of parts that were read from the store, if any."""
        if self._known:
            _log.info(
                "%d of %d parts were read from %s and not computed again", len(self._known), len(self._done), self.store
            )

    def _report_what_is_reused(self) -> None:
        """Log the number of stored parts before the first part is computed."""
        if self._known and len(self._known) == len(self._done):
            _log.info("%d parts were read from %s; the assessment resumes there", len(self._known), self.store)


def identities(motions: Mapping[str, BaseMotion]) -> dict[str, Any]:
    """Return the identities of motions, by name."""
    return {
        name: motion.digest if isinstance(motion, Record) else identity_of(motion) for name, motion in motions.items()
    }


def _digest(identity: Mapping[str, Any]) -> str:
    return hashlib.sha256(json.dumps(identity, sort_keys=True, default=exact_repr).encode()).hexdigest()[:24]


def _kept(path: Path) -> xr.Dataset | None:
    if not path.exists():
        return None
    try:
        return read_dataset(path)
    except FileError as error:
        _log.warning("%s; it is computed again", error)
        return None


def _keep(data: xr.Dataset, path: Path) -> None:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(f"cannot write {path}: {error.strerror or error}") from None
    write_netcdf(data, path)
