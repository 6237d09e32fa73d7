"""Figure of a verdict: the peak tilts of all variations, and the share of overturning over each variation."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure

from stylobate.plots.cells import ink_on
from stylobate.plots.kinds import figure_of
from stylobate.plots.result_figure import heading
from stylobate.plots.style import AS_DRAWN, BLUE, DASHES, GREY, ORANGE, VERMILION, new_figure, styled
from stylobate.results.verdict import CONTACT_LAW, KIND, LABELS, Verdict, percent

_SHARES = LinearSegmentedColormap.from_list("share", [BLUE, "#f4f4f4", VERMILION])
_LAWS = (BLUE, ORANGE)
_HATCHES = ("", "////")
_BINS = np.linspace(0.0, 1.25, 26)
_FALLEN_AT, _FALLEN_WIDTH = 1.32, 0.1
"""Place of the bar of overturned runs on the axis of the peak tilt over α_c."""


@figure_of(KIND)
@styled
def plot_verdict(found: xr.Dataset) -> Figure:
    """Draw the peak tilts by contact law, and the share of overturning from low to high values of each variation."""
    figure = new_figure(1.6 + 0.24 * max(found.sizes["variation"], 8))
    tilts, shares = figure.subplots(1, 2, width_ratios=(1.0, 1.15))
    _draw_tilts(tilts, found)
    _draw_shares(shares, found)
    heading(figure, str(Verdict(found)))
    return figure


def _draw_tilts(axes: Axes, found: xr.Dataset) -> None:
    names = [str(name) for name in found["model"].to_numpy()]
    law, ratio, state = (found[name].to_numpy() for name in ("law", "tilt_ratio", "overturned"))
    below, stacked = 0, np.zeros(_BINS.size - 1)
    for place, name in enumerate(names):
        look: dict[str, Any] = {
            "color": _LAWS[place % 2],
            "hatch": _HATCHES[place % 2],
            "edgecolor": "white",
            "linewidth": 0.4,
            "align": "edge",
        }
        heights = np.histogram(np.clip(ratio[(law == place) & (state == 0)], 0.0, _BINS[-1]), _BINS)[0]
        fallen = int(((law == place) & (state == 1)).sum())
        share = percent(float(found["model_share"][place]))
        axes.bar(_BINS[:-1], heights, np.diff(_BINS), stacked, label=f"{name}: {share} overturn", **look)
        axes.bar(_FALLEN_AT, fallen, _FALLEN_WIDTH, below, **look)
        stacked, below = stacked + heights, below + fallen
    unknown = int((state < 0).sum())
    axes.axvline(1.0, color=GREY, linewidth=0.8, linestyle=DASHES[1])
    ticks = [0.0, 0.25, 0.5, 0.75, 1.0, _FALLEN_AT + 0.5 * _FALLEN_WIDTH]
    axes.set_xticks(ticks, ["0", "0.25", "0.5", "0.75", "1", "over-\nturned"])
    axes.set(xlabel=r"peak tilt / $\alpha_c$", xlim=(0.0, 1.46))
    axes.set_ylabel("variations" + (f" ({unknown} not decided)" if unknown else ""))
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.06), borderaxespad=0.0)


def _draw_shares(axes: Axes, found: xr.Dataset) -> None:
    """Draw a row for each variation, the most influential on top."""
    order = np.argsort(-found["influence"].to_numpy(), kind="stable")
    names = [str(found["variation"].to_numpy()[place]) for place in order]
    for row, place in enumerate(order):
        cells = found["part_share"].to_numpy()[place]
        cells = cells[~np.isnan(cells)]
        width = 1.0 / max(cells.size, 1)
        starts = np.arange(cells.size) * width
        look: dict[str, Any] = {"color": _SHARES(cells), "edgecolor": "white", "gid": AS_DRAWN}
        axes.barh(np.full(cells.size, row), width, 0.8, starts, **look)
        laws = found["model"].to_numpy() if names[row] == CONTACT_LAW else np.full(cells.size, "")
        for start, cell, law in zip(starts, cells, laws, strict=True):
            label = f"{law} {100.0 * cell:.0f}".strip()
            ink = ink_on(_SHARES(cell))
            look = {"ha": "center", "va": "center", "fontsize": "x-small", "color": ink, "gid": AS_DRAWN}
            axes.text(start + 0.5 * width, row, label, **look)
        axes.text(1.02, row, percent(float(found["influence"][place])), va="center", fontsize="small")
    axes.set_yticks(np.arange(len(names)), [LABELS.get(name, name.replace("_", " ")) for name in names])
    axes.set(xlim=(0.0, 1.0), ylim=(len(names) - 0.5, -0.5), xticks=[0.08, 0.92])
    axes.set_xticklabels(["low values", "high values"])
    axes.tick_params(axis="both", length=0)
    axes.grid(visible=False)
    axes.spines[:].set_visible(False)
    axes.set_title("share of overturning [%]; right: influence", loc="right")
