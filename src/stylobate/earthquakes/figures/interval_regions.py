"""Regions of a figure of overturning intervals: overturning, survival, undecided, as boxes and hairlines."""

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
from stylobate.plots.cells import OUTCOME_LOOKS, UNFINISHED, Look, fill_options
from stylobate.plots.labels import axis_label
from stylobate.plots.style import BLACK, BLUE, GREY, VERMILION
from stylobate.results.outcomes import NOT_COMPUTED
from stylobate.text import plural

Floats = npt.NDArray[np.float64]
Box = tuple[float, float, float, float]
"""Left, right, lowest and highest amplitude."""
Boxes = list[Box]

UNRESOLVED = [Outcome.FAILED, Outcome.LIFTED_OFF, Outcome.LIMIT_REACHED]
UNCERTAIN: dict[str, Any] = {"marker": "o", "mfc": "white", "mec": BLACK, "mew": 0.5, "linestyle": "none"}
UNKNOWN: dict[str, Any] = {"marker": "x", "color": VERMILION, "linestyle": "none"}
WEAKEST: dict[str, Any] = {"color": BLUE, "linestyle": "--", "linewidth": 1.2}
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
        scales, ends = one["scale"].to_numpy(), amplitude_ends(one, factor)
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


def amplitude_ends(one: xr.Dataset, factor: Floats) -> tuple[float, float]:
    """Return the lowest and the highest amplitude of the scan of any case."""
    scales = one["scale"].to_numpy()
    return float((scales[0] * factor).min()), float((scales[-1] * factor).max())


def is_normalized(found: xr.Dataset) -> bool:
    """Return whether the amplitude is the peak base acceleration over c g, as in the literature."""
    return "frequency_ratio" in found.coords and bool((found["acceleration_ratio"] > 0.0).all())


def amplitude_label(found: xr.Dataset) -> str:
    """Return the axis label of the amplitudes."""
    return r"peak base acceleration $a/(c\,g)$" if is_normalized(found) else axis_label(found["scale"])


def interval_legend(found: xr.Dataset, *, hairlines: int, edges: bool) -> list[Patch | Line2D]:
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
    if np.unique(found["acceleration_ratio"]).size > 1 and is_normalized(found):
        entries.append(Patch(label="not computed", **fill_options(UNFINISHED)))
    if edges:
        entries.append(Patch(label="edge, not resolved", **fill_options(_EDGE)))
    if not is_normalized(found) and bool((found["acceleration_ratio"] > 0.0).all()):
        entries.append(Line2D([], [], **WEAKEST, label=r"peak acceleration $c\,g$"))
    return entries


def run_legend(counts: Sequence[int], markersize: float) -> list[Line2D]:
    """Return the legend entries for uncertain and undecided runs, with their `counts`."""
    looks = zip(counts, ("uncertain", "not decided"), (UNCERTAIN, UNKNOWN), strict=True)
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
    reasons = [one.label for one in Outcome if one in codes.intersection(UNRESOLVED)]
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
