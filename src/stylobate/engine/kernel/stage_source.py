"""Writes the stages of DOP853 for all lanes, as straight-line source.

E. Hairer, S. P. Nørsett, G. Wanner, "Solving Ordinary Differential Equations I", 2nd ed., section II.5: twelve stages
of order 8, the error estimated from formulas of orders 5 and 3. Written out, a stage is one loop over lanes on scalar
locals, which the compiler turns into vector instructions.
"""

from collections.abc import Callable, Iterable, Sequence

from stylobate.engine import dop853
from stylobate.engine.kernel.layout import Rows
from stylobate.engine.kernel.shape import STAGES, Shape


def vertical(shape: Shape) -> str:
    """Return the source of the vertical acceleration."""
    return "az" if "az" in shape.forcing.components else "0.0"


def rates_call(shape: Shape, at: Callable[[str], str], state: Sequence[str]) -> str:
    """Return the call of the model's right-hand side; `at` names a row, `state` are sources of the states."""
    before = [at("side"), "ah"] if shape.planar else ["ax", "ay"]
    arguments = [*state, *before, vertical(shape)]
    return f"rates({', '.join([*arguments, *(at(f'p{j}') for j in range(shape.parameters))])})"


def combination(coefficients: Iterable[float], names: Iterable[str]) -> str:
    """Return the source of a linear combination, terms with coefficient zero left out."""
    return " + ".join(f"{float(a)!r} * {name}" for a, name in zip(coefficients, names, strict=True) if a != 0.0)


def reciprocal_scales(order: int) -> list[str]:
    """Return what finds 1/scale of each state, by one division for two of them."""
    out = []
    for j in range(0, order, 2):
        if j + 1 < order:
            out.append(f"per_both = 1.0 / (scale{j} * scale{j + 1})")
            out += [f"per_scale{j} = per_both * scale{j + 1}", f"per_scale{j + 1} = per_both * scale{j}"]
        else:
            out.append(f"per_scale{j} = 1.0 / scale{j}")
    return out


def stage_lines(shape: Shape, rows: Rows, stage: int) -> list[str]:
    """Return the loop of one stage; the last one gives the new state and the slope there."""
    last = stage == STAGES
    weights = dop853.B if last else dop853.A[stage, :stage]
    fraction = 1.0 if last else float(dop853.C[stage])
    out = ["    for i in lanes(WIDTH):", f"        h = {rows.at('h')}", f"        t = {rows.at('time')}"]
    for j in range(shape.order):
        total = combination(weights, [rows.at(f"k{s}_{j}") for s in range(stage)])
        out.append(f"        s{j} = {rows.at(f'y{j}')} + h * ({total})")
    if last:  # at the time of the stage before
        out += [f"        {name} = {rows.at(f'end_{name}')}" for name in shape.forcing.components]
    else:
        out += [f"        {line}" for line in shape.forcing.lines(rows.at, f"t + {fraction!r} * h")]
    if stage == STAGES - 1:
        out += [f"        {rows.at(f'end_{name}')} = {name}" for name in shape.forcing.components]
    results = ", ".join(f"r{j}" for j in range(shape.order))
    out.append(f"        {results} = {rates_call(shape, rows.at, [f's{j}' for j in range(shape.order)])}")
    out += [f"        {rows.at(f'k{stage}_{j}')} = r{j}" for j in range(shape.order)]
    if last:
        out += [f"        {rows.at(f'new{j}')} = s{j}" for j in range(shape.order)]
    return out
