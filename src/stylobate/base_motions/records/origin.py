"""Origin of a record: the reading of its files and the processing since, by which it can be made again."""

import hashlib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Self


@dataclass(frozen=True, slots=True)
class RecordOrigin:
    """The files or the sample of a record, and the methods of `Record` applied since.

    Parameters
    ----------
    reading
        Arguments of the reading as plain values: `path` or `sample`, `units`, `directions` and others.
    processing
        For each method in order: its name as `method`, and its arguments.
    """

    reading: Mapping[str, Any]
    processing: tuple[Mapping[str, Any], ...] = ()

    @classmethod
    def of_files(cls, paths: Path | Iterable[Path], **arguments: Any) -> Self:
        """Make the origin of a record that is read now from one file, or from the files of one event.

        Parameters
        ----------
        paths
            The file or the files.
        **arguments
            Arguments of the reading as plain values; None for those not given.
        """
        one = isinstance(paths, Path)
        files = [paths] if isinstance(paths, Path) else list(paths)
        names = [str(path.absolute()) for path in files]
        digests = {name: hashlib.sha256(path.read_bytes()).hexdigest() for name, path in zip(names, files, strict=True)}
        given = {name: value for name, value in arguments.items() if value is not None}
        return cls({"path": names[0] if one else tuple(names), **given, "file_sha256": digests})

    def then(self, method: str, **arguments: Any) -> Self:
        """Add a method of `Record` and its arguments; None for an argument not given."""
        given = {name: value for name, value in arguments.items() if value is not None}
        return replace(self, processing=(*self.processing, {"method": method, **given}))
