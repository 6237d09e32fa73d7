"""Modules whose text is written by the package for a model."""

import linecache
import sys
import types
from collections.abc import Callable, Mapping
from typing import Any

PACKAGE = "stylobate_kernels"

_texts: dict[str, list[str]] = {}
"""Lines by the name of the file that there is not; `linecache`, which tracebacks read, may forget them."""


def written_module(name: str, text: str, functions: Mapping[str, Callable[..., Any]]) -> types.ModuleType:
    """Return the module of a text, in which functions of a model stand under these names.

    Its functions are plain Python; what compiles them, tracebacks and debuggers find their lines.
    """
    module = types.ModuleType(f"{PACKAGE}.{name}")
    module.__file__ = f"<{module.__name__}>"
    vars(module).update(functions)
    sys.modules[module.__name__] = module
    _texts[module.__file__] = text.splitlines(keepends=True)
    linecache.cache[module.__file__] = (len(text), None, _texts[module.__file__], module.__file__)
    exec(compile(text, module.__file__, "exec"), vars(module))  # noqa: S102  our own text
    return module


def lines_of(file: str) -> list[str]:
    """Return the lines of a file of functions: of a written module, or as it stands on disk."""
    if file in _texts:
        return _texts[file]
    linecache.checkcache(file)
    return linecache.getlines(file)
