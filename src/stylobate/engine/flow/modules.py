"""Source text and compilation of the flow of a model."""

from collections.abc import Callable
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

from stylobate.compiler.compiled import Compiled
from stylobate.compiler.programs import Written
from stylobate.compiler.unit import ArrayArgument
from stylobate.compiler.values import Kind
from stylobate.engine import elementary
from stylobate.engine.equations.expressions import Expression, Recording
from stylobate.engine.equations.recording import recorded
from stylobate.engine.flow import tableau
from stylobate.errors import UnsupportedError
from stylobate.models import Model

_MARK = "# --- the module's text begins here ---"

_IMPORTS = """\
import math

import numpy as np
import numpy.typing as npt

from stylobate.engine.elementary import turning_point, winding
from stylobate.engine.flow.tableau import DOP_A, DOP_C, DOP_E3, DOP_E5, Status

Table = npt.NDArray[np.float64]
Vector = npt.NDArray[np.float64]
"""


@cache
def flow_of(model: type[Model], states: int, numbers: int, *, planar: bool) -> Compiled:
    """Return the flow of a class of models with these numbers of states and parameters, three-dimensional or planar.

    Raises
    ------
    UnsupportedError
        If the equations cannot be differentiated.
    """
    rates = model.planar_rates if planar else model.rates
    if rates is None:
        message = f"model {model.name} has no equations of planar motion"
        raise UnsupportedError(message)
    functions: dict[str, Callable[..., Any]] = (
        {"rates": rates} if planar else {"rates": rates, "tilt_of": model.tilt_of}
    )
    loses = planar and model.impact_map is not None
    if loses:
        functions |= {"impact_map": model.impact_map, "from_plane": model.from_plane, "tilt_of": model.tilt_of}  # type: ignore[dict-item]
    given = None if planar else model.jacobian
    if given is not None:
        functions["jacobian"] = given
    kind = "plane" if planar else "space"
    order = 2 if planar else states
    arguments = _Arguments(order, numbers, planar=planar)
    text = "\n\n".join(
        [
            f'"""Written by stylobate {version("stylobate")}: the flow of {model.name} in {kind}."""\n',
            _IMPORTS,
            "\n".join(f"{name} = {value}" for name, value in arguments.constants.items()),
            _rates_source(arguments),
            _given_jacobian(arguments) if given is not None else _jacobian_source(rates, arguments),
            _lean_source(arguments),
            _loss_source(arguments, loses=loses),
            Path(__file__).with_name("pattern.py").read_text(encoding="utf-8").split(_MARK, 1)[1],
        ]
    )
    vector = ArrayArgument((numbers,))
    terms = ArrayArgument((None, 1 + 2 * len(arguments.accelerations)))
    return Compiled(
        name="flow",
        program=Written(text, (elementary, tableau)),
        functions=functions,
        arguments=(
            ArrayArgument((order, order + 2)),
            *[Kind.FLOAT] * 3,
            terms,
            vector,
            ArrayArgument((1 + numbers,)),
            terms,
            ArrayArgument((4,)),
            ArrayArgument((5,)),
        ),
        model=model.name,
        description=f"{model.name}, flow in {kind} with its derivatives",
    )


class _Arguments:
    """Arguments of the equations of a model, by their names in the module."""

    def __init__(self, order: int, numbers: int, *, planar: bool) -> None:
        self.planar = planar
        self.states = [f"y{j}" for j in range(order)]
        self.accelerations = [f"a{j}" for j in range(2 if planar else 3)]
        self.numbers = [f"p{j}" for j in range(numbers)]

    @property
    def all(self) -> list[str]:
        """All arguments in the order of the equations."""
        side = ["side"] if self.planar else []
        return [*self.states, *side, *self.accelerations, *self.numbers]

    @property
    def variables(self) -> list[str]:
        """Arguments with respect to which the equations are differentiated."""
        return [*self.states, *self.accelerations, *self.numbers]

    @property
    def constants(self) -> dict[str, int]:
        """Numbers of states, accelerations and parameters, and whether motion is planar."""
        counts = (len(self.states), len(self.accelerations), len(self.numbers))
        return dict(zip(("ORDER", "ACCELERATIONS", "NUMBERS", "PLANAR"), (*counts, self.planar), strict=True))

    def unpacked(self) -> list[str]:
        """Return lines that unpack the arguments from vectors."""
        groups = (("y", self.states), ("push", self.accelerations), ("numbers", self.numbers))
        return [f"    {name} = {vector}[{j}]" for vector, names in groups for j, name in enumerate(names)]


def _rates_source(arguments: _Arguments) -> str:
    results = ", ".join(f"out[{j}]" for j in range(len(arguments.states)))
    return "\n".join(
        [
            "def rates_into(y, push, side, numbers, out):",
            *arguments.unpacked(),
            f"    {results} = rates({', '.join(arguments.all)})",
        ]
    )


def _jacobian_source(rates: Callable[..., Any], arguments: _Arguments) -> str:
    record = Recording()
    inputs = {name: record.input(name) for name in arguments.all}
    results = [record.known(result) for result in recorded(rates, tuple(inputs.values()))]
    variables: list[Expression] = [inputs[name] for name in arguments.variables]
    table = record.derivatives(results, variables)
    lines, names = record.source([entry for row in table for entry in row])
    columns = len(variables)
    return "\n".join(
        [
            "def jacobian_into(y, push, side, numbers, out):",
            *arguments.unpacked(),
            *(f"    {line}" for line in lines),
            *(f"    out[{k // columns}, {k % columns}] = {name}" for k, name in enumerate(names)),
        ]
    )


def _given_jacobian(arguments: _Arguments) -> str:
    rows, columns = range(len(arguments.states)), range(len(arguments.variables))
    return "\n".join(
        [
            "def jacobian_into(y, push, side, numbers, out):",
            *arguments.unpacked(),
            f"    rows = jacobian({', '.join(arguments.all)})",
            *(f"    out[{i}, {j}] = rows[{i}][{j}]" for i in rows for j in columns),
        ]
    )


def _lean_source(arguments: _Arguments) -> str:
    if arguments.planar:
        body = "y[0], 0.0, y[1], 0.0"
    else:
        states = [f"y[{j}]" for j in range(len(arguments.states))]
        numbers = [f"numbers[{j}]" for j in range(len(arguments.numbers))]
        body = f"tilt_of({', '.join([*states, *numbers])})"
    return f"def lean_of(y, numbers):\n    return {body}"


def _loss_source(arguments: _Arguments, *, loses: bool) -> str:
    if not loses:
        return "def speed_after_passage(rate, numbers):\n    return rate"
    numbers = ", ".join(f"numbers[{j}]" for j in range(len(arguments.numbers)))
    return "\n".join(
        [
            "def speed_after_passage(rate, numbers):",
            f"    state = impact_map(*from_plane(0.0, rate, 1.0, 0.0, {numbers}), {numbers})",
            f"    _, _, vx, _ = tilt_of(*state, {numbers})",
            "    return vx",
        ]
    )
