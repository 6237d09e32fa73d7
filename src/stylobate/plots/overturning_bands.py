"""Overturning spectra: which amplitudes overturn, and above which the column is safe again."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path

from stylobate.errors import Outcome
from stylobate.plots.cells import cell_edges, fill_options, set_scale
from stylobate.plots.classes import OUTCOME_LOOKS, UNFINISHED, Look
from stylobate.plots.labels import axis_label
from stylobate.plots.spectrum_axes import Horizontal, finish, motion_names, named, split
from stylobate.plots.style import BLACK, BLUE, GREY, VERMILION, new_figure, styled
from stylobate.results.outcomes import NOT_COMPUTED, code_of

Floats = npt.NDArray[np.float64]
Boxes = list[tuple[float, float, float, float]]

_HEIGHT, _MOST_PANELS = 4.4, 4
_SAFE, _AGAIN, _FALLEN = Look("#ffffff"), Look("#DCEBF5", "////", BLUE), OUTCOME_LOOKS[Outcome.OVERTURNED]
_EDGE = Look(GREY)
# An edge wider than this part is told in the legend.
_WIDE_EDGE = 0.01
_NOT_TOLD = [code_of(outcome) for outcome in (Outcome.FAILED, Outcome.LIFTED_OFF, Outcome.LIMIT_REACHED)]
_NORMALIZED = "peak base acceleration / (g tan α)"
_UNCERTAIN: dict[str, Any] = {"marker": "o", "mfc": "white", "mec": BLACK, "mew": 0.5, "linestyle": "none"}
_UNKNOWN: dict[str, Any] = {"marker": "x", "color": VERMILION, "linestyle": "none"}
# A dot on an uncertain run is at least and at most this large, and the panels together so wide [points].
_DOTS, _WIDTH = (1.0, 3.2), 400.0
# What changes ω/p most.
_OF_THE_RATIO = ("angular_frequency", "size", "mass_height", "gravity")
# Where more than this part of all runs is uncertain, dots would hide the bands: they are counted only.
_MOST_MARKED = 0.2


@dataclass(slots=True)
class _Marks:
    """What the panels show besides bands, for the legend: uncertain runs, and those that tell nothing."""

    panels: int = 1
    counts: list[int] = field(default_factory=lambda: [0, 0])
    wide_edges: bool = False


@styled
def plot_overturning_bands(found: xr.Dataset) -> Figure:
    """Return a figure of the bands of amplitude that overturn, a panel for each value of a second parameter.

    White is safe, dark overturns, hatched is safe again above a band that overturns. Dots mark runs of the scan that
    are uncertain, crosses those that tell nothing. Pulses and harmonic motions are drawn as in the literature: peak
    base acceleration over g tan α, against ω/p. Others by their scale, over the size 2R if it varies; below the dashed
    line the peak acceleration is below g tan α.

    Raises
    ------
    ParameterError
        If the bands are over more than two parameters, or there are more than four panels: choose some by `found.sel`.
    """
    dims = [str(dim) for dim in found["bands"].dims]
    along, panel = split(found, dims, _MOST_PANELS, "overturning bands")
    count = 1 if panel is None else found.sizes[panel]
    figure = new_figure(_HEIGHT)
    rows = figure.subplots(1, count, sharey=True, squeeze=False)[0]
    marks = _Marks(panels=count)
    for place, axes in enumerate(rows):
        one = found if panel is None else found.isel({panel: place})
        one = one.expand_dims(case=1) if along is None else one.sortby(along).transpose(along, ...)
        _draw(axes, one, _horizontal(one, along), marks)
        if panel is not None:
            axes.set_title(named(found, panel, place))
    rows[0].set_ylabel(_NORMALIZED if _is_normalized(found) else axis_label(found["scale"]))
    figure.legend(handles=_legend(found, marks), loc="outside lower center", ncols=4)
    return figure


def _is_normalized(found: xr.Dataset) -> bool:
    return "frequency_ratio" in found.coords and bool((found["acceleration_ratio"] > 0.0).all())


def _horizontal(one: xr.Dataset, along: str | None) -> Horizontal:
    if along is None:
        ratio = f"ω / p = {one['frequency_ratio'].item():.3g}" if _is_normalized(one) else ""
        return Horizontal(np.zeros(1), ratio, ("",))
    if along == "motion":
        return motion_names(one)
    if _is_normalized(one) and along in _OF_THE_RATIO:
        return Horizontal(one["frequency_ratio"].to_numpy(), "ω / p")
    if along == "size":
        return Horizontal(2.0 * one["rim_distance"].to_numpy(), "size 2R [m]")
    return Horizontal(one[along].to_numpy(), axis_label(one[along]))


def _draw(axes: Axes, one: xr.Dataset, along: Horizontal, marks: _Marks) -> None:
    scales, ratio = one["scale"].to_numpy(), np.broadcast_to(one["acceleration_ratio"].to_numpy(), along.values.shape)
    factor = ratio if _is_normalized(one) else np.ones(ratio.shape)
    order = np.argsort(along.values)
    edges = np.empty((along.values.size, 2))
    sides = cell_edges(along.values[order])
    edges[order] = np.stack([sides[:-1], sides[1:]], axis=1)
    low, high = float((scales[0] * factor).min()), float((scales[-1] * factor).max())
    regions = _regions(one, factor, edges, (low, high))
    for look, boxes in regions.items():
        _fill(axes, boxes, look)
    marks.wide_edges |= any(high > (1.0 + _WIDE_EDGE) * low for _, _, low, high in regions[_EDGE])
    _mark(axes, one, along, factor, marks)
    if not _is_normalized(one) and np.all(ratio > 0.0):
        axes.step(edges.T.ravel("F"), np.repeat(1.0 / ratio, 2), color=BLUE, linestyle="--", linewidth=1.2)
    finish(axes, along)
    set_scale(axes, "y", scales)
    axes.set_xlim(edges.min(), edges.max())
    axes.set_ylim(low, high)
    axes.grid(visible=False)


def _regions(one: xr.Dataset, factor: Floats, edges: Floats, ends: tuple[float, float]) -> dict[Look, Boxes]:
    """Return the boxes of each look: from left to right, from bottom to top."""
    names = ("band_from", "band_to", "safe_below", "safe_above")
    begin, end, below, above = (factor[:, np.newaxis] * one[name].to_numpy() for name in names)
    first, last = _known(one, factor)
    boxes: dict[Look, Boxes] = {_EDGE: [], _AGAIN: [], _FALLEN: [], UNFINISHED: []}
    for place, (left, right) in enumerate(edges.tolist()):
        count = int(one["bands"][place])
        boxes[UNFINISHED] += [(left, right, ends[0], first[place]), (left, right, last[place], ends[1])]
        for band in range(count):
            boxes[_FALLEN].append((left, right, begin[place, band], end[place, band]))
            boxes[_EDGE].append((left, right, below[place, band], begin[place, band]))
            boxes[_EDGE].append((left, right, end[place, band], above[place, band]))
            top = below[place, band + 1] if band + 1 < count else last[place]
            boxes[_AGAIN].append((left, right, above[place, band], top))
    return boxes


def _known(one: xr.Dataset, factor: Floats) -> tuple[Floats, Floats]:
    """Return the lowest and highest amplitude of which something is known; both at the bottom where nothing is."""
    scales = one["scale"].to_numpy()
    told = ~one["outcome"].isin([NOT_COMPUTED, *_NOT_TOLD]).to_numpy()
    first, last = np.argmax(told, axis=1), scales.size - 1 - np.argmax(told[:, ::-1], axis=1)
    last = np.where(told.any(axis=1), last, 0)
    return factor * scales[first], factor * scales[last]


def _fill(axes: Axes, boxes: Boxes, look: Look) -> None:
    """Fill boxes, but those of no height or no end, with a look; they are one path, so that textures go on."""
    shown = np.array([box for box in boxes if box[3] > box[2]]).reshape(-1, 4)
    left, right, low, high = shown.T
    corners = np.stack([[left, low], [right, low], [right, high], [left, high], [left, low]])
    codes = np.tile([Path.MOVETO, Path.LINETO, Path.LINETO, Path.LINETO, Path.CLOSEPOLY], len(shown))
    path = Path(np.moveaxis(corners, 2, 0).reshape(-1, 2), codes)
    # Boxes meet without a line between them if they are drawn without edges; a hatch has the colour of its edge.
    axes.add_patch(PathPatch(path, facecolor=look.colour, edgecolor=look.ink, hatch=look.texture, linewidth=0.0))


def _mark(axes: Axes, one: xr.Dataset, along: Horizontal, factor: Floats, marks: _Marks) -> None:
    """Mark the runs of the scan that are uncertain or tell nothing, and count them."""
    codes, scales = one["outcome"].to_numpy(), one["scale"].to_numpy()
    size = float(np.clip(_WIDTH / marks.panels / max(codes.shape) / 2.0, *_DOTS))
    uncertain = one["uncertain"].to_numpy() & (codes != NOT_COMPUTED)
    unknown = one["outcome"].isin(_NOT_TOLD).to_numpy()
    for kind, (chosen, look) in enumerate(((uncertain, _UNCERTAIN), (unknown, _UNKNOWN))):
        rows, columns = np.nonzero(chosen)
        marks.counts[kind] += rows.size
        if rows.size <= _MOST_MARKED * chosen.size:
            axes.plot(along.values[rows], factor[rows] * scales[columns], **look, markersize=size)


def _legend(found: xr.Dataset, marks: _Marks) -> list[Patch | Line2D]:
    entries: list[Patch | Line2D] = [
        Patch(label=name, **fill_options(look))
        for name, look in (("safe", _SAFE), ("overturns", _FALLEN), ("safe again", _AGAIN))
    ]
    if bool(found["outcome"].isin([NOT_COMPUTED, *_NOT_TOLD]).any()):
        entries.append(Patch(label="not known", **fill_options(UNFINISHED)))
    if marks.wide_edges:
        entries.append(Patch(label="edge, not told", **fill_options(_EDGE)))
    if not _is_normalized(found) and bool((found["acceleration_ratio"] > 0.0).all()):
        entries.append(Line2D([], [], color=BLUE, linestyle="--", linewidth=1.2, label="peak acceleration g tan α"))
    for count, name, look in zip(marks.counts, ("uncertain", "tells nothing"), (_UNCERTAIN, _UNKNOWN), strict=True):
        if count:
            entries.append(Line2D([], [], label=f"{name}: {count} runs", markersize=_DOTS[1], **look))
    return entries
