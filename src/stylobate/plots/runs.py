"""Pictures of single runs: tilt against time, orbit of the tilt vector, azimuth; one run or several compared."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from stylobate.plots.style import BLACK, DASHES, GREY, PALETTE, new_figure, styled
from stylobate.results import Response

_EVENT_NAMES = {
    "release": "released",
    "rest": "at rest",
    "overturned": "overturned",
    "limit": "tilt limit",
    "lifted": "lifted off",
    "failed": "failed",
}
# A run with more events than this (rest and release in every period) keeps its curve readable without their marks.
_MOST_EVENTS = 6
# The name of an event later than this part of the run stands to its left.
_LATE = 0.8


@styled
def plot_runs(runs: Sequence[Response], labels: Sequence[str] | None = None) -> Figure:
    """Return a figure of one run, or of several compared.

    Shows the tilt angle and the azimuth of the lean against time, and the path of the tilt vector with the circle
    |α| = c beyond which the column, left alone, falls.

    Parameters
    ----------
    runs
        The runs, at least one.
    labels
        A name for each; by default its outcome.
    """
    names = labels or [run.outcome.value for run in runs]
    figure = new_figure(5.0)
    axes = figure.subplot_mosaic([["tilt", "orbit"], ["azimuth", "orbit"]], width_ratios=(1.15, 1.0))
    tilt, azimuth, orbit = axes["tilt"], axes["azimuth"], axes["orbit"]
    azimuth.sharex(tilt)
    for index, (run, name) in enumerate(zip(runs, names, strict=True)):
        line: dict[str, Any] = {
            "color": PALETTE[index % len(PALETTE)],
            "linestyle": DASHES[index % len(DASHES)] if index else "-",
        }
        time = run.data["time"]
        tilt.plot(time, run.data["amplitude"], linewidth=1.1, label=name, **line)
        azimuth.plot(time, run.data["azimuth"] / (2.0 * np.pi), linewidth=1.1, **line)
        _draw_orbit(orbit, run.data, line)
        _mark_events(tilt, run)
    limits = {float(run.data.attrs["slenderness"]) for run in runs}
    for c in limits:
        tilt.axhline(c, color=GREY, linewidth=0.9, linestyle=(0, (4, 2)))
        orbit.add_patch(Circle((0.0, 0.0), c, fill=False, color=GREY, linewidth=0.9, linestyle=(0, (4, 2))))
    _finish(tilt, orbit, azimuth, max(limits), compared=len(runs) > 1, title=names[0])
    return figure


def _draw_orbit(axes: Axes, data: xr.Dataset, line: dict[str, Any]) -> None:
    x, y = data["tilt"].sel(axis="x"), data["tilt"].sel(axis="y")
    axes.plot(x, y, linewidth=0.9, **line)
    axes.plot(x[:1], y[:1], marker="o", markersize=5, markerfacecolor="white", color=line["color"])
    axes.plot(x[-1:], y[-1:], marker="s", markersize=5, color=line["color"])


def _mark_events(axes: Axes, run: Response) -> None:
    if len(run.events) > _MOST_EVENTS:
        return
    for event in run.events:
        height = float(np.interp(event.time, run.data["time"], run.data["amplitude"]))
        axes.annotate(
            _EVENT_NAMES.get(event.kind, event.kind),
            (event.time, height),
            xytext=(0, 10),
            textcoords="offset points",
            ha="right" if event.time > _LATE * run.data["time"][-1] else "center",
            fontsize=7.5,
            arrowprops={"arrowstyle": "-|>", "color": BLACK, "linewidth": 0.6, "mutation_scale": 7},
        )


def _finish(tilt: Axes, orbit: Axes, azimuth: Axes, c: float, *, compared: bool, title: str) -> None:
    tilt.set_ylabel("tilt angle A [rad]")
    tilt.margins(y=0.15)
    tilt.set_ylim(bottom=0.0)
    tilt.annotate(
        "A = c", (1.0, c), xycoords=("axes fraction", "data"), ha="right", va="bottom", fontsize=8, color=GREY
    )
    if compared:
        tilt.legend(loc="upper left")
    else:
        tilt.set_title(title)
    azimuth.set_ylabel("azimuth β [turns]")
    azimuth.set_xlabel("time [s]")
    orbit.set_aspect("equal", adjustable="datalim")
    orbit.set_xlabel("tilt α₁ [rad]")
    orbit.set_ylabel("tilt α₂ [rad]")
    orbit.set_title("○ start, ■ end, dashed |α| = c")
