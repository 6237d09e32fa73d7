"""Writes the functions of a kernel that integrate: a step of all lanes, and the equations of one lane."""

from stylobate.engine.kernel.demand_source import demand_lines
from stylobate.engine.kernel.expansion import expansion_of
from stylobate.engine.kernel.judgement_source import judgement
from stylobate.engine.kernel.series_source import series_lines
from stylobate.engine.kernel.shape import STAGES, Shape
from stylobate.engine.kernel.stage_source import rates_call, stage_lines, vertical
from stylobate.engine.kernel.switching_source import switching_step_source
from stylobate.models import Model


def step_source(model: type[Model], shape: Shape) -> str:
    """Return the source of `step(buf)`, one attempt at a step in every lane."""
    if shape.guards:
        return switching_step_source(shape)
    rows = shape.rows()
    lines = ["@fast", "def step(buf):"]
    if shape.series:
        lines += series_lines(shape, rows, expansion_of(model, shape))
    else:
        for stage in range(1, STAGES + 1):
            lines += stage_lines(shape, rows, stage)
    lines += judgement(shape, rows)
    if shape.demands:
        lines += demand_lines(shape, rows)
    return "\n".join(lines) + "\n"


def accelerations_source(shape: Shape) -> str:
    """Return the source of `accelerations(buf, i, t)`, for the driver: horizontal x, y and vertical [g]."""
    rows = shape.rows()
    lines = ["def accelerations(buf, i, t):"]
    lines += [f"    {line}" for line in shape.forcing.lines(rows.of_lane, "t")]
    horizontal = "ah, 0.0" if shape.planar else "ax, ay"
    lines.append(f"    return {horizontal}, {vertical(shape)}")
    return "\n".join(lines) + "\n"


def rates_source(shape: Shape) -> str:
    """Return the source of `rates_at(buf, i, t, state)`, the right-hand side for the driver."""
    rows = shape.rows()
    lines = ["def rates_at(buf, i, t, state):"]
    lines += [f"    {line}" for line in shape.forcing.lines(rows.of_lane, "t")]
    lines.append(f"    return {rates_call(shape, rows.of_lane, [f'state[{j}]' for j in range(shape.order)])}")
    return "\n".join(lines) + "\n"
