"""Amplitude and phase of steady rolling against the frequency of the base."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import axis_label
from stylobate.plots.style import GREY, PALETTE, STABLE_WIDTH, UNSTABLE_WIDTH, new_figure, styled


@figure_of("response curves")
@styled
def plot_response(curves: xr.Dataset) -> Figure:
    """Return a figure of response `curves`: amplitude above, phase below, stable bold, unstable thin."""
    figure = new_figure(6.4)
    amplitude, phase = figure.add_subplot(2, 1, 1), figure.add_subplot(2, 1, 2)
    frequency = curves["angular_frequency"]
    amplitude.plot(frequency, curves["backbone"], color=GREY, linestyle=(0, (4, 2)), label="free rolling (5)")
    for index, (sense, name) in enumerate(_distinct(curves)):
        colour = PALETTE[index]
        for branch in curves["branch"].to_numpy():
            part = curves.sel(sense=sense, branch=branch)
            draw_branch(amplitude, frequency, part["amplitude"], part["stable"], color=colour)
            draw_branch(phase, frequency, part["phase"], part["stable"], color=colour)
        amplitude.plot([], [], color=colour, linewidth=STABLE_WIDTH, label=f"rolling {name}, stable")
        amplitude.plot([], [], color=colour, linewidth=UNSTABLE_WIDTH, label=f"rolling {name}, unstable")
    averaged = "averaged " if curves.attrs["averaged"] else ""
    amplitude.set_ylabel(rf"{averaged}tilt $\theta$ [rad]")
    amplitude.set_ylim(bottom=0.0)
    amplitude.legend()
    set_phase_axis(phase)
    phase.set_ylabel(rf"{averaged}phase $\psi$ [rad]")
    phase.set_xlabel(axis_label(frequency))
    phase.sharex(amplitude)
    return figure


def _distinct(curves: xr.Dataset) -> list[tuple[str, str]]:
    """Return the senses of rolling and their names; senses with the same curve appear once."""
    senses = [str(sense) for sense in curves["sense"].to_numpy()]
    first = curves["amplitude"].sel(sense=senses[0]).to_numpy()
    if len(senses) > 1 and np.allclose(first, curves["amplitude"].sel(sense=senses[1]), rtol=1e-9, equal_nan=True):
        return [(senses[0], "in either sense")]
    return [(sense, sense) for sense in senses]


def draw_branch(
    axes: Axes, frequency: xr.DataArray, values: xr.DataArray, stable: xr.DataArray, **options: object
) -> None:
    """Draw one branch, bold where stable and thin where not; the two parts meet."""
    x, y, bold = frequency.to_numpy(), values.to_numpy(), stable.to_numpy()
    touching = bold | np.append(bold[1:], False) & np.isfinite(y)
    axes.plot(x, y, linewidth=UNSTABLE_WIDTH, **options)  # type: ignore[arg-type]
    axes.plot(x, np.where(touching, y, np.nan), linewidth=STABLE_WIDTH, **options)  # type: ignore[arg-type]


def set_phase_axis(axes: Axes) -> None:
    """Mark 0, π/2 and π on a phase axis."""
    axes.set_yticks([0.0, np.pi / 2.0, np.pi], ["0", "π/2", "π"])
