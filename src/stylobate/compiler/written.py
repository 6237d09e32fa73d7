"""Modules with generated text for a model."""

import linecache
import sys
import types
from collections.abc import Callable, Mapping
from typing import Any

PACKAGE = "stylobate_kernels"

_texts: dict[str, list[str]] = {}
"""Lines by virtual file name; a copy, since `linecache`, which tracebacks use, may drop them."""


def written_module(name: str, text: str, functions: Mapping[str, Callable[..., Any]]) -> types.ModuleType:
    """Return the module of a text, with the functions of a model under these names.

    Its functions are plain Python; their lines are available to the compiler, tracebacks and debuggers.
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
    """Return the lines of a generated module or of a file on disk."""
    if file in _texts:
        return _texts[file]
    linecache.checkcache(file)
    return linecache.getlines(file)
