"""Cache folder of machine code that only this user can write; damaged entries are not read.

The content of an entry is executed. Therefore a folder or file that belongs to another user, or that other users can
write to, is never used, and a damaged file counts as missing. An entry is a name and bytes; the cache does not depend
on the compiler.
"""

import hashlib
import logging
import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from stylobate.errors import FileError
from stylobate.files import written_aside

VARIABLE = "STYLOBATE_CACHE"
"""Environment variable with the name of the folder."""

_log = logging.getLogger("stylobate")

_FORMAT = b"stylobate machine code 1\n"
_DIGEST = hashlib.sha256().digest_size
_CREATED = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)
_WRITABLE_BY_OTHERS = stat.S_IWGRP | stat.S_IWOTH


@dataclass(frozen=True, slots=True)
class TrustedCache:
    """Cache of entries by name in a folder of one user.

    Parameters
    ----------
    folder
        Folder; the first entry creates it if necessary, with access for its owner alone.

    Raises
    ------
    FileError
        If the folder belongs to another user, or other users can write to it.
    """

    folder: Path

    def __post_init__(self) -> None:
        try:
            problem = _distrust(self.folder.stat())
        except OSError:  # missing or inaccessible: entries are missing, and `write` raises the error
            return
        if problem:
            message = (
                f"cache of compiled code: {problem} (got {self.folder}). "
                f"Make it yours alone (chown, chmod go-w), or name another folder in ${VARIABLE}."
            )
            raise FileError(message)

    def read(self, name: str, *, quiet: bool = False) -> bytes | None:
        """Return an entry, or None if it is missing; a damaged or untrusted one counts as missing.

        A warning names a damaged or untrusted entry, unless `quiet`.
        """
        path = self.folder / name
        try:
            with path.open("rb") as file:
                problem = _distrust(os.fstat(file.fileno()))
                sealed = b"" if problem else file.read()
        except FileNotFoundError:
            return None
        except OSError as error:
            problem, sealed = f"it cannot be read: {error.strerror}", b""
        data = sealed[len(_FORMAT) + _DIGEST :]
        if not problem and sealed == _seal(name, data) + data:
            return data
        if not quiet:
            _log.warning("%s is not used: %s; it is compiled again", path, problem or "it is damaged")
        return None

    def write(self, name: str, data: bytes) -> None:
        """Write an entry completely or not at all.

        Raises
        ------
        OSError, FileError
            If the disk is full, the folder is read-only or the like; no partial file remains.
        """
        self.folder.mkdir(mode=stat.S_IRWXU, parents=True, exist_ok=True)
        with (
            written_aside(self.folder / name) as beside,
            os.fdopen(os.open(beside, _CREATED, stat.S_IRUSR | stat.S_IWUSR), "wb") as file,
        ):
            file.write(_seal(name, data) + data)

    @contextmanager
    def held(self, name: str) -> Iterator[None]:
        """Lock an entry, so that other processes that compute it wait; without file locks they do not wait."""
        from filelock import FileLock

        lock = FileLock(self.folder / f"{name}.lock")
        try:
            self.folder.mkdir(mode=stat.S_IRWXU, parents=True, exist_ok=True)
            lock.acquire()
        except (OSError, NotImplementedError):  # read-only, full, or a file system that cannot lock
            yield
            return
        try:
            yield
        finally:
            lock.release()


def _seal(name: str, data: bytes) -> bytes:
    return _FORMAT + hashlib.sha256(name.encode() + b"\0" + data).digest()


def _distrust(status: os.stat_result) -> str:
    """Return the reason not to trust a file or folder, or ""; the administrator is trusted."""
    if not hasattr(os, "geteuid"):  # Windows separates the folders of users
        return ""
    if status.st_uid not in (os.geteuid(), 0):
        return "it belongs to another user"
    if status.st_mode & _WRITABLE_BY_OTHERS:
        return "other users can write to it"
    return ""
