"""Writes how the functions are called by which a model changes between kinds of contact."""

from collections.abc import Callable, Sequence

from stylobate.engine.kernel.layout import Rows
from stylobate.engine.kernel.shape import Shape
from stylobate.engine.kernel.stage_source import vertical
from stylobate.models import Model


def margin_call(shape: Shape, at: Callable[[str], str], state: Sequence[str]) -> str:
    """Return the call of the model's guards; `at` names a row, `state` are sources of the states."""
    arguments = [
        *state,
        "ax",
        "ay",
        vertical(shape),
        at("rest_energy"),
        *(at(f"p{j}") for j in range(shape.parameters)),
    ]
    return f"guards({', '.join(arguments)})"


def refreshing_lines(shape: Shape, rows: Rows) -> list[str]:
    """Return what brings up to date what a state keeps from step to step, where one was made."""
    at = rows.at
    names = [at(f"{name}{j}") for name, count in (("y", shape.order), ("p", shape.parameters)) for j in range(count)]
    lines = [
        f"go = {at('go')}",
        f"{', '.join(f'r{j}' for j in range(shape.order))} = project({', '.join(names)})",
    ]
    kept = [(f"y{j}", f"r{j}") for j in range(shape.order)]
    kept.append(("last_margin", at("margin_now")))
    for name, new in kept:
        lines += [f"new = {new}", f"old = {at(name)}", f"{at(name)} = new if go > 0.0 else old"]
    return [*lines, f"{at('margin_now')} = {at('last_margin')}", f"{at('broken')} = 0.0"]


def margins_source(shape: Shape, rows: Rows) -> str:
    """Return the source of `margins_at(buf, i, t, state)`, for the driver: the guards, and behind them the limit's."""
    at = rows.of_lane
    state = [f"state[{j}]" for j in range(shape.order)]
    guards = [f"m{k}" for k in range(shape.guards)]
    parameters = ", ".join(at(f"p{j}") for j in range(shape.parameters))
    lines = [
        *shape.forcing.lines(at, "t"),
        f"{', '.join(guards)} = {margin_call(shape, at, state)}",
        f"x, y, _, _ = tilt_of({', '.join(state)}, {parameters})",
        f"return {', '.join(guards)}, {at('tilt_limit')} - math.sqrt(x * x + y * y)",
    ]
    return "\n".join(["def margins_at(buf, i, t, state):", *(f"    {line}" for line in lines)]) + "\n"


_WINDOW_ENDS = (("x", "footprint_x"), ("y", "footprint_y"), ("twist", "twist"))
_WINDOW_TIMES = (("sliding", ("SLIDING",)), ("rim", ("ROLLING", "SLIPPING")), ("flying", ("FLYING",)))


def window_source(model: type[Model], shape: Shape, rows: Rows) -> str:
    """Return the source of `note_window`, for the driver; it does nothing where contacts do not change."""
    lines = ["def note_window(buf, i, t):"]
    if not shape.guards:
        return "\n".join([*lines, "    pass"]) + "\n"
    at = rows.of_lane
    lines += [f"    contact = {at(f'y{shape.order - 1}')}", f"    present = t - {at('since')}"]
    lines.append(f"    {at('window_at')} = t")
    for name, state in _WINDOW_ENDS:
        lines.append(f"    {at(f'window_{name}')} = {at(f'y{model.state_names.index(state)}')}")
    for name, kinds in _WINDOW_TIMES:
        times = " + ".join(f"{at(f'time_{kind.lower()}')} + (present if contact == {kind} else 0.0)" for kind in kinds)
        lines.append(f"    {at(f'window_{name}')} = {times}")
    return "\n".join(lines) + "\n"


def reaction_source(shape: Shape, rows: Rows) -> str:
    """Return the source of `model_react`, for the driver: elapsed time and state behind a broken margin."""
    at = rows.of_lane
    state = ", ".join(at(f"y{j}") for j in range(shape.order))
    parameters = ", ".join(at(f"p{j}") for j in range(shape.parameters))
    after = ", ".join(f"s[{j}]" for j in range(shape.order))
    return f"""\
def model_react(buf, i, number, now, later, ahead):
    ax, ay, az = now
    bx, by, bz = later
    rest = {at("rest_energy")}
    elapsed, s = reset_map({state}, number, ax, ay, az, bx, by, bz, ahead, rest, {parameters})
    return elapsed, ({after})
"""
