"""Taylor series of the equations of a model."""

from collections.abc import Iterable
from functools import cache

from stylobate.engine.equations.expressions import Expression, Recording
from stylobate.engine.equations.recording import recorded
from stylobate.engine.equations.series import Series
from stylobate.engine.kernel.shape import SERIES_ORDER, Shape
from stylobate.errors import UnsupportedError
from stylobate.models import Model


class Expansion:
    """Taylor series of the states of a model and of the square of its tilt.

    Variables: coefficient k of state j `s{j}_{k}`, coefficients of the base acceleration `ax_{k}` …, parameters `p{j}`.

    Parameters
    ----------
    model
        The class of the model.
    states, parameters
        Numbers of states and of parameters.
    vertical
        Whether the base moves vertically too.

    Raises
    ------
    UnsupportedError
        If the equations cannot be recorded, or contain operations without a recurrence.
    """

    def __init__(self, model: type[Model], states: int, parameters: int, *, vertical: bool) -> None:
        record = Recording()
        self._names = [f"s{j}" for j in range(states)]
        pushes = ["ax", "ay", *(["az"] if vertical else [])]
        moving = {name: record.input(name) for name in (*self._names, *pushes)}
        numbers = tuple(record.input(f"p{j}") for j in range(parameters))
        state = tuple(moving[name] for name in self._names)
        rates = recorded(model.rates, (*state, *(moving.get(name, 0.0) for name in ("ax", "ay", "az")), *numbers))
        self._rates: list[Expression] = [record.known(rate) for rate in rates]
        x, y, _, _ = recorded(model.tilt_of, (*state, *numbers))
        self._series = Series(record, [*self._rates, record.known(x * x + y * y)], moving)

    @property
    def integrals(self) -> tuple[int, ...]:
        """For each state the state whose rate it is, or itself; its coefficients determine those of both."""
        out = list(range(len(self._names)))
        for j, rate in enumerate(self._rates):
            if rate.name in self._names:
                rate_of = self._names.index(rate.name)
                if out[rate_of] == rate_of and self._rates[rate_of].name not in self._names:
                    out[rate_of] = j
        return tuple(out)

    def coefficient_lines(self, k: int) -> list[str]:
        """Return lines that compute coefficients `k` of rates and square, and the next coefficients of the states."""
        out = self._series.lines(k)
        if k == SERIES_ORDER:
            return out
        integrals = self.integrals
        for j, integral in enumerate(integrals):
            rate = self.rate(j, k)
            if integral != j:
                out.append(f"s{integral}_{k + 2} = {rate} * {1.0 / ((k + 1) * (k + 2))!r}")
                out.append(f"s{j}_{k + 1} = {float(k + 2)!r} * s{integral}_{k + 2}")
            elif j not in (integrals[:j] + integrals[j + 1 :]):
                out.append(f"s{j}_{k + 1} = {rate} * {1.0 / (k + 1)!r}")
        return out

    def rate(self, j: int, k: int) -> str:
        """Return coefficient `k` of the rate of state `j`."""
        return self._series.result(j, k)

    def square(self, k: int) -> str:
        """Return coefficient `k` of the square of the tilt."""
        return self._series.result(len(self._names), k)


@cache
def series_integrals(model: type[Model], states: int, parameters: int, *, vertical: bool) -> tuple[int, ...]:
    """Return the `integrals` of a model's equations.

    Raises
    ------
    UnsupportedError
        If the equations have no series.
    """
    try:
        return Expansion(model, states, parameters, vertical=vertical).integrals
    except UnsupportedError as error:
        message = (
            f"the equations of model {model.name} hold more than sums, products, quotients and square roots, for which "
            "Taylor series are written; use method='dop853'"
        )
        raise UnsupportedError(message) from error


def expand_source(model: type[Model], shape: Shape) -> str:
    """Return the source of `expand(start, pushes, numbers)`, which computes the Taylor coefficients of a step.

    Its arguments are the states at the start of the step, the coefficients of each acceleration component and the
    parameters. Its results are the coefficients of the states, of the rates and of the square of the tilt.

    Raises
    ------
    UnsupportedError
        If a change of values has given the equations another structure than `shape` has.
    """
    vertical = "az" in shape.forcing.components
    expansion = Expansion(model, shape.states, shape.parameters, vertical=vertical)
    if expansion.integrals != shape.series:
        message = (
            f"the equations of model {model.name} have another structure since values that they read have changed; "
            "start again, or use method='dop853'"
        )
        raise UnsupportedError(message)
    states, orders = range(shape.states), range(SERIES_ORDER + 1)
    lines = [f"s{j}_0 = start[{j}]" for j in states]
    lines += [f"s{integral}_1 = s{j}_0" for j, integral in enumerate(shape.series) if integral != j]
    lines += [f"p{j} = numbers[{j}]" for j in range(shape.parameters)]
    lines += [f"{name}_{k} = pushes[{c}][{k}]" for c, name in enumerate(shape.forcing.components) for k in orders]
    for k in orders:
        lines += expansion.coefficient_lines(k)
    degrees = [shape.degree(j) if j in shape.expanded else SERIES_ORDER for j in states]
    results = (
        _nested([f"s{j}_{k}" for k in range(degrees[j] + 1)] for j in states),
        _nested([expansion.rate(j, k) for k in range(SERIES_ORDER)] for j in states),
        f"({', '.join(expansion.square(k) for k in orders)})",
    )
    body = "\n".join(f"    {line}" for line in [*lines, f"return {', '.join(results)}"])
    return f"import math\n\n\ndef expand(start, pushes, numbers):\n{body}\n"


def _nested(rows: Iterable[Iterable[str]]) -> str:
    tuples = (f"({', '.join(row)})" for row in rows)
    return f"({', '.join(tuples)})"
