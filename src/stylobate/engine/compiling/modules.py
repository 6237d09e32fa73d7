"""Modules of compiled code: compiled once, kept on disk, loaded by every later process."""

import hashlib
import logging
import os
import sys
import tempfile
import threading
import types
from collections.abc import Callable, Iterable, Mapping
from importlib.metadata import version
from pathlib import Path
from typing import Any

from filelock import FileLock
from llvmlite import binding as llvm
from numba import config
from numba.core.errors import NumbaError, UnsupportedBytecodeError

from stylobate.engine.compiling.apart import compile_apart
from stylobate.engine.compiling.loading import load
from stylobate.engine.compiling.model_code import fingerprint
from stylobate.errors import UnsupportedError

_log = logging.getLogger("stylobate")

_CACHE_VARIABLE = "STYLOBATE_CACHE"

_compiling = threading.RLock()


def compiled_module(
    name: str,
    source: str,
    functions: Mapping[str, Callable[..., Any]],
    *,
    imported: Iterable[types.ModuleType],
    told: str,
    of: str,
) -> types.ModuleType:
    """Return the module of this source with these functions of a model put in, from disk or newly compiled.

    Parameters
    ----------
    name
        Beginning of its file's name.
    source
        Its text.
    functions
        What stands in it under these names.
    imported
        Modules from which it takes compiled functions.
    told
        What is said to be compiled.
    of
        The model, as messages name it.

    Raises
    ------
    UnsupportedError
        If Numba cannot compile the model, or compiled code cannot be kept.
    """
    with _compiling:
        path = cache_folder() / f"{name}_{_key(source, functions, imported)}.py"
        if not path.exists():
            _write(path, source)
        mark = path.with_name(f"{path.stem}.{_machine()}.compiled")
        jit = not config.DISABLE_JIT  # type: ignore[attr-defined]
        if not jit or mark.exists():
            return _loaded(path, functions, of)
        # One process compiles, others that need the same wait for it.
        with FileLock(path.with_name(f"{mark.name}.lock")):
            if not mark.exists():
                # A warning for whoever has set up no logging: seconds pass, once.
                _log.warning("compiling %s; kept in %s", told, path.parent)
                compile_apart(path, functions)  # where that fails, it is compiled here, and what is wrong is told
            module = _loaded(path, functions, of)
            mark.touch()
        return module


def _loaded(path: Path, functions: Mapping[str, Callable[..., Any]], of: str) -> types.ModuleType:
    try:
        return load(path, functions)
    except (NumbaError, UnsupportedBytecodeError, RecursionError) as error:
        lines = (line.strip() for line in str(error).splitlines())
        reason = next((line for line in lines if line and not line.startswith("Failed in")), "no reason")
        message = f"model {of} cannot be compiled; single runs by simulate need no compiling: {reason}"
        raise UnsupportedError(message) from error


def cache_folder() -> Path:
    """Return the folder in which compiled code is kept: $STYLOBATE_CACHE, or `stylobate` in the user's cache folder."""
    chosen = os.environ.get(_CACHE_VARIABLE)
    if chosen:
        return Path(chosen)
    if sys.platform == "win32":
        base = Path(os.environ.get("LOCALAPPDATA", Path.home() / "AppData" / "Local"))
    elif sys.platform == "darwin":
        base = Path.home() / "Library" / "Caches"
    else:
        base = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache"))
    return base / "stylobate"


def _machine() -> str:
    """Return a digest of what machine code depends on besides its source."""
    folder = str(config.CACHE_DIR)  # type: ignore[attr-defined]
    told = [llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten(), folder]
    return hashlib.sha256("\n".join(told).encode()).hexdigest()[:8]


def _key(source: str, functions: Mapping[str, Callable[..., Any]], imported: Iterable[types.ModuleType]) -> str:
    parts = [source, version("numba"), version("numpy"), sys.version]
    parts += [Path(module.__file__ or "").read_text(encoding="utf-8") for module in imported]
    parts += [f"{name} {fingerprint(function)}" for name, function in sorted(functions.items())]
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()[:16]


def _write(path: Path, source: str) -> None:
    # Written aside and moved into place, so that another process never reads half of it.
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile("w", encoding="utf-8", dir=path.parent, delete=False) as aside:
            aside.write(source)
        Path(aside.name).replace(path)
    except OSError as error:
        message = f"cannot keep compiled code in {path.parent}: {error}; name another folder in ${_CACHE_VARIABLE}"
        raise UnsupportedError(message) from error
