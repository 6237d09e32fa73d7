"""Style of figures: a palette for colour-blind readers and grey print, and one page width."""

from collections.abc import Callable
from functools import wraps
from typing import Any, ParamSpec

import xarray as xr
from matplotlib import rc_context
from matplotlib.figure import Figure

from stylobate.plots.labels import in_own_units, with_literal_names

# Okabe and Ito's palette ("Color Universal Design", 2008) without its yellow; the lightness alternates.
PALETTE = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000")
BLUE, VERMILION, GREEN, PURPLE, SKY, ORANGE, BLACK = PALETTE
GREY = "#767676"

# Line styles that tell curves apart without colour.
DASHES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (1, 3)))

STABLE_WIDTH, UNSTABLE_WIDTH = 2.8, 0.9
WIDTH = 7.2
"""Width of a figure that spans a page [inches]."""

_SETTINGS: dict[Any, Any] = {
    "font.size": 9.5,
    "axes.titlesize": 10,
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.6,
    "legend.frameon": False,
    "legend.fontsize": 8.5,
    "hatch.linewidth": 0.55,
}


P = ParamSpec("P")


def styled(draw: Callable[P, Figure]) -> Callable[P, Figure]:
    """Apply the common settings; the user's settings stay.

    Dimensionless columns are labelled in their units, and names that a study states are printed as they are.
    """

    @wraps(draw)
    def drawn(*args: P.args, **kwargs: P.kwargs) -> Figure:
        with rc_context(_SETTINGS):
            results: Any = [in_own_units(one) for one in args]
            shown: Any = [with_literal_names(one) if isinstance(one, xr.Dataset) else one for one in results]
            return draw(*shown, **kwargs)

    return drawn


def new_figure(height: float, *, width: float = WIDTH) -> Figure:
    """Return an empty figure of this `width` and `height` [inches], apart from any interactive backend."""
    return Figure(figsize=(width, height), layout="constrained")
