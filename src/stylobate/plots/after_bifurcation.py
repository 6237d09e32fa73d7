"""Bars of the outcomes of runs near a bifurcation."""

from dataclasses import replace

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from stylobate.errors import Outcome
from stylobate.plots.classes import KIND_LOOKS, OUTCOME_LOOKS, Look
from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import axis_label
from stylobate.plots.style import new_figure, styled

# Textures of orbits of several periods; orbits of one period and of several have the same colour.
_TEXTURES, _MANY_PERIODS = {2: "//", 3: "||", 4: ".."}, "++"


@figure_of("after bifurcation")
@styled
def plot_after_bifurcation(found: xr.Dataset) -> Figure:
    """Draw the shares of the outcomes of runs at each value of the parameter.

    Colours are those of maps. A dashed line lies between the bars on either side of the bifurcation.
    """
    parameter = str(found.attrs["parameter"])
    ordered = found.sortby(parameter)
    values = ordered[parameter].to_numpy()
    shares = ordered["count"].transpose("fate", parameter).to_numpy() / ordered["count"].sum("fate").to_numpy()
    figure = new_figure(1.6 + 0.32 * values.size)
    axes = figure.subplots()
    place, left = np.arange(values.size), np.zeros(values.size)
    for index, name in enumerate(ordered["fate"].to_numpy()):
        look = _look(str(name))
        axes.barh(
            place,
            shares[index],
            left=left,
            facecolor=look.colour,
            edgecolor=look.ink if look.texture else "black",
            hatch=look.texture,
            linewidth=0.5,
            label=str(name),
        )
        left += shares[index]
    axes.set_yticks(place, [f"{value:.6g}" for value in values])
    axes.set_ylabel(axis_label(ordered[parameter]))
    axes.set_xlabel(f"share of {int(ordered['count'].isel({parameter: 0}).sum())} runs")
    axes.set_xlim(0.0, 1.0)
    axes.grid(visible=False)
    below = int(np.searchsorted(values, float(ordered.attrs["at"])))
    if 0 < below < values.size:
        between = below - 0.5
        axes.axhline(between, color="black", linestyle=(0, (4, 2)), linewidth=1.2)
        axes.annotate(
            f" {ordered.attrs['bifurcation']}", (1.0, between), va="center", fontsize="small", annotation_clip=False
        )
    figure.legend(loc="outside upper center", ncols=2, fontsize="small")
    return figure


def _look(fate: str) -> Look:
    """Return the look of an outcome: the look of its kind in maps, with a texture for each number of periods."""
    kind, _, periods = fate.partition(", period ")
    look = KIND_LOOKS.get(kind, OUTCOME_LOOKS[Outcome.STILL_MOVING])
    return replace(look, texture=_TEXTURES.get(int(periods), _MANY_PERIODS)) if periods else look
