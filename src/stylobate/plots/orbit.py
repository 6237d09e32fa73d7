"""Figure of a periodic orbit: tilt over its period, path of the tilt vector, Floquet multipliers."""

from typing import Any, Protocol, runtime_checkable

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from stylobate.plots.geometry import Floats
from stylobate.plots.result_figure import InAxes, ResultFigure, heading
from stylobate.plots.style import BLACK, BLUE, GREY, STABLE_WIDTH, VERMILION, new_figure, styled

_HEIGHT, _NARROW, _ROOM = 2.9, 3.6, 1.12


@runtime_checkable
class Orbit(Protocol):
    """A periodic orbit, as far as its figure needs it."""

    @property
    def path(self) -> Floats:
        """Tilt vector and its rate over the orbit, shape (4, n)."""

    @property
    def multipliers(self) -> npt.NDArray[np.complexfloating]:
        """Floquet multipliers."""

    @property
    def stable(self) -> bool:
        """Whether all multipliers lie inside the unit circle."""

    @property
    def periods(self) -> int:
        """Length in periods of the base motion."""


@styled
def plot_orbit(orbit: Orbit) -> Figure:
    """Draw a periodic orbit: tilt over its period, path of the tilt vector, and multipliers in the unit circle.

    The line of a stable orbit is bold, that of an unstable one dashed. In given axes only the tilt is drawn.
    """
    figure = new_figure(_HEIGHT)
    phase = np.linspace(0.0, orbit.periods, orbit.path.shape[1] + 1)
    x, y = (np.append(one, one[0]) for one in orbit.path[:2])
    line: dict[str, Any] = {"color": BLUE if orbit.stable else VERMILION}
    line |= {"linewidth": 0.7 * STABLE_WIDTH} if orbit.stable else {"linestyle": "--", "linewidth": 1.2}
    tilt, path, circle = _panels(figure)
    tilt.plot(phase, np.hypot(x, y), **line)
    tilt.set(xlabel="time [base periods]", ylabel=r"tilt $\theta$ [rad]", ylim=(0.0, _ROOM * np.hypot(x, y).max()))
    if path is None or circle is None:
        return figure
    path.plot(x, y, **line)
    path.plot(x[:1], y[:1], "o", color=BLACK, markerfacecolor="white", markersize=5)
    reach = _ROOM * float(np.hypot(x, y).max() or 1.0)
    path.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal")
    path.set(xlabel=r"tilt $\theta_x$ [rad]", ylabel=r"tilt $\theta_y$ [rad]")
    path.locator_params(nbins=3)
    _draw_multipliers(circle, orbit.multipliers)
    kind = "stable" if orbit.stable else "unstable"
    length = "the period of the base motion" if orbit.periods == 1 else f"{orbit.periods} periods of the base motion"
    heading(figure, f"Periodic orbit, {kind}, {length}")
    return figure


def _panels(figure: Figure) -> tuple[Axes, Axes | None, Axes | None]:
    """Return the panels of tilt, path and multipliers: beside each other; in a narrow figure the tilt above."""
    if isinstance(figure, InAxes):
        return figure.subplots(), None, None
    assert isinstance(figure, ResultFigure)
    if not figure.narrow:
        panels = figure.subplots(1, 3, width_ratios=(1.0, 1.1, 1.1))
        return panels[0], panels[1], panels[2]
    figure.grow(_NARROW - figure.get_figheight())
    named = figure.subplot_mosaic([["tilt", "tilt"], ["path", "circle"]], height_ratios=(1.0, 1.25))
    return named["tilt"], named["path"], named["circle"]


def _draw_multipliers(axes: Axes, multipliers: npt.NDArray[np.complexfloating]) -> None:
    axes.add_patch(Circle((0.0, 0.0), 1.0, fill=False, color=GREY, linewidth=0.9))
    outside = np.abs(multipliers) > 1.0
    axes.plot(multipliers.real[~outside], multipliers.imag[~outside], "o", color=BLUE, markersize=5)
    axes.plot(multipliers.real[outside], multipliers.imag[outside], "X", color=VERMILION, markersize=6)
    reach = _ROOM * max(1.0, float(np.abs(multipliers).max(initial=0.0)))
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal")
    axes.set(xlabel="Re", ylabel="Im", title="multipliers")
    axes.locator_params(nbins=3)
