"""Figures of overturning spectra: overturning intervals, and survival above them."""

from dataclasses import dataclass, field

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

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
from stylobate.earthquakes.figures.intervals_of_one import plot_intervals_of_one
from stylobate.earthquakes.figures.spectrum_axes import Horizontal, finish, motion_names, named, split
from stylobate.plots.cells import cell_edges, is_geometric, set_scale
from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import axis_label
from stylobate.plots.style import new_figure, styled
from stylobate.results.outcomes import NOT_COMPUTED

_HEIGHT, _MOST_PANELS = 4.4, 4
# Minimum and maximum size of the dot on an uncertain run, and width of all panels [points].
_DOTS, _WIDTH = (1.0, 3.2), 400.0
# Parameters that change ω/p most.
_OF_THE_RATIO = ("angular_frequency", "size", "mass_height", "gravity")
# If more than this fraction of all runs is uncertain, dots would hide the intervals, so the legend only counts them.
_MOST_MARKED = 0.2


@dataclass(slots=True)
class _Marks:
    """Contents of the panels for the legend: uncertain and undecided runs, hairlines, whether edges are seen."""

    panels: int = 1
    counts: list[int] = field(default_factory=lambda: [0, 0])
    hairlines: int = 0
    edges: bool = False


@figure_of("overturning intervals")
@styled
def plot_overturning_intervals(found: xr.Dataset) -> Figure:
    """Draw the overturning intervals of the amplitude, with a panel for each value of a second parameter.

    White means survival, dark overturning, hatched survival above an overturning interval, grey and cross-hatched
    undecided. Dots mark uncertain runs of the scan, crosses undecided runs. For pulses and harmonic motions the axes
    are those of the literature: peak base acceleration over c g, against ω/p. Other motions have the scale as vertical
    axis, over the size 2R if it varies; below the dashed line the peak acceleration is less than c g. Intervals too
    narrow to be seen are drawn as lines. For a single column the horizontal axis is the amplitude, and the figure
    includes the peak tilts of surviving runs.

    Raises
    ------
    ParameterError
        If the result has more than two parameters or more than four panels: choose some by `found.sel`.
    """
    dims = [str(dim) for dim in found["intervals"].dims]
    along, panel = split(found, dims, _MOST_PANELS, "overturning intervals")
    if along is None or found.sizes[along] == 1:
        return plot_intervals_of_one(found.squeeze(dims))
    count = 1 if panel is None else found.sizes[panel]
    figure = new_figure(_HEIGHT)
    rows = figure.subplots(1, count, sharey=True, squeeze=False)[0]
    marks = _Marks(panels=count)
    for place, axes in enumerate(rows):
        one = found if panel is None else found.isel({panel: place})
        one = one.sortby(along).transpose(along, ...)
        _draw(axes, one, _horizontal(one, along), marks)
        if panel is not None:
            axes.set_title(named(found, panel, place))
    rows[0].set_ylabel(amplitude_label(found))
    handles = interval_legend(found, hairlines=marks.hairlines, edges=marks.edges)
    columns = 3 if marks.hairlines else 4
    figure.legend(handles=[*handles, *run_legend(marks.counts, _DOTS[1])], loc="outside lower center", ncols=columns)
    return figure


def _horizontal(one: xr.Dataset, along: str) -> Horizontal:
    if along == "motion":
        return motion_names(one)
    if is_normalized(one) and along in _OF_THE_RATIO:
        return Horizontal(one["frequency_ratio"].to_numpy(), "ω / p")
    if along == "size":
        return Horizontal(2.0 * one["rim_distance"].to_numpy(), "size 2R [m]")
    return Horizontal(one[along].to_numpy(), axis_label(one[along]))


def _draw(axes: Axes, one: xr.Dataset, along: Horizontal, marks: _Marks) -> None:
    scales, ratio = one["scale"].to_numpy(), np.broadcast_to(one["acceleration_ratio"].to_numpy(), along.values.shape)
    factor = ratio if is_normalized(one) else np.ones(ratio.shape)
    order = np.argsort(along.values)
    edges = np.empty((along.values.size, 2))
    sides = cell_edges(along.values[order])
    edges[order] = np.stack([sides[:-1], sides[1:]], axis=1)
    regions = Regions.of(one, factor, edges, geometric=is_geometric(scales))
    regions.draw(axes)
    marks.hairlines += len(regions.hairlines)
    marks.edges |= regions.edges
    _mark(axes, one, along, factor, marks)
    if not is_normalized(one) and np.all(ratio > 0.0):
        axes.step(edges.T.ravel("F"), np.repeat(1.0 / ratio, 2), **WEAKEST)
    finish(axes, along)
    set_scale(axes, "y", scales)
    axes.set_xlim(edges.min(), edges.max())
    axes.set_ylim(amplitude_ends(one, factor))
    axes.grid(visible=False)


def _mark(axes: Axes, one: xr.Dataset, along: Horizontal, factor: Floats, marks: _Marks) -> None:
    """Mark and count the uncertain and undecided runs of the scan."""
    codes, scales = one["outcome"].to_numpy(), one["scale"].to_numpy()
    size = float(np.clip(_WIDTH / marks.panels / max(codes.shape) / 2.0, *_DOTS))
    uncertain = one["uncertain"].to_numpy() & (codes != NOT_COMPUTED)
    unknown = one["outcome"].isin(UNRESOLVED).to_numpy()
    for kind, (chosen, look) in enumerate(((uncertain, UNCERTAIN), (unknown, UNKNOWN))):
        rows, columns = np.nonzero(chosen)
        marks.counts[kind] += rows.size
        if rows.size <= _MOST_MARKED * chosen.size:
            axes.plot(along.values[rows], factor[rows] * scales[columns], **look, markersize=size)
