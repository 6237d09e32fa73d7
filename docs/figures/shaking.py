"""Draws the figures of the page "What records show" into docs/_static/shaking.

Run it with `python docs/figures/shaking.py`; it takes less than a minute on one core.
"""

import numpy as np
from matplotlib.figure import Figure
from saving import STATIC, save

import stylobate as sb

FOLDER = STATIC / "shaking"

MODEL = sb.Slender(
    sb.Column.solid(radius=0.4, height=4.0, density=2700.0), damping=0.03
)
QUAKES = sb.records.EvolvingNoise(
    arias=1.2,
    duration_5_95=8.0,
    middle_time=5.0,
    frequency=2.5,
    frequency_rate=-0.1,
    bandwidth=0.3,
)


def quakes(count: int) -> dict[str, sb.Record]:
    """Records along x and y, each with the same peak of the horizontal vector: of one PGA in RotD100."""
    made = (
        QUAKES.record(np.random.default_rng(seed), components=2, step=0.02)
        for seed in range(count)
    )
    return {
        f"quake {place + 1}": one.trimmed(0.0, 14.0).scaled_to(1.0)
        for place, one in enumerate(made)
    }


def analysis() -> Figure:
    """Twelve records at twenty scales."""
    found = sb.earthquakes.incremental_dynamic_analysis(
        MODEL, quakes(12), scales=np.linspace(1.6, 5.4, 20), component="RotD100"
    )
    bands = sb.earthquakes.reached_bands(
        found["intensity"], found["reached"].sel(limit_state="overturning")
    )
    print(bands["monotone"].to_numpy(), np.unique(found["outcome"], return_counts=True))
    return sb.plot(found)


def robust() -> Figure:
    """The same records near the median of their capacities, with small changes."""
    found = sb.earthquakes.robustness(MODEL, quakes(12), scale=3.8)
    print(found["share_flipped"].sel(limit_state="overturning").to_numpy())
    return sb.plot(found)


def directions() -> Figure:
    """Three of them, the planar column in every direction."""
    angles = np.radians(np.arange(0.0, 180.0, 10.0))
    scales = np.geomspace(1.6, 12.0, 30)
    found = sb.earthquakes.planar_bias(
        MODEL, dict(list(quakes(12).items())[:3]), scales=scales, directions=angles
    )
    print(
        found[["least_overturning", "worst_least_planar_overturning", "capacity_bias"]]
    )
    return sb.earthquakes.plot_directions(found)


def bias() -> Figure:
    """All of them, the planar column along both components, with the same dissipation: no loss at impacts."""
    return _bias(sb.PlanarRocking(MODEL.column, damping=0.03, restitution=1.0))


def bias_usual() -> Figure:
    """The same with Housner's restitution in the planar column."""
    return _bias(None)


def _bias(planar: sb.PlanarRocking | None) -> Figure:
    found = sb.earthquakes.planar_bias(
        MODEL, quakes(12), scales=np.linspace(1.6, 5.4, 20), planar=planar
    )
    names = (
        "overall_bias",
        "overall_scatter",
        "overall_standard_error",
        "overall_compared",
    )
    print(
        {
            name: float(found[name])
            for name in (
                *names,
                *(name.replace("overall", "capacity") for name in names[:3]),
            )
        }
    )
    return sb.plot(found)


def fragility() -> Figure:
    """Forty records and the fragility of their runs."""
    found = sb.earthquakes.incremental_dynamic_analysis(
        MODEL, quakes(40), scales=np.geomspace(1.6, 10.0, 14), component="RotD100"
    )
    fits = sb.earthquakes.fragility_of_runs(
        found, resamples=500, rng=np.random.default_rng(0)
    )
    print(fits[["median", "dispersion", "non_monotone_records"]])
    return sb.plot(fits.isel(limit_state=[1, 2, 4]))


DRAWINGS = (analysis, robust, directions, bias, bias_usual, fragility)

if __name__ == "__main__":
    for drawing in DRAWINGS:
        save(drawing(), FOLDER / f"{drawing.__name__}.png")
