"""Data that are computed once and found again under a key: parts of an assessment, sections of the paper's check."""

import hashlib
import json
import logging
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import xarray as xr

from stylobate.errors import FileError
from stylobate.quantities import exact_repr
from stylobate.results.storage import read_tree, write_netcdf

_log = logging.getLogger("stylobate")

# Lengths of the parts of a file's name: of the name of an entry, and of the digest of its identity.
_NAME, _DIGEST = 40, 24


@dataclass(frozen=True, slots=True)
class KeyedStore:
    """Data in a folder: one netCDF file for each key, which is a name and an identity.

    The identity holds everything on which the data depend, so that data of other inputs or code are never found. A file
    is written beside its place and moved there when complete: a process that is killed leaves no part of an entry. A
    file whose checksum differs counts as missing, and a warning names it.

    Parameters
    ----------
    folder
        Folder of the files; the first entry creates it.
    """

    folder: Path

    def read(self, name: str, identity: Mapping[str, Any]) -> xr.DataTree | None:
        """Read the entry of this key into memory; None if it is missing or damaged."""
        path = self._file(name, identity)
        if not path.exists():
            return None
        try:
            return read_tree(path)
        except FileError as error:
            _log.warning("%s; it is computed again", error)
            return None

    def write(
        self, name: str, identity: Mapping[str, Any], data: xr.Dataset | xr.DataTree, *, replace: bool = False
    ) -> None:
        """Store `data` under this key; with `replace` in place of all entries of this name.

        Raises
        ------
        FileError
            If the folder cannot be written.
        """
        path = self._file(name, identity)
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            for other in self.folder.glob(f"{_slug(name)}-{'?' * _DIGEST}.nc") if replace else ():
                other.unlink()
        except OSError as error:
            raise FileError(f"cannot write into {self.folder}: {error.strerror or error}") from None
        write_netcdf(data, path)

    def _file(self, name: str, identity: Mapping[str, Any]) -> Path:
        key = json.dumps({"name": name, **identity}, sort_keys=True, default=exact_repr)
        return self.folder / f"{_slug(name)}-{hashlib.sha256(key.encode()).hexdigest()[:_DIGEST]}.nc"


def _slug(name: str) -> str:
    return re.sub(r"\W+", "-", name.lower())[:_NAME]
