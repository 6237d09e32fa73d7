"""Frequency response of exact periodic orbits, beside that of theory."""

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import axis_label, unit_label
from stylobate.plots.style import GREY, PALETTE, STABLE_WIDTH, UNSTABLE_WIDTH, new_figure, styled

_DASHED = (0, (4, 2))
_HEIGHT, _HEIGHT_OF_ONE, _RATIOS = 6.0, 4.4, (2.2, 1.0)
# Of theory's curves where they are stable, and where not: thinner than exact ones.
_THEORY_WIDTHS = 1.5, 0.8
# Phases that differ by less than this fill their panel.
_SPREAD = 0.5 * np.pi
BIFURCATION_MARKS = {
    "fold": ("s", "fold"),
    "pitchfork": ("D", "pitchfork"),
    "branch point": ("P", "branch point"),
    "period doubling": ("^", "period doubling"),
    "Neimark-Sacker": ("o", "Neimark–Sacker"),
}
"""Marker and name of each kind."""

_FILLS = {1: ("black", ", supercritical"), 0: ("white", ", subcritical"), -1: ("#bbbbbb", "")}


@figure_of("exact response")
@styled
def plot_exact_response(curves: xr.Dataset) -> Figure:
    """Return a figure of `curves` of the kind "exact response": mean tilt with its range above, phase below.

    Stable orbits are bold, unstable ones thin; a shade from the least to the largest tilt shows how far stable ones
    swing. Of orbits that have no phase there is no panel below. Theory's curves are dashed, in grey. Bifurcations are
    marked: black where stability is lost softly, white where it is lost hard, grey where that is not decided.
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
            _draw(axes, part, quantity, colour, name if axes is tilt else None)
        _shade(tilt, part, colour)
    _mark(tilt, curves)
    if curves["stable"].any():
        tilt.plot([], [], color="black", linewidth=STABLE_WIDTH, label=f"bold: {stability_of(curves)}")
    tilt.set_ylabel(r"mean tilt $\theta$ [rad]")
    tilt.set_ylim(bottom=0.0)
    panels[-1].set_xlabel(axis_label(curves["angular_frequency"]))
    if phased:
        panels[1].set_ylabel(r"phase $\psi$ [rad]")
        _set_phase_axis(panels[1], curves["phase"].to_numpy())
    tilt.legend(fontsize="small")
    return figure


def _set_phase_axis(axes: Axes, phase: npt.NDArray[np.float64]) -> None:
    """Mark 0, π/2 and π, or show the phases of exact orbits enlarged where they hardly differ."""
    low, high = float(np.nanmin(phase)), float(np.nanmax(phase))
    if high - low > _SPREAD:
        axes.set_yticks([0.0, np.pi / 2.0, np.pi], ["0", "π/2", "π"])
        return
    room = 0.15 * (high - low) + 0.01
    axes.set_ylim(low - room, high + room)
    axes.locator_params(axis="y", nbins=5)


def stability_of(found: xr.Dataset) -> str:
    """Return what "stable" means in a result: neutrally without friction, in their plane of orbits that keep to one."""
    neutral = "" if found.attrs.get("friction", 1) else "neutrally "
    return f"{neutral}stable{' in the plane' if found.attrs.get('planar', 0) else ''}"


def _draw(axes: Axes, part: xr.Dataset, name: str, colour: str, label: str | None) -> None:
    x, y, touching = part["angular_frequency"].to_numpy(), part[name].to_numpy(), _touching(part)
    axes.plot(x, y, color=colour, linewidth=UNSTABLE_WIDTH)
    axes.plot(x, np.where(touching, y, np.nan), color=colour, linewidth=STABLE_WIDTH)
    if label is not None:
        axes.plot([], [], color=colour, linewidth=STABLE_WIDTH if touching.any() else UNSTABLE_WIDTH, label=label)


def _shade(axes: Axes, part: xr.Dataset, colour: str) -> None:
    x, low, high = (part[name].to_numpy() for name in ("angular_frequency", "least_tilt", "largest_tilt"))
    axes.fill_between(x, low, high, where=_touching(part), color=colour, alpha=0.15, linewidth=0.0)


def _touching(part: xr.Dataset) -> npt.NDArray[np.bool_]:
    """Return which points are stable or next to a stable one: a bifurcation belongs to both sides."""
    stable = part["stable"].to_numpy().astype(bool)  # a file holds numbers
    return np.asarray(stable | np.append(stable[1:], False) | np.append(False, stable[:-1]))


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


def _mark(axes: Axes, curves: xr.Dataset) -> None:
    kinds = curves["bifurcation_kind"].to_numpy().astype(str)
    for kind, (marker, name) in BIFURCATION_MARKS.items():
        for supercritical, (fill, decided) in _FILLS.items():
            chosen = (kinds == kind) & (curves["bifurcation_supercritical"].to_numpy() == supercritical)
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
