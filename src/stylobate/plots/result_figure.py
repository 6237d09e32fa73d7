"""The figure of a result: it shows itself in notebooks and by `show`, and its layout suits the width asked for."""

import math
import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from io import BytesIO
from typing import Any, Literal, cast

import numpy as np
from matplotlib import rc_context, rcParams, rcParamsDefault
from matplotlib.axes import Axes
from matplotlib.colorbar import Colorbar
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.transforms import ScaledTranslation

from stylobate.errors import ParameterError
from stylobate.plots.fitting import entries_of, has_no_place, is_filled

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
        message = f"size: the axes have their own (got {size!r}). Leave size or axes out"
        raise ParameterError(message)
    if axes is not None and not isinstance(axes, Axes):
        message = f"axes must be Matplotlib's Axes, got {type(axes).__name__}"
        raise ParameterError(message)
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
        message = f"size must be a positive width, or width and height, in inches, got {size!r}"
        raise ParameterError(message)
    return sides


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
        with rc_context(kept):
            super().savefig(*args, **options)

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
        message = (
            "axes: this figure has several panels (got one Axes). Leave axes out and pass size; runs, "
            "ensembles, overturning maps and branches are drawn in axes"
        )
        raise ParameterError(message)
