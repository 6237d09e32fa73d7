"""Flows of models: their integration, bound to a model and compiled."""

import math
from collections.abc import Callable
from functools import cache
from typing import Any

from stylobate.compiler.compiled import Compiled
from stylobate.compiler.programs import Bound, Written
from stylobate.compiler.unit import ArrayArgument
from stylobate.compiler.values import Kind
from stylobate.engine import dop853, elementary, sums
from stylobate.engine.equations.expressions import Expression, Recording
from stylobate.engine.equations.recording import recorded
from stylobate.engine.flow import integration, status
from stylobate.errors import UnsupportedError
from stylobate.models import Model

_VECTOR = 8
"""Maximum number of floats in a vector of a processor."""


def flow_of(model: type[Model], states: int, numbers: int, *, planar: bool) -> Compiled:
    """Return the flow of a class of models with these numbers of states and parameters, three-dimensional or planar.

    Its first call raises `UnsupportedError` if the equations cannot be differentiated.
    """
    rates = model.planar_rates if planar else model.rates
    if rates is None:
        message = f"model {model.name} has no equations of planar motion"
        raise UnsupportedError(message)
    loses = planar and model.impact_map is not None
    needed = ["impact_map", "from_plane", "tilt_of"] if loses else [] if planar else ["tilt_of"]
    functions: dict[str, Callable[..., Any]] = {"rates": rates, **{name: getattr(model, name) for name in needed}}
    if not planar and model.jacobian is not None:
        functions["jacobian"] = model.jacobian
    return _flow(model, tuple(functions.items()), states, numbers, planar=planar, loses=loses)


@cache
def _flow(
    model: type[Model],
    functions: tuple[tuple[str, Callable[..., Any]], ...],
    states: int,
    numbers: int,
    *,
    planar: bool,
    loses: bool,
) -> Compiled:
    order, accelerations = (2, 2) if planar else (states, 3)
    of_model = dict(functions)

    def jacobian() -> Written | None:
        if "jacobian" in of_model:
            return None
        return Written(_jacobian_source(of_model["rates"], order, accelerations, numbers, planar=planar))

    vector, terms = ArrayArgument((numbers,)), ArrayArgument((None, 1 + 2 * accelerations))
    return Compiled(
        name="flow",
        program=lambda: Bound(
            modules=[integration],
            names={
                "ORDER": order,
                "COLUMNS": columns_of(order),
                "ACCELERATIONS": accelerations,
                "NUMBERS": numbers,
                "PLANAR": planar,
                "LOSES": loses,
            },
            written=jacobian(),
            imported=[dop853, elementary, status, sums],
        ),
        functions=of_model,
        arguments=(
            ArrayArgument((order, columns_of(order))),
            *[Kind.FLOAT] * 3,
            terms,
            vector,
            ArrayArgument((1 + numbers,)),
            terms,
            ArrayArgument((4,)),
            ArrayArgument((5,)),
        ),
        model=model.name,
        description=f"{model.name}, flow in {'plane' if planar else 'space'} with its derivatives",
    )


def columns_of(order: int) -> int:
    """Return the number of columns of state and derivatives in whole vectors."""
    return _VECTOR * math.ceil((order + 2) / _VECTOR)


def _jacobian_source(rates: Callable[..., Any], states: int, accelerations: int, numbers: int, *, planar: bool) -> str:
    """Return the source of `jacobian`, which computes the derivatives of the recorded rates."""
    state = [f"y{j}" for j in range(states)]
    rest = [*(f"a{k}" for k in range(accelerations)), *(f"p{j}" for j in range(numbers))]
    arguments = [*state, *(["side"] if planar else []), *rest]
    record = Recording()
    inputs = {name: record.input(name) for name in arguments}
    results = [record.known(result) for result in recorded(rates, tuple(inputs.values()))]
    variables: list[Expression] = [inputs[name] for name in (*state, *rest)]
    table = record.derivatives(results, variables)
    lines, names = record.source([entry for row in table for entry in row])
    columns = len(variables)
    rows = [f"({', '.join(names[i * columns : (i + 1) * columns])})" for i in range(states)]
    body = "\n".join(f"    {line}" for line in [*lines, f"return {', '.join(rows)}"])
    return f"import math\n\n\ndef jacobian({', '.join(arguments)}):\n{body}\n"
