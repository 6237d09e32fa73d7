"""Writes the head of a kernel: constants, and the model's functions as the driver calls them."""

from collections.abc import Callable, Mapping, Sequence

from stylobate.engine.kernel.series_source import polynomial, state_polynomial
from stylobate.engine.kernel.shape import SERIES_ORDER, Shape
from stylobate.models import Model

OPTIONAL = ("rest_energy", "no_return_tilt", "departure", "passage", "at_rest", "impact_map")
"""Functions that a model may lack."""

SWITCHING = ("guards", "reset_map", "project")
"""Functions of a model that changes between kinds of contact."""


# A tilt that is none and yet has a side.
_ASIDE = 1e-140


def constants_source(model: type[Model], shape: Shape, has: Mapping[str, bool], *, to_plane: bool) -> str:
    """Return the source of the constants; `has` tells which functions the model gives."""
    values = {
        "WIDTH": shape.width,
        "ORDER": shape.order,
        "PARAMETERS": shape.parameters,
        "PLANAR": shape.planar,
        "SERIES": SERIES_ORDER if shape.series else 0,
        "VERTICAL": "az" in shape.forcing.components,
        "PARAMETERS_AT": shape.parameters_at,
        "MOTION_AT": shape.motion_at,
        "BREAKS_AT": shape.breaks_at,
        "TRACE_ROOM": shape.trace_room,
        "KEPT_STATES": shape.kept,
        "TRACE_STATES": max(shape.states, 2),
        "TRACE_WIDTH": shape.trace_width,
        "CAN_REST": has["rest_energy"],
        "CAN_DEPART": has["departure"],
        "CAN_PASS": has["passage"] and not shape.planar,
        "CAN_PROVE_NO_RETURN": has["no_return_tilt"],
        "CAN_GO_TO_PLANE": to_plane,
        "CAN_LOSE": has["impact_map"],
        "DEMANDS": shape.demands,
        "KEPT": shape.order + len(shape.changes),
        **shape.forcing.constants(shape.rows()),
        **(_contact_constants(model, shape) if shape.guards else {}),
    }
    return "".join(f"{name} = {value!r}\n" for name, value in values.items())


def _contact_constants(model: type[Model], shape: Shape) -> dict[str, float]:
    """Return numbers of guards and of kinds of contact, and parts of a step; the limit of the tilt is a margin too."""
    assert model.contact_kinds is not None
    names = model.guard_names
    return {
        "GUARDS": shape.guards,
        "FALLEN": names.index("fallen"),
        "FRICTION": names.index("friction"),
        "JAM": names.index("jam"),
        **dict(zip(("SLIP_X", "SLIP_Y"), shape.slip, strict=True)),
        "LAST": shape.guards - 1,
        "LIMIT": shape.guards,
        **{kind.name: kind.value for kind in model.contact_kinds},
    }


def model_source(shape: Shape, has: Mapping[str, bool]) -> str:
    """Return the source of the functions through which the driver calls the model for one lane."""
    rows = shape.rows()
    parameters = [rows.of_lane(f"p{j}") for j in range(shape.parameters)]
    state, new = ([rows.of_lane(f"{name}{j}") for j in range(shape.order)] for name in ("y", "new"))

    def call(name: str, *arguments: str) -> str:
        return f"{name}({', '.join([*arguments, *parameters])})"

    nothing = f"({'0.0, ' * shape.order})"
    definitions = {
        "row_state(buf, i, row)": "(" + "".join(f"buf[row + {j}, i], " for j in range(shape.order)) + ")",
        "series_within(buf, i, elapsed)": _series_within(shape),
        "model_lean(buf, i)": _plane_lean(state) if shape.planar else call("tilt_of", *state),
        "lean_of_new(buf, i)": _plane_lean(new) if shape.planar else call("tilt_of", *new),
        "model_rest_energy(buf, i, tilt, speed, az)": call("rest_energy", "tilt", "speed", "az")
        if has["rest_energy"]
        else "math.inf",
        "model_no_return(buf, i, largest, least)": call("no_return_tilt", "largest", "least")
        if has["no_return_tilt"]
        else "math.inf",
        "model_passage(buf, i, ax, ay, az)": call("passage", *state, "ax", "ay", "az")
        if has["passage"] and not shape.planar
        else f"(0.0, {nothing})",
        "model_at_rest(buf, i)": call("at_rest", *state) if has["at_rest"] and not shape.planar else nothing,
    }
    if not has["impact_map"]:
        definitions["model_struck(buf, i)"] = nothing
    elif not shape.planar:
        definitions["model_struck(buf, i)"] = call("impact_map", *state)
    definitions["model_contact(buf, i, ax, ay, az)"] = contact_call(
        shape, rows.of_lane, state, parameters, ("ax", "ay", "az")
    )
    if not has["departure"]:
        definitions["model_departure(buf, i, push, elapsed, ux, uy)"] = nothing
    elif not shape.planar:
        definitions["model_departure(buf, i, push, elapsed, ux, uy)"] = call("departure", "push", "elapsed")
    source = "\n\n".join(f"def {name}:\n    return {value}" for name, value in definitions.items()) + "\n"
    if has["departure"] and shape.planar:
        source += _plane_departure(call("departure", "push", "elapsed"), parameters)
    if has["impact_map"] and shape.planar:
        source += _plane_struck(state, parameters)
    return source


def contact_call(
    shape: Shape, at: Callable[[str], str], state: Sequence[str], parameters: Sequence[str], push: tuple[str, str, str]
) -> str:
    """Return the call of what tells the loads of the contact, or numbers that stand for none; `at` names a row."""
    if not shape.demands:
        return "(1.0, 0.0, 0.0)"
    numbers = ", ".join(parameters)
    # At the upright itself the column stands on the edge of the side to which it goes.
    tilt = f"{state[0]} + {_ASIDE!r} * {at('side')}"
    moving = f"*from_plane({tilt}, {state[1]}, 1.0, 0.0, {numbers})" if shape.planar else ", ".join(state)
    return f"contact({moving}, {', '.join(push)}, {numbers})"


def _series_within(shape: Shape) -> str:
    """Return the state at a time since the step just made began."""
    if not shape.series:
        return f"({'0.0, ' * shape.order})"
    at = shape.rows().of_lane
    polynomials = (polynomial(state_polynomial(shape, at, j), "elapsed") for j in range(shape.order))
    return f"({', '.join(polynomials)})"


def _plane_lean(state: list[str]) -> str:
    return f"({state[0]}, 0.0, {state[1]}, 0.0)"


def _plane_struck(state: list[str], parameters: list[str]) -> str:
    numbers = ", ".join(parameters)
    return f"""

def model_struck(buf, i):
    state = impact_map(*from_plane({state[0]}, {state[1]}, 1.0, 0.0, {numbers}), {numbers})
    x, y, vx, vy = tilt_of(*state, {numbers})
    return (x, vx)
"""


def _plane_departure(departure: str, parameters: list[str]) -> str:
    return f"""

def model_departure(buf, i, push, elapsed, ux, uy):
    state = {departure}
    x, y, vx, vy = tilt_of(*state, {", ".join(parameters)})
    return (x * ux + y * uy, vx * ux + vy * uy)
"""
