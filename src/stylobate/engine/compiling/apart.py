"""Compiling in a process apart.

Machine code that Numba has just compiled and the same code read back from disk can differ in the last bit: the one is
linked from parts that were optimised singly. So a kernel is compiled by another process and always read from disk, and
its numbers are the same in the first process as in every later one.
"""

import importlib
import marshal
import types
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from stylobate.engine.compiling.loading import MachineCode, load
from stylobate.engine.compiling.model_code import called_functions, plain_function, with_functions
from stylobate.processes import Worker


@dataclass(frozen=True, slots=True)
class _Portable:
    """A function by what it says, for a process that cannot import it: a notebook's, or a script's own."""

    name: str
    code: bytes
    values: Mapping[str, Any]
    modules: Mapping[str, str]
    called: Mapping[str, "_Portable"]

    @classmethod
    def of(
        cls, function: Callable[..., Any], known: dict[types.FunctionType, "_Portable"] | None = None
    ) -> "_Portable":
        """Return what `function` says, and with it the functions that it calls, each of them once."""
        plain, known = plain_function(function), {} if known is None else known
        if plain not in known:
            known[plain] = cls._said(plain, known)
        return known[plain]

    @classmethod
    def _said(cls, plain: types.FunctionType, known: dict[types.FunctionType, "_Portable"]) -> "_Portable":
        called = dict(called_functions(plain))
        replaced = {name.split(".")[0] for name in called}
        used = {name: plain.__globals__[name] for name in plain.__code__.co_names if name in plain.__globals__}
        return cls(
            plain.__name__,
            marshal.dumps(plain.__code__),
            {
                name: value
                for name, value in used.items()
                if not (isinstance(value, types.ModuleType) or (name in replaced and isinstance(value, type)))
                and name not in called
            },
            {name: value.__name__ for name, value in used.items() if isinstance(value, types.ModuleType)},
            {name: cls.of(value, known) for name, value in called.items()},
        )

    def function(self, known: dict[int, types.FunctionType] | None = None) -> types.FunctionType:
        """Return the function."""
        known = {} if known is None else known
        if id(self) not in known:
            known[id(self)] = self._made(known)
        return known[id(self)]

    def _made(self, known: dict[int, types.FunctionType]) -> types.FunctionType:
        names: dict[str, Any] = {"__name__": "stylobate_model", "__builtins__": __builtins__, **self.values}
        names |= {name: importlib.import_module(module) for name, module in self.modules.items()}
        code = marshal.loads(self.code)  # noqa: S302  our own pipe
        called = {name: portable.function(known) for name, portable in self.called.items()}
        return types.FunctionType(code, with_functions(names, called, code), self.name)


def compile_apart(name: str, source: str, functions: Mapping[str, Callable[..., Any]]) -> bytes:
    """Compile a module with these functions of the model in another process; return its machine code, or nothing.

    Nothing is returned for functions that cannot be sent to another process, and for what cannot be compiled: the
    error is then the same in this process, where it can be raised.
    """
    try:
        portables = {function_name: _Portable.of(function) for function_name, function in functions.items()}
        worker = Worker.started(quiet=True)
    except (ValueError, RecursionError, OSError):  # code that cannot be taken to pieces, or no process
        return b""
    try:
        return worker.call(_compiled, name, source, portables)
    except Exception:  # noqa: BLE001  as above
        return b""
    finally:
        worker.end()


def _compiled(name: str, source: str, portables: Mapping[str, _Portable]) -> bytes:
    machine_code = MachineCode()
    load(name, source, {name: portable.function() for name, portable in portables.items()}, machine_code)
    return machine_code.to_bytes()
