"""Search for the record files of a saved result after result and files were moved together."""

import hashlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any


def relocated(values: Any, folder: Path) -> Any:
    """Return the plain values of a saved result with the new paths of missing record files.

    The search uses the name of the file and the last parts of its old path, below `folder` and the folders above it. A
    file must have the SHA-256 of the file with which the result was made.

    Parameters
    ----------
    values
        Values of a provenance or a description: tables, lists and plain values.
    folder
        Folder of the result.
    """
    if isinstance(values, list):
        return [relocated(value, folder) for value in values]
    if not isinstance(values, Mapping):
        return values
    digests = values.get("file_sha256")
    if values.get("kind") != "record" or not isinstance(digests, Mapping):
        return {name: relocated(value, folder) for name, value in values.items()}
    places = {path: _place(path, digest, folder) for path, digest in digests.items()}
    path = values.get("path")
    moved = [places.get(one, one) for one in path] if isinstance(path, list) else places.get(str(path), path)
    return {**values, "path": moved, "file_sha256": {places[name]: digest for name, digest in digests.items()}}


def _place(path: str, digest: str, folder: Path) -> str:
    """Return the present path of a file; its old path if it is there, or if it is not found."""
    old = Path(path)
    if old.is_file():
        return path
    here = folder.absolute()
    for above in (here, *here.parents):
        for count in range(1, len(old.parts)):
            found = above.joinpath(*old.parts[-count:])
            if found.is_file() and hashlib.sha256(found.read_bytes()).hexdigest() == digest:
                return str(found)
    return path
