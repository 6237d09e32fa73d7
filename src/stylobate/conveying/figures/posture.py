"""Figure of the posture of a part: shares upright, rocking and fallen over the initial tilt, and peak tilts."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FormatStrFormatter, LogLocator, NullFormatter

from stylobate.conveying.posture import KIND, Posture
from stylobate.plots.cells import KIND_LOOKS, fill_options
from stylobate.plots.kinds import figure_of
from stylobate.plots.result_figure import heading
from stylobate.plots.style import BLUE, VERMILION, new_figure, styled

_LOOKS = {
    Posture.UPRIGHT: KIND_LOOKS["at rest"],
    Posture.ROCKING: KIND_LOOKS["rocking"],
    Posture.FALLEN: KIND_LOOKS["overturned"],
}
_HEIGHT, _TURN = 3.8, 2.0 * np.pi
# A logarithmic axis whose ends have less than this ratio has plain numbers, also between powers of ten.
_FEW = 50.0


@figure_of(KIND)
@styled
def plot_posture(found: xr.Dataset) -> Figure:
    """Draw the shares of each initial tilt as bars, and the peak tilt of each run over the phase of its start."""
    figure = new_figure(_HEIGHT)
    shares, peaks = figure.subplots(1, 2)
    _draw_shares(shares, found)
    _draw_peaks(peaks, found)
    heading(figure, str(found.attrs["verdict"]).partition(";")[0])
    return figure


def _draw_shares(axes: Axes, found: xr.Dataset) -> None:
    frictions, tilts = found["friction"].to_numpy(), found["tilt"].to_numpy()
    rows = found["share_of_tilt"].to_numpy().reshape(-1, len(Posture))
    names = [f"{tilt:g} rad" + (f", μ = {mu:.3g}" if frictions.size > 1 else "") for mu in frictions for tilt in tilts]
    left = np.zeros(len(rows))
    for kind in Posture:
        axes.barh(np.arange(len(rows)), rows[:, kind], 0.8, left, label=kind.name.lower(), **fill_options(_LOOKS[kind]))
        left = left + rows[:, kind]
    axes.set_yticks(np.arange(len(rows)), names)
    axes.set(xlim=(0.0, 1.0), ylim=(len(rows) - 0.5, -0.5), xlabel="share of the runs", ylabel="initial tilt")
    axes.grid(visible=False)
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=len(Posture))


def _draw_peaks(axes: Axes, found: xr.Dataset) -> None:
    fallen = found["posture"].to_numpy() == Posture.FALLEN
    phase, peak = found["phase"].to_numpy() / _TURN, found["peak_tilt"].to_numpy()
    shown = ~fallen & (peak > 0.0)
    axes.plot(phase[shown], peak[shown], ".", color=BLUE, label="stands")
    if fallen.any():
        top = float(peak[shown].max()) if shown.any() else 1.0
        axes.plot(phase[fallen], np.full(fallen.sum(), 2.0 * top), "x", color=VERMILION, label="fallen")
    axes.set(xlabel="phase at the start [turns]", ylabel="peak tilt [rad]")
    if shown.any():
        axes.set_yscale("log")
        axes.yaxis.set_minor_formatter(NullFormatter())
        low, high = axes.get_ylim()
        if high / low < _FEW:
            axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
            axes.yaxis.set_major_formatter(FormatStrFormatter("%g"))
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2)
