"""Kernels as modules: read from their files with the functions of a model put in."""

import importlib.util
import sys
import types
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from stylobate.engine.lanes.arithmetic import inlined, part
from stylobate.engine.lanes.head_source import OPTIONAL
from stylobate.engine.lanes.model_code import for_compiling


def load(path: Path, functions: Mapping[str, Callable[..., Any]]) -> types.ModuleType:
    """Return the module of the kernel in the file `path`, with these functions of the model; compiled if it must be."""
    name = f"stylobate_kernels.{path.stem}"
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    for function_name, function in functions.items():
        compiled = for_compiling(function, part if function_name in OPTIONAL else inlined)
        setattr(module, function_name, compiled)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module
