"""Bifurcation diagrams: branches of exact periodic orbits over their parameter."""

from collections.abc import Sequence

import xarray as xr
from matplotlib.figure import Figure

from stylobate.errors import ParameterError
from stylobate.plots.branch_lines import draw_part, key_of_stability, mark_bifurcations, shade_range
from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import axis_label
from stylobate.plots.style import PALETTE, new_figure, styled

_HEIGHT = 4.4


@figure_of("branch")
def plot_branch(points: xr.Dataset) -> Figure:
    """Return a figure of the `points` of one branch: see `plot_branches`."""
    return plot_branches([points])


@styled
def plot_branches(branches: Sequence[xr.Dataset], labels: Sequence[str] | None = None) -> Figure:
    """Return a figure of the mean tilt of branches against their parameter.

    Stable orbits are bold, unstable ones thin; a shade shows the range of the tilt of stable orbits over a period.
    Bifurcations are marked: black if supercritical, white if subcritical, grey if undecided.

    Parameters
    ----------
    branches
        `Branch.points` of one or several branches over the same parameter.
    labels
        A name for each.

    Raises
    ------
    ParameterError
        If the branches have different parameters.
    """
    parameters = list(dict.fromkeys(str(one.attrs["parameter"]) for one in branches))
    if len(parameters) > 1:
        message = f"branches must have one parameter, got {', '.join(parameters)}: plot those of each parameter alone"
        raise ParameterError(message)
    x = parameters[0]
    names: Sequence[str | None] = labels or [None] * len(branches)
    figure = new_figure(_HEIGHT)
    axes = figure.subplots()
    for index, (points, name) in enumerate(zip(branches, names, strict=True)):
        colour = PALETTE[index % len(PALETTE)]
        draw_part(axes, points, x, "mean_tilt", colour, label=name)
        shade_range(axes, points, x, colour)
    for points in branches:
        mark_bifurcations(axes, points, points["bifurcation_parameter"])
    key_of_stability(axes, max(branches, key=lambda points: int(points["stable"].sum())))
    axes.set_xlabel(axis_label(branches[0][x]))
    axes.set_ylabel(r"mean tilt $\theta$ [rad]")
    axes.set_ylim(bottom=0.0)
    axes.legend(fontsize="small")
    return figure
