"""Writes the constants of the implicit method, Radau IIA, and the projection of the state of one lane."""

from stylobate.engine import radau
from stylobate.engine.lanes.layout import Rows
from stylobate.engine.lanes.shape import Shape


def implicit_source(shape: Shape, rows: Rows) -> str:
    """Return the source of the coefficients, and of `model_project(buf, i)`."""
    tables = {
        "RADAU_NODES": radau.NODES,
        "RADAU_SLOPES": radau.SLOPES,
        "RADAU_EIGENVECTOR": radau.EIGENVECTOR,
        "RADAU_ERROR": radau.ERROR,
    }
    lines = [f"RADAU_STAGES, CHANGES = {radau.STAGES}, {radau.STAGES * shape.order}"]
    lines += [f"{name} = np.array({values!r})" for name, values in tables.items()]
    at = rows.of_lane
    names = [at(f"{name}{j}") for name, count in (("y", shape.order), ("p", shape.parameters)) for j in range(count)]
    lines += ["", "", "def model_project(buf, i):", f"    return project({', '.join(names)})"]
    return "\n".join(lines) + "\n"
