"""Draws the figures of the page "What records show" into docs/_static/shaking.

Run it with `python docs/figures/shaking.py`; it takes less than a minute on one core.
"""

import numpy as np
from matplotlib.figure import Figure
from saving import STATIC, save

import stylobate as sb

FOLDER = STATIC / "shaking"

MODEL = sb.Wobbling(
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
    intervals = sb.earthquakes.reached_intervals(
        found["intensity"], found["reached"].sel(limit_state="overturning")
    )
    print(
        intervals["monotone"].to_numpy(),
        np.unique(found["outcome"], return_counts=True),
    )
    return sb.plot(found)


def robust() -> Figure:
    """The same records near the median of their capacities, each under 300 small variations."""
    verdicts = {
        name: sb.verdict(MODEL, quake.scaled(3.8)) for name, quake in quakes(12).items()
    }
    print([(found.word.value, round(found.share, 2)) for found in verdicts.values()])
    figure = Figure(figsize=(7.2, 3.6), layout="constrained")
    axes = figure.subplots()
    for place, found in enumerate(verdicts.values()):
        low, high = found.interval
        axes.barh(place, 100.0 * (high - low), 0.6, left=100.0 * low, color="#56B4E9")
        axes.plot(100.0 * found.share, place, "|", color="#0072B2", markersize=10.0)
        for mark, share in zip("ox", found.share_by_model.values(), strict=True):
            axes.plot(
                100.0 * share, place, mark, color="black", markersize=4.5, mfc="none"
            )
    for mark, name in zip(
        "ox", next(iter(verdicts.values())).share_by_model, strict=True
    ):
        axes.plot([], [], mark, color="black", mfc="none", label=f"{name} alone")
    for limit in (5.0, 95.0):
        axes.axvline(limit, color="#767676", linewidth=0.8, linestyle="--")
    axes.set_yticks(range(len(verdicts)), list(verdicts))
    axes.set(
        xlabel="share of variations that overturn the column [%]", ylim=(11.6, -0.6)
    )
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False, loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return figure


def verdict() -> Figure:
    """The verdict on the column of the front page under El Centro 1940."""
    stone = sb.Column.solid(radius=0.3, height=3.0, density=2700.0)
    model = sb.Wobbling(stone, damping=stone.housner_damping())
    return sb.plot(sb.verdict(model, sb.sample_record("el centro 1940"), runs=1000))


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


DRAWINGS = (analysis, robust, verdict, directions, bias, bias_usual, fragility)

if __name__ == "__main__":
    for drawing in DRAWINGS:
        save(drawing(), FOLDER / f"{drawing.__name__}.png")
