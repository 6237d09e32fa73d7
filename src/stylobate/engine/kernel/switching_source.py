"""Writes the step of models that change between kinds of contact.

Their equations are long. They stand once, in a function that all stages call, and so do the guards: states are handed
over in rows. What is done with each state alike is one loop over all states of all lanes, which lie in a block of rows.
"""

from stylobate.engine import dop853
from stylobate.engine.kernel.demand_source import cubic_weights
from stylobate.engine.kernel.judgement_source import judgement
from stylobate.engine.kernel.layout import Rows
from stylobate.engine.kernel.margin_source import margin_call, refreshing_lines
from stylobate.engine.kernel.shape import MARGIN_PLACES, STAGES, Shape
from stylobate.engine.kernel.stage_source import combination, rates_call


def switching_step_source(shape: Shape) -> str:
    """Return the source of `step(buf)`, one attempt at a step in every lane, and of what it calls."""
    rows = shape.rows()
    h = rows.at("h")
    step = ["@fast", "def step(buf):", *over_lanes([f"{rows.at(f'step{j}')} = {h}" for j in range(shape.order)])]
    for stage in range(1, STAGES + 1):
        step += _stage(rows, stage)
    step += _over_block([f"{_block(rows, 'new0')} = {_block(rows, 'stage0')}"])
    for place in range(1, MARGIN_PLACES + 1):
        step += _place(rows, place / MARGIN_PLACES)
    step += judgement(shape, rows)
    step += over_lanes(refreshing_lines(shape, rows))
    return "\n\n\n".join("\n".join(lines) for lines in (_evaluation(shape, rows), _guarding(shape, rows), step)) + "\n"


def over_lanes(body: list[str]) -> list[str]:
    """Return the loop over lanes with this body."""
    return ["    for i in lanes(WIDTH):", *(f"        {line}" for line in body)]


def _evaluation(shape: Shape, rows: Rows) -> list[str]:
    """Return the function that evaluates the equations in all lanes, at this part of the step."""
    at = rows.at
    body = [
        *shape.forcing.lines(at, f"{at('time')} + share * {at('h')}"),
        f"{_names('r', shape.order)} = {rates_call(shape, at, [at(f'stage{j}') for j in range(shape.order)])}",
        *(f"{at(f'rate{j}')} = r{j}" for j in range(shape.order)),
    ]
    return ["@fast", "def evaluate(buf, share):", *over_lanes(body)]


def _guarding(shape: Shape, rows: Rows) -> list[str]:
    """Return the function that marks the lanes in which a margin is broken, or the tilt beyond its limit."""
    at = rows.at
    state = [at(f"stage{j}") for j in range(shape.order)]
    parameters = [at(f"p{j}") for j in range(shape.parameters)]
    last = f"m{shape.guards - 1}"
    body = [
        *shape.forcing.lines(at, f"{at('time')} + share * {at('h')}"),
        f"{_names('m', shape.guards)} = {margin_call(shape, at, state)}",
        f"x, y, _, _ = tilt_of({', '.join([*state, *parameters])})",
        f"least = {at('tilt_limit')} - math.sqrt(x * x + y * y)",
        *(f"least = min(least, m{k})" for k in range(shape.guards - 1)),
        # The last margin counts only where it was above before.
        f"before = {at('margin_now')}",
        f"{at('margin_now')} = {last}",
        f"crossed = (1.0 if {last} < 0.0 else 0.0) * (0.0 if before < 0.0 else 1.0)",
        f"{at('broken')} = max({at('broken')}, max(crossed, 1.0 if least < 0.0 else 0.0))",
    ]
    return ["@fast", "def guard(buf, share):", *over_lanes(body)]


def _stage(rows: Rows, stage: int) -> list[str]:
    """Return the lines of one stage; the last one gives the new state and the slope there."""
    last = stage == STAGES
    fraction = 1.0 if last else float(dop853.C[stage])
    weights = dop853.B if last else dop853.A[stage, :stage]
    total = combination(weights, [_block(rows, f"k{s}_0") for s in range(stage)])
    return [
        *_over_block([f"{_block(rows, 'stage0')} = {_block(rows, 'y0')} + {_block(rows, 'step0')} * ({total})"]),
        f"    evaluate(buf, {fraction!r})",
        *_over_block([f"{_block(rows, f'k{stage}_0')} = {_block(rows, 'rate0')}"]),
    ]


def _place(rows: Rows, share: float) -> list[str]:
    """Return what looks at the guards at a part of the step, on cubics through its ends."""
    values, slopes = cubic_weights(share)
    state = combination(values, [_block(rows, "y0"), _block(rows, "new0")])
    if share < 1.0:
        change = combination(slopes, [_block(rows, "k0_0"), _block(rows, f"k{STAGES}_0")])
        state = f"{state} + {_block(rows, 'step0')} * ({change})"
    return [*_over_block([f"{_block(rows, 'stage0')} = {state}"]), f"    guard(buf, {share!r})"]


def _block(rows: Rows, first: str) -> str:
    """Return the source of number `n` of the block of rows that begins with this one: of all states and lanes."""
    return f"buf[{rows[first]} * WIDTH + n]"


def _over_block(body: list[str]) -> list[str]:
    return ["    for n in lanes(ORDER * WIDTH):", *(f"        {line}" for line in body)]


def _names(letter: str, count: int) -> str:
    return ", ".join(f"{letter}{j}" for j in range(count))
