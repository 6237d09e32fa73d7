"""Draws the rooms of the package and the way imports run, from the contract in pyproject.toml.

Run it with `python docs/figures/architecture.py`; it writes docs/_static/architecture/rooms.png.
"""

import tomllib
from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from saving import save

ROOT = Path(__file__).parents[2]
TARGET = ROOT / "docs" / "_static" / "architecture" / "rooms.png"
DUTIES = {
    "cli": "the program stylobate: commands, and those of declared studies",
    "lab": "the laboratory: a local server and its page",
    "paper": "the source paper checked",
    "earthquakes": "records, fragility, assessment",
    "conveying": "slip, lift-off, transport",
    "plots": "figures of results; nothing is computed here",
    "studies": "maps, responses, model hierarchy, sweeps of many runs",
    "orbits": "exact periodic orbits, continuation, bifurcations",
    "practice": "rules of practice",
    "records": "files of records, measures, synthesis",
    "engine": "integration: runs, ensembles",
    "theory": "closed forms",
    "config": "files, options and provenance to objects",
    "provenance": "objects to plain values",
    "parameter_quantities": "what studies vary",
    "run_arguments": "the arguments of a run, each declared once",
    "models": "equations of motion",
    "base_motions": "acceleration of the base",
    "results": "what computations return; saving and loading",
    "column": "geometry, inertia, gravity",
    "liquids": "liquid in a tank as masses",
    "mass_properties": "mass, centre, inertia of joined bodies",
    "quantities": "the declaration of a number: symbol, unit, bounds",
    "compiler": "plain Python functions of numbers to machine code",
    "kinds": "names of classes in files",
    "files": "files written whole",
    "processes": "worker processes",
    "equality": "equality by content",
    "progress": "bars of long computations",
    "errors": "exceptions, checks, outcomes",
    "elementwise": "numbers or arrays",
    "text": "plurals, digits",
    "cards": "objects in notebooks",
    "units": "1.2 mm, 25°",
}


def layers() -> list[list[str]]:
    """Return the rooms of each layer, the highest first."""
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))[
        "tool"
    ]["importlinter"]["contracts"]
    (found,) = (one["layers"] for one in contracts if one["type"] == "layers")
    return [
        [room.strip() for room in layer.split("|")]
        for layer in found
        if layer != "__main__"
    ]


def draw() -> Figure:
    """Return the figure: one row for each layer; imports run downwards."""
    rows = layers()
    figure = Figure(figsize=(7.2, 0.42 * len(rows) + 0.2))
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set(xlim=(0.0, 100.0), ylim=(-0.1, len(rows)))
    axes.axis("off")
    for place, row in enumerate(rows):
        width, y = 94.0 / len(row), len(rows) - 1.0 - place
        for column, room in enumerate(row):
            x = 1.0 + column * width
            axes.add_patch(
                Rectangle(
                    (x, y + 0.08),
                    width - 1.0,
                    0.84,
                    facecolor="#eef2f7",
                    edgecolor="#8792a2",
                    lw=0.7,
                )
            )
            alone = len(row) == 1
            axes.text(
                x + 1.5,
                y + (0.5 if alone else 0.68),
                room,
                size=8.5,
                weight="bold",
                va="center",
            )
            at = (x + 18.0, y + 0.5) if alone else (x + 1.5, y + 0.3)
            axes.text(*at, DUTIES[room], size=7.5, va="center", color="#3c4856")
    axes.annotate(
        "",
        (96.5, 0.1),
        (96.5, len(rows) - 0.1),
        arrowprops={"arrowstyle": "-|>", "color": "#5d6b7d"},
    )
    axes.text(
        98.3,
        len(rows) / 2,
        "imports",
        rotation=90,
        size=9,
        ha="center",
        va="center",
        color="#5d6b7d",
    )
    return figure


if __name__ == "__main__":
    save(draw(), TARGET)
