"""The figure of a result: it shows itself in notebooks and by `show`, and its layout suits the width asked for.

Texts, ticks and legends are fitted into their panels once the layout is known, by measuring them.
"""

import math
import re
import sys
import textwrap
import warnings
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from io import BytesIO
from itertools import pairwise
from typing import Any, Literal, cast

import numpy as np
from matplotlib import rc_context, rcParams, rcParamsDefault
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis, XAxis
from matplotlib.collections import QuadMesh
from matplotlib.colorbar import Colorbar
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.text import Text
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, MaxNLocator
from matplotlib.transforms import Bbox, ScaledTranslation

from stylobate.errors import ParameterError, UnlikelyInputWarning

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
# Words of more characters, such as names without blanks, are broken where room is missing, and in legends; names of an
# axis are shortened, since each has one line.
_WORD, _WHOLE_WORD = 20, 32
# A broken word keeps this part of the room.
_WITHIN = 0.85
_JOINT = re.compile(r"[^_./\-]+[_./\-]*|[_./\-]+")


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
    whole = dict[Text, str]()
    for one in drawn:
        if isinstance(one, Text) and float(one.get_fontsize()) < smallest:
            one.set_fontsize(smallest)
        words = one.get_text().split() if isinstance(one, Text) and one not in figure.texts else ()
        if isinstance(one, Text) and max(map(len, words), default=0) > _WHOLE_WORD:
            whole[one] = one.get_text()  # a layout with the whole word would leave its panel no room
            one.set_text(_broken(one.get_text(), _WHOLE_WORD))
    for axes in panels:
        _in_millimetres(axes)
        for axis in (axes.xaxis, axes.yaxis):
            _shorten_names(axis)
    for text in figure.texts if len(panels) == len(figure.axes) else ():
        _wrap(text, figure.bbox.width - text.get_window_extent().x0)
    _lay_out(figure)
    entries = {text for one in figure.findobj(Legend) for text in one.get_texts()}
    for text in whole.keys() - entries:
        text.set_text(whole[text])
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
                beyond = axes.figure.bbox.x1 - panel.x0 if place == "left" else math.inf
                _wrap(text, min(_TITLE * panel.width, beyond) if place != "right" else panel.x1)
    _wrap(axes.xaxis.label, _LABEL * panel.width)
    _wrap(axes.yaxis.label, _LABEL * panel.height)


def _wrap(text: Text, room: float) -> None:
    """Break a text into as few lines of similar length as fit into `room` [pixels], between words if possible."""
    words, length = text.get_text(), _length(text)
    if length <= room:
        return
    most = int(max(map(len, words.splitlines())) * _WITHIN * room / length)
    text.set_text(words := _broken(words, max(_CHARACTERS, most)))
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


def _broken(text: str, most: int) -> str:
    """Break long words into lines of at most `most` characters; a formula stays whole."""
    if "$" in text:
        return text
    parts = re.split(r"(\s+)", text)
    return "".join(one if len(one) <= max(_WORD, most) else "\n".join(_pieces(one, most)) for one in parts)


def _pieces(word: str, most: int) -> list[str]:
    """Cut a word into pieces of at most `most` characters, after one of _ . / - if possible."""
    found = [""]
    for part in _JOINT.findall(word):
        cut = [part[at : at + most] for at in range(0, len(part), most)]
        for one in cut:
            if len(found[-1]) + len(one) <= most:
                found[-1] += one
            else:
                found.append(one)
    return [one for one in found if one]


def _lines(words: str, most: int) -> list[str]:
    return [part for line in words.splitlines() for part in textwrap.wrap(line, most, break_long_words=False)]


def _length(text: Text) -> float:
    box = text.get_window_extent()
    return float(box.height if text.get_rotation() == 90.0 else box.width)  # noqa: PLR2004  degrees


def _shorten_names(axis: Axis) -> None:
    """Leave the middle out of long names at an axis."""
    if isinstance(axis.get_major_locator(), FixedLocator):
        names = [label.get_text() for label in axis.get_majorticklabels()]
        words = [max(name.split(), key=len, default="") for name in names]
        if max(map(len, words), default=0) > _WHOLE_WORD:
            axis.set_ticklabels([name.replace(word, _short(word)) for name, word in zip(names, words, strict=True)])


def _short(word: str) -> str:
    end = _WHOLE_WORD // 3
    return word if len(word) <= _WHOLE_WORD or "$" in word else f"{word[: 2 * end]}…{word[-end:]}"


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


WIDTH = 7.2
"""Width of a figure that spans a page [inches]."""

# A narrower figure has one column of panels, with the legend below.
_NARROW = 5.2
# A narrower figure is lower by this part of the difference in width; minimum height [inches].
_SHRINKS, _LEAST = 0.65, 1.9
# Dots per inch in a notebook: twice those of the page, for screens of high resolution.
_SCREEN = 96.0
# Width of a character, of the font size; of the mark of an entry of a legend and the
# space about it [inches]; height of a line, of the font size.
_CHARACTER, _MARK, _LINE = 0.52, 0.5, 1.5
_POINTS = 72.0
# Font size [points] of a figure that spans a page, and of one in a column of a journal, which is at most this wide.
_FONT, _FONT_OF_A_COLUMN, _COLUMN = 9.5, 8.0, 4.5
# Above this width [inches], as on a slide, everything grows with the figure.
_SLIDE = 8.5
# A legend stands below given axes if it takes less than this part of their height, else beside them.
_BELOW = 0.4
# Settings with which files keep their texts as texts, unless the user changed them.
_SAVED = {"pdf.fonttype": 42, "ps.fonttype": 42, "svg.fonttype": "none"}


@dataclass(frozen=True, slots=True)
class Asked:
    """What the caller asked for: the `size` of the figure (width and height or None) [inches], or `axes` to draw in."""

    size: tuple[float, float | None] | None = None
    axes: Axes | None = None


_DEFAULT = Asked()
_ASKED: ContextVar[Asked] = ContextVar("_ASKED")


def asked_for() -> Asked:
    """Return the size or the axes that the caller of the figure asked for."""
    return _ASKED.get(_DEFAULT)


@contextmanager
def drawing(size: float | tuple[float, float] | None = None, axes: Axes | None = None) -> Iterator[None]:
    """Draw figures in a `size`, or in `axes` of another figure, within this context.

    Parameters
    ----------
    size
        Width [inches], or width and height; by default 7.2 inches, with a height that suits the content.
    axes
        Axes of a figure of the caller, for figures of one panel.

    Raises
    ------
    ParameterError
        If the size is not positive, or both are given.
    """
    if size is not None and axes is not None:
        raise ParameterError(f"size: the axes have their own (got {size!r}). Leave size or axes out")
    if axes is not None and not isinstance(axes, Axes):
        raise ParameterError(f"axes must be Matplotlib's Axes, got {type(axes).__name__}")
    asked = None if size is None else _checked(size)
    token = _ASKED.set(Asked(asked, axes))
    try:
        yield
    finally:
        _ASKED.reset(token)


def enlarged() -> float:
    """Return the factor by which fonts and lines of the figure grow: more than 1 on a slide."""
    width = _width()
    return width / WIDTH if width > _SLIDE else 1.0


def usual_font() -> float:
    """Return the font size of a figure of the width asked for [points]."""
    return _FONT_OF_A_COLUMN if _width() <= _COLUMN else _FONT * enlarged()


def font_ratio() -> float:
    """Return the font size in use over that of a page: heights of panels suit it."""
    return float(rcParams["font.size"]) / _FONT


def _width() -> float:
    size = asked_for().size
    return WIDTH if size is None else size[0]


def heading(figure: Figure, text: str) -> None:
    """Write `text` above all panels; lines that do not fit the width are broken."""
    figure.suptitle(text, x=0.01, ha="left", fontsize="medium")


def beside_or_below(figure: Figure) -> Literal["right", "bottom"]:
    """Return the place of a colour bar: below the panel in a narrow figure."""
    return "bottom" if isinstance(figure, ResultFigure) and figure.narrow else "right"


def _checked(size: Any) -> tuple[float, float | None]:
    match size:
        case (width, height) | [width, height]:
            pass
        case width:
            height = None
    try:
        sides = float(width), None if height is None else float(height)
    except (TypeError, ValueError):
        sides = math.nan, None
    if not all(side is None or 0.0 < side < math.inf for side in sides):
        raise ParameterError(f"size must be a positive width, or width and height, in inches, got {size!r}")
    return sides


_MISSING = re.compile(r"Glyph (\d+) .* missing from (?:current )?font")


@contextmanager
def missing_glyphs() -> Iterator[dict[str, None]]:
    """Yield the characters of what is drawn in this context that the fonts lack, in place of many warnings."""
    found = dict[str, None]()
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        yield found
    for one in caught:
        if glyph := _MISSING.match(str(one.message)):
            found[chr(int(glyph[1]))] = None
        else:
            warnings.warn_explicit(one.message, one.category, one.filename, one.lineno)


def remark_on_glyphs(missing: Iterable[str], remedy: str) -> None:
    """Warn of characters that are drawn as boxes, because the fonts lack them."""
    message = f"fonts: boxes are drawn for characters that they lack (got {', '.join(missing)}). {remedy}."
    warnings.warn(message, UnlikelyInputWarning, stacklevel=3)


class ResultFigure(Figure):
    """A Matplotlib figure of a result, drawn without pyplot: it is never shown twice and need not be closed.

    It is displayed at the end of a notebook's cell, or by `show`.
    """

    def __init__(self, width: float, height: float, *, fixed: bool = False) -> None:
        super().__init__(figsize=(width, height), layout="constrained")
        self.fixed = fixed

    @property
    def narrow(self) -> bool:
        """Whether panels stand below each other and the legend below them."""
        return bool(self.get_figwidth() < _NARROW)

    def grow(self, by: float) -> None:
        """Add this height [inches] unless the caller asked for a height."""
        if not self.fixed:
            self.set_figheight(self.get_figheight() + by)

    def savefig(self, *args: Any, **options: Any) -> None:
        """Save the figure as `Figure.savefig` does; texts in PDF and SVG stay texts unless the user set otherwise."""
        theirs, factory = cast("dict[Any, Any]", rcParams), cast("dict[Any, Any]", rcParamsDefault)
        kept: Any = {name: value for name, value in _SAVED.items() if theirs[name] == factory[name]}
        with rc_context(kept), missing_glyphs() as missing:
            super().savefig(*args, **options)
        if missing:
            remark_on_glyphs(missing, 'Name a font that has them in matplotlib.rcParams["font.family"]')

    def _repr_png_(self) -> tuple[bytes, dict[str, int]]:
        buffer = BytesIO()
        self.savefig(buffer, format="png", dpi=2.0 * _SCREEN)
        width, height = (round(_SCREEN * side) for side in self.get_size_inches())
        return buffer.getvalue(), {"width": width, "height": height}

    def show(self, warn: bool = True) -> None:
        """Show the figure: in a notebook as its output, elsewhere in a window, until the window is closed."""
        shell = sys.modules["IPython"].get_ipython() if "IPython" in sys.modules else None
        if hasattr(shell, "kernel"):
            sys.modules["IPython"].display.display(self)
            return
        import matplotlib.pyplot as plt

        blank = plt.figure()
        kind, number = type(blank.canvas), blank.number
        plt.close(blank)
        if kind.required_interactive_framework is None:
            if warn:
                message = "show: no window can be opened here. Save the figure by savefig"
                warnings.warn(message, UserWarning, stacklevel=2)
            return
        manager = kind.new_manager(self, number)  # pragma: no cover  needs a display
        manager.show()  # pragma: no cover
        type(manager).start_main_loop()  # pragma: no cover

    def make_place(self) -> None:
        """Move legends that cover what their panels show below all panels."""
        for axes in self.axes:
            legend = axes.get_legend()
            if legend is None or not has_no_place(legend, axes):
                continue
            handles, names = entries_of(legend, axes)
            size = legend.get_texts()[0].get_fontsize()
            legend.remove()
            self.legend(handles, names, loc="outside lower left", ncols=3, fontsize=size)

    def subplots(self, nrows: int = 1, ncols: int = 1, **options: Any) -> Any:
        """Return panels as `Figure.subplots` does; in a narrow figure those of one row stand below each other."""
        if not (self.narrow and nrows == 1 and ncols > 1):
            return super().subplots(nrows, ncols, **options)
        options.pop("width_ratios", None)
        squeeze = options.pop("squeeze", True)
        self.grow(_SHRINKS * self.get_figheight() * (ncols - 1.0))
        found = super().subplots(ncols, 1, squeeze=False, **options)
        return found[:, 0] if squeeze else found.T

    def legend(self, *args: Any, **options: Any) -> Legend:
        """Add a legend; one outside the panels stands below them in a narrow figure, in as many columns as fit."""
        loc = str(options.get("loc", ""))
        if not loc.startswith("outside"):
            return super().legend(*args, **options)
        if self.narrow and "upper" in loc and loc.startswith("outside right"):
            options["loc"] = "outside lower left"
        legend = super().legend(*args, **options)
        if options["loc"].startswith("outside right"):
            return legend
        texts = [text.get_text() for text in legend.get_texts()]
        size = float(legend.get_texts()[0].get_fontsize()) if texts else 1.0
        longest = max((len(line) for text in texts for line in text.splitlines()), default=1)
        fitting = int(self.get_figwidth() // (_CHARACTER * size * longest / _POINTS + _MARK))
        columns = max(1, min(fitting, options.get("ncols", 2), len(texts)))
        if self.narrow:
            lines = sum(1 + text.count("\n") for text in texts) / columns
            self.grow(_LINE * size * lines / _POINTS)
        if columns == options.get("ncols"):
            return legend
        legend.remove()
        return super().legend(*args, **options | {"ncols": columns})

    @classmethod
    def asked_for(cls, height: float, width: float) -> "ResultFigure":
        """Return an empty figure of this `height` and `width`, or as the caller asked for."""
        asked = asked_for()
        if asked.axes is not None:
            return InAxes(asked.axes)
        taller = max(1.0, float(rcParams["font.size"]) / usual_font())
        if asked.size is None:
            return cls(width, taller * height)
        wide, tall = asked.size
        ratio = wide / width
        suits = taller * max(_LEAST, height * (ratio if ratio >= 1.0 else 1.0 - _SHRINKS * (1.0 - ratio)))
        return cls(wide, suits if tall is None else tall, fixed=tall is not None)


class InAxes(ResultFigure):
    """A stand-in for a figure of one panel that is drawn in axes of the caller's figure."""

    def __init__(self, axes: Axes) -> None:
        super().__init__(WIDTH, WIDTH)
        self._axes_of_caller = axes

    @property
    def narrow(self) -> bool:
        """Whether there is no room beside the panel; there is none beside the caller's axes."""
        return False

    def subplots(self, nrows: int = 1, ncols: int = 1, **options: Any) -> Any:
        """Return the caller's axes for one panel."""
        if (nrows, ncols) != (1, 1):
            self._refuse()
        axes = self._axes_of_caller
        return axes if options.get("squeeze", True) else np.array([[axes]])

    def add_subplot(self, *_: Any, **__: Any) -> Any:
        """Refuse a figure of several panels."""
        self._refuse()

    def add_gridspec(self, *_: Any, **__: Any) -> Any:
        """Refuse a figure of several panels."""
        self._refuse()

    def subplot_mosaic(self, *_: Any, **__: Any) -> Any:
        """Refuse a figure of several panels."""
        self._refuse()

    def legend(self, *args: Any, **options: Any) -> Legend:
        """Add the legend within the axes, in a frame; entries have one line, the first of their labels."""
        kept = {name: value for name, value in options.items() if name in ("handles", "labels", "title", "fontsize")}
        look: dict[str, Any] = {"frameon": True, "framealpha": 0.9, "edgecolor": "#cccccc", "handlelength": 1.6}
        legend = self._axes_of_caller.legend(*args, **look | kept)
        for text in legend.get_texts():
            text.set_text(text.get_text().partition("\n")[0])
        return legend

    def colorbar(self, *args: Any, **options: Any) -> Colorbar:
        """Add a colour bar to the caller's figure."""
        return self.finished().colorbar(*args, **options)

    def make_place(self) -> None:
        """Move a legend that covers what the axes show below or beside them, if the caller's figure makes room."""
        axes, figure = self._axes_of_caller, self.finished()
        legend = axes.get_legend()
        if legend is None or figure.get_layout_engine() is None or not (has_no_place(legend, axes) or is_filled(axes)):
            return
        panel, numbers, box = axes.get_window_extent(), axes.xaxis.get_tightbbox(), legend.get_window_extent()
        columns = max(1, int(panel.width // box.width))
        handles, names = entries_of(legend, axes)
        place: dict[str, Any] = {"bbox_to_anchor": (1.0, 1.0)}
        if box.height / columns < _BELOW * panel.height:
            foot = 0.0 if numbers is None else (numbers.y0 - panel.y0) / figure.dpi
            below = axes.transAxes + ScaledTranslation(0.0, foot, figure.dpi_scale_trans)
            place = {"bbox_to_anchor": (0.0, 0.0), "bbox_transform": below, "ncols": columns, "borderaxespad": 0.2}
        size = legend.get_texts()[0].get_fontsize()
        axes.legend(handles, names, loc="upper left", fontsize=size, frameon=False, **place)

    def finished(self) -> Figure:
        """Return the caller's figure."""
        figure = self._axes_of_caller.get_figure(root=True)
        assert figure is not None
        return figure

    def _refuse(self) -> None:
        raise ParameterError(
            "axes: this figure has several panels (got one Axes). Leave axes out and pass size; runs, "
            "ensembles, overturning maps and branches are drawn in axes"
        )
