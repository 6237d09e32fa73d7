"""Draws the figure of the first example, one column under many shakings, into docs/_static/home-earthquake.png.

Run it with `python docs/figures/home.py`; it takes seconds.
"""

import numpy as np
from matplotlib.figure import Figure
from saving import STATIC, save

import stylobate as sb

SCALES = np.linspace(0.3, 2.3, 21)
STANDS, OVERTURNS = "#0072B2", "#D55E00"
TOP = 1.25  # place of the columns that overturned, in tilts over α_c


def earthquake() -> Figure:
    """Verdicts on the column of the front page at 21 scales of El Centro 1940, 100 variations each."""
    stone = sb.Column.solid(radius=0.3, height=3.0, density=2700.0)  # m, kg/m³
    model = sb.Wobbling(stone, damping=stone.housner_damping())
    quake = sb.sample_record("el centro 1940")
    verdicts = [sb.verdict(model, quake.scaled(scale), runs=100) for scale in SCALES]
    figure = Figure(figsize=(7.2, 4.6), layout="constrained")
    tilts, shares = figure.subplots(2, 1, sharex=True, height_ratios=(2.0, 1.0))
    rng = np.random.default_rng(0)
    for scale, found in zip(SCALES, verdicts, strict=True):
        ratio = found.data["tilt_ratio"].to_numpy()
        fallen = np.isinf(ratio)
        at = scale + rng.uniform(-0.035, 0.035, ratio.size)
        up = TOP + rng.uniform(-0.05, 0.05, ratio.size)
        tilts.plot(at[~fallen], ratio[~fallen], ".", color=STANDS, markersize=3.0)
        tilts.plot(at[fallen], up[fallen], "x", color=OVERTURNS, markersize=3.5)
    tilts.set_yticks([0.0, 0.5, 1.0, TOP], ["0", "0.5", "1", "overturned"])
    tilts.set(ylabel="peak tilt / tipping angle", ylim=(-0.04, TOP + 0.12))
    tilts.plot([], [], ".", color=STANDS, label="stands")
    tilts.plot([], [], "x", color=OVERTURNS, label="overturns")
    tilts.legend(frameon=False, loc="upper left")
    low, high = np.transpose([found.interval for found in verdicts])
    shares.fill_between(
        SCALES, 100.0 * low, 100.0 * high, color=OVERTURNS, alpha=0.3, linewidth=0.0
    )
    shares.plot(SCALES, [100.0 * found.share for found in verdicts], color=OVERTURNS)
    for limit in (5.0, 95.0):
        shares.axhline(limit, color="#767676", linewidth=0.8, linestyle="--")
    shares.set(
        xlabel="scale of the record of El Centro 1940",
        ylabel="overturned [%]",
        ylim=(-4.0, 104.0),
        xlim=(SCALES[0] - 0.06, SCALES[-1] + 0.06),
    )
    for axes in (tilts, shares):
        axes.spines[["top", "right"]].set_visible(False)
    return figure


if __name__ == "__main__":
    save(earthquake(), STATIC / "home-earthquake.png")
