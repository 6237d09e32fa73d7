"""The figure of a result: it shows itself in notebooks and by `show`, and its layout suits the width asked for."""

import math
import sys
import textwrap
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from io import BytesIO
from typing import Any, Literal

import numpy as np
from matplotlib import rcParams
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.text import Text

from stylobate.errors import ParameterError

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
# Part of its place that a panel keeps beside labels and legends.
_PANEL = 0.9


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


def heading(figure: Figure, text: str) -> None:
    """Write `text` above all panels, in lines that fit the width."""
    characters = figure.get_figwidth() * _POINTS / (_CHARACTER * rcParams["font.size"])
    figure.suptitle("\n".join(textwrap.wrap(text, int(characters))), x=0.01, ha="left", fontsize="medium")


def beside_or_below(figure: Figure) -> Literal["right", "bottom"]:
    """Return the place of a colour bar: below the panel in a narrow figure."""
    return "bottom" if isinstance(figure, ResultFigure) and figure.narrow else "right"


def fit_texts(figure: Figure) -> None:
    """Break titles and labels of axes that are longer than their panel."""
    width, height = figure.get_size_inches() * _POINTS / _CHARACTER
    for axes in figure.axes:
        extent = axes.get_position()
        across, along = _PANEL * extent.width * width, _PANEL * extent.height * height
        title = axes.get_title(loc="left")
        titles = [(one, 1.15 * across) for one in axes.findobj(Text) if title and one.get_text() == title]
        for text, room in (*titles, (axes.xaxis.label, across), (axes.yaxis.label, along)):
            characters = max(12, int(room / text.get_fontsize()))
            lines = text.get_text().splitlines()
            if any(len(line) > characters for line in lines):
                text.set_text("\n".join(part for line in lines for part in textwrap.wrap(line, characters)))


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
        self._fixed = fixed

    @property
    def narrow(self) -> bool:
        """Whether panels stand below each other and the legend below them."""
        return bool(self.get_figwidth() < _NARROW)

    def grow(self, by: float) -> None:
        """Add this height [inches] unless the caller asked for a height."""
        if not self._fixed:
            self.set_figheight(self.get_figheight() + by)

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
        import matplotlib.pyplot as plt  # noqa: PLC0415  only windows need it

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
        if asked.size is None:
            return cls(width, height)
        wide, tall = asked.size
        ratio = wide / width
        suits = max(_LEAST, height * (ratio if ratio >= 1.0 else 1.0 - _SHRINKS * (1.0 - ratio)))
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
        """Add the legend within the axes, where there is room."""
        kept = {name: value for name, value in options.items() if name in ("handles", "labels", "title", "fontsize")}
        return self._axes_of_caller.legend(*args, **kept)

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
