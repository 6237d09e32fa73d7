"""Files of records that a saved result names, found again where the result and they were moved together."""

import hashlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any


def relocated(values: Any, folder: Path) -> Any:
    """Return the plain values of a saved result with its missing files of records found beside it.

    A file is looked for by its name, and by the last of the folders it was in, from `folder` and the folders above it
    on, and is taken only if its SHA-256 is that of the file the result was made with.

    Parameters
    ----------
    values
        Of a provenance or a description: tables, lists and plain values.
    folder
        Where the result lies.
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
    """Return where a file is now; where it was if it is there, or nowhere."""
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
