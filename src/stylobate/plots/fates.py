"""What runs come to beside a bifurcation."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from stylobate.plots.labels import axis_label
from stylobate.plots.style import PALETTE, new_figure, styled

_HATCHES = ("", "//", "..", "xx", "\\\\", "oo", "++")
_FIXED = {"overturned": "#4d4d4d", "at rest": "#d9d9d9", "unsettled": "white"}


@styled
def plot_fates(found: xr.Dataset) -> Figure:
    """Return a figure of the kind "fates": for each value of the parameter the shares of what runs came to."""
    parameter = str(found.attrs["parameter"])
    ordered = found.sortby(parameter)
    values = ordered[parameter].to_numpy()
    shares = ordered["count"].transpose("fate", parameter).to_numpy() / ordered["count"].sum("fate").to_numpy()
    figure = new_figure(1.6 + 0.32 * values.size)
    axes = figure.subplots()
    place, left, moving = np.arange(values.size), np.zeros(values.size), 0
    for index, name in enumerate(ordered["fate"].to_numpy()):
        fixed = _FIXED.get(str(name))
        look: dict[str, Any] = {
            "color": fixed or PALETTE[moving % len(PALETTE)],
            "hatch": "" if fixed else _HATCHES[moving % len(_HATCHES)],
        }
        moving += fixed is None
        axes.barh(place, shares[index], left=left, edgecolor="black", linewidth=0.5, label=str(name), **look)
        left += shares[index]
    axes.set_yticks(place, [f"{value:.6g}" for value in values])
    axes.set_ylabel(axis_label(ordered[parameter]))
    axes.set_xlabel(f"share of {int(ordered['count'].isel({parameter: 0}).sum())} runs")
    axes.set_xlim(0.0, 1.0)
    axes.grid(visible=False)
    at = float(np.interp(float(ordered.attrs["at"]), values, place, left=np.nan, right=np.nan))
    if np.isfinite(at):
        axes.axhline(at, color="black", linestyle=(0, (4, 2)), linewidth=1.2)
        axes.annotate(
            f" {ordered.attrs['bifurcation']}", (1.0, at), va="center", fontsize="small", annotation_clip=False
        )
    figure.legend(loc="outside upper center", ncols=2, fontsize="small")
    return figure
