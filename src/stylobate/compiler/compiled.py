"""Functions that are compiled at their first call."""

import ctypes
import types
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt

from stylobate.compiler import kept
from stylobate.compiler.machine import Machine, native
from stylobate.compiler.programs import Program, Written
from stylobate.compiler.reads import Reads, Watch
from stylobate.compiler.sources import CompileError
from stylobate.compiler.unit import ArrayArgument, Unit
from stylobate.compiler.values import Element, NumberKind
from stylobate.errors import UnsupportedError


@dataclass(frozen=True, eq=False)
class Compiled:
    """Compiled function of a module that belongs to a model.

    Parameters
    ----------
    name
        Name of the function.
    program
        Function that returns the program of its module; it is called again if a value that was read has changed.
    functions
        Functions of the model, by their names in the module.
    arguments
        Arguments of the function.
    model, description
        Names of the model and of the compiled program in messages.
    fast
        Names of functions of the model whose arithmetic is fast, see `marks.fast`.
    brief
        Whether compilation is too short to be logged.
    """

    name: str
    program: Callable[[], Program]
    functions: Mapping[str, Callable[..., Any]]
    arguments: Sequence[ArrayArgument | NumberKind]
    model: str
    description: str
    fast: Sequence[str] = field(default=())
    brief: bool = False

    def __call__(self, *values: Any) -> int:
        """Call the function with these contiguous arrays and numbers; return its result.

        Raises
        ------
        UnsupportedError
            If the model cannot be compiled.
        """
        if kept.runs_plain():
            return self.plain(*values)
        passed: list[Any] = []
        for argument, value in zip(self.arguments, values, strict=True):
            passed += [value] if isinstance(argument, NumberKind) else _passed(argument, value)
        return int(self._code()(*passed))

    def plain(self, *values: Any) -> int:
        """Call the function as plain Python, without compilation."""
        with np.errstate(all="ignore"):  # unused numbers may be NaN
            return int(getattr(self.module, self.name)(*values) or 0)

    @property
    def module(self) -> types.ModuleType:
        """Module of plain Python; it is made again if its text has changed."""
        return self._module_of(self.program())

    def _module_of(self, program: Program) -> types.ModuleType:
        own, texts = vars(self), list(program.texts)
        if own.get("_texts") != texts:
            own["_module"] = program.module(f"{self._words}_{id(self)}", self.functions)
            own["_texts"] = texts
        return own["_module"]  # type: ignore[no-any-return]

    def unit(self, *, machine: Machine | None = None, exact: bool = False, reads: Reads | None = None) -> Unit:
        """Return a new unit for functions of the module, with the lanes of a machine, by default of this one."""
        fast = [function for name, function in self.functions.items() if name in self.fast]
        lanes = (machine or native()).lanes
        return Unit(lanes=lanes, fast=fast, exact=exact, reads=reads, trusted=True)

    @property
    def _words(self) -> str:
        return "".join(character if character.isalnum() else "_" for character in self.description)

    def _code(self) -> Callable[..., int]:
        """Return the machine code; it is loaded again if a value that was read while compiling has changed."""
        function, watch = vars(self).get("_loaded", (None, None))
        if watch is None or not watch.unchanged():
            vars(self)["_loaded"] = function, _ = self._load()
        return function  # type: ignore[no-any-return]

    def _load(self) -> tuple[Callable[..., int], Watch]:
        program = self.program()

        def write(reads: Reads) -> str:
            unit = self.unit(reads=reads)
            unit.export(getattr(self._module_of(program), self.name), self.name, self.arguments)
            return unit.module.text(native().attributes)

        try:
            parts = [repr((self.name, self.arguments, self.fast)), *program.texts]
            logged = None if self.brief else self.description
            engine, watch = kept.code_of(self._words, parts, self.functions, write, logged)
        except CompileError as error:
            raise UnsupportedError(
                f"model {self.model} cannot be compiled; `simulate` computes single runs without compilation: {error}"
            ) from error
        kinds = [kind for argument in self.arguments for kind in _types_of(argument)]
        function = ctypes.CFUNCTYPE(ctypes.c_int64, *kinds)(engine.get_function_address(self.name))
        vars(function)["engine"] = engine  # keeps the code alive
        return function, watch


def _passed(argument: ArrayArgument, value: np.ndarray[Any, Any]) -> list[int]:
    """Return the pointer of an array, and its lengths that are unknown at compile time."""
    assert value.flags.c_contiguous
    assert value.dtype == (np.float64 if argument.element is Element.FLOAT else np.uint8)
    known = zip(value.shape, argument.shape, strict=True)
    lengths = []
    for length, expected in known:
        assert expected in (None, length)
        if expected is None:
            lengths.append(length)
    return [value.ctypes.data, *lengths]


def _types_of(argument: ArrayArgument | NumberKind) -> list[Any]:
    if isinstance(argument, NumberKind):
        return [ctypes.c_double if argument is NumberKind.FLOAT else ctypes.c_int64]
    return [ctypes.c_void_p, *[ctypes.c_int64] * argument.shape.count(None)]


Floats = npt.NDArray[np.float64]

# Minimum number of rows for compilation.
_FEW = 64


def over_rows(function: Callable[..., Any], rows: Floats, *, name: str) -> Floats:
    """Evaluate `function` for each row of numbers; return shape (n, results).

    Parameters
    ----------
    function
        Function of floats that returns a tuple of floats. It is called as plain Python if it cannot be compiled.
    rows
        Arguments, shape (n, arguments).
    name
        Name for messages, such as that of the model.
    """
    if not len(rows):
        return np.empty((0, 0))
    results = len(function(*rows[0].tolist()))
    if len(rows) >= _FEW:
        out = np.empty((len(rows), results))
        try:
            _compiled(function, rows.shape[1], results, name)(np.ascontiguousarray(rows), out)
        except UnsupportedError:
            pass
        else:
            return out
    return np.array([function(*row) for row in rows.tolist()], dtype=float)


@cache
def _compiled(function: Callable[..., Any], arguments: int, results: int, name: str) -> Compiled:
    program = Written(_text(arguments, results))
    return Compiled(
        name="over_rows",
        program=lambda: program,
        functions={"function": function},
        arguments=(ArrayArgument((None, arguments)), ArrayArgument((None, results))),
        model=name,
        description=f"{name}, {getattr(function, '__name__', 'function')} along runs",
        brief=True,
    )


def _text(arguments: int, results: int) -> str:
    numbers = ", ".join(f"rows[k, {j}]" for j in range(arguments))
    lines = [
        "def over_rows(rows, out):",
        "    for k in range(len(rows)):",
        f"        found = function({numbers})",
        *(f"        out[k, {j}] = found[{j}]" for j in range(results)),
    ]
    return "\n".join(lines) + "\n"
