"""Pictures of single runs: tilt against time, orbit of the tilt vector, azimuth; one run or several compared."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from stylobate.plots.contact_strip import ContactHistory, draw_contact
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
# Heights of a panel, of a row of kinds of contact, and of what is about the rows [inches].
_PANEL, _ROW, _GAP = 2.0, 0.19, 0.3
# The name of an event later than this part of the run stands to its left.
_LATE = 0.8
# A line whose direction has no more than this part along x runs along y, but for rounding.
_ALONG_Y = 1e-9


@styled
def plot_runs(runs: Sequence[Response], labels: Sequence[str] | None = None) -> Figure:
    """Return a figure of one run, or of several compared.

    Shows the tilt angle, the azimuth of the lean (in a plane: the tilt with its sign) and the base acceleration
    against time, and the path of the tilt vector. Dashed: |α| = c, beyond which the column, left alone, falls, and the
    acceleration c g that releases it. Of one run of a model that changes its contact also how the column met the
    plane, a row for each kind of contact.

    Parameters
    ----------
    runs
        The runs, at least one.
    labels
        A name for each; by default its outcome.
    """
    names = labels or [run.outcome.label for run in runs]
    contact = ContactHistory.of(runs[0]) if len(runs) == 1 and "contact" in runs[0].data else None
    figure, axes = _panels(contact)
    tilt, azimuth, base, orbit = axes["tilt"], axes["azimuth"], axes["base"], axes["orbit"]
    azimuth.sharex(tilt)
    base.sharex(tilt)
    planar = all(run.planar for run in runs)
    for index, (run, name) in enumerate(zip(runs, names, strict=True)):
        line: dict[str, Any] = {
            "color": PALETTE[index % len(PALETTE)],
            "linestyle": DASHES[index % len(DASHES)] if index else "-",
        }
        time = run.data["time"]
        tilt.plot(time, run.data["amplitude"], linewidth=1.1, label=name, **line)
        azimuth.plot(
            time, _signed_tilt(run.data) if planar else run.data["azimuth"] / (2.0 * np.pi), linewidth=1.1, **line
        )
        base.plot(time, np.hypot(*run.data["base_acceleration"].to_numpy()[:, :2].T), linewidth=1.1, **line)
        _draw_orbit(orbit, run.data, line)
        if len(runs) == 1:
            _mark_events(tilt, run)
    limits = {float(run.data.attrs["slenderness"]) for run in runs}
    for c in limits:
        tilt.axhline(c, color=GREY, linewidth=0.9, linestyle=(0, (4, 2)))
        orbit.add_patch(Circle((0.0, 0.0), c, fill=False, color=GREY, linewidth=0.9, linestyle=(0, (4, 2))))
    for level in {float(run.data.attrs["release_acceleration"]) for run in runs}:
        base.axhline(level, color=GREY, linewidth=0.9, linestyle=(0, (4, 2)))
    base.set_ylabel("|base acc.| [m/s²]")
    base.set_xlabel("time [s]")
    azimuth.set_ylabel("tilt along its line [rad]" if planar else "azimuth β [turns]")
    _finish(tilt, orbit, max(limits), compared=len(runs) > 1, title=names[0])
    return figure


def _panels(contact: ContactHistory | None) -> tuple[Figure, dict[str, Axes]]:
    """Return a figure and its panels by name, with that of the kinds of contact drawn where it is wanted."""
    heights = {"tilt": _PANEL, "contact": 0.0, "azimuth": _PANEL, "base": _PANEL}
    if contact is None:
        del heights["contact"]
    else:
        heights["contact"] = _GAP + _ROW * len(contact.shown)
    figure = new_figure(sum(heights.values()))
    axes = figure.subplot_mosaic(
        [[name, "orbit"] for name in heights], width_ratios=(1.15, 1.0), height_ratios=list(heights.values())
    )
    if contact is not None:
        axes["contact"].sharex(axes["tilt"])
        draw_contact(axes["contact"], contact)
    return figure, axes


def _draw_orbit(axes: Axes, data: xr.Dataset, line: dict[str, Any]) -> None:
    x, y = data["tilt"].sel(axis="x"), data["tilt"].sel(axis="y")
    axes.plot(x, y, linewidth=0.9, **line)
    axes.plot(x[:1], y[:1], marker="o", markersize=5, markerfacecolor="white", color=line["color"])
    axes.plot(x[-1:], y[-1:], marker="s", markersize=5, color=line["color"])


def _signed_tilt(data: xr.Dataset) -> np.ndarray:
    """Return the tilt along the line in which a planar run moves, positive towards +x, or +y of a line along y."""
    tilt = data["tilt"].to_numpy()
    x, y = tilt[np.argmax(np.hypot(*tilt.T))]
    length = np.hypot(x, y)
    if length == 0.0:
        return np.zeros(len(tilt))
    positive = x > 0.0 if abs(x) > _ALONG_Y * length else y > 0.0
    return np.asarray(tilt @ (x, y) / (length if positive else -length))


def _mark_events(axes: Axes, run: Response) -> None:
    # The first and the last: a run may be released and come to rest in every period.
    events = [event for event in run.events if not event.repeats]
    for event in dict.fromkeys((*events[:1], *events[-1:])):
        height = float(np.interp(event.time, run.data["time"], run.data["amplitude"]))
        axes.annotate(
            _EVENT_NAMES.get(event.kind, event.kind),
            (event.time, height),
            xytext=(0, 10),
            textcoords="offset points",
            ha="right" if event.time > _LATE * run.data["time"][-1] else "left",
            fontsize=7.5,
            arrowprops={"arrowstyle": "-|>", "color": BLACK, "linewidth": 0.6, "mutation_scale": 7},
        )


def _finish(tilt: Axes, orbit: Axes, c: float, *, compared: bool, title: str) -> None:
    tilt.set_ylabel("tilt angle A [rad]")
    tilt.margins(y=0.15)
    tilt.set_ylim(bottom=0.0)
    tilt.annotate(
        "A = c", (1.0, c), xycoords=("axes fraction", "data"), ha="right", va="bottom", fontsize=8, color=GREY
    )
    if compared:
        tilt.figure.legend(loc="outside upper left", ncols=4)
    else:
        tilt.set_title(title)
    orbit.set_aspect("equal", adjustable="datalim")
    orbit.set_xlabel("tilt α₁ [rad]")
    orbit.set_ylabel("tilt α₂ [rad]")
    orbit.set_title("○ start, ■ end, dashed |α| = c")
