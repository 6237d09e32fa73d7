"""Responses over a parameter: steady rolling, its stability, slow sweeps, Poincaré sections, Lyapunov exponents."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from stylobate.errors import Outcome
from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import axis_label, unit_label
from stylobate.plots.style import DASHES, GREY, PALETTE, STABLE_WIDTH, UNSTABLE_WIDTH, new_figure, styled
from stylobate.results.outcomes import outcome_label


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


Floats = npt.NDArray[np.float64]

_HEIGHT_RATIOS = (2.6, 1.0)
_BAND = 0.18
_MARKERS = {Outcome.OVERTURNED: "X", Outcome.LIMIT_REACHED: "D", Outcome.LIFTED_OFF: "^", Outcome.FAILED: "*"}
_MOST_LEGS, _MOST_MARKED = 8, 30


@figure_of("slow sweep")
@styled
def plot_slow_sweep(found: xr.Dataset) -> Figure:
    """Return a figure of tilt and turns per period against the parameter of a slow sweep.

    Lines are means over the last periods at each value, bands reach from the minimum to maximum tilt. Full triangles
    point right if the parameter rises, hollow triangles left if it falls. A cross marks overturning, at the last mean
    tilt.
    """
    figure = new_figure(5.2)
    tilts, turns = figure.subplots(2, 1, sharex=True, height_ratios=_HEIGHT_RATIOS)
    legend: list[Line2D | Patch] = []
    name = str(found.attrs["parameter"])
    sweeps = range(found.sizes["sweep"])
    for sweep in sweeps:
        one, colour = found.isel(sweep=sweep), PALETTE[sweep % len(PALETTE)]
        for leg, rising in _legs(one[name].to_numpy()):
            part = one.isel(step=leg)
            if np.isfinite(part["mean_tilt"]).any():
                _draw_leg(tilts, turns, part, colour, rising=rising)
                which = f"sweep {sweep + 1}, " if len(sweeps) > 1 else ""
                legend.append(_line(colour, rising=rising, label=f"{which}{'upward' if rising else 'downward'}"))
    legend = legend if len(legend) <= _MOST_LEGS else []
    if np.any(found["peak_tilt"] - found["minimum_tilt"] > 0.0):
        legend.append(Patch(color=GREY, alpha=2.0 * _BAND, linewidth=0.0, label="minimum to maximum tilt"))
    legend += _draw_ends(tilts, found)
    tilts.set_ylabel(r"tilt $\theta$ [rad]")
    tilts.set_ylim(bottom=0.0)
    tilts.legend(handles=legend)
    turns.set_ylabel("turns per period")
    # Deviations from a whole number of turns stay visible.
    low, high = turns.get_ylim()
    turns.set_ylim(min(low, -0.1), max(high, 1.1) if high > 0.0 else 0.1)
    turns.set_xlabel(axis_label(found[name]))
    return figure


def _legs(values: Floats) -> Iterator[tuple[slice, bool]]:
    """Return the parts along which `values` rise or fall; the value at a turn belongs to both."""
    rises = np.diff(values) >= 0.0
    if not rises.size:
        yield slice(0, 1), True
        return
    turns = np.flatnonzero(rises[1:] != rises[:-1]) + 1
    for begin, end in zip([0, *turns], [*turns, rises.size], strict=True):
        yield slice(int(begin), int(end) + 1), bool(rises[begin])


def _draw_leg(tilts: Axes, turns: Axes, part: xr.Dataset, colour: str, *, rising: bool) -> None:
    x = part[str(part.attrs["parameter"])].to_numpy()
    tilts.fill_between(
        x, part["minimum_tilt"].to_numpy(), part["peak_tilt"].to_numpy(), color=colour, alpha=_BAND, linewidth=0.0
    )
    for axes, quantity in ((tilts, "mean_tilt"), (turns, "turns_per_period")):
        line = _line(colour, rising=rising)
        line.set_data(x, part[quantity].to_numpy())
        line.set_markevery(1 + x.size // _MOST_MARKED)
        axes.add_line(line)
        axes.autoscale_view()


def _line(colour: str, *, rising: bool, label: str = "") -> Line2D:
    return Line2D(
        [],
        [],
        color=colour,
        linewidth=1.1,
        linestyle="-" if rising else "--",
        marker=">" if rising else "<",
        markersize=3.6,
        markerfacecolor=colour if rising else "white",
        label=label,
    )


def _draw_ends(axes: Axes, found: xr.Dataset) -> list[Line2D]:
    """Mark the ends of the runs at their last mean tilt, and return the entries of the legend."""
    name, named = str(found.attrs["parameter"]), dict[Outcome, str]()
    for sweep in range(found.sizes["sweep"]):
        one = found.isel(sweep=sweep)
        codes, tilt = one["outcome"].to_numpy(), one["mean_tilt"].to_numpy()
        for outcome, marker in _MARKERS.items():
            for step in np.flatnonzero(codes == outcome):
                mark: dict[str, Any] = {"marker": marker, "linestyle": "none", "color": PALETTE[sweep % len(PALETTE)]}
                height = float(tilt[step - 1]) if step else 0.0
                axes.plot(float(one[name][step]), height, markersize=8, markeredgecolor="white", zorder=4, **mark)
                named[outcome] = marker
    return [
        Line2D([], [], marker=marker, linestyle="none", color=GREY, markersize=7, label=f"{outcome.label} here")
        for outcome, marker in named.items()
    ]


_QUANTITIES = (("section_tilt", "tilt", r"\theta"), ("section_tilt_rate", "tilt rate", r"\dot\theta"))
# Size of the markers, which falls with their number [points].
_LARGEST, _LEAST, _AREA = 4.5, 1.4, 60.0
_MOST_NAMED = 7
_NOTHING = "no points: the motion ended before"


@figure_of("Poincaré section")
@styled
def plot_section(found: xr.Dataset) -> Figure:
    """Return a figure of a Poincaré section: tilt on the left, its rate on the right, a colour for each run."""
    figure = new_figure(3.9)
    dims = list(found["outcome"].dims)
    runs = found.stack(each=dims, create_index=False) if dims else found.expand_dims("each")
    count = runs.sizes["each"]
    size = float(np.clip(_AREA / np.sqrt(found.sizes["period"]), _LEAST, _LARGEST))
    panels = figure.subplots(1, 2)
    for axes, (name, label, symbol) in zip(panels, _QUANTITIES, strict=True):
        for each in range(count):
            points = runs[name].isel(each=each)
            axes.plot(
                points.sel(axis="x"),
                points.sel(axis="y"),
                linestyle="none",
                marker="o",
                markersize=size,
                markeredgewidth=0.0,
                color=PALETTE[each % len(PALETTE)],
            )
        unit = unit_label(found[name])
        axes.set(xlabel=f"{label} ${symbol}_x$ [{unit}]", ylabel=f"{label} ${symbol}_y$ [{unit}]")
        axes.set_aspect("equal", adjustable="datalim")
        axes.locator_params(nbins=5)
        if not np.isfinite(runs[name]).any():
            axes.text(0.5, 0.5, _NOTHING, transform=axes.transAxes, ha="center", va="center", color=GREY)
    if count <= _MOST_NAMED:
        for each in range(count):
            which = f"run {each + 1}: " if count > 1 else ""
            ending = outcome_label(int(runs["outcome"].isel(each=each)))
            panels[0].plot([], [], "o", color=PALETTE[each], markersize=_LARGEST, label=f"{which}{ending}")
        figure.legend(loc="outside upper left", ncols=count)
    return figure


_LARGEST_PLACE = 9


@figure_of("Lyapunov exponents")
@styled
def plot_lyapunov(found: xr.Dataset) -> Figure:
    """Draw Lyapunov exponents against the periods over which they were computed, with their errors."""
    figure = new_figure(3.8)
    axes = figure.subplots()
    axes.axhline(0.0, color=GREY, linewidth=0.9)
    period = found["period"].to_numpy()
    for place, number in enumerate(found["exponent"].to_numpy()):
        one, colour = found.sel(exponent=number), PALETTE[place % len(PALETTE)]
        value, error = float(one["lyapunov_exponent"]), float(one["error"])
        dashes = DASHES[place % len(DASHES)]
        unit = _unit(one["lyapunov_exponent"])
        name = rf"$\lambda_{int(number)}$ {_value_and_error(value, error, unit)}"
        axes.plot(period, one["running"], color=colour, linestyle=dashes, linewidth=1.6, label=name)
        if np.isfinite(value):
            axes.axhspan(value - error, value + error, color=colour, alpha=0.15, linewidth=0.0)
    axes.set_xscale("log")
    axes.set_xlabel(axis_label(found["period"]))
    axes.set_ylabel(axis_label(found["running"]))
    figure.legend(loc="outside right upper")
    axes.set_title(_title(found))
    return figure


def _title(found: xr.Dataset) -> str:
    within = ", in its plane" if found.attrs["planar"] else ""
    if found["lyapunov_exponent"].isnull().any():
        lasted = int(found["periods_counted"]) + int(found.attrs.get("periods_skipped", 0))
        return f"{found.attrs['ending']} after {lasted} whole periods{within}"
    total = f"{float(found['lyapunov_exponent'].sum()):.6g}".replace("-", "−")
    return f"sum {total} {_unit(found['lyapunov_exponent'])}{within}"


def _unit(exponent: xr.DataArray) -> str:
    return unit_label(exponent).removeprefix("1")


def _value_and_error(value: float, error: float, unit: str) -> str:
    """Return value and error in text: the error with two digits, the value with as many decimals."""
    if not np.isfinite(value):
        return "undecided"
    place = _LARGEST_PLACE if error == 0.0 else int(np.clip(1 - np.floor(np.log10(error)), 0, _LARGEST_PLACE))
    return f"= {value:.{place}f} ± {error:.{place}f} {unit}".replace("-", "−")
