"""Writes what tells how near a step of DOP853 is to the boundary of its stability, for one lane.

E. Hairer, G. Wanner, "Solving Ordinary Differential Equations II", section IV.2: hλ from the slopes of the two last
stages, which belong to states at one time.
"""

from stylobate.engine import dop853
from stylobate.engine.kernel.layout import Rows
from stylobate.engine.kernel.shape import STAGES, Shape
from stylobate.engine.kernel.stage_source import combination


def stability_source(shape: Shape, rows: Rows) -> str:
    """Return the source of `stability(buf, i)`, hλ of the step just made; its slopes lie in the rows of its stages."""

    def row(name: str) -> str:
        return f"buf[{rows[f'{name}0']} + j, i]"

    last = STAGES - 1
    stages = [row("last_slope"), *(row(f"k{stage}_") for stage in range(1, last))]
    lines = [
        f"h = {rows.of_lane('made')}",
        "apart, change = 0.0, 0.0",
        "for j in range(ORDER):",
        f"    step = {row('new')} - {row('last')} - h * ({combination(dop853.A[last, :last], stages)})",
        f"    turned = {row(f'k{STAGES}_')} - {row(f'k{last}_')}",
        "    apart += step * step",
        "    change += turned * turned",
        "return h * math.sqrt(change / apart) if apart > 0.0 else 0.0",
    ]
    assert shape.guards
    return "\n".join(["def stability(buf, i):", *(f"    {line}" for line in lines)]) + "\n"
