"""Cache of machine code on disk: compiled once, loaded by later processes."""

import hashlib
import json
import logging
import os
import sys
import threading
from collections.abc import Callable, Iterable
from functools import cache
from pathlib import Path

from llvmlite import binding as llvm

from stylobate.compiler import machine
from stylobate.compiler.reads import NO_VALUE, Functions, Place, Reads, Watch
from stylobate.compiler.refusal import CompileError, Refusal
from stylobate.compiler.trusted_cache import VARIABLE, TrustedCache
from stylobate.errors import FileError

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
) -> tuple[llvm.ExecutionEngine, Watch]:
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
        return machine.linked(code), watch


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
    return machine.object_code(text), watch


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
    return hashlib.sha256(machine.described().encode()).hexdigest()[:8]
