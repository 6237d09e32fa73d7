"""Frequency response of exact periodic orbits, beside that of theory."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stylobate.plots.style import GREY, PALETTE, STABLE_WIDTH, UNSTABLE_WIDTH, new_figure, styled

_DASHED = (0, (4, 2))
BIFURCATION_MARKS = {
    "fold": ("s", "fold"),
    "pitchfork": ("D", "pitchfork"),
    "branch point": ("P", "branch point"),
    "period doubling": ("^", "period doubling"),
    "Neimark-Sacker": ("o", "Neimark–Sacker"),
}
"""Marker and name of each kind."""

_FILLS = {1: ("black", ", soft loss"), 0: ("white", ", hard loss"), -1: ("#bbbbbb", "")}


@styled
def plot_exact_response(curves: xr.Dataset) -> Figure:
    """Return a figure of `curves` of the kind "exact response": mean tilt with its range above, phase below.

    Stable orbits are bold, unstable ones thin; a shade from the least to the largest tilt shows how far stable ones
    swing. Theory's curves are dashed, in grey. Bifurcations are marked: black where stability is lost softly, white
    where it is lost hard, grey where the orbit is unstable on both sides.
    """
    figure = new_figure(6.6)
    tilt, phase = figure.subplots(2, 1, sharex=True)
    _draw_theory(tilt, curves, "averaged_amplitude")
    _draw_theory(phase, curves, "averaged_phase")
    for index in range(curves.sizes["branch_index"]):
        part = curves.isel(point=np.nonzero(curves["branch"].to_numpy() == index)[0])
        colour = PALETTE[index % len(PALETTE)]
        name = str(curves["branch_name"][index].item())
        _draw(tilt, part, "mean_tilt", colour, name)
        _draw(phase, part, "phase", colour, None)
        _shade(tilt, part, colour)
    _mark(tilt, curves)
    tilt.set_ylabel("mean tilt A [rad]")
    tilt.set_ylim(bottom=0.0)
    phase.set_ylabel("phase ψ [rad]")
    phase.set_xlabel("angular frequency of the base [rad/s]")
    phase.set_yticks([0.0, np.pi / 2.0, np.pi], ["0", "π/2", "π"])
    tilt.legend(fontsize="small")
    return figure


def _draw(axes: Axes, part: xr.Dataset, name: str, colour: str, label: str | None) -> None:
    x, y, stable = (part[key].to_numpy() for key in ("angular_frequency", name, "stable"))
    stable = stable.astype(bool)  # a file holds numbers
    # A bifurcation is a point of the curve that belongs to both sides.
    touching = stable | np.append(stable[1:], False) | np.append(False, stable[:-1])
    axes.plot(x, y, color=colour, linewidth=UNSTABLE_WIDTH)
    axes.plot(x, np.where(touching, y, np.nan), color=colour, linewidth=STABLE_WIDTH)
    if label is not None:
        axes.plot([], [], color=colour, linewidth=STABLE_WIDTH if stable.any() else UNSTABLE_WIDTH, label=label)


def _shade(axes: Axes, part: xr.Dataset, colour: str) -> None:
    x, stable = part["angular_frequency"].to_numpy(), part["stable"].to_numpy().astype(bool)
    low, high = part["least_tilt"].to_numpy(), part["largest_tilt"].to_numpy()
    axes.fill_between(x, low, high, where=stable, color=colour, alpha=0.15, linewidth=0.0)


def _draw_theory(axes: Axes, curves: xr.Dataset, name: str) -> None:
    if name not in curves:
        return
    x = curves["averaged_frequency"].to_numpy()
    told = "theory" if bool(curves["averaged_is_exact"]) else "averaged"
    for index in range(curves.sizes["averaged_branch"]):
        y = curves[name][index].to_numpy()
        stable = curves["averaged_stable"][index].to_numpy().astype(bool)
        axes.plot(x, y, color=GREY, linewidth=UNSTABLE_WIDTH, linestyle=_DASHED)
        axes.plot(x, np.where(stable, y, np.nan), color=GREY, linewidth=STABLE_WIDTH, linestyle=_DASHED)
    axes.plot([], [], color=GREY, linewidth=STABLE_WIDTH, linestyle=_DASHED, label=told)


def _mark(axes: Axes, curves: xr.Dataset) -> None:
    kinds = curves["bifurcation_kind"].to_numpy().astype(str)
    for kind, (marker, name) in BIFURCATION_MARKS.items():
        for soft, (fill, decided) in _FILLS.items():
            chosen = (kinds == kind) & (curves["bifurcation_soft"].to_numpy() == soft)
            if not chosen.any():
                continue
            axes.plot(
                curves["bifurcation_angular_frequency"].to_numpy()[chosen],
                curves["bifurcation_mean_tilt"].to_numpy()[chosen],
                marker=marker,
                linestyle="none",
                color="black",
                markerfacecolor=fill,
                markersize=5.0,
                zorder=5,
                label=name + decided,
            )
