"""Frequency response of exact periodic orbits, compared with theory."""

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stylobate.plots.branch_lines import draw_part, key_of_stability, mark_bifurcations, shade_range
from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import axis_label, unit_label
from stylobate.plots.style import GREY, PALETTE, new_figure, styled

_DASHED = (0, (4, 2))
_HEIGHT, _HEIGHT_OF_ONE, _RATIOS = 6.0, 4.4, (2.2, 1.0)
# Line widths of stable and unstable theory: thinner than exact curves.
_THEORY_WIDTHS = 1.5, 0.8
# Phases that differ by less than this fill their panel.
_SPREAD = 0.5 * np.pi


@figure_of("exact response")
@styled
def plot_exact_response(curves: xr.Dataset) -> Figure:
    """Draw exact response `curves`: mean tilt with its range above, phase below.

    Stable orbits are bold, unstable ones thin; a shade shows the minimum to maximum tilt of stable orbits. Orbits
    without a phase have no panel below. Theory's curves are dashed, in grey. Bifurcations are marked: black if
    supercritical, white if subcritical, grey if undecided.
    """
    phased = bool(np.isfinite(curves["phase"]).any())
    figure = new_figure(_HEIGHT if phased else _HEIGHT_OF_ONE)
    panels = figure.subplots(1 + phased, 1, sharex=True, squeeze=False, height_ratios=_RATIOS[: 1 + phased])[:, 0]
    tilt, quantities = panels[0], ("mean_tilt", "phase")
    for axes, name in zip(panels, ("averaged_amplitude", "averaged_phase"), strict=False):
        _draw_theory(axes, curves, name)
    for index in range(curves.sizes["branch_index"]):
        part = curves.isel(point=np.nonzero(curves["branch"].to_numpy() == index)[0])
        colour = PALETTE[index % len(PALETTE)]
        name = str(curves["branch_name"][index].item()).replace("rad/s", unit_label(curves["angular_frequency"]))
        for axes, quantity in zip(panels, quantities, strict=False):
            draw_part(axes, part, "angular_frequency", quantity, colour, label=name if axes is tilt else None)
        shade_range(tilt, part, "angular_frequency", colour)
    mark_bifurcations(tilt, curves, curves["bifurcation_angular_frequency"])
    key_of_stability(tilt, curves)
    tilt.set_ylabel(r"mean tilt $\theta$ [rad]")
    tilt.set_ylim(bottom=0.0)
    panels[-1].set_xlabel(axis_label(curves["angular_frequency"]))
    if phased:
        panels[1].set_ylabel(r"phase $\psi$ [rad]")
        _set_phase_axis(panels[1], curves["phase"].to_numpy())
    tilt.legend(fontsize="small")
    return figure


def _set_phase_axis(axes: Axes, phase: npt.NDArray[np.float64]) -> None:
    """Mark 0, π/2 and π, or zoom in on the phases of exact orbits if these hardly differ."""
    low, high = float(np.nanmin(phase)), float(np.nanmax(phase))
    if high - low > _SPREAD:
        axes.set_yticks([0.0, np.pi / 2.0, np.pi], ["0", "π/2", "π"])
        return
    room = 0.15 * (high - low) + 0.01
    axes.set_ylim(low - room, high + room)
    axes.locator_params(axis="y", nbins=5)


def _draw_theory(axes: Axes, curves: xr.Dataset, name: str) -> None:
    if name not in curves:
        return
    x = curves["averaged_frequency"].to_numpy()
    label = "theory" if bool(curves["averaged_is_exact"]) else "averaged"
    for index in range(curves.sizes["averaged_branch"]):
        y = curves[name][index].to_numpy()
        stable = curves["averaged_stable"][index].to_numpy().astype(bool)
        axes.plot(x, y, color=GREY, linewidth=_THEORY_WIDTHS[1], linestyle=_DASHED)
        axes.plot(x, np.where(stable, y, np.nan), color=GREY, linewidth=_THEORY_WIDTHS[0], linestyle=_DASHED)
    axes.plot([], [], color=GREY, linewidth=_THEORY_WIDTHS[0], linestyle=_DASHED, label=label)
