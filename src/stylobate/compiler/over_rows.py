"""Compiled evaluation of a function of a model for many rows of numbers."""

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt

from stylobate.compiler.compiled import Compiled
from stylobate.compiler.programs import Written
from stylobate.compiler.unit import ArrayArgument
from stylobate.errors import UnsupportedError

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
