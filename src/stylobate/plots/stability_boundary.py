"""Stability boundary of rolling, and map of the errors of averaging."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import axis_label
from stylobate.plots.style import GREY, PALETTE, new_figure, styled

_DASHED = (0, (4, 2))
# Theory is thinner than exact curves.
_THEORY_WIDTH = 1.2
_STYLES = {
    "pitchfork": (PALETTE[0], "-"),
    "Neimark-Sacker": (PALETTE[1], "-."),
    "fold": (PALETTE[2], ":"),
    "period doubling": (PALETTE[3], "--"),
}
_UNDECIDED = "unstable on both sides"
_NAMES = {"Neimark-Sacker": "Neimark–Sacker"}


@figure_of("stability boundary")
@styled
def plot_stability_boundary(boundary: xr.Dataset) -> Figure:
    """Draw the curves of a stability boundary.

    Curves are bold if the loss of stability is supercritical, half as bold if it is subcritical, and thin if the orbit
    is unstable on both sides. If there is no curve, a note states the stability of rolling.
    """
    figure = new_figure(4.4)
    axes = figure.subplots()
    parameter = boundary[str(boundary.attrs["parameter"])]
    labelled: set[str] = set()
    for index, name in enumerate(boundary["curve_kind"].to_numpy()):
        part = boundary.isel(point=np.nonzero(boundary["curve"].to_numpy() == index)[0])
        x, y, supercritical = (
            part[key].to_numpy() for key in ("angular_frequency", str(parameter.name), "supercritical")
        )
        colour, line = _STYLES[str(name)]
        for chosen, how, width in (
            (supercritical == 1, "supercritical", 2.6),
            (supercritical == 0, "subcritical", 1.6),
            (supercritical == -1, _UNDECIDED, 0.7),
        ):
            added = "" if str(name) == "fold" else f", {how}"
            for first, last in _runs(chosen):
                label = _NAMES.get(str(name), str(name)) + added
                axes.plot(
                    x[first : last + 1],
                    y[first : last + 1],
                    color=colour,
                    linestyle=line,
                    linewidth=width,
                    label=None if label in labelled else label,
                )
                labelled.add(label)
    if "theory_frequency" in boundary:
        name = "theory" if bool(boundary["theory_is_exact"]) else "averaged"
        look: dict[str, Any] = {"color": GREY, "linestyle": _DASHED, "linewidth": _THEORY_WIDTH, "label": name}
        x, y = _inside(boundary)
        if np.isfinite(x).any():
            axes.plot(x, y, **look)
    axes.set_xlabel(axis_label(boundary["angular_frequency"]))
    axes.set_ylabel(axis_label(parameter))
    for limit, name in ((axes.set_xlim, "angular_frequency_range"), (axes.set_ylim, "bounds")):
        if name in boundary.attrs:
            limit(*(float(end) for end in boundary.attrs[name]))
    if not boundary.sizes["curve_index"]:
        axes.set_title(f"no loss of stability: exact rolling is {boundary.attrs['rolling']} here")
    if axes.get_legend_handles_labels()[0]:
        axes.legend()
    return figure


def _inside(boundary: xr.Dataset) -> tuple[np.ndarray, np.ndarray]:
    """Return theory's curve within the requested frequencies and one point beyond; NaN elsewhere."""
    x, y = boundary["theory_frequency"].to_numpy(), boundary["theory_parameter"].to_numpy()
    low, high = boundary.attrs.get("angular_frequency_range", (-np.inf, np.inf))
    inside = np.concatenate([[False], (x >= low) & (x <= high), [False]])
    return np.where(inside[:-2] | inside[1:-1] | inside[2:], x, np.nan), y


def _runs(chosen: np.ndarray) -> list[tuple[int, int]]:
    """Return first and last index of each interval, starting one point before so that intervals meet."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], chosen, [False]]).astype(int)))
    return [(max(int(first) - 1, 0), int(last) - 1) for first, last in zip(edges[::2], edges[1::2], strict=True)]


_CASES = (
    ((1, 1), "stable, as averaging predicts", PALETTE[0]),
    ((0, 1), "unstable, averaging predicts stable", PALETTE[1]),
    ((1, 0), "stable, averaging predicts unstable", PALETTE[2]),
    ((0, 0), "unstable, as averaging predicts", "#d9d9d9"),
    ((-1, None), "exact rolling not found", "white"),
)
_LEVELS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5)


@figure_of("averaging map")
@styled
def plot_averaging_map(found: xr.Dataset) -> Figure:
    """Draw an averaging map: agreement of averaged and exact stability, and the error of the mean tilt."""
    figure = new_figure(5.0)
    axes = figure.subplots()
    parameter = str(found.attrs["parameter"])
    neutral = "" if found.attrs.get("friction", 1) else "neutrally "
    exact, averaged = (
        found[name].transpose(parameter, "angular_frequency").to_numpy() for name in ("exact", "averaged")
    )
    classes = np.full(exact.shape, len(_CASES) - 1)
    for index, ((true, said), _, _) in enumerate(_CASES[:-1]):
        classes[(exact == true) & (averaged == said)] = index
    colours = ListedColormap([colour for _, _, colour in _CASES])
    x, y = found["angular_frequency"].to_numpy(), found[parameter].to_numpy()
    axes.pcolormesh(x, y, classes, cmap=colours, vmin=-0.5, vmax=len(_CASES) - 0.5, alpha=0.55, rasterized=True)
    error = np.abs(found["error"].transpose(parameter, "angular_frequency").to_numpy())
    _contours(axes, x, y, error)
    axes.set_xlabel(axis_label(found["angular_frequency"]))
    axes.set_ylabel(axis_label(found[parameter]))
    handles = [
        Patch(facecolor=colour, edgecolor="black", linewidth=0.4, alpha=0.55, label=_called(name, neutral))
        for index, (_, name, colour) in enumerate(_CASES)
        if np.any(classes == index)
    ]
    figure.legend(handles=handles, loc="outside upper center", ncols=2, fontsize="small")
    return figure


def _called(name: str, neutral: str) -> str:
    return f"{neutral}{name}" if name.startswith("stable") else name


def _contours(axes: Axes, x: np.ndarray, y: np.ndarray, error: np.ndarray) -> None:
    """Draw contours of the deviation of the averaged mean tilt at round percentages."""
    inside = [level for level in _LEVELS if np.nanmin(error) < level < np.nanmax(error)]
    if not inside or min(error.shape) < 2:  # noqa: PLR2004
        return
    lines = axes.contour(x, y, error, levels=inside, colors="black", linewidths=0.8)
    axes.clabel(lines, fmt=lambda level: f"{100.0 * level:g} %", fontsize="x-small")
