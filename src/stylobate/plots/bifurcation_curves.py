"""Bifurcation curves in the plane of two parameters."""

import json
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from stylobate.errors import ParameterError
from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import axis_label
from stylobate.plots.style import PALETTE, new_figure, styled

_HEIGHT = 4.4
# Line styles of supercritical, subcritical and undecided bifurcations.
_LINES: dict[int, dict[str, Any]] = {
    1: {"linewidth": 2.4, "linestyle": "-"},
    0: {"linewidth": 1.6, "linestyle": (0, (4, 2))},
    -1: {"linewidth": 1.1, "linestyle": "-"},
}
_DECIDED = {1: "supercritical", 0: "subcritical", -1: "fold, or not decided"}


@figure_of("bifurcation curve")
def plot_bifurcation_curve(points: xr.Dataset) -> Figure:
    """Return a figure of the `points` of one curve: see `plot_bifurcation_curves`."""
    return plot_bifurcation_curves([points])


@styled
def plot_bifurcation_curves(curves: Sequence[xr.Dataset], labels: Sequence[str] | None = None) -> Figure:
    """Return a figure of curves of bifurcations in the plane of their two parameters.

    Lines are bold for supercritical bifurcations, dashed for subcritical ones, and thin for folds and undecided
    bifurcations.

    Parameters
    ----------
    curves
        `BifurcationCurve.points` of one or several curves over the same two parameters.
    labels
        A name for each; by default the kind of the bifurcation.

    Raises
    ------
    ParameterError
        If the curves have different parameters.
    """
    planes = [tuple(json.loads(one.attrs["parameters"])) for one in curves]
    if any(set(plane) != set(planes[0]) for plane in planes):
        pairs = " and ".join(str(plane) for plane in dict.fromkeys(planes))
        message = f"curves must have the same two parameters, got {pairs}: plot those of each plane alone"
        raise ParameterError(message)
    x, y = planes[0]
    figure = new_figure(_HEIGHT)
    axes = figure.subplots()
    names = labels or [str(one.attrs["bifurcation"]) for one in curves]
    for index, (points, name) in enumerate(zip(curves, names, strict=True)):
        colour = PALETTE[index % len(PALETTE)]
        code = points["supercritical"].to_numpy()
        along, height = points[x].to_numpy(), points[y].to_numpy()
        for decided, line in _LINES.items():
            here = code == decided
            shown = here | np.append(False, here[:-1])
            axes.plot(along, np.where(shown, height, np.nan), color=colour, **line)
        axes.plot([], [], color=colour, linewidth=2.4, label=name)
    for decided, line in _LINES.items():
        if any((points["supercritical"] == decided).any() for points in curves):
            axes.plot([], [], color="black", label=_DECIDED[decided], **line)
    axes.set_xlabel(axis_label(curves[0][x]))
    axes.set_ylabel(axis_label(curves[0][y]))
    axes.legend(fontsize="small")
    return figure
