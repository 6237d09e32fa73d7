"""A folder of machine code that only this user can have written, and that is read only if it is whole.

Whatever is read from here is executed. A folder or a file of another user, or one that others can write to, is
therefore never used, and a file whose bytes are not those that were written counts as missing. Nothing here depends on
the compiler: an entry is a name and bytes.
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
"""The environment variable that names the folder."""

_log = logging.getLogger("stylobate")

_FORMAT = b"stylobate machine code 1\n"
_DIGEST = hashlib.sha256().digest_size
_CREATED = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)
_WRITABLE_BY_OTHERS = stat.S_IWGRP | stat.S_IWOTH


@dataclass(frozen=True, slots=True)
class TrustedCache:
    """Entries by name in a folder of one user.

    Parameters
    ----------
    folder
        Need not exist: the first entry makes it, for its owner alone.

    Raises
    ------
    FileError
        If the folder belongs to another user, or other users can write to it.
    """

    folder: Path

    def __post_init__(self) -> None:
        try:
            problem = _distrust(self.folder.stat())
        except OSError:  # not there, or not to be reached: entries are missing, and writing one says why
            return
        if problem:
            message = (
                f"cache of compiled code: {problem} (got {self.folder}). "
                f"Make it yours alone (chown, chmod go-w), or name another folder in ${VARIABLE}."
            )
            raise FileError(message)

    def read(self, name: str, *, quiet: bool = False) -> bytes | None:
        """Return an entry, or None if it is missing; a damaged or untrusted one counts as missing.

        Such a one is named by a warning, unless `quiet`.
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
        """Write an entry whole or not at all.

        Raises
        ------
        OSError, FileError
            If the disk is full, the folder read-only and the like; nothing half written is left.
        """
        self.folder.mkdir(mode=stat.S_IRWXU, parents=True, exist_ok=True)
        with (
            written_aside(self.folder / name) as beside,
            os.fdopen(os.open(beside, _CREATED, stat.S_IRUSR | stat.S_IWUSR), "wb") as file,
        ):
            file.write(_seal(name, data) + data)

    @contextmanager
    def held(self, name: str) -> Iterator[None]:
        """Hold an entry, so that other processes that make the same one wait; without locks they do not wait."""
        from filelock import FileLock  # noqa: PLC0415  only compiling needs locks; filelock takes long to load

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
    """Return why a file or folder is not to be trusted, or nothing; the administrator is trusted."""
    if not hasattr(os, "geteuid"):  # Windows keeps the folders of users apart
        return ""
    if status.st_uid not in (os.geteuid(), 0):
        return "it belongs to another user"
    if status.st_mode & _WRITABLE_BY_OTHERS:
        return "other users can write to it"
    return ""
