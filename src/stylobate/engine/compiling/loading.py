"""Modules of compiled code, made from their text with the functions of a model put in."""

import linecache
import marshal
import pickle
import sys
import types
from collections.abc import Callable, Mapping
from contextvars import ContextVar
from dataclasses import dataclass, field
from typing import Any, TypeVar, cast

from numba import njit
from numba.core.caching import NullCache
from numba.core.compiler import CompileResult
from numba.core.serialize import dumps

from stylobate.engine.compiling.arithmetic import inlined, part
from stylobate.engine.compiling.model_code import for_compiling

_F = TypeVar("_F", bound=Callable[..., Any])

INLINED = ("rates", "tilt_of", "contact", "guards", "project")
"""What is called in loops over lanes, which would not become vector code round a call."""


@dataclass(slots=True)
class MachineCode:
    """What is kept of a compiled module: its code for Python, and that for the machine of each function."""

    module: bytes = b""
    functions: dict[str, bytes] = field(default_factory=dict)

    @classmethod
    def from_bytes(cls, data: bytes) -> "MachineCode":
        """Return what `to_bytes` was called on; the bytes must be trusted."""
        return cls(*pickle.loads(data))  # noqa: S301  read from a trusted cache, or from a process of our own

    def to_bytes(self) -> bytes:
        """Return it as bytes."""
        return pickle.dumps((self.module, self.functions))


_machine_code: ContextVar[MachineCode] = ContextVar("_machine_code")


def load(
    name: str, source: str, functions: Mapping[str, Callable[..., Any]], machine_code: MachineCode
) -> types.ModuleType:
    """Return the module of this source, with these functions of the model.

    What `machine_code` lacks is compiled, and added to it.
    """
    module = types.ModuleType(f"stylobate_kernels.{name}")
    module.__file__ = f"<{module.__name__}>"
    for function_name, function in functions.items():
        compiled = for_compiling(function, inlined if function_name in INLINED else part)
        setattr(module, function_name, compiled)
    sys.modules[module.__name__] = module
    # Messages of the compiler and tracebacks quote the lines from here: the text is in no file.
    linecache.cache[module.__file__] = (len(source), None, source.splitlines(keepends=True), module.__file__)
    if not machine_code.module:
        machine_code.module = marshal.dumps(compile(source, module.__file__, "exec"))
    before = _machine_code.set(machine_code)
    try:
        exec(marshal.loads(machine_code.module), vars(module))  # noqa: S102, S302  as above
    finally:
        _machine_code.reset(before)
    return module


def kept(signature: str) -> Callable[[_F], _F]:
    """Compile a function of a module and all that it calls for arguments of this type, at once; keep the machine code.

    In a module that is loaded with machine code of the function, that is taken instead.
    """

    def compiled(function: _F) -> _F:
        dispatcher: Any = njit(error_model="numpy", nogil=True)(function)
        if hasattr(dispatcher, "compile"):  # not where Numba is switched off
            dispatcher._cache = _FromMemory(function.__name__, _machine_code.get().functions)  # noqa: SLF001
            dispatcher.compile(signature)
            dispatcher.disable_compile()
        return cast("_F", dispatcher)

    return compiled


class _FromMemory(NullCache):
    """Gives Numba the machine code of one function, as its own cache gives it from files."""

    def __init__(self, name: str, functions: dict[str, bytes]) -> None:
        self._name, self._functions = name, functions

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return the compiled function, or None."""
        del sig  # a kept function has one
        target_context.refresh()
        if self._name not in self._functions:
            return None
        parts = pickle.loads(self._functions[self._name])  # noqa: S301  trusted with the module
        return cast("Any", CompileResult)._rebuild(target_context, *parts)  # noqa: SLF001

    def save_overload(self, sig: Any, cres: Any) -> None:
        """Add the compiled function, unless its code holds addresses of this process."""
        del sig
        if not cres.library.has_dynamic_globals:
            self._functions[self._name] = cast("Any", dumps)(cres._reduce())  # noqa: SLF001
