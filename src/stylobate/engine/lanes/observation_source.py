"""Writes what integrates over the last periods: mean tilt, and the parts that turn with the forcing.

Few lanes are in their last periods at one time. Each is observed by itself, the loop running over the nodes of Gauss's
rule within its step instead of over lanes.
"""

import numpy as np

from stylobate.engine.lanes.layout import Rows
from stylobate.engine.lanes.series_source import polynomial, state_polynomial
from stylobate.engine.lanes.shape import NODES, OBSERVED, SERIES_ORDER, Shape

_PLACES, _WEIGHTS = np.polynomial.legendre.leggauss(NODES)  # on −1 … 1
# What turns with the forcing and against it: row, component along the cosine, along the sine, and the sign of that.
_TURNING = (
    ("forward_cos", "x", "y", "+"),
    ("forward_sin", "y", "x", "-"),
    ("backward_cos", "x", "y", "-"),
    ("backward_sin", "y", "x", "+"),
)


def observation_source(shape: Shape) -> str:
    """Return the source of `observe(buf, i)`: integrals over the step just made in lane `i`.

    They are those of the tilt, and of the lean times e^{∓2πi t/T}, T being the period of the base motion.
    """
    rows = shape.rows()
    at = rows.at
    # Sums would have to be taken in order: products are kept, and added afterwards.
    kept = {name: f"buf[{rows[f'node_{name}']} * WIDTH + node]" for name in OBSERVED}
    lines = [
        "@vectorised",
        "def observe(buf, i):",
        f"    h = {at('made')}",
        f"    w = {at('per_turn')}",
        f"    start = w * ({at('time')} - h)",
        *(f"    p{j} = {at(f'p{j}')}" for j in range(shape.parameters)),
        *(f"    {line}" for line in _terms_of_step(shape, rows)),
        f"    for node in range({NODES}):",
        "        u = PLACES[node]",
        *(f"        s{j} = {_state_within(shape, j)}" for j in range(shape.order)),
        f"        x, y, _, _ = {_lean(shape)}",
        "        turns = start + w * (u * h)",
        "        cos = cos_turns(turns)",
        "        sin = cos_turns(turns - 0.25)",
        "        weight = h * WEIGHTS[node]",
        f"        {kept['mean_tilt']} = weight * math.sqrt(x * x + y * y)",
        *(f"        {kept[name]} = weight * ({a} * cos {sign} {b} * sin)" for name, a, b, sign in _TURNING),
        f"    for node in range({NODES}):",
        *(f"        {at(name)} += {kept[name]}" for name in OBSERVED),
        f"    {at('late_least')} = min({at('late_least')}, {at('low')})",
    ]
    tables = f"PLACES = np.array({(0.5 + 0.5 * _PLACES).tolist()})\nWEIGHTS = np.array({(0.5 * _WEIGHTS).tolist()})\n\n"
    return tables + "\n".join(lines) + "\n"


def _terms_of_step(shape: Shape, rows: Rows) -> list[str]:
    """Return the coefficients, in the part `u` of the step, of the polynomials that tell its states."""
    at = rows.at
    if shape.series:
        out = [f"power{k} = {f'power{k - 1} * h' if k > 1 else 'h'}" for k in range(1, SERIES_ORDER + 2)]
        for j in range(shape.order):
            start, *terms = state_polynomial(shape, at, j)
            out += [f"t{j}_0 = {start}", *(f"t{j}_{k} = power{k} * ({term})" for k, term in enumerate(terms, 1))]
        return out
    out = []
    for j in range(shape.order):  # cubics
        out += [
            f"t{j}_0 = {at(f'last{j}')}",
            f"t{j}_1 = h * {at(f'last_slope{j}')}",
            f"rise = {at(f'y{j}')} - t{j}_0",
            f"end = h * {at(f'k0_{j}')}",
            f"t{j}_2 = 3.0 * rise - 2.0 * t{j}_1 - end",
            f"t{j}_3 = t{j}_1 + end - 2.0 * rise",
        ]
    return out


def _state_within(shape: Shape, j: int) -> str:
    degree = shape.degree(j) if shape.series and j in shape.expanded else SERIES_ORDER if shape.series else 3
    return polynomial([f"t{j}_{k}" for k in range(degree + 1)], "u")


def _lean(shape: Shape) -> str:
    if shape.planar:
        return "s0, 0.0, s1, 0.0"
    return f"lean({', '.join([*(f's{j}' for j in range(shape.order)), *(f'p{j}' for j in range(shape.parameters))])})"
