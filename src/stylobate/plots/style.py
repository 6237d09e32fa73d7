"""Style of figures: a palette for colour-blind readers and grey print, below the settings of the user's own style.

Figures are drawn for white paper. `styled` then gives their neutral colours (black, white, grey) those of the user's
style, so that a dark style has light lines on a dark ground. The colours of the palette keep their meaning.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from functools import wraps
from typing import Any, ParamSpec

import numpy as np
import xarray as xr
from matplotlib import rc_context, rcParams, rcParamsDefault
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import Collection
from matplotlib.colors import ListedColormap, to_rgb, to_rgba, to_rgba_array
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.text import Annotation, Text

from stylobate.plots.labels import in_own_units, with_literal_names
from stylobate.plots.result_figure import (
    WIDTH,
    InAxes,
    ResultFigure,
    asked_for,
    enlarged,
    fit_words,
    missing_glyphs,
    thin_out_ticks,
    usual_font,
)

# Okabe and Ito's palette ("Color Universal Design", 2008) without its yellow; the lightness alternates.
PALETTE = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000")
BLUE, VERMILION, GREEN, PURPLE, SKY, ORANGE, BLACK = PALETTE
GREY = "#767676"

# Line styles that tell curves apart without colour.
DASHES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (1, 3)))

STABLE_WIDTH, UNSTABLE_WIDTH = 2.8, 0.9

# Smallest size of text [points] unless the user's own font is smaller.
_SMALLEST = 6.0

AS_DRAWN = "as drawn"
"""Gid of texts and patches that keep their colours in dark styles: what is written on a coloured ground."""

_SETTINGS: dict[Any, Any] = {
    "axes.titlesize": "medium",
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.6,
    "legend.frameon": False,
    "legend.fontsize": "small",
    "hatch.linewidth": 0.55,
}
_COLOURS = (
    *("text.color", "axes.facecolor", "axes.edgecolor", "axes.labelcolor", "axes.titlecolor", "figure.facecolor"),
    *("xtick.color", "xtick.labelcolor", "ytick.color", "ytick.labelcolor", "legend.facecolor", "legend.edgecolor"),
    *("legend.labelcolor", "patch.edgecolor", "hatch.color"),
)
# Colours differ from grey by less than this in any component, or they are no neutral colours.
_NEUTRAL = 0.02
# On a dark ground, colours with components below this mean are mixed with so much of the colour of text.
_DIM, _LIGHTER = 0.5, 0.3
# Colour maps of so many colours or fewer are those of classes.
_CLASSES = 32

P = ParamSpec("P")
_DRAWING: ContextVar[bool] = ContextVar("_DRAWING", default=False)
_PAPER: ContextVar[Any] = ContextVar("_PAPER", default="white")


def styled(draw: Callable[P, Figure]) -> Callable[P, Figure]:
    """Apply the settings of this package below those of the user.

    Dimensionless columns are labelled in their units, and names that a study states are printed as they are.
    """

    @wraps(draw)
    def drawn(*args: P.args, **kwargs: P.kwargs) -> Figure:
        if _DRAWING.get():  # a part of another figure
            return draw(*args, **kwargs)
        caller = asked_for().axes
        present = set() if caller is None else {*caller.findobj()}
        token = _DRAWING.set(True)
        try:
            with _settings(), missing_glyphs():  # the file of the figure remarks on them
                results: Any = [in_own_units(one) for one in args]
                shown: Any = [with_literal_names(one) if isinstance(one, xr.Dataset) else one for one in results]
                figure = draw(*shown, **kwargs)
                smallest = min(_SMALLEST, float(rcParams["font.size"]))
                page = figure.finished() if isinstance(figure, InAxes) else figure
                panels = page.axes if caller is None else [caller]
                new = [one for one in (page if caller is None else caller).findobj() if one not in present]
                fit_words(page, panels, new, smallest)
                if isinstance(figure, ResultFigure):
                    figure.make_place()
                thin_out_ticks(page, panels)
        finally:
            _DRAWING.reset(token)
        new = [one for one in (page if caller is None else caller).findobj() if one not in present]
        _restyle(page, panels, new, 1.0 if caller is not None else enlarged())
        return page

    return drawn


def new_figure(height: float, *, width: float = WIDTH) -> Figure:
    """Return an empty figure of this `width` and `height` [inches], or of the size or in the axes that were asked for.

    It is drawn apart from any interactive backend.
    """
    return ResultFigure.asked_for(height, width)


@contextmanager
def _settings() -> Iterator[None]:
    """Draw for white paper with our settings, except for those that the user changed."""
    ours = {"font.size": usual_font(), **_SETTINGS}
    theirs: dict[Any, Any] = dict(rcParams)
    factory: dict[Any, Any] = dict(rcParamsDefault)
    settings = {name: value for name, value in ours.items() if theirs[name] == factory[name]}
    white = {name: factory[name] for name in _COLOURS}
    token = _PAPER.set(theirs["axes.facecolor"])
    try:
        with rc_context(settings | white | {"grid.color": _SETTINGS["grid.color"]}):
            yield
    finally:
        _PAPER.reset(token)


def paper() -> tuple[float, float, float]:
    """Return red, green and blue of the ground in the user's style, for what is drawn with the gid AS_DRAWN."""
    return to_rgb(_PAPER.get())


def _restyle(figure: Figure, panels: Sequence[Axes], drawn: Sequence[Artist], scale: float) -> None:
    """Give the neutral colours of what was drawn those of the user's style, and enlarge its lines and marks."""
    ink, paper = (np.array(to_rgba(rcParams[name])[:3]) for name in ("text.color", "axes.facecolor"))
    dark = not (np.all(ink == 0.0) and np.all(paper == 1.0))
    if not dark and scale == 1.0:
        return

    def themed(colours: Any) -> Any:
        found = np.array([to_rgba(colours)]) if isinstance(colours, str | tuple) else to_rgba_array(colours)
        neutral = np.ptp(found[:, :3], axis=1, keepdims=True) < _NEUTRAL if len(found) else np.zeros((0, 1), bool)
        level = found[:, :3].mean(axis=1, keepdims=True) if len(found) else np.zeros((0, 1))
        lighter = found[:, :3] + (_LIGHTER * (ink - found[:, :3]) if paper.mean() < ink.mean() else 0.0)
        found[:, :3] = np.where(neutral, ink + level * (paper - ink), np.where(level < _DIM, lighter, found[:, :3]))
        return found

    for artist in drawn:
        if dark and artist.get_gid() != AS_DRAWN:
            _recolour(artist, themed)
        _enlarge(artist, scale)
    for axes in panels:
        if dark:
            tick = dict.fromkeys(("color", "labelcolor"), rcParams["xtick.color"])
            axes.tick_params(which="both", **tick, grid_color=themed(_SETTINGS["grid.color"])[0])
    if dark and isinstance(figure, ResultFigure):
        figure.patch.set_facecolor(rcParams["figure.facecolor"])


def _recolour(artist: Artist, themed: Callable[[Any], Any]) -> None:
    match artist:
        case Line2D():
            colours = (artist.get_color(), artist.get_markerfacecolor(), artist.get_markeredgecolor())
            line, face, edge = (themed(one)[0] for one in colours)
            artist.set(color=line, markerfacecolor=face, markeredgecolor=edge)
        case Text():
            artist.set_color(themed(artist.get_color())[0])
            for patch in (artist.get_bbox_patch(), artist.arrow_patch if isinstance(artist, Annotation) else None):
                if patch is not None:
                    _recolour(patch, themed)
        case Patch():
            artist.set(facecolor=themed(artist.get_facecolor())[0], edgecolor=themed(artist.get_edgecolor())[0])
        case Collection():
            if artist.get_array() is None:
                artist.set_facecolor(themed(artist.get_facecolor()))
                artist.set_edgecolor(themed(artist.get_edgecolor()))
            elif isinstance(artist.cmap, ListedColormap) and artist.cmap.N <= _CLASSES:
                artist.set_cmap(ListedColormap(themed(artist.cmap.colors)))


def _enlarge(artist: Artist, scale: float) -> None:
    if isinstance(artist, Line2D):
        artist.set(linewidth=scale * artist.get_linewidth(), markersize=scale * artist.get_markersize())
        artist.set_markeredgewidth(scale * artist.get_markeredgewidth())
    elif isinstance(artist, Patch):
        artist.set_linewidth(scale * artist.get_linewidth())
    elif isinstance(artist, Collection):
        artist.set_linewidth([scale * width for width in np.atleast_1d(artist.get_linewidth())])
