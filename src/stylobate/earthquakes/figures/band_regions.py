"""Where in a figure a column overturns, is safe again, or is undecided: boxes over amplitude, and hairlines."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path

from stylobate.errors import Outcome
from stylobate.plots.cells import fill_options
from stylobate.plots.classes import OUTCOME_LOOKS, UNFINISHED, Look
from stylobate.plots.labels import axis_label
from stylobate.plots.style import BLACK, BLUE, GREY, VERMILION
from stylobate.results.outcomes import NOT_COMPUTED
from stylobate.text import plural

Floats = npt.NDArray[np.float64]
Box = tuple[float, float, float, float]
# Left, right, lowest and highest amplitude of each.
Boxes = list[Box]

UNRESOLVED = [Outcome.FAILED, Outcome.LIFTED_OFF, Outcome.LIMIT_REACHED]
UNCERTAIN: dict[str, Any] = {"marker": "o", "mfc": "white", "mec": BLACK, "mew": 0.5, "linestyle": "none"}
UNKNOWN: dict[str, Any] = {"marker": "x", "color": VERMILION, "linestyle": "none"}
WEAKEST: dict[str, Any] = {"color": BLUE, "linestyle": "--", "linewidth": 1.2}
"""The line below which the peak acceleration is below g tan α."""

_SAFE, _AGAIN, _FALLEN = Look("#ffffff"), Look("#DCEBF5", "////", BLUE), OUTCOME_LOOKS[Outcome.OVERTURNED]
_EDGE = Look(GREY)
UNDECIDED = Look("#e6e6e6", "xxx", GREY)
"""Where runs ended before they showed whether the column overturns."""
# An edge wider than this fraction appears in the legend.
_WIDE_EDGE = 0.01
# What takes less than this part of the axis would be thinner than a line of this width [points], and is drawn as one.
_HAIRLINE, _THINNEST = 0.007, 2.0


@dataclass(frozen=True, slots=True)
class Regions:
    """The boxes of each look, and the bands too narrow to be seen: `hairlines`."""

    boxes: dict[Look, Boxes]
    hairlines: Boxes

    @classmethod
    def of(cls, one: xr.Dataset, factor: Floats, edges: Floats, *, geometric: bool) -> "Regions":
        """Return the regions of the cases in `one`.

        Parameters
        ----------
        one
            Bands over (case, band), runs over (case, scale).
        factor
            By which the scales of each case are multiplied where they are drawn, shape (case,).
        edges
            Between which each case is drawn, shape (case, 2).
        geometric
            Whether the axis of amplitudes is logarithmic.
        """
        scales, ends = one["scale"].to_numpy(), amplitude_ends(one, factor)
        boxes: dict[Look, Boxes] = {_EDGE: [], _AGAIN: [], _FALLEN: [], UNDECIDED: [], UNFINISHED: []}
        for place, (left, right) in enumerate(edges.tolist()):
            unit = float(factor[place])
            own = _Intervals.of(one.isel({one["bands"].dims[0]: place}))
            first, last = unit * float(scales[0]), unit * float(scales[-1])
            boxes[UNFINISHED] += [(left, right, ends[0], first), (left, right, last, ends[1])]
            for look, intervals in own.looks(float(scales[-1])).items():
                boxes[look] += [(left, right, unit * low, unit * high) for low, high in intervals]
        thin = [box for box in boxes[_FALLEN] if _share(box, ends, geometric=geometric) < _HAIRLINE]
        return cls(boxes, thin)

    @property
    def has_wide_edges(self) -> bool:
        """Whether there is an edge wide enough for the legend."""
        return any(high > (1.0 + _WIDE_EDGE) * low for _, _, low, high in self.boxes[_EDGE])

    def draw(self, axes: Axes, *, along_x: bool = False) -> None:
        """Fill the boxes, amplitudes upwards; or `along_x`, their other sides then parts of the height of the axes."""
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
    """The scales of one case: of bands, between the decided runs beside each, and of what is undecided."""

    bands: list[tuple[float, float]]
    reach: list[tuple[float, float]]
    undecided: list[tuple[float, float]]

    @classmethod
    def of(cls, one: xr.Dataset) -> "_Intervals":
        """Return the intervals in a table of bands without axes."""
        begin, end, below, above = (
            one[name].to_numpy() for name in ("band_from", "band_to", "safe_below", "safe_above")
        )
        outside = np.where(np.isnan(below), begin, below), np.where(np.isnan(above), end, above)
        stretch = one["undecided_from"].to_numpy(), one["undecided_to"].to_numpy()
        return cls(*(_finite(*pair) for pair in ((begin, end), outside, stretch)))

    def looks(self, last: float) -> dict[Look, list[tuple[float, float]]]:
        """Return the intervals of each look up to the `last` scale; what is left is safe and was so below."""
        taken = sorted([*self.reach, *self.undecided])
        free = [(high, low) for (_, high), (low, _) in pairwise([*taken, (last, last)])]
        lowest = min((low for low, _ in self.bands), default=np.inf)
        sides = [
            side
            for (low, high), (below, above) in zip(self.bands, self.reach, strict=True)
            for side in ((below, low), (high, above))
        ]
        again = [pair for pair in free if pair[0] > lowest]
        return {_EDGE: sides, _AGAIN: again, _FALLEN: self.bands, UNDECIDED: self.undecided}


def _finite(low: Floats, high: Floats) -> list[tuple[float, float]]:
    return [pair for pair in zip(low.tolist(), high.tolist(), strict=True) if not np.isnan(pair).any()]


_THIN: dict[str, Any] = {"color": VERMILION, "linewidth": _THINNEST, "solid_capstyle": "butt", "zorder": 2.5}


def amplitude_ends(one: xr.Dataset, factor: Floats) -> tuple[float, float]:
    """Return the lowest and the highest amplitude of the scan of any case."""
    scales = one["scale"].to_numpy()
    return float((scales[0] * factor).min()), float((scales[-1] * factor).max())


def is_normalized(found: xr.Dataset) -> bool:
    """Return whether the bands are drawn as in the literature, by the peak base acceleration over g tan α."""
    return "frequency_ratio" in found.coords and bool((found["acceleration_ratio"] > 0.0).all())


def amplitude_label(found: xr.Dataset) -> str:
    """Return what the amplitudes are called in a figure of the bands."""
    return r"peak base acceleration $a/(c\,g)$" if is_normalized(found) else axis_label(found["scale"])


def band_legend(found: xr.Dataset, *, hairlines: int, wide_edges: bool) -> list[Patch | Line2D]:
    """Return the entries of a legend for what is drawn of all the bands `found`."""
    entries: list[Patch | Line2D] = [
        Patch(label=name, **fill_options(look))
        for name, look in (("survives", _SAFE), ("overturns", _FALLEN), ("survives again", _AGAIN))
    ]
    if hairlines:
        label = f"overturns, narrower than drawn: {plural(hairlines, 'interval')}"
        entries.append(Line2D([], [], **_THIN, label=label))
    if bool(found["undecided_from"].notnull().any()):
        entries.append(Patch(label=undecided_label(found["outcome"]), **fill_options(UNDECIDED)))
    if np.unique(found["acceleration_ratio"]).size > 1 and is_normalized(found):
        entries.append(Patch(label="not computed", **fill_options(UNFINISHED)))
    if wide_edges:
        entries.append(Patch(label="edge, undecided", **fill_options(_EDGE)))
    if not is_normalized(found) and bool((found["acceleration_ratio"] > 0.0).all()):
        entries.append(Line2D([], [], **WEAKEST, label=r"peak acceleration $c\,g$"))
    return entries


def run_legend(counts: Sequence[int], markersize: float) -> list[Line2D]:
    """Return the entries for runs that are uncertain, and for those that are undecided, of which there are so many."""
    looks = zip(counts, ("uncertain", "not decided"), (UNCERTAIN, UNKNOWN), strict=True)
    return [
        Line2D([], [], label=f"{name}: {plural(count, 'run')}", markersize=markersize, **look)
        for count, name, look in looks
        if count
    ]


def _share(box: Box, ends: tuple[float, float], *, geometric: bool) -> float:
    """Return which part of the axis of amplitudes a box takes."""
    _, _, low, high = box
    if geometric:
        return float(np.log(high / low) / np.log(ends[1] / ends[0]))
    return (high - low) / (ends[1] - ends[0])


def undecided_label(outcomes: xr.DataArray) -> str:
    """Return "not decided", with the reasons that are among these outcomes of runs."""
    reasons = undecided_reasons(outcomes)
    return f"not decided: {', '.join(reasons)}" if reasons else "not decided"


def undecided_reasons(outcomes: xr.DataArray) -> list[str]:
    """Return why runs with these outcomes are undecided, in words, each once."""
    codes = set(np.unique(outcomes.to_numpy()).tolist())
    reasons = [one.label for one in Outcome if one in codes.intersection(UNRESOLVED)]
    return [*reasons, "not computed"] if NOT_COMPUTED in codes else reasons


def _fill(axes: Axes, boxes: Boxes, look: Look, *, along_x: bool) -> None:
    """Fill boxes, but those of no height or no end, with a look; they are one path, so that textures go on."""
    shown = np.array([box for box in boxes if box[3] > box[2]]).reshape(-1, 4)
    left, right, low, high = shown.T
    corners = np.stack([[left, low], [right, low], [right, high], [left, high], [left, low]])
    corners = corners[:, ::-1] if along_x else corners
    codes = np.tile([Path.MOVETO, Path.LINETO, Path.LINETO, Path.LINETO, Path.CLOSEPOLY], len(shown))
    path = Path(np.moveaxis(corners, 2, 0).reshape(-1, 2), codes)
    place = {"transform": axes.get_xaxis_transform()} if along_x else {}
    # Boxes meet without a line between them if they are drawn without edges; a hatch has the colour of its edge.
    axes.add_patch(
        PathPatch(path, facecolor=look.colour, edgecolor=look.ink, hatch=look.texture, linewidth=0.0, **place)
    )
