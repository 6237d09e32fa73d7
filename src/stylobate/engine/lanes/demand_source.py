"""Writes what follows the loads of the contact: the loop behind a step that finds their extremes within it."""

from collections.abc import Callable

from stylobate.engine.lanes.head_source import contact_call
from stylobate.engine.lanes.layout import Rows
from stylobate.engine.lanes.series_source import polynomial, state_polynomial
from stylobate.engine.lanes.shape import Shape
from stylobate.engine.lanes.stage_source import vertical


def demand_lines(shape: Shape, rows: Rows) -> list[str]:
    """Return the loop: each load at the middle and the end of the step just made, and parabolas through three values.

    Those at its start are kept from the step before. The state in the middle is that of the cubics through the ends, or
    of the series.
    """
    at = rows.at
    parameters = [at(f"p{j}") for j in range(shape.parameters)]
    body = [f"h = {at('made')}", f"t = {at('time')}", f"go = {at('go')}"]
    body += [f"m{j} = {_middle(shape, at, j)}" for j in range(shape.order)]
    for name, state, time in (
        ("1", [f"m{j}" for j in range(shape.order)], "t - 0.5 * h"),
        ("2", [at(f"y{j}") for j in range(shape.order)], "t"),
    ):
        body += shape.forcing.lines(at, time)
        push = ("ah", "0.0", vertical(shape)) if shape.planar else ("ax", "ay", vertical(shape))
        body += [
            f"normal{name}, force, moment = {contact_call(shape, at, state, parameters, push)}",
            f"per = 1.0 / max(normal{name}, {_LEAST!r})",
            f"friction{name} = force * per",
            f"pivoting{name} = moment * per",
        ]
    for name, sign in (("normal", -1.0), ("friction", 1.0), ("pivoting", 1.0)):
        body += _extreme(at, name, sign)
    return ["    for i in range(WIDTH):", *(f"        {line}" for line in body)]


# A normal force below this part of the weight counts as that: the demands are as good as infinite.
_LEAST = 1e-12


def _middle(shape: Shape, at: Callable[[str], str], j: int) -> str:
    if shape.series:
        return polynomial(state_polynomial(shape, at, j), "(0.5 * h)")
    ends = f"0.5 * ({at(f'last{j}')} + {at(f'y{j}')})"
    return f"{ends} + 0.125 * h * ({at(f'last_slope{j}')} - {at(f'k0_{j}')})"


def _extreme(at: Callable[[str], str], name: str, sign: float) -> list[str]:
    """Return what notes the largest value of a load, or with `sign` −1 the least one."""
    row, now = at(name), at(f"{name}_now")
    kept = "max" if sign > 0.0 else "min"
    return [
        f"start = {now}",
        f"end = {name}2",
        f"bend = start - 2.0 * {name}1 + end",
        "slant = end - start",
        # The parabola has its extreme within the step, and of the right kind.
        f"inside = 1.0 if abs(slant) < {-2.0 * sign!r} * bend else 0.0",
        f"top = {name}1 - slant * slant / (8.0 * (bend if inside > 0.0 else 1.0))",
        f"top = top if inside > 0.0 else {name}1",
        f"top = {kept}(top, {kept}(start, end))",
        f"before = {row}",
        f"seen = {kept}(before, top)",
        f"{row} = seen if go > 0.0 else before",
        f"{now} = end if go > 0.0 else start",
    ]
