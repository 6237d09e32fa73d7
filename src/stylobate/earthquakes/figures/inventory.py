"""Figure of an inventory: the first objects of the ranking with their intervals, and their peak tilts."""

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import literal
from stylobate.plots.result_figure import WIDTH
from stylobate.plots.style import BLACK, BLUE, GREY, VERMILION, new_figure, styled
from stylobate.text import plural

Floats = npt.NDArray[np.float64]

_HEIGHT, _ROW, _MOST_ROWS = 2.2, 0.19, 40
# Place of overturned columns on the axis of tilts, beyond 1.
_BEYOND = 1.15
# Share of runs from which a figure calls an object one that slides.
_MOST_OF_ITS_RUNS = 0.5
# Smallest rate that the axis shows, as a fraction of the largest.
_DECADES = 1e-6


@figure_of("inventory")
@styled
def plot_inventory(found: xr.Dataset) -> Figure:
    """Draw the first 40 objects of a ranking: probability or annual rate with its interval, and the peak tilt.

    Grey bars reach over the bounds if runs are not known. On the right the line of each object goes from the median of
    the peak tilt to its 84 % quantile; beyond 1 the object overturned. Objects without rank are grey.
    """
    rows = min(found.sizes["object"], _MOST_ROWS)
    state = str(found.attrs["limit_state"])
    scale = int(np.argmin(np.abs(np.log(found["scale"].to_numpy()))))
    shown = found.isel(object=slice(rows), scale=scale).sel(limit_state=state)
    figure = new_figure(_HEIGHT + _ROW * rows, width=1.2 * WIDTH)
    left, right = figure.subplots(1, 2, sharey=True, width_ratios=(3, 2))
    by_rate = found.attrs["ranked_by"] == "annual_rate"
    names = ("annual_rate", "rate") if by_rate else ("probability", "probability")
    value = shown[names[0]].to_numpy()
    low, high, least, most = (shown[f"{names[1]}_{end}"].to_numpy() for end in ("low", "high", "least", "most"))
    places = np.arange(rows)
    colours = [BLUE if rank else GREY for rank in shown["rank"].to_numpy().tolist()]
    if by_rate:
        left.set_xscale("log")
        floor = max(float(np.nanmax(np.append(value, 1e-12))) * _DECADES, 1e-12)
        value, low, high, least, most = (np.maximum(one, floor) for one in (value, low, high, least, most))
        left.set_xlabel(f"annual rate of {state} [1/a]")
    else:
        left.set_xlim(-0.02, 1.02)
        left.set_xlabel(f"probability of {state}")
    left.hlines(places, least, np.where(np.isfinite(most), most, high), color=GREY, linewidth=4.5, alpha=0.45)
    left.hlines(places, low, high, color=colours, linewidth=1.6)
    left.scatter(value, places, s=16.0, c=colours, zorder=3)
    _draw_tilts(right, shown, places, colours)
    left.set_yticks(places, _labels(shown))
    left.set_ylim(rows - 0.4, -0.6)
    percent = f"{100.0 * float(found.attrs['confidence']):g} % interval over records"
    left.set_title(percent, fontsize="small")
    figure.suptitle(_title(found, rows), fontsize="medium")
    return figure


def _draw_tilts(axes: Axes, shown: xr.Dataset, places: npt.NDArray[np.intp], colours: list[str]) -> None:
    middle, upper = (np.minimum(shown[name].to_numpy(), _BEYOND) for name in ("tilt_median", "tilt_84"))
    axes.hlines(places, middle, np.where(np.isnan(upper), middle, upper), color=colours, linewidth=1.6)
    stands = middle < _BEYOND
    own = [colour for colour, one in zip(colours, stands, strict=True) if one]
    axes.scatter(middle[stands], places[stands], s=16.0, c=own, zorder=3)
    for at, mark in ((middle >= _BEYOND, "x"), (stands & (upper >= _BEYOND), ">")):
        axes.scatter(np.full(int(at.sum()), _BEYOND), places[at], s=18.0, marker=mark, color=VERMILION, zorder=3)
    for place, tilt, slides in zip(places, middle, shown["sliding_share"].to_numpy(), strict=True):
        if np.isnan(tilt):
            reason = "slides before it rocks" if slides > _MOST_OF_ITS_RUNS else "not known"
            behind = {"facecolor": axes.get_facecolor(), "edgecolor": "none", "pad": 1.0}
            axes.text(0.0, place, reason, va="center", fontsize="x-small", color=GREY, bbox=behind)
    axes.axvline(1.0, color=BLACK, linewidth=0.8, linestyle="--")
    axes.set_xlim(-0.03, _BEYOND + 0.06)
    axes.set_xticks([0.0, 0.5, 1.0, _BEYOND], ["0", "0.5", "1", "over-\nturned"])
    axes.set_xlabel(r"peak tilt $\theta/\alpha_c$")
    axes.set_title("median to 84 %", fontsize="small")


def _labels(shown: xr.Dataset) -> list[str]:
    """Return rank, name and site of each object."""
    rows = zip(*(shown[name].to_numpy().tolist() for name in ("rank", "object", "site")), strict=True)
    return [literal(f"{rank or '–'}  {name}{f' ({site})' if site else ''}") for rank, name, site in rows]


def _title(found: xr.Dataset, rows: int) -> str:
    total, withheld = found.sizes["object"], int((found["rank"] == 0).sum())
    title = plural(total, "object") if rows == total else f"first {rows} of {plural(total, 'object')}"
    return f"{title}; {withheld} without rank" if withheld else title
