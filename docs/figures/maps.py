"""Draws the figures of the page "maps" into docs/_static/maps; takes three minutes on two cores.

Run it with `python docs/figures/maps.py`. The column is that of the paper, c = η = 0.1, in its units.
"""

import numpy as np
import xarray as xr
from saving import STATIC, save

import stylobate as sb

FOLDER = STATIC / "maps"
MODEL = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
BOX = dict.fromkeys(("tilt_x", "tilt_y", "tilt_rate_x", "tilt_rate_y"), (-0.06, 0.06))


def overturning() -> xr.Dataset:
    """Straight-line motion from rest: frequency against amplitude."""
    line = sb.Harmonic.straight(acceleration=1.0, angular_frequency=1.0)
    over = {
        "angular_frequency": np.linspace(0.5, 8.0, 240),
        "acceleration": np.linspace(0.06, 0.6, 200),
    }
    return sb.studies.overturning_map(MODEL, line, over=over, duration=500.0)


def basins() -> xr.Dataset:
    """Starts that lean and do not move, under straight-line motion with a quasi-periodic attractor."""
    line = sb.Harmonic.straight(acceleration=0.09, angular_frequency=4.0)
    axis = np.linspace(-0.105, 0.105, 240)
    return sb.studies.basins(
        MODEL, line, over={"tilt_x": axis, "tilt_y": axis}, periods=400.0
    )


def fractions() -> xr.Dataset:
    """What random starts come to as the amplitude grows."""
    line = sb.Harmonic.straight(acceleration=0.1, angular_frequency=6.0)
    along = {"acceleration": np.linspace(0.02, 0.4, 39)}
    far = sb.studies.AttractorRules(branch_tolerance=2.0)  # as its values are apart
    return sb.studies.basin_fractions(
        MODEL,
        line,
        along=along,
        over=BOX,
        count=1500,
        periods=400.0,
        attractor_rules=far,
    )


def erosion() -> xr.Dataset:
    """How near the vertical the nearest overturning start comes as the amplitude of circular motion grows."""
    circle = sb.Harmonic.circular(acceleration=0.1, angular_frequency=2.0)
    axis = np.linspace(-0.105, 0.105, 43)
    over = {
        "tilt_x": axis,
        "tilt_y": axis,
        "start_phase": np.linspace(0.0, 2.0 * np.pi, 8, endpoint=False),
    }
    along = {"acceleration": np.linspace(0.0, 0.05, 26)}
    return sb.studies.erosion(MODEL, circle, along=along, over=over, periods=60.0)


if __name__ == "__main__":
    for study in (overturning, basins, fractions, erosion):
        save(sb.plot(study()), FOLDER / f"{study.__name__}.png")
