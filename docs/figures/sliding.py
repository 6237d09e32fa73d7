"""Draws the figures of the page "Contact that slips, pivots, lifts off and lands" into docs/_static/sliding.

Run it with `python docs/figures/sliding.py`; it takes a minute or two on one core.
"""

import numpy as np
from matplotlib.figure import Figure
from saving import STATIC, save

import stylobate as sb
from stylobate.conveying.figures.slipping_boundary import plot_slipping_boundary

FOLDER = STATIC / "sliding"
COLUMN = sb.Column.dimensionless(slenderness=0.1)
ETA = 0.1


def run() -> Figure:
    """A column let go on a plane of little friction: it rolls, slips, rolls and stands."""
    model = sb.Sliding(COLUMN, friction_coefficient=0.06, damping=0.05)
    found = sb.simulate(model, tilt=(0.05, 0.0), tilt_rate=(0.0, 0.05), duration=30.0)
    print(
        {
            name: value
            for name, value in found.measures.items()
            if name.startswith("time_")
        }
    )
    return sb.plot(found)


def gentle() -> Figure:
    """The paper's steady rolling, whose twist is held, on a base that shakes gently."""
    found = sb.conveying.slipping_boundary(
        sb.Wobbling(COLUMN, damping=ETA, constraint="rubber"),
        sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.0),
        friction_coefficient=np.linspace(0.005, 0.13, 126),
        angular_frequency=np.linspace(0.6, 8.0, 371),
    )
    shown = found.sel(friction_coefficient=[0.03, 0.04, 0.05, 0.06], method="nearest")
    print(shown["rolling_from"].to_numpy(), shown["rolling_to"].to_numpy())
    return plot_slipping_boundary(found, friction_coefficient=[0.03, 0.04, 0.05])


def hard() -> Figure:
    """The same column, free to spin, on a base that shakes hard."""
    found = sb.conveying.slipping_boundary(
        sb.Sliding(COLUMN, damping=ETA, spin_damping=1.0),
        sb.Harmonic.circular(acceleration=0.5, angular_frequency=1.0),
        friction_coefficient=np.linspace(0.005, 0.12, 116),
        angular_frequency=np.linspace(0.8, 8.0, 361),
    )
    shown = found.sel(friction_coefficient=[0.03, 0.05, 0.07, 0.1], method="nearest")
    for name in ("rolling_from", "rolling_to", "slipping_from", "slipping_to"):
        print(name, shown[name].to_numpy())
    return plot_slipping_boundary(found, friction_coefficient=[0.03, 0.05, 0.07])


def start() -> Figure:
    """What begins to move first, over slenderness."""
    found = sb.conveying.start_boundary(
        sb.Sliding(sb.Column.solid(radius=0.5, height=10.0, density=2700.0)),
        slenderness=np.linspace(0.02, 0.8, 313),
        friction_coefficient=[0.1, 0.3, 0.6],
        vertical_ratio=[0.0, 1.0],
    )
    return sb.plot(found)


def drift() -> Figure:
    """A part on an oblique conveyor, over friction and acceleration."""
    part = sb.Column.solid(radius=0.02, height=0.03, density=7800.0)
    found = sb.conveying.drift(
        sb.Sliding(part),
        sb.Harmonic.oblique(acceleration=1.0, angular_frequency=60.0, angle=0.52),
        over={
            "acceleration": np.linspace(1.0, 30.0, 59),
            "friction_coefficient": np.linspace(0.02, 0.6, 30),
        },
    )
    print(found["outcome"].to_series().value_counts())
    return sb.plot(found)


DRAWINGS = (run, gentle, hard, start, drift)

if __name__ == "__main__":
    for drawing in DRAWINGS:
        save(drawing(), FOLDER / f"{drawing.__name__}.png")
