"""Machine code for this machine, and its cache on disk: compiled once, loaded by later processes.

The content of an entry is executed. Therefore a folder or file that belongs to another user, or that other users can
write to, is never used, and a damaged file counts as missing. An entry is a name and bytes; the cache does not depend
on the compiler.
"""

import hashlib
import json
import logging
import os
import stat
import sys
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from stylobate.compiler.machine import linked, native
from stylobate.compiler.reads import NO_VALUE, Functions, Place, Reads, Watch
from stylobate.compiler.sources import CompileError, Refusal
from stylobate.errors import FileError
from stylobate.files import written_aside

if TYPE_CHECKING:
    from llvmlite import binding as llvm

VARIABLE = "STYLOBATE_CACHE"
"""Environment variable with the name of the folder."""


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
            raise FileError(
                f"cache of compiled code: {problem} (got {self.folder}). "
                f"Make it yours alone (chown, chmod go-w), or name another folder in ${VARIABLE}."
            )

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


PLAIN_VARIABLE = "STYLOBATE_PLAIN"
"""If this variable is 1, nothing is compiled: functions run as plain Python, slowly, also in a debugger."""

_MOST_LISTS = 16
"""Maximum number of lists of places for one program."""

_log = logging.getLogger("stylobate")
_notices = logging.getLogger("stylobate.compiling")
_loading = threading.RLock()


def runs_plain() -> bool:
    """Return whether the user has chosen plain Python."""
    return os.environ.get(PLAIN_VARIABLE, "") not in ("", "0")


def code_of(
    name: str,
    parts: Iterable[str],
    functions: Functions,
    write: Callable[[Reads], str],
    description: str | None,
) -> tuple["llvm.ExecutionEngine", Watch]:
    """Load machine code from disk, or compile it; return it with the watch over the values on which it depends.

    For each program the folder has a list of the places at which earlier compilations read values. The name of an entry
    contains a digest of the present values at these places: code of other values is not found.

    Parameters
    ----------
    name
        Prefix of the file name.
    parts
        Texts that determine the code.
    functions
        Functions of a model that determine the code.
    write
        Function that returns the text of the LLVM module, and logs the values that it reads.
    description
        Description for the log; None logs nothing.

    Raises
    ------
    CompileError
        If a function contains unsupported code.
    FileError
        If other users can write to the folder of compiled code.
    """
    program = f"{name}_{_digest([_own_text(), *parts, *sorted(functions)])}.{_machine_key()}"
    folder = TrustedCache(cache_folder())
    with _loading:
        found = _found(folder, program, functions, quiet=True)
        if found is None:
            # One process compiles; others that need the same code wait.
            with folder.held(program):
                found = _found(folder, program, functions)
                if found is None:
                    # A warning is visible without logging setup; compilation can take seconds.
                    if description is not None:
                        _notices.warning("compiling %s; kept in %s", description, folder.folder)
                    found = _compiled(write, Reads(functions))
                    _keep(folder, program, *found)
        code, watch = found
        return linked(code), watch


def _found(
    folder: TrustedCache, program: str, functions: Functions, *, quiet: bool = False
) -> tuple[bytes, Watch] | None:
    """Return the code of a program whose values are the present ones."""
    for places in _lists(folder, program):
        try:
            watch = Watch(functions, places)
        except NO_VALUE:
            continue
        code = folder.read(_entry(program, watch), quiet=quiet)
        if code is not None:
            return code, watch
    return None


def _compiled(write: Callable[[Reads], str], reads: Reads) -> tuple[bytes, Watch]:
    text = write(reads)
    try:
        watch = reads.watch()
    except Refusal as refusal:
        raise CompileError(refusal) from refusal
    return native().object_code(text), watch


def _lists(folder: TrustedCache, program: str) -> list[list[Place]]:
    """Return the lists of places of earlier compilations, the latest first."""
    kept = folder.read(f"{program}.places", quiet=True)
    return [] if kept is None else [[Place(*place) for place in places] for places in json.loads(kept)]


def _entry(program: str, watch: Watch) -> str:
    return f"{program}_{_digest([json.dumps(watch.places), *watch.descriptions])}.code"


def cache_folder() -> Path:
    """Return the folder of compiled code: $STYLOBATE_CACHE, or `stylobate` in the cache folder of the user."""
    chosen = os.environ.get(VARIABLE)
    if chosen:
        return Path(chosen)
    if sys.platform == "win32":
        base = Path(os.environ.get("LOCALAPPDATA", Path.home() / "AppData" / "Local"))
    elif sys.platform == "darwin":
        base = Path.home() / "Library" / "Caches"
    else:
        base = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache"))
    return base / "stylobate"


def _keep(folder: TrustedCache, program: str, code: bytes, watch: Watch) -> None:
    """Write an entry, and the places of its values; on failure warn that each process will compile again."""
    others = [places for places in _lists(folder, program) if places != watch.places]
    try:
        folder.write(_entry(program, watch), code)
        folder.write(f"{program}.places", json.dumps([watch.places, *others][:_MOST_LISTS]).encode())
    except (OSError, FileError) as error:
        _log.warning(
            "compiled code cannot be kept in %s: %s; name another folder in $%s, or every process compiles it",
            *(folder.folder, getattr(error, "strerror", None) or error, VARIABLE),
        )


def _digest(texts: Iterable[str]) -> str:
    return hashlib.sha256("\n".join(texts).encode()).hexdigest()[:16]


@cache
def _own_text() -> str:
    """Return the source of the compiler, on which machine code depends."""
    return "".join(path.read_text(encoding="utf-8") for path in sorted(Path(__file__).parent.glob("*.py")))


@cache
def _machine_key() -> str:
    return hashlib.sha256(native().described().encode()).hexdigest()[:8]
