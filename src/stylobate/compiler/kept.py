"""Cache of machine code on disk: compiled once, loaded by later processes."""

import hashlib
import logging
import os
import sys
import threading
from collections.abc import Callable, Iterable, Mapping
from functools import cache
from pathlib import Path
from typing import Any

from llvmlite import binding as llvm

from stylobate.compiler import machine
from stylobate.compiler.fingerprint import fingerprint
from stylobate.compiler.trusted_cache import VARIABLE, TrustedCache
from stylobate.errors import FileError

PLAIN_VARIABLE = "STYLOBATE_PLAIN"
"""If this variable is 1, nothing is compiled: functions run as plain Python, slowly, also in a debugger."""

_log = logging.getLogger("stylobate")
_notices = logging.getLogger("stylobate.compiling")
_loading = threading.RLock()


def runs_plain() -> bool:
    """Return whether the user has chosen plain Python."""
    return os.environ.get(PLAIN_VARIABLE, "") not in ("", "0")


def code_of(
    name: str,
    parts: Iterable[str],
    functions: Mapping[str, Callable[..., Any]],
    write: Callable[[], str],
    description: str | None,
) -> llvm.ExecutionEngine:
    """Load machine code from disk, or compile it.

    Parameters
    ----------
    name
        Prefix of the file name.
    parts
        Texts that determine the code.
    functions
        Functions of a model that determine the code.
    write
        Function that returns the text of the LLVM module.
    description
        Description for the log; None logs nothing.

    Raises
    ------
    CompileError
        If a function contains unsupported code.
    FileError
        If other users can write to the folder of compiled code.
    """
    entry = f"{name}_{_key(parts, functions)}.{_machine_key()}.code"
    folder = TrustedCache(cache_folder())
    with _loading:
        code = folder.read(entry, quiet=True)
        if code is None:
            # One process compiles; others that need the same code wait.
            with folder.held(entry):
                code = folder.read(entry)
                if code is None:
                    # A warning is visible without logging setup; compilation can take seconds.
                    if description is not None:
                        _notices.warning("compiling %s; kept in %s", description, folder.folder)
                    code = machine.object_code(write())
                    _keep(folder, entry, code)
        return machine.linked(code)


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


def _keep(folder: TrustedCache, entry: str, code: bytes) -> None:
    """Write an entry; on failure warn that each process will compile again."""
    try:
        folder.write(entry, code)
    except (OSError, FileError) as error:
        _log.warning(
            "compiled code cannot be kept in %s: %s; name another folder in $%s, or every process compiles it",
            *(folder.folder, getattr(error, "strerror", None) or error, VARIABLE),
        )


def _key(parts: Iterable[str], functions: Mapping[str, Callable[..., Any]]) -> str:
    texts = [_own_text(), *parts]
    texts += [f"{name} {fingerprint(function)}" for name, function in sorted(functions.items())]
    return hashlib.sha256("\n".join(texts).encode()).hexdigest()[:16]


@cache
def _own_text() -> str:
    """Return the source of the compiler, on which machine code depends."""
    return "".join(path.read_text(encoding="utf-8") for path in sorted(Path(__file__).parent.glob("*.py")))


@cache
def _machine_key() -> str:
    return hashlib.sha256(machine.described().encode()).hexdigest()[:8]
