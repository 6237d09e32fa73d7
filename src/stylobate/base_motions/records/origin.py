"""Origin of a record: reading arguments and processing steps that reproduce it."""

import hashlib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Self


@dataclass(frozen=True, slots=True)
class RecordOrigin:
    """The files or the sample of a record, and the methods of `Record` applied to it.

    Parameters
    ----------
    reading
        Arguments of the reading as plain values: `path` or `sample`, `units`, `directions` and others.
    processing
        Name (`method`) and arguments of each method, in order.
    """

    reading: Mapping[str, Any]
    processing: tuple[Mapping[str, Any], ...] = ()

    @classmethod
    def of_files(cls, paths: Path | Iterable[Path], **arguments: Any) -> Self:
        """Create the origin of a record read from one file or from the files of one event.

        Parameters
        ----------
        paths
            The file or the files.
        **arguments
            Arguments of the reading as plain values; None for arguments not given.
        """
        one = isinstance(paths, Path)
        files = [paths] if isinstance(paths, Path) else list(paths)
        names = [str(path.absolute()) for path in files]
        digests = {name: hashlib.sha256(path.read_bytes()).hexdigest() for name, path in zip(names, files, strict=True)}
        given = {name: value for name, value in arguments.items() if value is not None}
        return cls({"path": names[0] if one else tuple(names), **given, "file_sha256": digests})

    def then(self, method: str, **arguments: Any) -> Self:
        """Append a method of `Record` and its arguments; None for an argument not given."""
        given = {name: value for name, value in arguments.items() if value is not None}
        return replace(self, processing=(*self.processing, {"method": method, **given}))
