"""Figures of base motions: acceleration, velocity and displacement against time, and the path of the base."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

from stylobate.base_motions import BaseMotion, Record
from stylobate.plots.geometry import Floats
from stylobate.plots.labels import literal
from stylobate.plots.result_figure import InAxes, ResultFigure, heading
from stylobate.plots.runs import draw_history
from stylobate.plots.style import BLACK, BLUE, DASHES, GREY, VERMILION, new_figure, styled
from stylobate.records import response_spectra

COMPONENT_LOOKS: tuple[dict[str, Any], ...] = (
    {"color": BLUE, "linestyle": "-"},
    {"color": VERMILION, "linestyle": "--"},
    {"color": GREY, "linestyle": DASHES[3]},
)
"""Looks of the components along x, y and z."""
_NAMES = "xyz"
_ROWS = {
    "acceleration\n[m/s²]": (BaseMotion.acceleration, 1.0),
    "velocity\n[m/s]": (BaseMotion.velocity, 1.0),
    "displacement\n[mm]": (BaseMotion.displacement, 1e3),
}
_HEIGHT, _POINTS, _PERIODS, _SECONDS = 4.2, 4000, 4.0, 60.0
# Periods of a response spectrum [s], and its damping.
_SPECTRUM, _DAMPING = np.geomspace(0.05, 5.0, 60), 0.05
# Components below this fraction of the largest are rounding.
_ROUNDING = 1e-12


@styled
def plot_motion(motion: BaseMotion) -> Figure:
    """Draw a base motion: acceleration, velocity and displacement along x, y and z against time.

    Beside them stands the path of the base, if it moves along two axes. A motion without end is drawn for four periods.
    Of a record the components of the acceleration are drawn, with their response spectra at 5 % damping. In given axes
    only the acceleration is drawn.
    """
    figure = new_figure(_HEIGHT)
    time = np.linspace(0.0, _end(motion), _POINTS)
    acceleration = motion.acceleration(time).T
    moving = [place for place in range(3) if _moves(acceleration, place)] or [0]
    if isinstance(figure, InAxes):
        axes = figure.subplots()
        _draw_row(axes, time, acceleration, moving)
        axes.set(xlabel="time [s]", ylabel="acceleration [m/s²]")
        axes.legend()
        return figure
    assert isinstance(figure, ResultFigure)
    if isinstance(motion, Record):
        _draw_record(figure, motion, moving)
        return figure
    rows, beside = _arranged(figure, list(_ROWS), "path" if len(moving) > 1 else "")
    for label, panel in rows.items():
        derivative, factor = _ROWS[label]
        _draw_row(panel, time, factor * derivative(motion, time).T, moving)
        panel.set_ylabel(label)
    if beside is not None:
        _draw_path(beside, 1e3 * motion.displacement(time).T, *moving[:2])
        figure.legend(*next(iter(rows.values())).get_legend_handles_labels(), loc="outside upper left", ncols=3)
    return figure


def _draw_record(figure: ResultFigure, record: Record, moving: list[int]) -> None:
    """Draw each component of a record in a row, with its peak, and the response spectra beside."""
    rows, beside = _arranged(figure, [_NAMES[place] for place in moving], "spectrum")
    for place, (name, panel) in zip(moving, rows.items(), strict=True):
        _draw_row(panel, record.times, record.samples.T, [place])
        peak = float(np.abs(record.samples[:, place]).max())
        panel.set_title(f"{name}: peak {peak:.3g} m/s²", fontsize="small")
        panel.set_ylabel("[m/s²]")
    assert beside is not None
    draw_spectra(beside, response_spectra(record, _SPECTRUM, damping=_DAMPING))
    beside.set_xlabel("period [s]")
    heading(figure, literal(record.name))


def _arranged(figure: ResultFigure, names: list[str], beside: str) -> tuple[dict[str, Axes], Axes | None]:
    """Return panels against time below each other, and one beside or, in a narrow figure, below them."""
    options: dict[str, Any] = {}
    rows: list[Any] = [[name] for name in names]
    if beside and figure.narrow:
        figure.grow(figure.get_figwidth())
        rows.append([beside])
        options["height_ratios"] = [*(1.0 for _ in names), 2.4]
    elif beside:
        rows = [[name, beside] for name in names]
        options["width_ratios"] = (1.4, 1.0)
    axes = figure.subplot_mosaic(rows, **options)
    for name in names:
        if name != names[0]:
            axes[name].sharex(axes[names[0]])
        if name != names[-1]:
            axes[name].tick_params(axis="x", labelbottom=False)
    axes[names[-1]].set_xlabel("time [s]")
    return {name: axes[name] for name in names}, axes.get(beside)


def _end(motion: BaseMotion) -> float:
    if np.isfinite(motion.duration):
        return float(motion.duration)
    return _SECONDS if motion.period is None else float(_PERIODS * motion.period)


def _moves(values: Floats, place: int) -> bool:
    return bool(np.ptp(values[place]) > _ROUNDING * np.abs(values).max() > 0.0)


def _draw_row(axes: Axes, time: Floats, values: Floats, moving: list[int]) -> None:
    for place in moving:
        look: dict[str, Any] = {"linewidth": 0.9, "zorder": 3.0 - place, "label": _NAMES[place]}
        draw_history(axes, time, values[place], **look | COMPONENT_LOOKS[place])


def _draw_path(axes: Axes, displacement: Floats, first: int, second: int) -> None:
    x, y = displacement[first], displacement[second]
    axes.plot(x, y, color=BLACK, linewidth=0.9)
    axes.plot(x[:1], y[:1], marker="o", markersize=5, markerfacecolor="white", color=BLACK)
    axes.set_aspect("equal", adjustable="datalim")
    axes.set(xlabel=f"{_NAMES[first]} [mm]", ylabel=f"{_NAMES[second]} [mm]", title="path of the base")
    axes.locator_params(nbins=5)


def draw_spectra(axes: Axes, spectra: Any) -> None:
    """Draw the response spectra of a record from `response_spectra`, with RotD50 if it has two components."""
    for axis in spectra["axis"].to_numpy().tolist():
        look: dict[str, Any] = {"linewidth": 1.0, "label": axis} | COMPONENT_LOOKS[_NAMES.index(axis)]
        axes.loglog(spectra["period"], spectra["psa"].sel(axis=axis), **look)
    if "rotd50" in spectra:
        axes.loglog(spectra["period"], spectra["rotd50"], color=BLACK, linewidth=1.4, label="RotD50")
    for one in (axes.xaxis, axes.yaxis):
        one.set_major_formatter("{x:g}")
        one.set_minor_formatter(NullFormatter())
    axes.set_title(f"response spectrum, {100.0 * spectra.attrs['damping']:g} % damping")
    axes.set_ylabel("PSA [m/s²]")
    axes.legend(loc="lower left", ncols=2)
