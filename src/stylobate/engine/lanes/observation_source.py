"""Writes the loop that integrates over the last periods: mean tilt, and the parts that turn with the forcing."""

from collections.abc import Callable

from stylobate.engine.lanes.shape import Shape

GROUP = 8
"""Lanes that are observed together, when one of them is watched."""


def _rates_of_tilt(shape: Shape, at: Callable[[str], str]) -> tuple[str, str]:
    """Return what finds the rates of the tilt at both ends; in a plane it begins at the upright with some speed."""
    if shape.planar:
        return f"rate0 = {at('side')} * {at('vx_before')}", f"rate1 = {at('side')} * {at('vx')}"
    return (
        f"rate0 = {at('radial_before')} / ({at('tilt_before')} + 1e-300)",
        f"rate1 = {at('radial')} / ({at('tilt')} + 1e-300)",
    )


def observation_source(shape: Shape) -> str:
    """Return the source of `observe(buf)`: integrals over the step just made, in the first lanes of a buffer.

    Each is the trapezoidal rule with its end correction, exact for cubics: of the tilt, and of the lean times
    e^{∓2πi t/T}, T being the period of the base motion.
    """
    rows = shape.rows()
    at = rows.at
    body = [
        f"h = {at('made')}",
        f"weight = h * {at('watched')}",
        f"correction = weight * h * {1.0 / 12.0!r}",
        *_rates_of_tilt(shape, at),
        f"{at('mean_tilt')} = {at('mean_tilt')} + 0.5 * weight * ({at('tilt_before')} + {at('tilt')})"
        " + correction * (rate0 - rate1)",
        f"seen = {at('watched')} * abs(h)",
        f"least = {at('late_least')}",
        f"low = {at('low')}",
        f"{at('late_least')} = min(least, low if seen > 0.0 else least)",
        f"w = {at('per_turn')}",
        f"turns1 = w * {at('time')}",
        "turns0 = turns1 - w * h",
        "cos0 = cos_turns(turns0)",
        "sin0 = cos_turns(turns0 - 0.25)",
        "cos1 = cos_turns(turns1)",
        "sin1 = cos_turns(turns1 - 0.25)",
        "w = 6.283185307179586 * w",
    ]
    for end, source in (("0", "_before"), ("1", "")):
        x, y = ("x_before", "y_before") if source else ("x", "y")
        vx, vy = f"vx{source}", f"vy{source}"
        body += [
            f"x{end} = {at(x)}",
            f"y{end} = {at(y)}",
            # Rates of x and y in a frame that turns with the forcing, and in one that turns against it.
            f"fx{end} = {at(vx)} + w * y{end}",
            f"fy{end} = {at(vy)} - w * x{end}",
            f"bx{end} = {at(vx)} - w * y{end}",
            f"by{end} = {at(vy)} + w * x{end}",
        ]
    for name, x, y, sign in (
        ("forward_cos", "x", "y", "+"),
        ("forward_sin", "y", "x", "-"),
        ("backward_cos", "x", "y", "-"),
        ("backward_sin", "y", "x", "+"),
    ):
        frame = name[0]
        values = [f"({x}{e} * cos{e} {sign} {y}{e} * sin{e})" for e in "01"]
        slopes = [f"({frame}{x}{e} * cos{e} {sign} {frame}{y}{e} * sin{e})" for e in "01"]
        body.append(
            f"{at(name)} = {at(name)} + 0.5 * weight * ({values[0]} + {values[1]})"
            f" + correction * ({slopes[0]} - {slopes[1]})"
        )
    head = ["@vectorised", "def observe(buf):", f"    for i in range({GROUP}):"]
    lines = [*head, *(f"        {line}" for line in body)]
    return "\n".join(lines) + "\n"
