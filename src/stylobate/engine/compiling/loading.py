"""Compiled modules, read from their files with the functions of a model put in."""

import importlib.util
import sys
import types
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from stylobate.engine.compiling.arithmetic import inlined, part
from stylobate.engine.compiling.model_code import for_compiling

INLINED = ("rates", "lean", "contact", "margins", "refreshed")
"""What is called in loops over lanes, which would not become vector code round a call."""


def load(path: Path, functions: Mapping[str, Callable[..., Any]]) -> types.ModuleType:
    """Return the module in the file `path`, with these functions of the model; compiled if it must be."""
    name = f"stylobate_kernels.{path.stem}"
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    for function_name, function in functions.items():
        compiled = for_compiling(function, inlined if function_name in INLINED else part)
        setattr(module, function_name, compiled)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module
