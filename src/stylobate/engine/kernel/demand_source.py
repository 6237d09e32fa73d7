"""Writes what follows the loads of the contact: the loop behind a step that finds their extremes within it."""

from collections.abc import Callable

from stylobate.engine.kernel.head_source import contact_call
from stylobate.engine.kernel.layout import Rows
from stylobate.engine.kernel.series_source import polynomial, state_polynomial
from stylobate.engine.kernel.shape import DEMANDS, Shape
from stylobate.engine.kernel.stage_source import combination, vertical

PLACES = 4
"""Equal parts of a step, at the ends of which the loads are looked at."""


def demand_lines(shape: Shape, rows: Rows) -> list[str]:
    """Return the loops: each load at the quarters of the step just made, and two parabolas through three values each.

    Those at its start are kept from the step before. The states within are those of the cubics through the ends, or of
    the series. A loop that evaluated several places would be too long to become vector code.
    """
    loops = [_loads(shape, rows, place) for place in range(1, PLACES + 1)]
    loops.append([f"go = {rows.at('go')}", *(line for name in DEMANDS for line in _extreme(rows.at, name))])
    return [line for body in loops for line in ("    for i in lanes(WIDTH):", *(f"        {text}" for text in body))]


def _loads(shape: Shape, rows: Rows, place: int) -> list[str]:
    """Return what finds the loads at a place of the step."""
    at, share = rows.at, place / PLACES
    state = [_within(shape, at, j, share) for j in range(shape.order)]
    push = ("ah" if shape.planar else "ax", "0.0" if shape.planar else "ay", vertical(shape))
    parameters = [at(f"p{j}") for j in range(shape.parameters)]
    return [
        f"h = {at('made')}",
        f"t = {at('time')}",
        *(f"s{j} = {value}" for j, value in enumerate(state)),
        *shape.forcing.lines(at, f"t - {1.0 - share!r} * h" if place < PLACES else "t"),
        f"load, force, moment = {contact_call(shape, at, [f's{j}' for j in range(shape.order)], parameters, push)}",
        f"per = 1.0 / max(load, {_LEAST!r})",
        f"{at(f'normal_{place}')} = load",
        f"{at(f'friction_{place}')} = force * per",
        f"{at(f'pivoting_{place}')} = moment * per",
    ]


# A normal force below this part of the weight counts as that: the demands are as good as infinite.
_LEAST = 1e-12


def _within(shape: Shape, at: Callable[[str], str], j: int, share: float) -> str:
    """Return a state at this part of the step."""
    if share == 1.0:
        return at(f"y{j}")
    if shape.series:
        return polynomial(state_polynomial(shape, at, j), f"({share!r} * h)")
    values, slopes = cubic_weights(share)
    change = combination(slopes, [at(f"last_slope{j}"), at(f"k0_{j}")])
    return f"{combination(values, [at(f'last{j}'), at(f'y{j}')])} + h * ({change})"


def cubic_weights(share: float) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the weights of values and slopes at the ends of a step of the cubic through them, at this part of it."""
    rest = 1.0 - share
    values = (rest * rest * (1.0 + 2.0 * share), share * share * (3.0 - 2.0 * share))
    return values, (share * rest * rest, -share * share * rest)


def _extreme(at: Callable[[str], str], name: str) -> list[str]:
    """Return what notes the largest value of a load, or the least normal force."""
    row, now = at(name), at(f"{name}_now")
    sign, kept = (-1.0, "min") if name == "normal" else (1.0, "max")
    values = [now, *(at(f"{name}_{place}") for place in range(1, PLACES + 1))]
    out = [f"value{place} = {value}" for place, value in enumerate(values)]
    out.append("top = value0")
    for first in range(0, PLACES, 2):
        start, middle, end = (f"value{first + k}" for k in range(3))
        out += [
            f"bend = {start} - 2.0 * {middle} + {end}",
            f"slant = {end} - {start}",
            # The parabola has its extreme within these two parts, and of the right kind.
            f"inside = 1.0 if abs(slant) < {-2.0 * sign!r} * bend else 0.0",
            f"peak = {middle} - slant * slant / (8.0 * (bend if inside > 0.0 else 1.0))",
            f"peak = peak if inside > 0.0 else {middle}",
            f"top = {kept}({kept}(top, peak), {end})",
        ]
    return [
        *out,
        f"before = {row}",
        f"seen = {kept}(before, top)",
        f"{row} = seen if go > 0.0 else before",
        f"{now} = value{PLACES} if go > 0.0 else value0",
    ]
