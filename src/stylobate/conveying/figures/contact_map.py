"""Figures of contact maps, mean transport velocities, postures and onsets of motion."""

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import FormatStrFormatter, LogLocator, NullFormatter

from stylobate.conveying.posture import KIND, Posture
from stylobate.errors import Outcome, ParameterError
from stylobate.plots.cells import KIND_LOOKS, OUTCOME_LOOKS, Look, cell_edges, contact_classes, fill_options
from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import axis_label
from stylobate.plots.maps import draw_classes
from stylobate.plots.result_figure import WIDTH, beside_or_below, heading
from stylobate.plots.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    PURPLE,
    STABLE_WIDTH,
    UNSTABLE_WIDTH,
    VERMILION,
    new_figure,
    styled,
)
from stylobate.results.outcomes import ContactClass, knife_edge_remarks

Floats = npt.NDArray[np.float64]

_HEIGHT, _TALL, _LOW, _WIDE = 4.6, 5.4, 3.6, 10.0
_PLANE = 2
# Minimum mean twist rate of a column that counts as turning [rad/s].
_STILL = 1e-9


@figure_of("contact map")
@styled
def plot_contact_map(found: xr.Dataset) -> Figure:
    """Draw a contact map: the kinds of contact over two parameters, and the peak tilt if a column tilted."""
    x, y = (str(dim) for dim in found["outcome"].dims)
    ordered = found.sortby([x, y]).transpose(y, x, ...)
    stands = (ordered["contact_class"] != ContactClass.OVERTURNS) & (ordered["peak_tilt"] > 0.0)
    peak = np.ma.masked_invalid(ordered["peak_tilt"].where(stands).to_numpy())
    figure = new_figure(_HEIGHT, width=_WIDE if peak.count() else WIDTH)
    panels = figure.subplots(1, 2 if peak.count() else 1, sharex=True, sharey=True, squeeze=False)[0]
    handles = draw_classes(panels[0], found, found["contact_class"], contact_classes(found))
    panels[0].set_title("\n".join(knife_edge_remarks(found)), loc="left", fontsize="small")
    if not peak.count():
        figure.legend(handles=handles, loc="outside right upper")
        return figure
    figure.legend(handles=handles, loc="outside lower center", ncols=3)
    look = {"cmap": "viridis", "norm": LogNorm(), "rasterized": True}
    drawn = panels[1].pcolormesh(cell_edges(ordered[x]), cell_edges(ordered[y]), peak, **look)
    panels[1].grid(visible=False)
    panels[1].set_xlabel(axis_label(found[x]))
    panels[1].set_title("white: never tilted, or overturned", fontsize="small")
    figure.colorbar(drawn, ax=panels[1], label=axis_label(found["peak_tilt"]))
    return figure


@figure_of("drift")
@styled
def plot_drift(found: xr.Dataset) -> Figure:
    """Draw mean transport velocity and rate of rotation over one parameter, or the speed over two.

    A dotted line marks the throw number 1, above which a standing column leaves the base.
    """
    if found["outcome"].ndim == _PLANE:
        figure = new_figure(_HEIGHT)
        _draw_speed(figure, figure.subplots(), found)
        return figure
    name = str(found["outcome"].dims[0])
    ordered = found.sortby(name)
    x, turning = ordered[name].to_numpy(), ordered["mean_twist_rate"].to_numpy()
    turns = bool(np.any(np.abs(np.nan_to_num(turning)) > _STILL))
    figure = new_figure(_TALL if turns else _LOW)
    panels = list(figure.subplots(2 if turns else 1, 1, sharex=True, squeeze=False)[:, 0])
    _draw_velocity(panels[0], x, ordered["mean_velocity"])
    if turns:
        panels[1].plot(x, turning, color=BLACK, marker=".")
        panels[1].set_ylabel(axis_label(found["mean_twist_rate"], "mean twist rate"))
    panels[-1].set_xlabel(axis_label(found[name]))
    panels[0].set_title("\n".join(knife_edge_remarks(found)), loc="left", fontsize="small")
    thrown = _where_thrown(x, ordered["throw_number"].to_numpy())
    for axes in panels:
        axes.axhline(0.0, color=BLACK, linewidth=0.5)
        if thrown is not None:
            axes.axvline(thrown, color=GREY, linewidth=0.9, linestyle=":")
    if thrown is not None:
        panels[0].annotate(
            "throw number 1",
            (thrown, 1.0),
            xycoords=("data", "axes fraction"),
            xytext=(3, 0),
            textcoords="offset points",
            va="top",
            fontsize="small",
            color=GREY,
        )
    return figure


def _draw_velocity(axes: Axes, x: Floats, mean: xr.DataArray) -> None:
    velocity = mean.to_numpy()
    axes.plot(x, velocity[:, 0], color=BLUE, marker=".", label="along x")
    axes.plot(x, velocity[:, 1], color=VERMILION, linestyle="--", marker=".", label="along y")
    if np.isnan(velocity).any():
        axes.plot([], [], linestyle="none", label="gaps: motion ends before the last period")
    axes.set_ylabel(axis_label(mean, "mean velocity"))
    axes.legend()


def _where_thrown(x: Floats, throw: Floats) -> float | None:
    """Return the first x at which the throw number passes 1, or None."""
    passed = np.flatnonzero((throw[:-1] < 1.0) & (throw[1:] >= 1.0))
    if not passed.size:
        return None
    k = int(passed[0])
    return float(np.interp(1.0, throw[k : k + 2], x[k : k + 2]))


def _draw_speed(figure: Figure, axes: Axes, found: xr.Dataset) -> None:
    x, y = (str(dim) for dim in found["outcome"].dims)
    ordered = found.sortby([x, y]).transpose(y, x, ...)
    speed = np.ma.masked_invalid(ordered["transport_speed"].to_numpy())
    axes.grid(visible=False)
    axes.patch.set(facecolor="white", hatch="////", edgecolor="#b0b0b0")
    drawn = axes.pcolormesh(cell_edges(ordered[x]), cell_edges(ordered[y]), speed, cmap="viridis", rasterized=True)
    figure.colorbar(
        drawn,
        ax=axes,
        location=beside_or_below(figure),
        label=axis_label(found["transport_speed"], "mean transport speed"),
    )
    titles = knife_edge_remarks(found)
    throw = ordered["throw_number"].to_numpy()
    if throw.min() < 1.0 < throw.max():
        axes.contour(ordered[x], ordered[y], throw, levels=[1.0], colors="white", linestyles=":")
        titles.append("dotted: throw number 1")
    if speed.mask.any():
        titles.append("hatched: motion ends before the last period")
    axes.set_title("\n".join(titles), loc="left", fontsize="small")
    axes.set_xlabel(axis_label(found[x]))
    axes.set_ylabel(axis_label(found[y]))


_LOOKS = {
    Posture.UPRIGHT: KIND_LOOKS["at rest"],
    Posture.ROCKING: KIND_LOOKS["rocking"],
    Posture.FALLEN: KIND_LOOKS["overturned"],
}
_POSTURE_HEIGHT, _TURN = 3.8, 2.0 * np.pi
# A logarithmic axis whose ends have less than this ratio has plain numbers, also between powers of ten.
_FEW = 50.0


@figure_of(KIND)
@styled
def plot_posture(found: xr.Dataset) -> Figure:
    """Draw the shares of each initial tilt as bars, and the peak tilt of each run over the phase of its start."""
    figure = new_figure(_POSTURE_HEIGHT)
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


_ONSET_HEIGHT = 4.4
_DASHED = (0, (4, 2))
# Maximum number of frictions and of panels.
_COLOURS, _MOST = (BLUE, VERMILION, GREEN, PURPLE), 4
# End of the axis over the largest threshold other than lift-off.
_ROOM = 1.25

_STAYS, _SLIDES, _ROCKS = OUTCOME_LOOKS[Outcome.AT_REST], OUTCOME_LOOKS[Outcome.SLID], KIND_LOOKS["rocking"]
_REGIONS: dict[str, Look] = {"stays": _STAYS, "slides": _SLIDES, "rocks": _ROCKS}


@figure_of("start boundary")
@styled
def plot_start_boundary(found: xr.Dataset) -> Figure:
    """Draw the onset of motion over slenderness, with one panel for each vertical ratio and incline.

    The black line is the onset of rocking, coloured lines are the onset of sliding for each friction coefficient. A
    line is bold if its motion begins first, otherwise thin and dashed. With one coefficient the regions are filled. A
    dash-dotted line, if in range, is the acceleration at which the normal force vanishes.

    Raises
    ------
    ParameterError
        If there are more than four friction coefficients or panels. Choose some by `found.sel`.
    """
    chosen = [name for name in ("friction_coefficient", "vertical_ratio", "incline") if name not in found.dims]
    found = found.expand_dims(chosen)
    cases = found.stack(case=("vertical_ratio", "incline"))
    if cases.sizes["case"] > _MOST or cases.sizes["friction_coefficient"] > _MOST:
        raise ParameterError(
            f"a figure of the start of motion has up to {_MOST} frictions, and {_MOST} panels for ratios and inclines; "
            f"got {cases.sizes['friction_coefficient']} and {cases.sizes['case']}: choose some by found.sel(...)"
        )
    figure = new_figure(_ONSET_HEIGHT)
    panels = figure.subplots(1, cases.sizes["case"], sharex=True, sharey=True, squeeze=False)[0]
    for place, axes in enumerate(panels):
        _draw(axes, cases.isel(case=place).sortby("slenderness"))
        axes.set_title(_name(cases.isel(case=place), found), fontsize="small")
        axes.set_xlabel(axis_label(found["slenderness"]))
    panels[0].set_ylabel(axis_label(found["acceleration"], "acceleration of the base"))
    panels[0].set_xlim(float(found["slenderness"].min()), float(found["slenderness"].max()))
    panels[0].set_ylim(0.0, _top(found))
    figure.legend(handles=_legend(found), loc="outside lower center", ncols=3)
    return figure


def _draw(axes: Axes, case: xr.Dataset) -> None:
    c = case["slenderness"].to_numpy()
    frictions = case["friction_coefficient"].to_numpy()
    if frictions.size == 1:
        _fill(axes, case.isel(friction_coefficient=0))
    slips = case["slide"].to_numpy() < case["rock"].to_numpy()  # (slenderness, friction)
    _line(axes, c, case["rock"].isel(friction_coefficient=0).to_numpy(), ~np.all(slips, axis=1), BLACK)
    for index, colour in enumerate(_COLOURS[: frictions.size]):
        _line(axes, c, case["slide"].isel(friction_coefficient=index).to_numpy(), slips[:, index], colour)
    lift = case["lift_off"].isel(friction_coefficient=0).to_numpy()
    axes.plot(c, np.where(np.isfinite(lift), lift, np.nan), color=GREY, linestyle="-.", linewidth=1.2)


def _line(axes: Axes, c: np.ndarray, threshold: np.ndarray, first: npt.ArrayLike, colour: str) -> None:
    shown = np.where(np.isfinite(threshold), threshold, np.nan)
    axes.plot(c, shown, color=colour, linewidth=UNSTABLE_WIDTH, linestyle=_DASHED)
    axes.plot(c, np.where(np.asarray(first), shown, np.nan), color=colour, linewidth=STABLE_WIDTH)


def _fill(axes: Axes, case: xr.Dataset) -> None:
    c, least, slides = (case[name].to_numpy() for name in ("slenderness", "acceleration", "slide"))
    rocks, top = case["rock"].to_numpy(), 10.0 * np.nanmax(np.where(np.isfinite(least), least, 0.0))
    least = np.minimum(least, top)
    axes.fill_between(c, 0.0, least, **fill_options(_STAYS))
    inside = slides < rocks
    # The regions meet between two samples: each region extends to the first sample of the next.
    touching = inside | np.append(inside[1:], False) | np.append(False, inside[:-1])
    for where, look in ((touching, _SLIDES), (~inside, _ROCKS)):
        axes.fill_between(c, least, top, where=where, **fill_options(look))
    axes.grid(visible=False)


def _top(found: xr.Dataset) -> float:
    held = np.minimum(found["slide"].to_numpy(), found["rock"].to_numpy())
    return _ROOM * float(held[np.isfinite(held)].max())


def _name(case: xr.Dataset, found: xr.Dataset) -> str:
    lines = []
    ratio, incline = float(case["vertical_ratio"]), float(case["incline"])
    if found.sizes["vertical_ratio"] > 1 or ratio != 0.0:
        lines.append(f"vertical / horizontal {ratio:.3g}")
    if found.sizes["incline"] > 1 or incline != 0.0:
        lines.append(f"incline {incline:.3g} rad")
    return "\n".join(lines)


def _legend(found: xr.Dataset) -> list[Line2D | Patch]:
    frictions = found["friction_coefficient"].to_numpy()
    entries: list[Line2D | Patch] = [Line2D([], [], color=BLACK, linewidth=STABLE_WIDTH, label="begins to rock")]
    entries += [
        Line2D([], [], color=colour, linewidth=STABLE_WIDTH, label=rf"begins to slide, $\mu$ = {friction:.3g}")
        for friction, colour in zip(frictions, _COLOURS, strict=False)
    ]
    if (found["lift_off"] < _top(found)).any():
        entries.append(Line2D([], [], color=GREY, linestyle="-.", linewidth=1.2, label="is lifted"))
    entries.append(
        Line2D([], [], color=BLACK, linewidth=UNSTABLE_WIDTH, linestyle=_DASHED, label="not the first motion")
    )
    if frictions.size == 1:
        entries += [Patch(label=name, **fill_options(look)) for name, look in _REGIONS.items()]
    return entries
