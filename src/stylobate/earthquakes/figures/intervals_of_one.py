"""Figure of the overturning intervals of one column along the amplitude, with the peak tilts of surviving runs."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from stylobate.earthquakes.figures.interval_regions import (
    UNCERTAIN,
    UNKNOWN,
    UNRESOLVED,
    WEAKEST,
    Floats,
    Regions,
    amplitude_ends,
    amplitude_label,
    interval_legend,
    is_normalized,
    run_legend,
)
from stylobate.errors import Outcome
from stylobate.plots.cells import is_geometric, set_scale
from stylobate.plots.style import BLACK, new_figure, styled
from stylobate.results.outcomes import NOT_COMPUTED

_HEIGHT_OF_ONE, _DOT = 3.8, 3.2


@styled
def plot_intervals_of_one(found: xr.Dataset) -> Figure:
    """Draw the overturning intervals of one column, and its peak tilts between them.

    Parameters
    ----------
    found
        Overturning intervals of one case: `interval_from` … over `interval`, `outcome` and `peak_tilt` over the scale.
    """
    figure = new_figure(_HEIGHT_OF_ONE)
    axes = figure.subplots()
    ratio = float(found["acceleration_ratio"])
    factor = ratio if is_normalized(found) else 1.0
    scales = found["scale"].to_numpy()
    one, factors = found.expand_dims(case=1), np.array([factor])
    regions = Regions.of(one, factors, np.array([[0.0, 1.0]]), geometric=is_geometric(scales))
    regions.draw(axes, along_x=True)
    if not is_normalized(found) and ratio > 0.0:
        axes.axvline(1.0 / ratio, **WEAKEST)
    counts = _draw_runs(axes, found, factor * scales)
    set_scale(axes, "x", scales)
    axes.set(xlim=amplitude_ends(one, factors), xlabel=amplitude_label(found), ylabel=r"peak tilt $\theta/\alpha_c$")
    axes.set_ylim(bottom=0.0)
    axes.grid(visible=False)
    axes.set_title(_title(found), fontsize="small")
    tilts = Line2D([], [], color=BLACK, marker=".", markersize=4.0, linewidth=0.9, label="peak tilt where it survives")
    handles = interval_legend(found, hairlines=len(regions.hairlines), edges=regions.edges)
    figure.legend(handles=[*handles, tilts, *run_legend(counts, _DOT)], loc="outside lower center", ncols=3)
    return figure


def _draw_runs(axes: Axes, found: xr.Dataset, amplitude: Floats) -> tuple[int, int]:
    """Draw the peak tilts of surviving runs; mark and count uncertain and undecided runs."""
    codes, tilt = found["outcome"].to_numpy(), found["peak_tilt"].to_numpy() / float(found["tipping_angle"])
    unknown = np.isin(codes, UNRESOLVED)
    uncertain = found["uncertain"].to_numpy() & (codes != NOT_COMPUTED)
    stands = ~unknown & (codes != Outcome.OVERTURNED)
    shown = np.where(stands, tilt, np.nan)
    axes.plot(amplitude, shown, color=BLACK, marker=".", markersize=4.0, linewidth=0.9)
    # Runs without a peak tilt are marked at the lower edge.
    height = np.where(stands, shown, 0.0)
    for chosen, look in ((uncertain, UNCERTAIN), (unknown, UNKNOWN)):
        if chosen.any():
            axes.plot(amplitude[chosen], height[chosen], **look, markersize=_DOT, clip_on=False, zorder=4)
    return int(uncertain.sum()), int(unknown.sum())


def _title(found: xr.Dataset) -> str:
    size, tangent = 2.0 * float(found["rim_distance"]), float(np.tan(found["tipping_angle"]))
    parts = [f"one column: size $2R$ = {size:.3g} m, $c$ = {tangent:.3g}"]
    parts += [f"ω / p = {float(found['frequency_ratio']):.3g}"] if is_normalized(found) else []
    return ", ".join(parts)
