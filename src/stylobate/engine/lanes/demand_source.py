"""Writes what follows the loads of the contact: the loop behind a step that finds their extremes within it."""

from collections.abc import Callable

from stylobate.engine.lanes.head_source import contact_call
from stylobate.engine.lanes.layout import Rows
from stylobate.engine.lanes.series_source import polynomial, state_polynomial
from stylobate.engine.lanes.shape import DEMANDS, Shape
from stylobate.engine.lanes.stage_source import vertical


def demand_lines(shape: Shape, rows: Rows) -> list[str]:
    """Return the loops: each load at the middle and the end of the step just made, and parabolas through three values.

    Those at its start are kept from the step before. The state in the middle is that of the cubics through the ends, or
    of the series. A loop that evaluated both places would be too long to become vector code.
    """
    at = rows.at
    places = (
        ("middle", [_middle(shape, at, j) for j in range(shape.order)], "t - 0.5 * h"),
        ("end", [at(f"y{j}") for j in range(shape.order)], "t"),
    )
    loops = [_loads(shape, rows, *place) for place in places]
    loops.append([f"go = {at('go')}", *(line for name in DEMANDS for line in _extreme(at, name))])
    return [line for body in loops for line in ("    for i in range(WIDTH):", *(f"        {text}" for text in body))]


def _loads(shape: Shape, rows: Rows, place: str, state: list[str], time: str) -> list[str]:
    """Return what finds the loads at a place of the step."""
    at = rows.at
    push = ("ah" if shape.planar else "ax", "0.0" if shape.planar else "ay", vertical(shape))
    parameters = [at(f"p{j}") for j in range(shape.parameters)]
    return [
        f"h = {at('made')}",
        f"t = {at('time')}",
        *(f"s{j} = {value}" for j, value in enumerate(state)),
        *shape.forcing.lines(at, time),
        f"load, force, moment = {contact_call(shape, at, [f's{j}' for j in range(shape.order)], parameters, push)}",
        f"per = 1.0 / max(load, {_LEAST!r})",
        f"{at(f'normal_{place}')} = load",
        f"{at(f'friction_{place}')} = force * per",
        f"{at(f'pivoting_{place}')} = moment * per",
    ]


# A normal force below this part of the weight counts as that: the demands are as good as infinite.
_LEAST = 1e-12


def _middle(shape: Shape, at: Callable[[str], str], j: int) -> str:
    if shape.series:
        return polynomial(state_polynomial(shape, at, j), "(0.5 * h)")
    ends = f"0.5 * ({at(f'last{j}')} + {at(f'y{j}')})"
    return f"{ends} + 0.125 * h * ({at(f'last_slope{j}')} - {at(f'k0_{j}')})"


def _extreme(at: Callable[[str], str], name: str) -> list[str]:
    """Return what notes the largest value of a load, or the least normal force."""
    row, now = at(name), at(f"{name}_now")
    sign, kept = (-1.0, "min") if name == "normal" else (1.0, "max")
    return [
        f"start = {now}",
        f"middle = {at(f'{name}_middle')}",
        f"end = {at(f'{name}_end')}",
        "bend = start - 2.0 * middle + end",
        "slant = end - start",
        # The parabola has its extreme within the step, and of the right kind.
        f"inside = 1.0 if abs(slant) < {-2.0 * sign!r} * bend else 0.0",
        "top = middle - slant * slant / (8.0 * (bend if inside > 0.0 else 1.0))",
        "top = top if inside > 0.0 else middle",
        f"top = {kept}(top, {kept}(start, end))",
        f"before = {row}",
        f"seen = {kept}(before, top)",
        f"{row} = seen if go > 0.0 else before",
        f"{now} = end if go > 0.0 else start",
    ]
