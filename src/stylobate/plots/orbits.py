"""Periodic orbits: one orbit, branches over their parameter, curves of bifurcations, outcomes beside a bifurcation."""

import json
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Protocol, runtime_checkable

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Rectangle

from stylobate.errors import Outcome, ParameterError
from stylobate.plots.cells import KIND_LOOKS, OUTCOME_LOOKS, Look
from stylobate.plots.geometry import Floats
from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import axis_label, unit_label
from stylobate.plots.result_figure import InAxes, ResultFigure, heading
from stylobate.plots.style import (
    BLACK,
    BLUE,
    GREY,
    PALETTE,
    STABLE_WIDTH,
    UNSTABLE_WIDTH,
    VERMILION,
    new_figure,
    styled,
)
from stylobate.results.outcomes import stability_of

_NARROW, _ROOM = 3.6, 1.12


@runtime_checkable
class DrawnOrbit(Protocol):
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
def plot_orbit(orbit: DrawnOrbit) -> Figure:
    """Draw a periodic orbit: tilt over its period, path of the tilt vector, and multipliers in the unit circle.

    The line of a stable orbit is bold, that of an unstable one dashed. In given axes only the tilt is drawn.
    """
    figure = new_figure(2.9)
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


def _beside_stable(part: xr.Dataset) -> npt.NDArray[np.bool_]:
    """Return which points are stable or next to a stable one: a bifurcation belongs to both sides."""
    stable = part["stable"].to_numpy().astype(bool)  # a file holds numbers
    return np.asarray(stable | np.append(stable[1:], False) | np.append(False, stable[:-1]))


@figure_of("branch")
def plot_branch(points: xr.Dataset) -> Figure:
    """Return a figure of the `points` of one branch: see `plot_branches`."""
    return plot_branches([points])


@styled
def plot_branches(branches: Sequence[xr.Dataset], labels: Sequence[str] | None = None) -> Figure:
    """Return a figure of the mean tilt of branches against their parameter.

    Stable orbits are bold, unstable ones thin; a shade shows the range of the tilt of stable orbits over a period.
    Bifurcations are marked: black if supercritical, white if subcritical, grey if undecided.

    Parameters
    ----------
    branches
        `Branch.points` of one or several branches over the same parameter.
    labels
        A name for each.

    Raises
    ------
    ParameterError
        If the branches have different parameters.
    """
    parameters = list(dict.fromkeys(str(one.attrs["parameter"]) for one in branches))
    if len(parameters) > 1:
        raise ParameterError(
            f"branches must have one parameter, got {', '.join(parameters)}: plot those of each parameter alone"
        )
    x = parameters[0]
    names: Sequence[str | None] = labels or [None] * len(branches)
    figure = new_figure(4.4)
    axes = figure.subplots()
    for index, (points, name) in enumerate(zip(branches, names, strict=True)):
        colour = PALETTE[index % len(PALETTE)]
        draw_part(axes, points, x, "mean_tilt", colour, label=name)
        shade_range(axes, points, x, colour)
    for points in branches:
        mark_bifurcations(axes, points, points["bifurcation_parameter"])
    key_of_stability(axes, max(branches, key=lambda points: int(points["stable"].sum())))
    axes.set_xlabel(axis_label(branches[0][x]))
    axes.set_ylabel(r"mean tilt $\theta$ [rad]")
    axes.set_ylim(bottom=0.0)
    axes.legend(fontsize="small")
    return figure


# Line styles of supercritical, subcritical and undecided bifurcations.
_LINES: dict[int, dict[str, Any]] = {
    1: {"linewidth": 2.4, "linestyle": "-"},
    0: {"linewidth": 1.6, "linestyle": (0, (4, 2))},
    -1: {"linewidth": 1.1, "linestyle": "-"},
}
_DECIDED = {1: "supercritical", 0: "subcritical", -1: "fold, or not decided"}


@figure_of("bifurcation curve")
def plot_bifurcation_curve(points: xr.Dataset) -> Figure:
    """Return a figure of the `points` of one curve: see `plot_bifurcation_curves`."""
    return plot_bifurcation_curves([points])


@styled
def plot_bifurcation_curves(curves: Sequence[xr.Dataset], labels: Sequence[str] | None = None) -> Figure:
    """Return a figure of curves of bifurcations in the plane of their two parameters.

    Lines are bold for supercritical bifurcations, dashed for subcritical ones, and thin for folds and undecided
    bifurcations.

    Parameters
    ----------
    curves
        `BifurcationCurve.points` of one or several curves over the same two parameters.
    labels
        A name for each; by default the kind of the bifurcation.

    Raises
    ------
    ParameterError
        If the curves have different parameters.
    """
    planes = [tuple(json.loads(one.attrs["parameters"])) for one in curves]
    if any(set(plane) != set(planes[0]) for plane in planes):
        pairs = " and ".join(str(plane) for plane in dict.fromkeys(planes))
        raise ParameterError(f"curves must have the same two parameters, got {pairs}: plot those of each plane alone")
    x, y = planes[0]
    figure = new_figure(4.4)
    axes = figure.subplots()
    names = labels or [str(one.attrs["bifurcation"]) for one in curves]
    for index, (points, name) in enumerate(zip(curves, names, strict=True)):
        colour = PALETTE[index % len(PALETTE)]
        code = points["supercritical"].to_numpy()
        along, height = points[x].to_numpy(), points[y].to_numpy()
        for decided, line in _LINES.items():
            here = code == decided
            shown = here | np.append(False, here[:-1])
            axes.plot(along, np.where(shown, height, np.nan), color=colour, **line)
        axes.plot([], [], color=colour, linewidth=2.4, label=name)
    for decided, line in _LINES.items():
        if any((points["supercritical"] == decided).any() for points in curves):
            axes.plot([], [], color="black", label=_DECIDED[decided], **line)
    axes.set_xlabel(axis_label(curves[0][x]))
    axes.set_ylabel(axis_label(curves[0][y]))
    axes.legend(fontsize="small")
    return figure


# Textures of orbits of several periods; orbits of one period and of several have the same colour.
_TEXTURES, _MANY_PERIODS = {2: "//", 3: "||", 4: ".."}, "++"


@figure_of("after bifurcation")
@styled
def plot_after_bifurcation(found: xr.Dataset) -> Figure:
    """Draw the shares of the outcomes of runs at each value of the parameter.

    Colours are those of maps. A dashed line lies between the bars on either side of the bifurcation.
    """
    parameter = str(found.attrs["parameter"])
    ordered = found.sortby(parameter)
    values = ordered[parameter].to_numpy()
    shares = ordered["count"].transpose("fate", parameter).to_numpy() / ordered["count"].sum("fate").to_numpy()
    figure = new_figure(1.6 + 0.32 * values.size)
    axes = figure.subplots()
    place, left = np.arange(values.size), np.zeros(values.size)
    for index, name in enumerate(ordered["fate"].to_numpy()):
        look = _look(str(name))
        axes.barh(
            place,
            shares[index],
            left=left,
            facecolor=look.colour,
            edgecolor=look.ink if look.texture else "black",
            hatch=look.texture,
            linewidth=0.5,
            label=str(name),
        )
        left += shares[index]
    axes.set_yticks(place, [f"{value:.6g}" for value in values])
    axes.set_ylabel(axis_label(ordered[parameter]))
    axes.set_xlabel(f"share of {int(ordered['count'].isel({parameter: 0}).sum())} runs")
    axes.set_xlim(0.0, 1.0)
    axes.grid(visible=False)
    below = int(np.searchsorted(values, float(ordered.attrs["at"])))
    if 0 < below < values.size:
        between = below - 0.5
        axes.axhline(between, color="black", linestyle=(0, (4, 2)), linewidth=1.2)
        axes.annotate(
            f" {ordered.attrs['bifurcation']}", (1.0, between), va="center", fontsize="small", annotation_clip=False
        )
    figure.legend(loc="outside upper center", ncols=2, fontsize="small")
    return figure


def _look(fate: str) -> Look:
    """Return the look of an outcome: the look of its kind in maps, with a texture for each number of periods."""
    kind, _, periods = fate.partition(", period ")
    look = KIND_LOOKS.get(kind, OUTCOME_LOOKS[Outcome.STILL_MOVING])
    return replace(look, texture=_TEXTURES.get(int(periods), _MANY_PERIODS)) if periods else look


_DASHED = (0, (4, 2))
_RATIOS = (2.2, 1.0)
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
    figure = new_figure(6.0 if phased else 4.4)
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
