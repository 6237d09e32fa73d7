"""Kernels: compiled once for a model and a kind of base motion, kept on disk, loaded by every later process."""

import hashlib
import logging
import os
import re
import sys
import tempfile
import threading
import types
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

from llvmlite import binding as llvm
from numba import config
from numba.core.errors import NumbaError

from stylobate.engine.lanes import arithmetic, pattern, roots
from stylobate.engine.lanes.apart import compile_apart
from stylobate.engine.lanes.columns import LOOKS, Status, Window
from stylobate.engine.lanes.head_source import OPTIONAL, constants_source, model_source
from stylobate.engine.lanes.loading import load
from stylobate.engine.lanes.model_code import fingerprint
from stylobate.engine.lanes.observation_source import observation_source
from stylobate.engine.lanes.shape import Shape
from stylobate.engine.lanes.step_source import accelerations_source, rates_source, step_source
from stylobate.errors import UnsupportedError
from stylobate.models import Model

_log = logging.getLogger("stylobate")

_MARK = "# --- the kernel's text begins here ---"
_CACHE_VARIABLE = "STYLOBATE_CACHE"


@dataclass(frozen=True, slots=True)
class Kernel:
    """A compiled kernel."""

    shape: Shape
    module: types.ModuleType

    @property
    def advance(self) -> Callable[..., bool]:
        """Runs a batch; see the driver."""
        function: Callable[..., bool] = self.module.advance
        return function


_compiling = threading.Lock()


def kernel_of(model: type[Model], shape: Shape) -> Kernel:
    """Return the kernel of a class of models for this shape, from memory, from disk or newly compiled.

    Raises
    ------
    UnsupportedError
        If Numba cannot compile the model, or kernels cannot be kept.
    """
    with _compiling:
        return _kernel(model, shape)


@cache
def _kernel(model: type[Model], shape: Shape) -> Kernel:
    functions = _functions(model, shape)
    source = kernel_source(model, shape)
    key = _key(source, functions)
    path = cache_folder() / f"{_file_name(model, shape)}_{key}.py"
    if not path.exists():
        _write(path, source)
    mark = path.with_name(f"{path.stem}.{_machine()}.compiled")
    if not mark.exists() and not config.DISABLE_JIT:  # type: ignore[attr-defined]
        # A warning for whoever has set up no logging: seconds pass, once.
        _log.warning("compiling %s, %s; kept in %s", model.name, _kind(shape), path.parent)
        compile_apart(path, functions)  # where that fails, it is compiled here, and what is wrong is told
    try:
        kernel = Kernel(shape, load(path, functions))
    except (NumbaError, RecursionError) as error:
        lines = (line.strip() for line in str(error).splitlines())
        reason = next((line for line in lines if line and not line.startswith("Failed in")), "no reason")
        message = f"model {model.name} cannot be compiled for ensembles, but simulate can run it: {reason}"
        raise UnsupportedError(message) from error
    if not config.DISABLE_JIT:  # type: ignore[attr-defined]
        mark.touch()
    return kernel


def _machine() -> str:
    """Return a digest of what machine code depends on besides its source."""
    folder = str(config.CACHE_DIR)  # type: ignore[attr-defined]
    told = [llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten(), folder]
    return hashlib.sha256("\n".join(told).encode()).hexdigest()[:8]


def kernel_source(model: type[Model], shape: Shape) -> str:
    """Return the source of the module of a kernel."""
    has = {name: getattr(model, name) is not None for name in OPTIONAL}
    to_plane = not shape.planar and model.planar_rates is not None
    text = "\n\n".join(
        [
            f'"""Written by stylobate {version("stylobate")}: {model.name}, {_kind(shape)}."""\n',
            _IMPORTS,
            constants_source(shape, has, to_plane=to_plane),
            accelerations_source(shape),
            rates_source(shape),
            model_source(shape, has),
            step_source(shape),
            observation_source(shape),
            _driver_text(),
        ]
    )
    return _with_numbers(text, shape)


_IMPORTS = """\
import math

import numpy as np
import numpy.typing as npt

from stylobate.engine.lanes.arithmetic import cos_turns, kept, part, turning_point, vectorised, winding
from stylobate.engine.lanes.layout import Table
from stylobate.engine.lanes.roots import cubic, first_growth_past, first_return, nearest_turn, quintic, turns_of
from stylobate.models.model import Push
"""


def cache_folder() -> Path:
    """Return the folder in which kernels are kept: $STYLOBATE_CACHE, or `stylobate` in the user's cache folder."""
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


def _functions(model: type[Model], shape: Shape) -> dict[str, Callable[..., Any]]:
    """Return the model's functions as a kernel of this shape uses them, by name."""
    functions = {"rates": model.planar_rates if shape.planar else model.rates, "lean": model.lean}
    functions |= {name: getattr(model, name) for name in OPTIONAL}
    return {name: function for name, function in functions.items() if function is not None}


def _driver_text() -> str:
    folder = Path(pattern.__file__).parent
    texts = ((folder / f"{name}.py").read_text(encoding="utf-8") for name in pattern.ORDER)
    return "".join(text.split(_MARK, 1)[1] for text in texts)


def _with_numbers(text: str, shape: Shape) -> str:
    """Return `text` with names of columns and rows replaced by their numbers."""
    rows = shape.rows()
    special = {
        "STATE": rows["y0"],
        "SLOPE": rows["k0_0"],
        "NEW": rows["new0"],
        "SLOPE_NEW": rows["k12_0"],
        "LAST_STATE": rows["last0"],
        "LAST_SLOPE": rows["last_slope0"],
        "BEFORE": rows["before_tilt_change"],
        "LATE": rows["late_tilt_change"],
        "LOOK": rows["look0"],
        "PARAMETER": rows["p0"] if shape.parameters else 0,
        "COUNT": len(rows),
    }

    def number(match: re.Match[str]) -> str:
        table, name = match.groups()
        if table == "R":
            return str(special[name] if name in special else rows[name.lower()])
        return str(int((Window if table == "Window" else Status)[name]))

    numbered = re.sub(r"\b(R|Window|Status)\.([A-Z_]+)\b", number, text)
    return re.sub(r"\bLOOKS\b", str(LOOKS), numbered)


def _key(source: str, functions: Mapping[str, Callable[..., Any]]) -> str:
    parts = [source, version("numba"), version("numpy"), sys.version]
    parts += [Path(module.__file__ or "").read_text(encoding="utf-8") for module in (arithmetic, roots)]
    parts += [f"{name} {fingerprint(function)}" for name, function in sorted(functions.items())]
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()[:16]


def _kind(shape: Shape) -> str:
    return f"{'plane' if shape.planar else 'space'} motion, {shape.forcing.tag}, {shape.width} lanes"


def _file_name(model: type[Model], shape: Shape) -> str:
    name = re.sub(r"\W+", "_", model.name)
    return f"{name}_{'plane' if shape.planar else 'space'}_{shape.forcing.tag}_{shape.width}"


def _write(path: Path, source: str) -> None:
    # Written aside and moved into place, so that another process never reads half of it.
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile("w", encoding="utf-8", dir=path.parent, delete=False) as aside:
            aside.write(source)
        Path(aside.name).replace(path)
    except OSError as error:
        message = f"cannot keep compiled kernels in {path.parent}: {error}; name another folder in ${_CACHE_VARIABLE}"
        raise UnsupportedError(message) from error
