"""Writes how the state within a step of DOP853 is told as accurately as at its end: its dense output, for one lane.

E. Hairer, S. P. Nørsett, G. Wanner, "Solving Ordinary Differential Equations I", 2nd ed., section II.6: a polynomial of
order 7, from three stages more.
"""

from stylobate.engine import dop853
from stylobate.engine.kernel.layout import Rows
from stylobate.engine.kernel.shape import DENSE_TERMS, STAGES, Shape
from stylobate.engine.kernel.stage_source import combination

_EXTRA = ("extra0_", "extra1_", "extra2_")


def dense_source(shape: Shape, rows: Rows) -> str:
    """Return the source of `set_dense` and `dense_state`.

    `set_dense(buf, i, state, slope, t, h)` sets the polynomial of the step over h from the time t, whose state and
    slope at its start lie in the rows from `state` and `slope` on; `dense_state(buf, i, u)` is the state at the part u
    of the step just tried.
    """
    head = "def set_dense(buf, i, state, slope, t, h):"
    if shape.series:
        return f"{head}\n    pass\n"

    def row(name: str) -> str:
        return f"buf[{rows[f'{name}0']} + j, i]"

    start = "buf[state + j, i]"
    stages = ["buf[slope + j, i]"]
    stages += [row(f"k{stage}_") for stage in range(1, STAGES + 1)] + [row(name) for name in _EXTRA]
    lines = [head]
    made = f"row_state(buf, i, {rows['dense0_0']})"
    for number, (weights, fraction, name) in enumerate(zip(dop853.A_EXTRA, dop853.C_EXTRA, _EXTRA, strict=True)):
        known = STAGES + 1 + number
        lines += [
            "    for j in range(ORDER):",
            f"        {row('dense0_')} = {start} + h * ({combination(weights[:known], stages[:known])})",
            f"    slopes = rates_at(buf, i, t + {float(fraction)!r} * h, {made})",
            "    for j in range(ORDER):",
            f"        {row(name)} = slopes[j]",
        ]
    lines += [
        "    for j in range(ORDER):",
        f"        change = {row('new')} - {start}",
        f"        {row('dense0_')} = change",
        f"        {row('dense1_')} = h * {stages[0]} - change",
        f"        {row('dense2_')} = 2.0 * change - h * ({stages[0]} + {stages[STAGES]})",
        *(f"        {row(f'dense{3 + k}_')} = h * ({combination(d, stages)})" for k, d in enumerate(dop853.D)),
    ]
    if shape.guards:
        lines += ["", "", "def dense_state(buf, i, u):", "    v = 1.0 - u"]
        lines.append(f"    return ({', '.join(_within(rows, j) for j in range(shape.order))})")
    return "\n".join(lines) + "\n"


def _within(rows: Rows, j: int) -> str:
    terms = [rows.of_lane(f"dense{power}_{j}") for power in range(DENSE_TERMS)]
    text = terms[-1]
    for power in reversed(range(DENSE_TERMS - 1)):
        text = f"{terms[power]} + {'v' if power % 2 == 0 else 'u'} * ({text})"
    return f"{rows.of_lane(f'y{j}')} + u * ({text})"
