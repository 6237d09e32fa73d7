"""Lines of branches of orbits: bold if stable, thin if unstable, with the range of tilt and the bifurcations."""

from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle

from stylobate.plots.style import STABLE_WIDTH, UNSTABLE_WIDTH

BIFURCATION_MARKS = {
    "fold": ("s", "fold"),
    "pitchfork": ("D", "pitchfork"),
    "branch point": ("P", "branch point"),
    "period doubling": ("^", "period doubling"),
    "Neimark-Sacker": ("o", "Neimark–Sacker"),
}
"""Marker and name of each kind."""

_SHADE: dict[str, Any] = {"alpha": 0.15, "linewidth": 0.0}
_FILLS = {1: ("black", ", supercritical"), 0: ("white", ", subcritical"), -1: ("#bbbbbb", "")}


def draw_part(axes: Axes, part: xr.Dataset, x: str, y: str, colour: str, *, label: str | None = None) -> None:
    """Draw the quantity `y` of one branch against `x`, bold where its orbits are stable."""
    along, values, bold = part[x].to_numpy(), part[y].to_numpy(), _beside_stable(part)
    axes.plot(along, values, color=colour, linewidth=UNSTABLE_WIDTH)
    axes.plot(along, np.where(bold, values, np.nan), color=colour, linewidth=STABLE_WIDTH)
    if label is not None:
        axes.plot([], [], color=colour, linewidth=STABLE_WIDTH if bold.any() else UNSTABLE_WIDTH, label=label)


def shade_range(axes: Axes, part: xr.Dataset, x: str, colour: str) -> None:
    """Shade the range of the tilt over a period where the orbits of one branch are stable."""
    along, low, high = (part[name].to_numpy() for name in (x, "minimum_tilt", "peak_tilt"))
    axes.fill_between(along, low, high, where=_beside_stable(part), color=colour, **_SHADE)


def mark_bifurcations(axes: Axes, found: xr.Dataset, x: xr.DataArray) -> None:
    """Mark the bifurcations of `found` at `x` and their mean tilt; the legend lists each kind once."""
    kinds = found["bifurcation_kind"].to_numpy().astype(str)
    named = axes.get_legend_handles_labels()[1]
    for kind, (marker, name) in BIFURCATION_MARKS.items():
        for supercritical, (fill, decided) in _FILLS.items():
            chosen = (kinds == kind) & (found["bifurcation_supercritical"].to_numpy() == supercritical)
            if not chosen.any():
                continue
            axes.plot(
                x.to_numpy()[chosen],
                found["bifurcation_mean_tilt"].to_numpy()[chosen],
                marker=marker,
                linestyle="none",
                color="black",
                markerfacecolor=fill,
                markersize=5.0,
                zorder=5,
                label=None if name + decided in named else name + decided,
            )


def key_of_stability(axes: Axes, found: xr.Dataset) -> None:
    """Add the meaning of bold lines and shades to the legend if an orbit of `found` is stable."""
    if found["stable"].any():
        axes.plot([], [], color="black", linewidth=STABLE_WIDTH, label=f"bold: {stability_of(found)}")
        axes.add_patch(
            Rectangle((0.0, 0.0), 0.0, 0.0, color="black", label="range of the tilt over a period", **_SHADE)
        )


def stability_of(found: xr.Dataset) -> str:
    """Return the meaning of "stable": neutrally stable without damping, in the plane for planar orbits."""
    neutral = "" if found.attrs.get("friction", 1) else "neutrally "
    return f"{neutral}stable{' in the plane' if found.attrs.get('planar', 0) else ''}"


def _beside_stable(part: xr.Dataset) -> npt.NDArray[np.bool_]:
    """Return which points are stable or next to a stable one: a bifurcation belongs to both sides."""
    stable = part["stable"].to_numpy().astype(bool)  # a file holds numbers
    return np.asarray(stable | np.append(stable[1:], False) | np.append(False, stable[:-1]))
