"""Figures of single runs: tilt against time, orbit of the tilt vector, azimuth; one run or several compared."""

import textwrap
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle

from stylobate.plots.contact_strip import ContactHistory, draw_contact
from stylobate.plots.labels import axis_label
from stylobate.plots.style import BLACK, DASHES, GREY, PALETTE, new_figure, styled
from stylobate.results import Response

_EVENT_NAMES = {
    "uplift": "uplift",
    "rest": "at rest",
    "overturned": "overturned",
    "limit": "tilt limit",
    "lifted": "lifted off",
    "failed": "failed",
}
# Heights of a panel, of a row of kinds of contact, and of the margin about the rows [inches].
_PANEL, _ROW, _GAP = 1.75, 0.19, 0.3
# If the base does not move, two panels have the height of three, as the path beside them needs.
_HIGH_PANEL = 1.5 * _PANEL
# The name of an event later than this fraction of the run is written to its left.
_LATE = 0.8
# Tolerance for rounding: a direction with no more than this fraction along x is the direction of y.
_ALONG_Y = 1e-9
# Margin about the orbit, and characters in a line of the reason beside it.
_ROOM, _LINE = 1.08, 46
_MOST_REASONS = 2
_DASHED = (0, (4, 2))
_LIMIT: dict[str, Any] = {"color": GREY, "linewidth": 0.9, "linestyle": _DASHED}


@styled
def plot_runs(runs: Sequence[Response], labels: Sequence[str] | None = None) -> Figure:
    """Return a figure of one run, or of several compared.

    The panels show the tilt angle, the azimuth of the lean (for planar motion: the tilt with its sign) and the base
    acceleration against time, and the path of the tilt vector. Dashed lines show θ = c, beyond which the column falls
    on a base at rest, and the acceleration c g at which it uplifts. For one run of a model that changes its contact, a
    strip shows the contact history. The text below the path is the reason for the outcome, or a key to several runs.

    Parameters
    ----------
    runs
        The runs, at least one.
    labels
        A name for each; by default its outcome.
    """
    names = labels or [run.outcome.label for run in runs]
    contact = ContactHistory.of(runs[0]) if len(runs) == 1 and "contact" in runs[0].data else None
    shaken = any(bool((run.data["base_acceleration"] != 0.0).any()) for run in runs)
    figure, axes = _panels(contact, shaken=shaken)
    tilt, azimuth, orbit = axes["tilt"], axes["azimuth"], axes["orbit"]
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
        if shaken:  # later runs below, so that weaker ones stay visible
            acceleration = np.hypot(*run.data["base_acceleration"].to_numpy()[:, :2].T)
            axes["base"].plot(time, acceleration, linewidth=0.9, zorder=2.0 - 0.01 * index, **line)
        _draw_orbit(orbit, run.data, line)
        if len(runs) == 1:
            _mark_events(tilt, run)
    limits = {float(run.data.attrs["slenderness"]) for run in runs}
    for c in limits:
        tilt.axhline(c, **_LIMIT)
        orbit.add_patch(Circle((0.0, 0.0), c, fill=False, **_LIMIT))
    if shaken:
        for level in {float(run.data.attrs["uplift_acceleration"]) for run in runs}:
            axes["base"].axhline(level, **_LIMIT)
        axes["base"].set_ylabel(axis_label(runs[0].data["base_acceleration"]))
    axes["base" if shaken else "azimuth"].set_xlabel(axis_label(runs[0].data["time"]))
    azimuth.set_ylabel("tilt along its line [rad]" if planar else r"azimuth $\beta$ [turns]")
    _finish(tilt, orbit, max(limits), runs)
    _write_key(axes["notes"], runs, names, shaken=shaken)
    return figure


def _panels(contact: ContactHistory | None, *, shaken: bool) -> tuple[Figure, dict[str, Axes]]:
    """Return a figure and its panels by name; contact and base have panels only if they change or move."""
    panel = _PANEL if shaken else _HIGH_PANEL
    heights = {"tilt": panel, "contact": 0.0, "azimuth": panel, "base": panel}
    if contact is None:
        del heights["contact"]
    else:
        heights["contact"] = _GAP + _ROW * len(contact.shown)
    if not shaken:
        del heights["base"]
    figure = new_figure(sum(heights.values()))
    *upper, lowest = heights
    rows: list[Any] = [*([name, "orbit"] for name in upper), [lowest, "notes"]]
    axes = figure.subplot_mosaic(
        rows,
        width_ratios=(1.15, 1.0),
        height_ratios=list(heights.values()),
    )
    for name in heights:
        if name != "tilt":
            axes[name].sharex(axes["tilt"])
        if name != lowest:
            axes[name].tick_params(axis="x", labelbottom=False)
    if contact is not None:
        draw_contact(axes["contact"], contact)
    return figure, axes


def _draw_orbit(axes: Axes, data: xr.Dataset, line: dict[str, Any]) -> None:
    x, y = data["tilt"].sel(axis="x"), data["tilt"].sel(axis="y")
    axes.plot(x, y, linewidth=0.9, **line)
    axes.plot(x[:1], y[:1], marker="o", markersize=5, markerfacecolor="white", color=line["color"])
    axes.plot(x[-1:], y[-1:], marker="s", markersize=5, color=line["color"])


def _signed_tilt(data: xr.Dataset) -> np.ndarray:
    """Return the tilt along the line of a planar run, positive towards +x, or towards +y if the line is along y."""
    tilt = data["tilt"].to_numpy()
    x, y = tilt[np.argmax(np.hypot(*tilt.T))]
    length = np.hypot(x, y)
    if length == 0.0:
        return np.zeros(len(tilt))
    positive = x > 0.0 if abs(x) > _ALONG_Y * length else y > 0.0
    return np.asarray(tilt @ (x, y) / (length if positive else -length))


def _mark_events(axes: Axes, run: Response) -> None:
    # The first and the last only: a run may uplift and come to rest in every period.
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
            bbox={"facecolor": "white", "alpha": 0.75, "linewidth": 0.0, "pad": 0.5},
            arrowprops={"arrowstyle": "-|>", "color": BLACK, "linewidth": 0.6, "mutation_scale": 7},
        )


def _finish(tilt: Axes, orbit: Axes, c: float, runs: Sequence[Response]) -> None:
    tilt.set_ylabel(r"tilt $\theta$ [rad]")
    tilt.margins(y=0.15)
    tilt.set_ylim(bottom=0.0)
    tilt.annotate(
        r"$\theta = c$",
        (0.01, c),
        xycoords=("axes fraction", "data"),
        ha="left",
        va="bottom",
        fontsize=8,
        color=GREY,
    )
    reach = _ROOM * max(c, *(float(np.abs(run.data["tilt"]).max()) for run in runs))
    orbit.set(xlim=(-reach, reach), ylim=(-reach, reach))
    orbit.set_aspect("equal", adjustable="box", anchor="N")
    orbit.set_xlabel(r"tilt $\theta_x$ [rad]")
    orbit.set_ylabel(r"tilt $\theta_y$ [rad]")
    orbit.locator_params(nbins=5)


def _write_key(axes: Axes, runs: Sequence[Response], names: Sequence[str], *, shaken: bool) -> None:
    """Write the legend, and the outcomes with their reasons as far as there is room."""
    axes.axis("off")
    mark: dict[str, Any] = {"linestyle": "none", "color": BLACK, "markersize": 5}
    entries = [
        Line2D([], [], marker="o", markerfacecolor="white", label="start", **mark),
        Line2D([], [], marker="s", label="end", **mark),
        Line2D([], [], label=r"$\theta = c$; uplift at $c\,g$" if shaken else r"$\theta = c$", **_LIMIT),
    ]
    axes.legend(handles=entries, loc="upper left", ncols=3, columnspacing=1.2, handlelength=1.8, borderaxespad=0.0)
    if len(runs) > 1:
        assert isinstance(axes.figure, Figure)
        handles = axes.figure.axes[0].get_legend_handles_labels()[0]
        axes.figure.legend(handles=handles, loc="outside upper left", ncols=4)
    if len(runs) > _MOST_REASONS:
        return
    lines: list[tuple[str, dict[str, Any]]] = []
    for index, (run, name) in enumerate(zip(runs, names, strict=True)):
        heading = name if name == run.outcome.label else f"{name}: {run.outcome.label}"
        lines += [(heading, {"weight": "bold", "color": PALETTE[index % len(PALETTE)] if len(runs) > 1 else BLACK})]
        lines += [(line, {}) for line in textwrap.wrap(run.reason, _LINE)]
    for place, (line, look) in enumerate(lines):
        offset = (0, -18 - 12.0 * place)
        axes.annotate(
            line,
            (0.0, 1.0),
            xytext=offset,
            xycoords="axes fraction",
            textcoords="offset points",
            va="top",
            size=8.5,
            **look,
        )
