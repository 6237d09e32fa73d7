"""Writes the constants of the implicit method, Radau IIA, and the projection of the state of one lane."""

from stylobate.engine import radau
from stylobate.engine.kernel.layout import Rows
from stylobate.engine.kernel.shape import Shape


def implicit_source(shape: Shape, rows: Rows) -> str:
    """Return the source of the coefficients, and of `model_project(buf, i)`."""
    lines = [f"CHANGES = {radau.STAGES * shape.order}"]
    at = rows.of_lane
    names = [at(f"{name}{j}") for name, count in (("y", shape.order), ("p", shape.parameters)) for j in range(count)]
    lines += ["", "", "def model_project(buf, i):", f"    return project({', '.join(names)})"]
    return "\n".join(lines) + "\n"
