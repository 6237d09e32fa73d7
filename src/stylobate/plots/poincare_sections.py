"""Poincaré sections: tilt and its rate once per period."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import unit_label
from stylobate.plots.style import GREY, PALETTE, new_figure, styled
from stylobate.results.outcomes import outcome_label

_HEIGHT = 3.9
_QUANTITIES = (("section_tilt", "tilt", r"\theta"), ("section_tilt_rate", "tilt rate", r"\dot\theta"))
# Size of the markers, which falls with their number [points].
_LARGEST, _LEAST, _AREA = 4.5, 1.4, 60.0
_MOST_NAMED = 7
_NOTHING = "no points: the motion ended before"


@figure_of("Poincaré section")
@styled
def plot_section(found: xr.Dataset) -> Figure:
    """Return a figure of a Poincaré section: tilt on the left, its rate on the right, a colour for each run."""
    figure = new_figure(_HEIGHT)
    dims = list(found["outcome"].dims)
    runs = found.stack(each=dims, create_index=False) if dims else found.expand_dims("each")
    count = runs.sizes["each"]
    size = float(np.clip(_AREA / np.sqrt(found.sizes["period"]), _LEAST, _LARGEST))
    panels = figure.subplots(1, 2)
    for axes, (name, label, symbol) in zip(panels, _QUANTITIES, strict=True):
        for each in range(count):
            points = runs[name].isel(each=each)
            axes.plot(
                points.sel(axis="x"),
                points.sel(axis="y"),
                linestyle="none",
                marker="o",
                markersize=size,
                markeredgewidth=0.0,
                color=PALETTE[each % len(PALETTE)],
            )
        unit = unit_label(found[name])
        axes.set(xlabel=f"{label} ${symbol}_x$ [{unit}]", ylabel=f"{label} ${symbol}_y$ [{unit}]")
        axes.set_aspect("equal", adjustable="datalim")
        axes.locator_params(nbins=5)
        if not np.isfinite(runs[name]).any():
            axes.text(0.5, 0.5, _NOTHING, transform=axes.transAxes, ha="center", va="center", color=GREY)
    if count <= _MOST_NAMED:
        for each in range(count):
            which = f"run {each + 1}: " if count > 1 else ""
            ending = outcome_label(int(runs["outcome"].isel(each=each)))
            panels[0].plot([], [], "o", color=PALETTE[each], markersize=_LARGEST, label=f"{which}{ending}")
        figure.legend(loc="outside upper left", ncols=count)
    return figure
