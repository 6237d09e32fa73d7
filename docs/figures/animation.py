"""Draws the moving pictures of the page "Pictures that move" into docs/_static/animation.

Run it with `python docs/figures/animation.py`; it takes a minute or so on one core.
"""

from collections.abc import Callable
from pathlib import Path

import numpy as np

import stylobate as sb

FOLDER = Path(__file__).parents[1] / "_static" / "animation"
SHOWN = {"size": (520, 400), "frames_per_second": 18}


def temple() -> sb.plots.Animation:
    """A temple column shaken by the record of El Centro, made half as strong again."""
    column = sb.Column.frustum(radius=0.45, top_radius=0.36, height=4.6, density=2600.0)
    quake = 1.5 * sb.sample_record("el centro 1940")
    run = sb.simulate(sb.Wobbling(column, damping=0.03), quake, duration=16.0)
    return sb.animate(run, speed=2.0, **SHOWN)


def rolling() -> sb.plots.Animation:
    """A slim column on a base that moves in a circle rolls round its rim, and turns the other way about its axis."""
    column = sb.Column.solid(radius=0.1, height=1.6, density=2700.0)
    circle = sb.Harmonic.circular(acceleration=0.9, angular_frequency=5.5)
    model = sb.Rolling(column, damping=0.1, spin_damping=0.1)
    run = sb.simulate(model, circle, tilt=(0.05, 0.0), tilt_rate=(0.0, 0.25), duration=8.0)
    return sb.animate(run, **SHOWN)


def coin() -> sb.plots.Animation:
    """A disc let go on its rim wobbles faster the lower it comes."""
    disc = sb.Column.solid(radius=0.04, height=0.008, density=8000.0)
    run = sb.simulate(sb.Rolling(disc, rolling_resistance=0.02), tilt=(0.6, 0.0), tilt_rate=(0.0, 8.0), duration=2.0)
    return sb.animate(run, speed=0.3, **SHOWN)


def part() -> sb.plots.Animation:
    """A part that was set down askew walks along a conveyor."""
    body = sb.Column.solid(radius=0.02, height=0.03, density=7800.0)
    oblique = sb.Harmonic.oblique(acceleration=14.0, angular_frequency=60.0, angle=0.52)
    model = sb.Sliding(body, friction_coefficient=0.3, normal_restitution=0.3)
    run = sb.simulate(model, oblique, tilt=(-0.5, 0.2), spin=8.0, duration=1.2)
    return sb.animate(run, speed=0.2, **SHOWN)


DRAWINGS: tuple[Callable[[], sb.plots.Animation], ...] = (temple, rolling, coin, part)

if __name__ == "__main__":
    FOLDER.mkdir(parents=True, exist_ok=True)
    for drawing in DRAWINGS:
        drawn = drawing()
        path = drawn.save(FOLDER / f"{drawing.__name__}.gif")
        tilt = np.hypot(*drawn.motion.tilt.T).max() / drawn.motion.shape.slenderness
        print(f"{drawn!r}, up to {tilt:.2f} c, {path.stat().st_size / 1e6:.2f} MB")
