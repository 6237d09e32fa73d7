"""Draws the figures of the page "Overturning spectra and rocking spectra" into docs/_static/spectra.

Run it with `python docs/figures/spectra.py`; it takes seconds on two cores.
"""

import numpy as np
import xarray as xr
from saving import STATIC, save

import stylobate as sb

FOLDER = STATIC / "spectra"
STONE = sb.Column.solid(radius=0.5, height=5.0, density=2000.0)


def pulse() -> xr.Dataset:
    """Overturn by one sine: frequency and amplitude, for three damping values."""
    column = sb.Column.dimensionless(slenderness=0.1)
    sine = sb.Pulse.one_sine(acceleration=0.1, angular_frequency=1.0)
    over = {
        "angular_frequency": np.linspace(0.5, 9.0, 86) * column.frequency_parameter,
        "damping": [0.02, 0.1, 0.2],
    }
    return sb.earthquakes.overturning_intervals(
        sb.Slender(column), sine, scales=np.geomspace(1.0, 20.0, 41), over=over
    )


def one() -> xr.Dataset:
    """Overturn one column by El Centro 1940, three components, at many scales."""
    column = sb.Column.solid(radius=0.3, height=3.0, density=2700.0)
    quake = sb.sample_record("el centro 1940")
    return sb.earthquakes.overturning_intervals(
        sb.Wobbling(column, damping=0.03), quake, scales=np.geomspace(0.5, 2.0, 61)
    )


def record() -> xr.Dataset:
    """Overturn by El Centro 1940, three components: size and scale, for three slendernesses."""
    quake = sb.sample_record("el centro 1940")
    over = {"size": np.geomspace(0.2, 4.0, 27), "slenderness": [0.1, 0.15, 0.2]}
    model = sb.Wobbling(STONE, damping=0.05)
    scales = np.geomspace(0.25, 4.0, 41)
    return sb.earthquakes.overturning_intervals(
        model, quake, scales=scales, over=over, width=3e-3
    )


def rocking() -> xr.Dataset:
    """Peaks under the same record at its own scale."""
    quake = sb.sample_record("el centro 1940")
    over = {"size": np.geomspace(0.1, 10.0, 60), "slenderness": [0.1, 0.15, 0.2, 0.25]}
    return sb.earthquakes.rocking_spectrum(
        sb.Wobbling(STONE, damping=0.05), quake, over=over
    )


if __name__ == "__main__":
    for study in (pulse, one, record, rocking):
        save(sb.plot(study()), FOLDER / f"{study.__name__}.png")
