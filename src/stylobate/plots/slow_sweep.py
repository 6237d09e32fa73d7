"""A slow sweep: tilt and turns against the parameter, up and down."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from stylobate.errors import Outcome
from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import axis_label
from stylobate.plots.style import GREY, PALETTE, new_figure, styled

Floats = npt.NDArray[np.float64]

_HEIGHT, _HEIGHT_RATIOS = 5.2, (2.6, 1.0)
_BAND = 0.18
_MARKERS = {Outcome.OVERTURNED: "X", Outcome.LIMIT_REACHED: "D", Outcome.LIFTED_OFF: "^", Outcome.FAILED: "*"}
_MOST_NAMED, _MOST_MARKED = 8, 30


@figure_of("slow sweep")
@styled
def plot_slow_sweep(found: xr.Dataset) -> Figure:
    """Return a figure of tilt and turns per period against the parameter of a slow sweep.

    Lines are means over the last periods at each value, bands reach from the minimum to maximum tilt. Full triangles
    point right if the parameter rises, hollow triangles left if it falls. A cross marks overturning, at the last mean
    tilt.
    """
    figure = new_figure(_HEIGHT)
    tilts, turns = figure.subplots(2, 1, sharex=True, height_ratios=_HEIGHT_RATIOS)
    legend: list[Line2D | Patch] = []
    name = str(found.attrs["parameter"])
    sweeps = range(found.sizes["sweep"])
    for sweep in sweeps:
        one, colour = found.isel(sweep=sweep), PALETTE[sweep % len(PALETTE)]
        for leg, rising in _legs(one[name].to_numpy()):
            part = one.isel(step=leg)
            if np.isfinite(part["mean_tilt"]).any():
                _draw_leg(tilts, turns, part, colour, rising=rising)
                which = f"sweep {sweep + 1}, " if len(sweeps) > 1 else ""
                legend.append(_line(colour, rising=rising, label=f"{which}{'upward' if rising else 'downward'}"))
    legend = legend if len(legend) <= _MOST_NAMED else []
    if np.any(found["peak_tilt"] - found["minimum_tilt"] > 0.0):
        legend.append(Patch(color=GREY, alpha=2.0 * _BAND, linewidth=0.0, label="minimum to maximum tilt"))
    legend += _draw_ends(tilts, found)
    tilts.set_ylabel(r"tilt $\theta$ [rad]")
    tilts.set_ylim(bottom=0.0)
    tilts.legend(handles=legend)
    turns.set_ylabel("turns per period")
    # Deviations from a whole number of turns stay visible.
    low, high = turns.get_ylim()
    turns.set_ylim(min(low, -0.1), max(high, 1.1) if high > 0.0 else 0.1)
    turns.set_xlabel(axis_label(found[name]))
    return figure


def _legs(values: Floats) -> Iterator[tuple[slice, bool]]:
    """Return the parts along which `values` rise or fall; the value at a turn belongs to both."""
    rises = np.diff(values) >= 0.0
    if not rises.size:
        yield slice(0, 1), True
        return
    turns = np.flatnonzero(rises[1:] != rises[:-1]) + 1
    for begin, end in zip([0, *turns], [*turns, rises.size], strict=True):
        yield slice(int(begin), int(end) + 1), bool(rises[begin])


def _draw_leg(tilts: Axes, turns: Axes, part: xr.Dataset, colour: str, *, rising: bool) -> None:
    x = part[str(part.attrs["parameter"])].to_numpy()
    tilts.fill_between(
        x, part["minimum_tilt"].to_numpy(), part["peak_tilt"].to_numpy(), color=colour, alpha=_BAND, linewidth=0.0
    )
    for axes, quantity in ((tilts, "mean_tilt"), (turns, "turns_per_period")):
        line = _line(colour, rising=rising)
        line.set_data(x, part[quantity].to_numpy())
        line.set_markevery(1 + x.size // _MOST_MARKED)
        axes.add_line(line)
        axes.autoscale_view()


def _line(colour: str, *, rising: bool, label: str = "") -> Line2D:
    return Line2D(
        [],
        [],
        color=colour,
        linewidth=1.1,
        linestyle="-" if rising else "--",
        marker=">" if rising else "<",
        markersize=3.6,
        markerfacecolor=colour if rising else "white",
        label=label,
    )


def _draw_ends(axes: Axes, found: xr.Dataset) -> list[Line2D]:
    """Mark the ends of the runs at their last mean tilt, and return the entries of the legend."""
    name, named = str(found.attrs["parameter"]), dict[Outcome, str]()
    for sweep in range(found.sizes["sweep"]):
        one = found.isel(sweep=sweep)
        codes, tilt = one["outcome"].to_numpy(), one["mean_tilt"].to_numpy()
        for outcome, marker in _MARKERS.items():
            for step in np.flatnonzero(codes == outcome):
                mark: dict[str, Any] = {"marker": marker, "linestyle": "none", "color": PALETTE[sweep % len(PALETTE)]}
                height = float(tilt[step - 1]) if step else 0.0
                axes.plot(float(one[name][step]), height, markersize=8, markeredgecolor="white", zorder=4, **mark)
                named[outcome] = marker
    return [
        Line2D([], [], marker=marker, linestyle="none", color=GREY, markersize=7, label=f"{outcome.label} here")
        for outcome, marker in named.items()
    ]
