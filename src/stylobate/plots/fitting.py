"""Fit texts, ticks and legends into their panels once the layout is known, by measuring them."""

import re
import textwrap
import warnings
from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis, XAxis
from matplotlib.collections import QuadMesh
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.text import Text
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator
from matplotlib.transforms import Bbox

# A title may reach this far over its panel [widths], a label of an axis this far.
_TITLE, _LABEL = 1.12, 1.04
# Minimum number of characters in a line, and distance between numbers of an axis [pixels].
_CHARACTERS, _APART = 9, 6.0
_MOST_TICKS = 6
# Lengths below this are written in mm [m].
_SHORT = 0.1
# A legend in a panel has no place if it takes this part of the panel, or lies on a curve and takes the second part.
_LARGE, _ON_CURVE = 0.3, 0.2
# A logarithmic axis of fewer decades has ticks at equal distances.
_DECADES = 1.5
# Points between two of a curve at which it may lie below a legend.
_BETWEEN = 8
_TYPESET = re.compile(r"\$[^$]*\$")


def fit_words(figure: Figure, panels: Sequence[Axes], drawn: Iterable[Artist], smallest: float) -> None:
    """Break long titles and labels, write short lengths in mm, and enlarge texts below a font size.

    Parameters
    ----------
    panels
        The panels that were drawn in.
    drawn
        The artists that were drawn.
    smallest
        Smallest size of text [points].
    """
    for one in drawn:
        if isinstance(one, Text) and float(one.get_fontsize()) < smallest:
            one.set_fontsize(smallest)
    for axes in panels:
        _in_millimetres(axes)
    for text in figure.texts if len(panels) == len(figure.axes) else ():
        _wrap(text, figure.bbox.width - text.get_window_extent().x0)
    _lay_out(figure)
    for axes in panels:
        _fit_words(axes)
    _lay_out(figure)


def thin_out_ticks(figure: Figure, panels: Sequence[Axes]) -> None:
    """Reduce the number of ticks until their numbers do not overlap."""
    _lay_out(figure)
    for axes in panels:
        axes.apply_aspect()
        for axis in (axes.xaxis, axes.yaxis):
            _thin_out(axis)


def has_no_place(legend: Legend, axes: Axes) -> bool:
    """Return whether a legend within a panel covers what the panel shows."""
    box, panel = legend.get_window_extent(), axes.get_window_extent()
    common = Bbox.intersection(box, panel)
    if common is None:
        return False
    part = common.width * common.height / (panel.width * panel.height)
    return part > _LARGE or (part > _ON_CURVE and _crosses(box, axes))


def entries_of(legend: Legend, axes: Axes) -> tuple[list[Artist], list[str]]:
    """Return handles and labels from which the legend of a panel can be made again."""
    names = [text.get_text() for text in legend.get_texts()]
    handles = dict(zip(*axes.get_legend_handles_labels()[::-1], strict=True))
    made: list[Any] = list(legend.legend_handles)
    return [handles.get(name) or one for name, one in zip(names, made, strict=True)], names


def is_filled(axes: Axes) -> bool:
    """Return whether a panel is a map, so that a legend within it covers cells."""
    return any(isinstance(one, QuadMesh) for one in axes.collections)


def _lay_out(figure: Figure) -> None:
    engine = figure.get_layout_engine()
    if engine is not None:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # a layout without room is reported when the figure is drawn
            engine.execute(figure)


def _crosses(box: Bbox, axes: Axes) -> bool:
    for line in axes.lines:
        if line.get_transform() == axes.transData:
            points = axes.transData.transform(line.get_path().interpolated(_BETWEEN).vertices)
            if np.any(np.all((points > box.min) & (points < box.max), axis=1)):
                return True
    return False


def _fit_words(axes: Axes) -> None:
    panel = axes.get_window_extent()
    for place in ("left", "center", "right"):
        words = axes.get_title(loc=place)
        for text in axes.findobj(Text) if words else ():
            if isinstance(text, Text) and text.get_text() == words:
                _wrap(text, _TITLE * panel.width if place != "right" else panel.x1)
    _wrap(axes.xaxis.label, _LABEL * panel.width)
    _wrap(axes.yaxis.label, _LABEL * panel.height)


def _wrap(text: Text, room: float) -> None:
    """Break a text into as few lines of similar length as fit into `room` [pixels], between words."""
    words = text.get_text()
    if _length(text) <= room or " " not in words:
        return
    # A formula stays whole.
    kept = _TYPESET.sub(lambda found: found.group().replace(" ", "\0"), words)
    characters = max(map(len, kept.splitlines()))
    for most in range(characters, _CHARACTERS - 1, -1):
        lines = _lines(kept, most)
        text.set_text("\n".join(lines).replace("\0", " "))
        if _length(text) <= room:
            break
    while most > _CHARACTERS and len(_lines(kept, most - 1)) == len(lines):
        most -= 1
    text.set_text("\n".join(_lines(kept, most)).replace("\0", " "))


def _lines(words: str, most: int) -> list[str]:
    return [part for line in words.splitlines() for part in textwrap.wrap(line, most, break_long_words=False)]


def _length(text: Text) -> float:
    box = text.get_window_extent()
    return float(box.height if text.get_rotation() == 90.0 else box.width)  # noqa: PLR2004  degrees


def _in_millimetres(axes: Axes) -> None:
    """Write short lengths in mm: the numbers of an axis and its unit; axes of one scale have one unit."""
    lengths = [axis for axis in (axes.xaxis, axes.yaxis) if axis.label.get_text().endswith("[m]")]
    short = [axis for axis in lengths if np.abs(axis.get_view_interval()).max() < _SHORT]
    if axes.get_aspect() != "auto" and short != lengths:
        return
    for axis in short:
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{1e3 * value:.6g}".replace("-", "−")))
        axis.label.set_text(f"{axis.label.get_text().removesuffix('[m]')}[mm]")


def _thin_out(axis: Axis) -> None:
    """Reduce the number of ticks until their numbers do not overlap."""
    if not isinstance(locator := axis.get_major_locator(), MaxNLocator | LogLocator):
        return
    coarser: list[MaxNLocator | LogLocator] = [
        MaxNLocator(most, steps=[1, 2, 2.5, 4, 5, 10], min_n_ticks=min(most, 2)) for most in range(_MOST_TICKS, 0, -1)
    ]
    if isinstance(locator, LogLocator):
        low, high = np.log10(np.abs(axis.get_view_interval()))
        coarser = [LogLocator(subs=(1.0, 3.0)), LogLocator()] if high - low > _DECADES else coarser[-3:]
    for one in coarser:
        if not _overlap(axis):
            return
        axis.set_major_locator(one)


def _overlap(axis: Axis) -> bool:
    """Return whether numbers of an axis overlap."""
    axis.get_majorticklabels()  # places the labels
    low, high = sorted(axis.get_view_interval())
    shown = [tick.label1 for tick in axis.get_major_ticks() if low <= tick.get_loc() <= high]
    boxes = [one.get_window_extent() for one in shown if one.get_visible() and one.get_text()]
    across = isinstance(axis, XAxis)
    along = sorted((box.x0, box.x1) if across else (box.y0, box.y1) for box in boxes)
    gap = _APART if across else 0.0
    return any(after[0] < before[1] + gap for before, after in pairwise(along))
