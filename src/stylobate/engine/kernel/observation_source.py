"""Writes what integrates over the last periods: mean tilt, and the parts that turn with the forcing.

Few lanes are in their last periods at one time. Each is observed by itself; where steps are made by series, which are
long, a loop runs over the nodes of Gauss's rule within the step.
"""

import numpy as np

from stylobate.engine.kernel.layout import Rows
from stylobate.engine.kernel.series_source import polynomial, state_polynomial
from stylobate.engine.kernel.shape import NODES, OBSERVED, SERIES_ORDER, Shape

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
    lines = [
        "@fast",
        "def observe(buf, i):",
        f"    h = {at('made')}",
        f"    w = {at('per_turn')}",
        f"    start = w * ({at('time')} - h)",
        *(f"    p{j} = {at(f'p{j}')}" for j in range(shape.parameters)),
        *(f"    {line}" for line in (_by_nodes(shape, rows) if shape.series else _by_ends(shape, rows))),
        f"    {at('late_least')} = min({at('late_least')}, {at('low')})",
    ]
    tables = f"PLACES = np.array({(0.5 + 0.5 * _PLACES).tolist()})\nWEIGHTS = np.array({(0.5 * _WEIGHTS).tolist()})\n\n"
    return tables + "\n".join(lines) + "\n"


def _by_nodes(shape: Shape, rows: Rows) -> list[str]:
    """Return what integrates by Gauss's rule, the states at its nodes being those of the step's series."""
    # Sums would have to be taken in order: products are kept, and added afterwards.
    kept = {name: f"buf[{rows[f'node_{name}']} * WIDTH + node]" for name in OBSERVED}
    out = _terms_of_step(shape, rows)
    out += [
        f"for node in lanes({NODES}):",
        "    u = PLACES[node]",
        *(f"    s{j} = {_state_within(shape, j)}" for j in range(shape.order)),
        f"    x, y, _, _ = {_lean(shape, [f's{j}' for j in range(shape.order)])}",
        "    turns = start + w * (u * h)",
        "    cos = cos_turns(turns)",
        "    sin = cos_turns(turns - 0.25)",
        "    weight = h * WEIGHTS[node]",
        f"    {kept['mean_tilt']} = weight * math.sqrt(x * x + y * y)",
        *(f"    {kept[name]} = weight * ({a} * cos {sign} {b} * sin)" for name, a, b, sign in _TURNING),
        f"for node in range({NODES}):",
        *(f"    {rows.at(name)} += {kept[name]}" for name in OBSERVED),
    ]
    return out


def _by_ends(shape: Shape, rows: Rows) -> list[str]:
    """Return what integrates by the trapezoidal rule with its end correction, exact for cubics.

    Tilt and lean are those in a frame that turns with the forcing, or against it, where steady rolling stands still.
    """
    at = rows.at
    out = ["weight = 0.5 * h", f"correction = h * h * {1.0 / 12.0!r}", "turning = 6.283185307179586 * w"]
    for end, name, turns in (("0", "last", "start"), ("1", "y", "start + w * h")):
        x, y, vx, vy = (f"{part}{end}" for part in ("x", "y", "vx", "vy"))
        state = [at(f"{name}{j}") for j in range(shape.order)]
        out += [
            f"{x}, {y}, {vx}, {vy} = {_lean(shape, state)}",
            f"cos{end} = cos_turns({turns})",
            f"sin{end} = cos_turns({turns} - 0.25)",
            f"tilt{end} = math.sqrt({x} * {x} + {y} * {y})",
            # In a plane a tilt begins at the upright with some speed.
            f"rate{end} = {at('side')} * {vx}"
            if shape.planar
            else f"rate{end} = ({x} * {vx} + {y} * {vy}) / (tilt{end} + 1e-300)",
            f"fx{end} = {vx} + turning * {y}",
            f"fy{end} = {vy} - turning * {x}",
            f"bx{end} = {vx} - turning * {y}",
            f"by{end} = {vy} + turning * {x}",
        ]
    out.append(f"{at('mean_tilt')} += weight * (tilt0 + tilt1) + correction * (rate0 - rate1)")
    for name, a, b, sign in _TURNING:
        frame = name[0]
        values = [f"({a}{e} * cos{e} {sign} {b}{e} * sin{e})" for e in "01"]
        slopes = [f"({frame}{a}{e} * cos{e} {sign} {frame}{b}{e} * sin{e})" for e in "01"]
        out.append(f"{at(name)} += weight * ({values[0]} + {values[1]}) + correction * ({slopes[0]} - {slopes[1]})")
    return out


def _terms_of_step(shape: Shape, rows: Rows) -> list[str]:
    """Return the coefficients, in the part `u` of the step, of the polynomials that tell its states."""
    out = [f"power{k} = {f'power{k - 1} * h' if k > 1 else 'h'}" for k in range(1, SERIES_ORDER + 2)]
    for j in range(shape.order):
        start, *terms = state_polynomial(shape, rows.at, j)
        out += [f"t{j}_0 = {start}", *(f"t{j}_{k} = power{k} * ({term})" for k, term in enumerate(terms, 1))]
    return out


def _state_within(shape: Shape, j: int) -> str:
    degree = shape.degree(j) if j in shape.expanded else SERIES_ORDER
    return polynomial([f"t{j}_{k}" for k in range(degree + 1)], "u")


def _lean(shape: Shape, state: list[str]) -> str:
    if shape.planar:
        return f"{state[0]}, 0.0, {state[1]}, 0.0"
    return f"tilt_of({', '.join([*state, *(f'p{j}' for j in range(shape.parameters))])})"
