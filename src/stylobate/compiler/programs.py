"""Modules of plain Python for compilation: generated for a model, or bound to one."""

import types
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any, Protocol

from stylobate.compiler.sources import written_module

Functions = Mapping[str, Callable[..., Any]]


class Program(Protocol):
    """Module that is created on demand, and the texts that determine it."""

    @property
    def texts(self) -> Sequence[str]:
        """Texts that determine the module."""

    def module(self, name: str, functions: Functions) -> types.ModuleType:
        """Return the module of plain Python that contains the `functions` of a model under their names."""


@dataclass(frozen=True, eq=False)
class Written:
    """Module with generated text, which uses functions of the `imported` modules."""

    text: str
    imported: Sequence[types.ModuleType] = ()

    @property
    def texts(self) -> Sequence[str]:
        """Text of the module, and texts of the imported modules."""
        return [self.text, *map(text_of, self.imported)]

    def module(self, name: str, functions: Functions) -> types.ModuleType:
        """Return the module; its lines are available to tracebacks and debuggers."""
        return written_module(name, self.text, functions)


class Unbound:
    """Placeholder in a module for a name that each program binds."""

    def __init__(self, name: str) -> None:
        self.name = name

    def __repr__(self) -> str:
        return f"<{self.name}, which no program has bound>"


def placeholders(module: str, declared: Mapping[str, Any]) -> Callable[[str], Unbound]:
    """Return the function `__getattr__` of a module that only declares names, so that other modules can import them."""

    def placeholder(name: str) -> Unbound:
        if name in declared:
            return Unbound(name)
        raise AttributeError(f"{module} declares no name {name}")

    return placeholder


@dataclass(frozen=True, eq=False)
class Bound:
    """Ordinary modules, with their open names bound.

    Parameters
    ----------
    modules
        Modules whose functions call each other and the bound names instead of their imports.
    names
        Values of the `Unbound` names and of others; any other name is a function of the model, of the generated part,
        or of one of the modules.
    written
        Part with generated text, whose functions are bound too; None for no such part.
    imported
        Modules whose functions and constants are used unchanged.
    """

    modules: Sequence[types.ModuleType]
    names: Mapping[str, Any]
    written: Written | None = None
    imported: Sequence[types.ModuleType] = field(default=())

    @property
    def texts(self) -> Sequence[str]:
        """Texts of all modules, and a text of the bound names."""
        words = repr(sorted((name, repr(value)) for name, value in self.names.items()))
        written = self.written.texts if self.written is not None else ()
        return [words, *written, *map(text_of, (*self.modules, *self.imported))]

    def module(self, name: str, functions: Functions) -> types.ModuleType:
        """Return a module with the functions of all modules; tracebacks and debuggers show their own files."""
        written = {} if self.written is None else vars(self.written.module(f"{name}_written", functions))
        scopes: dict[str, dict[str, Any]] = {module.__name__: {} for module in self.modules}
        own = {
            (module.__name__, key): _with_names(value, scopes[module.__name__])
            for module in self.modules
            for key, value in vars(module).items()
            if _belongs_to(value, {module.__name__})
        }
        meanings = {**{key: function for (_, key), function in own.items()}, **written, **functions, **self.names}
        for module in self.modules:
            for key, value in vars(module).items():
                if key in self.names or isinstance(value, Unbound):
                    scopes[module.__name__][key] = meanings.get(key, value)
                elif not key.startswith("__"):
                    scopes[module.__name__][key] = _with_own(value, own)
        made = types.ModuleType(name)
        vars(made).update({key: function for (_, key), function in own.items()})
        return made


def _with_own(value: Any, own: Mapping[tuple[str, str], object]) -> Any:
    """Return a value with the `own` functions in place of those of the modules, in tuples and named tuples too."""
    if isinstance(value, types.FunctionType):
        return own.get((value.__module__, value.__name__), value)
    if not isinstance(value, tuple):
        return value
    parts = [_with_own(part, own) for part in value]
    return type(value)(*parts) if hasattr(value, "_fields") else tuple(parts)


def _belongs_to(value: object, modules: set[str]) -> bool:
    """Return whether a value is a function defined in one of the modules."""
    return isinstance(value, types.FunctionType) and value.__module__ in modules


def _with_names(function: types.FunctionType, names: dict[str, Any]) -> types.FunctionType:
    """Return a copy of a function with other global names."""
    made = types.FunctionType(function.__code__, names, function.__name__, function.__defaults__)
    made.__kwdefaults__ = function.__kwdefaults__
    made.__module__ = function.__module__
    vars(made).update(vars(function))
    return made


@cache
def text_of(module: types.ModuleType) -> str:
    """Return the source text of a module."""
    return Path(module.__file__ or "").read_text(encoding="utf-8")
