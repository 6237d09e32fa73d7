"""Modules of compiled code: compiled once, kept on disk, loaded by every later process."""

import hashlib
import logging
import os
import sys
import threading
import types
from collections.abc import Callable, Iterable, Mapping
from importlib.metadata import version
from pathlib import Path
from typing import Any

from numba import config
from numba.core.errors import NumbaError, UnsupportedBytecodeError
from numba.core.registry import cpu_target

from stylobate.engine.compiling.apart import compile_apart
from stylobate.engine.compiling.loading import MachineCode, load
from stylobate.engine.compiling.model_code import fingerprint
from stylobate.engine.compiling.trusted_cache import VARIABLE, TrustedCache
from stylobate.errors import FileError, UnsupportedError

_log = logging.getLogger("stylobate")

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
        Beginning of its name.
    source
        Its text.
    functions
        What stands in it under these names.
    imported
        Modules from which it takes compiled functions.
    told
        Description of what is compiled.
    of
        The model, as messages name it.

    Raises
    ------
    UnsupportedError
        If Numba cannot compile the model.
    FileError
        If other users can write to the folder of compiled code.
    """
    name = f"{name}_{_key(source, functions, imported)}"
    with _compiling:
        machine_code = MachineCode()
        if not config.DISABLE_JIT:  # type: ignore[attr-defined]
            machine_code = _kept_or_compiled(TrustedCache(cache_folder()), name, source, functions, told)
        try:
            return load(name, source, functions, machine_code)
        except (NumbaError, UnsupportedBytecodeError, RecursionError) as error:
            message = f"model {of} cannot be compiled; single runs by simulate need no compiling: {_reason(error)}"
            raise UnsupportedError(message) from error


def cache_folder() -> Path:
    """Return the folder in which compiled code is kept: $STYLOBATE_CACHE, or `stylobate` in the user's cache folder."""
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


def _kept_or_compiled(
    cache: TrustedCache, name: str, source: str, functions: Mapping[str, Callable[..., Any]], told: str
) -> MachineCode:
    """Return the machine code of a module: empty if it can be compiled in this process alone, or not at all."""
    entry = f"{name}.{_machine()}.code"
    data = cache.read(entry, quiet=True)
    if data is None:
        # One process compiles, others that need the same wait for it.
        with cache.held(entry):
            data = cache.read(entry)
            if data is None:
                # A warning, seen where no logging is set up: seconds pass, once.
                _log.warning("compiling %s; kept in %s", told, cache.folder)
                data = compile_apart(name, source, functions)
                _keep(cache, entry, data)
    return MachineCode.from_bytes(data) if data else MachineCode()


def _keep(cache: TrustedCache, entry: str, data: bytes) -> None:
    """Write an entry, or warn that each process will compile it."""
    if not data:
        return
    try:
        cache.write(entry, data)
    except (OSError, FileError) as error:
        _log.warning(
            "compiled code cannot be kept in %s: %s; name another folder in $%s, or every process compiles it",
            *(cache.folder, getattr(error, "strerror", None) or error, VARIABLE),
        )


def _reason(error: Exception) -> str:
    lines = (line.strip() for line in str(error).splitlines())
    return next((line for line in lines if line and not line.startswith("Failed in")), "no reason")


def _machine() -> str:
    """Return a digest of what machine code depends on besides its source."""
    processor = cpu_target.target_context.codegen().magic_tuple()
    return hashlib.sha256(repr((processor, version("llvmlite"))).encode()).hexdigest()[:8]


def _key(source: str, functions: Mapping[str, Callable[..., Any]], imported: Iterable[types.ModuleType]) -> str:
    parts = [source, version("numba"), version("numpy"), sys.version]
    parts += [Path(module.__file__ or "").read_text(encoding="utf-8") for module in imported]
    parts += [f"{name} {fingerprint(function)}" for name, function in sorted(functions.items())]
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()[:16]
