"""Draws the figure of the first example, a column under a recorded earthquake, into docs/_static/home-earthquake.png.

Run it with `python docs/figures/home.py`; it takes seconds.
"""

from matplotlib.figure import Figure
from saving import STATIC, save

import stylobate as sb


def earthquake() -> Figure:
    """The example of the front page: two scales of El Centro 1940."""
    stone = sb.Column.solid(radius=0.3, height=3.0, density=2700.0)  # m, kg/m³
    model = sb.Wobbling(stone, damping=0.03)
    quake = sb.sample_record("el centro 1940")
    runs = [sb.simulate(model, quake.scaled(scale)) for scale in (0.8, 1.0)]
    print([run.outcome.name for run in runs])
    return sb.plot(runs, labels=["80 %", "100 %"])


if __name__ == "__main__":
    save(earthquake(), STATIC / "home-earthquake.png")
