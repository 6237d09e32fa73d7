"""Figures of overturning intervals, over one case or over a spectrum, and of survival above them."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path

from stylobate.earthquakes.figures.spectra import Horizontal, finish, motion_names, named, split
from stylobate.errors import Outcome
from stylobate.plots.cells import OUTCOME_LOOKS, UNFINISHED, Look, cell_edges, fill_options, is_geometric, set_scale
from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import axis_label
from stylobate.plots.style import BLACK, BLUE, GREY, VERMILION, new_figure, styled
from stylobate.results.outcomes import NOT_COMPUTED
from stylobate.text import plural

Floats = npt.NDArray[np.float64]
Box = tuple[float, float, float, float]
"""Left, right, lowest and highest amplitude."""
Boxes = list[Box]

_UNRESOLVED = [Outcome.FAILED, Outcome.LIFTED_OFF, Outcome.LIMIT_REACHED]
_UNCERTAIN: dict[str, Any] = {"marker": "o", "mfc": "white", "mec": BLACK, "mew": 0.5, "linestyle": "none"}
_UNKNOWN: dict[str, Any] = {"marker": "x", "color": VERMILION, "linestyle": "none"}
_WEAKEST: dict[str, Any] = {"color": BLUE, "linestyle": "--", "linewidth": 1.2}
"""Line below which the peak acceleration is less than c g."""

_SAFE, _AGAIN, _FALLEN = Look("#ffffff"), Look("#DCEBF5", "////", BLUE), OUTCOME_LOOKS[Outcome.OVERTURNED]
_EDGE = Look(GREY)
UNDECIDED = Look("#e6e6e6", "xxx", GREY)
"""Look of undecided scales."""
# An edge that takes more than this fraction of the axis is seen, and appears in the legend.
_SEEN = 0.002
# A box that takes less than this fraction of the axis is drawn as a line of this width [points].
_HAIRLINE, _THINNEST = 0.007, 2.0


@dataclass(frozen=True, slots=True)
class Regions:
    """The boxes of each look; `hairlines`, overturning intervals too narrow to be seen; whether `edges` are seen."""

    boxes: dict[Look, Boxes]
    hairlines: Boxes
    edges: bool

    @classmethod
    def of(cls, one: xr.Dataset, factor: Floats, edges: Floats, *, geometric: bool) -> "Regions":
        """Compute the regions of the cases in `one`.

        Parameters
        ----------
        one
            Intervals over (case, interval), runs over (case, scale).
        factor
            Factor from scales to drawn amplitudes, shape (case,).
        edges
            Left and right edge of each case, shape (case, 2).
        geometric
            Whether the axis of amplitudes is logarithmic.
        """
        scales, ends = one["scale"].to_numpy(), _amplitude_ends(one, factor)
        boxes: dict[Look, Boxes] = {_EDGE: [], _AGAIN: [], _FALLEN: [], UNDECIDED: [], UNFINISHED: []}
        for place, (left, right) in enumerate(edges.tolist()):
            unit = float(factor[place])
            own = _Intervals.of(one.isel({one["intervals"].dims[0]: place}))
            first, last = unit * float(scales[0]), unit * float(scales[-1])
            boxes[UNFINISHED] += [(left, right, ends[0], first), (left, right, last, ends[1])]
            for look, intervals in own.looks(float(scales[-1])).items():
                boxes[look] += [(left, right, unit * low, unit * high) for low, high in intervals]
        thin = [box for box in boxes[_FALLEN] if _share(box, ends, geometric=geometric) < _HAIRLINE]
        seen = any(_share(box, ends, geometric=geometric) > _SEEN for box in boxes[_EDGE])
        return cls(boxes, thin, seen)

    def draw(self, axes: Axes, *, along_x: bool = False) -> None:
        """Fill the boxes with amplitudes upwards; or `along_x`, with their other sides as fractions of the height."""
        for look, boxes in self.boxes.items():
            _fill(axes, boxes, look, along_x=along_x)
        for left, right, low, high in self.hairlines:
            middle = (low + high) / 2.0
            if along_x:
                axes.axvline(middle, **_THIN)
            else:
                axes.plot([left, right], [middle, middle], **_THIN)


@dataclass(frozen=True, slots=True)
class _Intervals:
    """Intervals of scales of one case: `intervals`; `reach`, to the decided runs beside each interval; `undecided`."""

    intervals: list[tuple[float, float]]
    reach: list[tuple[float, float]]
    undecided: list[tuple[float, float]]

    @classmethod
    def of(cls, one: xr.Dataset) -> "_Intervals":
        """Read the intervals from a table of intervals without axes."""
        begin, end, below, above = (
            one[name].to_numpy() for name in ("interval_from", "interval_to", "safe_below", "safe_above")
        )
        outside = np.where(np.isnan(below), begin, below), np.where(np.isnan(above), end, above)
        stretch = one["undecided_from"].to_numpy(), one["undecided_to"].to_numpy()
        return cls(*(_finite(*pair) for pair in ((begin, end), outside, stretch)))

    def looks(self, last: float) -> dict[Look, list[tuple[float, float]]]:
        """Return the intervals of each look up to the `last` scale; the column survives at all other scales."""
        taken = sorted([*self.reach, *self.undecided])
        free = [(high, low) for (_, high), (low, _) in pairwise([*taken, (last, last)])]
        lowest = min((low for low, _ in self.intervals), default=np.inf)
        sides = [
            side
            for (low, high), (below, above) in zip(self.intervals, self.reach, strict=True)
            for side in ((below, low), (high, above))
        ]
        again = [pair for pair in free if pair[0] > lowest]
        return {_EDGE: sides, _AGAIN: again, _FALLEN: self.intervals, UNDECIDED: self.undecided}


def _finite(low: Floats, high: Floats) -> list[tuple[float, float]]:
    return [pair for pair in zip(low.tolist(), high.tolist(), strict=True) if not np.isnan(pair).any()]


_THIN: dict[str, Any] = {"color": VERMILION, "linewidth": _THINNEST, "solid_capstyle": "butt", "zorder": 2.5}


def _amplitude_ends(one: xr.Dataset, factor: Floats) -> tuple[float, float]:
    """Return the lowest and the highest amplitude of the scan of any case."""
    scales = one["scale"].to_numpy()
    return float((scales[0] * factor).min()), float((scales[-1] * factor).max())


def _is_normalized(found: xr.Dataset) -> bool:
    """Return whether the amplitude is the peak base acceleration over c g, as in the literature."""
    return "frequency_ratio" in found.coords and bool((found["acceleration_ratio"] > 0.0).all())


def _amplitude_label(found: xr.Dataset) -> str:
    """Return the axis label of the amplitudes."""
    return r"peak base acceleration $a/(c\,g)$" if _is_normalized(found) else axis_label(found["scale"])


def _interval_legend(found: xr.Dataset, *, hairlines: int, edges: bool) -> list[Patch | Line2D]:
    """Return the legend entries for the overturning intervals `found`."""
    entries: list[Patch | Line2D] = [
        Patch(label=name, **fill_options(look))
        for name, look in (("survives", _SAFE), ("overturns", _FALLEN), ("survives again", _AGAIN))
    ]
    if hairlines:
        label = f"overturns, narrower than drawn: {plural(hairlines, 'interval')}"
        entries.append(Line2D([], [], **_THIN, label=label))
    if bool(found["undecided_from"].notnull().any()):
        entries.append(Patch(label=undecided_label(found["outcome"]), **fill_options(UNDECIDED)))
    if np.unique(found["acceleration_ratio"]).size > 1 and _is_normalized(found):
        entries.append(Patch(label="not computed", **fill_options(UNFINISHED)))
    if edges:
        entries.append(Patch(label="edge, not resolved", **fill_options(_EDGE)))
    if not _is_normalized(found) and bool((found["acceleration_ratio"] > 0.0).all()):
        entries.append(Line2D([], [], **_WEAKEST, label=r"peak acceleration $c\,g$"))
    return entries


def _run_legend(counts: Sequence[int], markersize: float) -> list[Line2D]:
    """Return the legend entries for uncertain and undecided runs, with their `counts`."""
    looks = zip(counts, ("uncertain", "not decided"), (_UNCERTAIN, _UNKNOWN), strict=True)
    return [
        Line2D([], [], label=f"{name}: {plural(count, 'run')}", markersize=markersize, **look)
        for count, name, look in looks
        if count
    ]


def _share(box: Box, ends: tuple[float, float], *, geometric: bool) -> float:
    """Return the fraction of the axis of amplitudes that a box takes."""
    _, _, low, high = box
    if geometric:
        return float(np.log(high / low) / np.log(ends[1] / ends[0]))
    return (high - low) / (ends[1] - ends[0])


def undecided_label(outcomes: xr.DataArray) -> str:
    """Return "not decided" with the reasons in these outcomes."""
    reasons = undecided_reasons(outcomes)
    return f"not decided: {', '.join(reasons)}" if reasons else "not decided"


def undecided_reasons(outcomes: xr.DataArray) -> list[str]:
    """Return the reasons for undecided runs among these outcomes, each once."""
    codes = set(np.unique(outcomes.to_numpy()).tolist())
    reasons = [one.label for one in Outcome if one in codes.intersection(_UNRESOLVED)]
    return [*reasons, "not computed"] if NOT_COMPUTED in codes else reasons


def _fill(axes: Axes, boxes: Boxes, look: Look, *, along_x: bool) -> None:
    """Fill boxes of finite, positive height with a look; they form one path, so that textures are continuous."""
    shown = np.array([box for box in boxes if box[3] > box[2]]).reshape(-1, 4)
    left, right, low, high = shown.T
    corners = np.stack([[left, low], [right, low], [right, high], [left, high], [left, low]])
    corners = corners[:, ::-1] if along_x else corners
    codes = np.tile([Path.MOVETO, Path.LINETO, Path.LINETO, Path.LINETO, Path.CLOSEPOLY], len(shown))
    path = Path(np.moveaxis(corners, 2, 0).reshape(-1, 2), codes)
    place = {"transform": axes.get_xaxis_transform()} if along_x else {}
    # Boxes without edges meet without a line between them; a hatch has the colour of the edge.
    axes.add_patch(
        PathPatch(path, facecolor=look.colour, edgecolor=look.ink, hatch=look.texture, linewidth=0.0, **place)
    )


_HEIGHT_OF_ONE, _DOT = 3.8, 3.2


@styled
def _plot_intervals_of_one(found: xr.Dataset) -> Figure:
    """Draw the overturning intervals of one column, and its peak tilts between them.

    Parameters
    ----------
    found
        Overturning intervals of one case: `interval_from` … over `interval`, `outcome` and `peak_tilt` over the scale.
    """
    figure = new_figure(_HEIGHT_OF_ONE)
    axes = figure.subplots()
    ratio = float(found["acceleration_ratio"])
    factor = ratio if _is_normalized(found) else 1.0
    scales = found["scale"].to_numpy()
    one, factors = found.expand_dims(case=1), np.array([factor])
    regions = Regions.of(one, factors, np.array([[0.0, 1.0]]), geometric=is_geometric(scales))
    regions.draw(axes, along_x=True)
    if not _is_normalized(found) and ratio > 0.0:
        axes.axvline(1.0 / ratio, **_WEAKEST)
    counts = _draw_runs(axes, found, factor * scales)
    set_scale(axes, "x", scales)
    axes.set(xlim=_amplitude_ends(one, factors), xlabel=_amplitude_label(found), ylabel=r"peak tilt $\theta/\alpha_c$")
    axes.set_ylim(bottom=0.0)
    axes.grid(visible=False)
    axes.set_title(_title(found), fontsize="small")
    tilts = Line2D([], [], color=BLACK, marker=".", markersize=4.0, linewidth=0.9, label="peak tilt where it survives")
    handles = _interval_legend(found, hairlines=len(regions.hairlines), edges=regions.edges)
    figure.legend(handles=[*handles, tilts, *_run_legend(counts, _DOT)], loc="outside lower center", ncols=3)
    return figure


def _draw_runs(axes: Axes, found: xr.Dataset, amplitude: Floats) -> tuple[int, int]:
    """Draw the peak tilts of surviving runs; mark and count uncertain and undecided runs."""
    codes, tilt = found["outcome"].to_numpy(), found["peak_tilt"].to_numpy() / float(found["tipping_angle"])
    unknown = np.isin(codes, _UNRESOLVED)
    uncertain = found["uncertain"].to_numpy() & (codes != NOT_COMPUTED)
    stands = ~unknown & (codes != Outcome.OVERTURNED)
    shown = np.where(stands, tilt, np.nan)
    axes.plot(amplitude, shown, color=BLACK, marker=".", markersize=4.0, linewidth=0.9)
    # Runs without a peak tilt are marked at the lower edge.
    height = np.where(stands, shown, 0.0)
    for chosen, look in ((uncertain, _UNCERTAIN), (unknown, _UNKNOWN)):
        if chosen.any():
            axes.plot(amplitude[chosen], height[chosen], **look, markersize=_DOT, clip_on=False, zorder=4)
    return int(uncertain.sum()), int(unknown.sum())


def _title(found: xr.Dataset) -> str:
    size, tangent = 2.0 * float(found["rim_distance"]), float(np.tan(found["tipping_angle"]))
    parts = [f"one column: size $2R$ = {size:.3g} m, $c$ = {tangent:.3g}"]
    parts += [f"ω / p = {float(found['frequency_ratio']):.3g}"] if _is_normalized(found) else []
    return ", ".join(parts)


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
        return _plot_intervals_of_one(found.squeeze(dims))
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
    rows[0].set_ylabel(_amplitude_label(found))
    handles = _interval_legend(found, hairlines=marks.hairlines, edges=marks.edges)
    columns = 3 if marks.hairlines else 4
    figure.legend(handles=[*handles, *_run_legend(marks.counts, _DOTS[1])], loc="outside lower center", ncols=columns)
    return figure


def _horizontal(one: xr.Dataset, along: str) -> Horizontal:
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
    regions = Regions.of(one, factor, edges, geometric=is_geometric(scales))
    regions.draw(axes)
    marks.hairlines += len(regions.hairlines)
    marks.edges |= regions.edges
    _mark(axes, one, along, factor, marks)
    if not _is_normalized(one) and np.all(ratio > 0.0):
        axes.step(edges.T.ravel("F"), np.repeat(1.0 / ratio, 2), **_WEAKEST)
    finish(axes, along)
    set_scale(axes, "y", scales)
    axes.set_xlim(edges.min(), edges.max())
    axes.set_ylim(_amplitude_ends(one, factor))
    axes.grid(visible=False)


def _mark(axes: Axes, one: xr.Dataset, along: Horizontal, factor: Floats, marks: _Marks) -> None:
    """Mark and count the uncertain and undecided runs of the scan."""
    codes, scales = one["outcome"].to_numpy(), one["scale"].to_numpy()
    size = float(np.clip(_WIDTH / marks.panels / max(codes.shape) / 2.0, *_DOTS))
    uncertain = one["uncertain"].to_numpy() & (codes != NOT_COMPUTED)
    unknown = one["outcome"].isin(_UNRESOLVED).to_numpy()
    for kind, (chosen, look) in enumerate(((uncertain, _UNCERTAIN), (unknown, _UNKNOWN))):
        rows, columns = np.nonzero(chosen)
        marks.counts[kind] += rows.size
        if rows.size <= _MOST_MARKED * chosen.size:
            axes.plot(along.values[rows], factor[rows] * scales[columns], **look, markersize=size)
