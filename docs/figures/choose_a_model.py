"""Measures the table of the page "Choose a model": how long each model takes, and how often it overturns.

Run it with `python docs/figures/choose_a_model.py`; it takes half a minute on one core. One stone column under 200
scales of El Centro 1940 by each model, in turns in one process; the shortest processor time of five rounds counts.
"""

import time
from pathlib import Path

import numpy as np

import stylobate as sb

FOLDER = Path(__file__).parents[1] / "_static" / "choose-a-model"
COLUMN = sb.Column.solid(radius=0.3, height=3.0, density=2700.0)
DAMPING, FRICTION = 0.03, 0.7
SCALES = np.linspace(0.6, 1.4, 200)
ROUNDS = 5


def models() -> dict[str, sb.Model]:
    """Return the models by name, with the same damping."""
    spinning = {"damping": DAMPING, "spin_damping": DAMPING}
    return {
        "Slender": sb.Slender(COLUMN, damping=DAMPING),
        "SlenderRolling": sb.SlenderRolling(COLUMN, **spinning),
        "Wobbling": sb.Wobbling(COLUMN, damping=DAMPING),
        "Rolling": sb.Rolling(COLUMN, **spinning),
        "Sliding": sb.Sliding(COLUMN, friction_coefficient=FRICTION, **spinning),
        "PlanarRocking": sb.PlanarRocking(COLUMN, damping=DAMPING),
    }


def measure() -> list[str]:
    """Return the rows of the table."""
    space = sb.sample_record("el centro 1940")
    planar = type(space).from_components(
        x=space.samples[:, 0], z=space.samples[:, 2], step=space.step
    )
    seconds = dict.fromkeys(models(), np.inf)
    overturned = {}
    for _ in range(ROUNDS):
        for name, model in models().items():
            motion = planar if name == "PlanarRocking" else space
            begun = time.process_time()
            runs = sb.simulate_ensemble(
                model, motion, duration=62.0, parameters={"scale": SCALES}, threads=1
            )
            seconds[name] = min(seconds[name], time.process_time() - begun)
            overturned[name] = float((runs["outcome"] == sb.Outcome.OVERTURNED).mean())
    unit = seconds["Slender"]
    return [
        f"| `{name}` | {seconds[name] / unit:.1f} | {100.0 * overturned[name]:.0f} % |"
        for name in seconds
    ]


if __name__ == "__main__":
    FOLDER.mkdir(parents=True, exist_ok=True)
    lines = ["| model | relative time | overturned |", "|---|---|---|", *measure()]
    (FOLDER / "cost.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")
    print(*lines, sep="\n")
