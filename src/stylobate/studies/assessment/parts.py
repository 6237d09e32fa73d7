"""The parts of an assessment, each kept in a file once it is computed: what was interrupted goes on from there."""

import hashlib
import json
import logging
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeAlias

import xarray as xr

from stylobate.errors import FileError
from stylobate.motions import BaseMotion, Record
from stylobate.studies.sweeps.computing import Progress
from stylobate.studies.sweeps.fingerprint import identity_of

_log = logging.getLogger("stylobate")

Announce: TypeAlias = Callable[[str, int, int], None]
"""Told what is computed, how much of everything is done and how much there is, in runs."""


@dataclass(frozen=True, slots=True)
class Parts:
    """Parts computed or, from the folder `store`, known.

    Parameters
    ----------
    store
        Where they are kept; None keeps nothing.
    total
        Runs of all parts, about.
    announce
        Told of progress.
    """

    store: Path | None
    total: int
    announce: Announce
    _done: list[int] = field(default_factory=list, init=False)
    _known: list[str] = field(default_factory=list, init=False)

    def get(
        self, name: str, runs: int, identity: Mapping[str, Any], compute: Callable[[Progress], xr.Dataset]
    ) -> xr.Dataset:
        """Return the part `name` of about so many `runs`; it is computed if none of the same `identity` is kept.

        Raises
        ------
        FileError
            If the store cannot be written.
        """
        before = sum(self._done)
        self.announce(name, before, self.total)
        path = None if self.store is None else self.store / f"{_digest({'part': name, **identity})}.nc"
        found = None if path is None else _kept(path)
        if found is not None:
            self._known.append(name)
        else:
            found = compute(
                lambda done, total: self.announce(name, before + round(runs * done / max(total, 1)), self.total)
            )
            if path is not None:
                _keep(found, path)
        self._done.append(runs)
        self.announce(name, before + runs, self.total)
        return found

    def tell(self) -> None:
        """Log in one line how many parts were known, if any were."""
        if self._known:
            _log.info(
                "%d of %d parts were kept in %s and not computed again", len(self._known), len(self._done), self.store
            )


def identities(motions: Mapping[str, BaseMotion]) -> dict[str, Any]:
    """Return what tells these motions from others, by name."""
    return {
        name: motion.digest if isinstance(motion, Record) else identity_of(motion) for name, motion in motions.items()
    }


def _digest(identity: Mapping[str, Any]) -> str:
    return hashlib.sha256(json.dumps(identity, sort_keys=True, default=repr).encode()).hexdigest()[:24]


def _kept(path: Path) -> xr.Dataset | None:
    if not path.exists():
        return None
    try:
        with xr.open_dataset(path, engine="h5netcdf", decode_times=False) as stored:
            return stored.load()
    except (OSError, ValueError):  # cut short by a crash: computed again
        return None


def _keep(data: xr.Dataset, path: Path) -> None:
    beside = path.with_suffix(".part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        data.to_netcdf(beside, engine="h5netcdf")
        beside.replace(path)
    except OSError as error:
        message = f"cannot write {path}: {error.strerror or error}"
        raise FileError(message) from None
