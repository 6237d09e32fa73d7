"""Modules of plain Python from which functions are compiled: written for a model, or bound to one."""

import types
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any, Protocol

from stylobate.compiler.written import written_module

Functions = Mapping[str, Callable[..., Any]]


class Program(Protocol):
    """A module that is made when it is needed, and the texts on which it depends."""

    @property
    def texts(self) -> Sequence[str]:
        """What the module is made of."""

    def module(self, name: str, functions: Functions) -> types.ModuleType:
        """Return the module, of plain Python, in which `functions` of a model stand under their names."""


@dataclass(frozen=True, eq=False)
class Written:
    """A module whose text is written by the package; it takes functions from the `imported` modules."""

    text: str
    imported: Sequence[types.ModuleType] = ()

    @property
    def texts(self) -> Sequence[str]:
        """The text, and those of what it imports."""
        return [self.text, *map(text_of, self.imported)]

    def module(self, name: str, functions: Functions) -> types.ModuleType:
        """Return the module; tracebacks and debuggers find its lines."""
        return written_module(name, self.text, functions)


class Unbound:
    """Stands in a module for a name that each program gives a meaning of its own."""

    def __init__(self, name: str) -> None:
        self.name = name

    def __repr__(self) -> str:
        return f"<{self.name}, which no program has bound>"


@dataclass(frozen=True, eq=False)
class Bound:
    """Modules as they stand, with the names that they leave open given a meaning.

    Parameters
    ----------
    modules
        Their functions call each other, and what is bound, instead of what they import.
    names
        What names mean, those that are `Unbound` and any others; a name that is not here means a function of the model,
        of the written part, or of one of the modules.
    written
        A part whose text is written, whose functions are bound too; None for no such part.
    imported
        Modules whose functions and constants they use as they are.
    """

    modules: Sequence[types.ModuleType]
    names: Mapping[str, Any]
    written: Written | None = None
    imported: Sequence[types.ModuleType] = field(default=())

    @property
    def texts(self) -> Sequence[str]:
        """The texts of all modules, and what is bound in words."""
        words = repr(sorted((name, repr(value)) for name, value in self.names.items()))
        written = self.written.texts if self.written is not None else ()
        return [words, *written, *map(text_of, (*self.modules, *self.imported))]

    def module(self, name: str, functions: Functions) -> types.ModuleType:
        """Return a module with the functions of all; tracebacks and debuggers find their lines where they stand."""
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
                elif _belongs_to(value, set(scopes)):
                    scopes[module.__name__][key] = own[value.__module__, value.__name__]
                elif not key.startswith("__"):
                    scopes[module.__name__][key] = value
        made = types.ModuleType(name)
        vars(made).update({key: function for (_, key), function in own.items()})
        return made


def _belongs_to(value: object, modules: set[str]) -> bool:
    """Return whether a value is a function that stands in one of the modules."""
    return isinstance(value, types.FunctionType) and value.__module__ in modules


def _with_names(function: types.FunctionType, names: dict[str, Any]) -> types.FunctionType:
    """Return a function with other names round it."""
    made = types.FunctionType(function.__code__, names, function.__name__, function.__defaults__)
    made.__kwdefaults__ = function.__kwdefaults__
    made.__module__ = function.__module__
    vars(made).update(vars(function))
    return made


@cache
def text_of(module: types.ModuleType) -> str:
    """Return the text of a module that stands in a file."""
    return Path(module.__file__ or "").read_text(encoding="utf-8")
