"""Modules whose text is written by the package for a model."""

import linecache
import sys
import types
from collections.abc import Callable, Mapping
from typing import Any

PACKAGE = "stylobate_kernels"


def written_module(name: str, text: str, functions: Mapping[str, Callable[..., Any]]) -> types.ModuleType:
    """Return the module of a text, in which functions of a model stand under these names.

    Its functions are plain Python; what compiles them, tracebacks and debuggers find their lines.
    """
    module = types.ModuleType(f"{PACKAGE}.{name}")
    module.__file__ = f"<{module.__name__}>"
    vars(module).update(functions)
    sys.modules[module.__name__] = module
    linecache.cache[module.__file__] = (len(text), None, text.splitlines(keepends=True), module.__file__)
    exec(compile(text, module.__file__, "exec"), vars(module))  # noqa: S102  our own text
    return module
