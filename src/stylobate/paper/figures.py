"""Figures of the source paper and additional figures, from the data of the check."""

import re
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from stylobate.plots.responses import draw_branch, set_phase_axis
from stylobate.plots.style import (
    BLACK,
    BLUE,
    DASHES,
    GREY,
    PALETTE,
    STABLE_WIDTH,
    UNSTABLE_WIDTH,
    VERMILION,
    new_figure,
    styled,
)

# The paper's numbers of the curves by amplitude and branch, and their positions along ν.
_CURVE_NUMBERS = {(0, "lower"): (2, 0.62), (0, "upper"): (3, 0.28), (1, "lower"): (4, 0.42), (1, "upper"): (5, 0.5)}
_COLOURS = (BLUE, VERMILION)
_LIMIT = (0, (4, 2))


@styled
def sketch() -> Figure:
    """Draw the leaning column from the side and from above, with the symbols."""
    figure = new_figure(3.4)
    side, above = figure.subplots(1, 2, width_ratios=(1.5, 1.0))
    tilt, r, height = 0.28, 0.5, 3.2
    turn = np.array([[np.cos(tilt), np.sin(tilt)], [-np.sin(tilt), np.cos(tilt)]])
    corners = np.array([[-2.0 * r, 0.0], [0.0, 0.0], [0.0, height], [-2.0 * r, height], [-2.0 * r, 0.0]]) @ turn.T
    foot, centre, top = (np.array([-r, y]) @ turn.T for y in (0.0, height / 2.0, height * 1.12))
    side.fill(*corners.T, facecolor="#e8edf2", edgecolor=BLACK, linewidth=1.2)
    side.plot([-1.6, 1.9], [0.0, 0.0], color=BLACK, linewidth=2.0)
    side.plot(*np.array([foot, top]).T, color=GREY, linestyle="-.", linewidth=0.9)
    side.plot([foot[0], foot[0]], [foot[1], foot[1] + height * 1.1], color=GREY, linewidth=0.9)
    side.plot(*centre, "o", color=BLUE)
    side.plot(0.0, 0.0, "o", color=VERMILION)
    for text, place in (
        ("centre of mass, at the height h on the axis", (centre[0] + 0.85, centre[1] - 0.05)),
        ("contact point on the rim, radius r", (0.1, -0.36)),
        (r"$\theta$", (foot[0] + 0.42, foot[1] + height * 1.08)),
    ):
        side.annotate(text, place, fontsize="small")
    side.annotate("acceleration of the base", (-1.6, -0.75), fontsize="small", va="center")
    side.annotate("", (2.6, -0.75), (1.5, -0.75), arrowprops={"arrowstyle": "-|>", "color": BLACK, "linewidth": 1.6})
    angle = 0.9
    above.add_patch(Circle((0.0, 0.0), 1.0, fill=False, color=BLACK, linewidth=1.2))
    above.plot([-1.3, 1.3], [0.0, 0.0], color=GREY, linewidth=0.9)
    above.plot([0.0, 0.0], [-1.3, 1.3], color=GREY, linewidth=0.9)
    above.annotate("", (np.cos(angle), np.sin(angle)), (0.0, 0.0), arrowprops={"arrowstyle": "->", "color": BLUE})
    above.plot(np.cos(angle), np.sin(angle), "o", color=VERMILION)
    arc = np.linspace(0.0, angle, 30)
    above.plot(0.45 * np.cos(arc), 0.45 * np.sin(arc), color=BLACK, linewidth=0.9)
    for text, place in (
        (r"$\beta$", (0.5, 0.2)),
        (r"$\theta$", (0.24, 0.62)),
        ("$x$", (1.34, -0.06)),
        ("$y$", (-0.1, 1.38)),
    ):
        above.annotate(text, place, fontsize=9)
    for axes, limits in ((side, (-1.7, 4.1, -1.0, 3.8)), (above, (-1.5, 1.6, -1.4, 1.6))):
        axes.set_aspect("equal")
        axes.axis(limits)
        axes.axis("off")
    return figure


@styled
def figure_2(response: xr.Dataset, straight: xr.Dataset | None = None) -> Figure:
    """Draw Fig. 2, tilt against frequency; for straight-line motion also the full motion `straight`."""
    figure = new_figure(4.4)
    axes = figure.subplots()
    nu = response["nu"]
    axes.plot(nu, response["backbone"], color=GREY, linestyle=_LIMIT)
    _number(axes, 1, 0.05, float(response["backbone"][0]))
    for (index, branch), (number, place) in _CURVE_NUMBERS.items():
        part = response.isel(a0=index).sel(branch=branch)
        draw_branch(axes, nu, part["amplitude"], part["stable"], color=_COLOURS[index])
        _number(axes, number, place, float(part["amplitude"].interp(nu=place)), color=_COLOURS[index])
    if straight is not None:
        _draw_full_motion(axes, straight)
    _name_amplitudes(axes, response, 1.0 if straight is None else 2.0)
    axes.legend(loc="upper right")
    axes.set_xlabel(r"frequency ratio $\nu = \Omega/\omega_0$")
    axes.set_ylabel(r"tilt angle $\theta$ [rad]" if straight is None else r"tilt angle $\theta$, averaged [rad]")
    axes.set_xlim(0.0, 4.1)
    axes.set_ylim(0.0, 0.172)
    return figure


@styled
def figure_3(response: xr.Dataset, *, averaged: bool) -> Figure:
    """Draw Fig. 3, phase against frequency; `averaged` for straight-line motion."""
    figure = new_figure(4.0)
    axes = figure.subplots()
    places = {2: 0.8, 3: 2.6, 4: 1.2, 5: 1.9}
    for (index, branch), (number, _) in _CURVE_NUMBERS.items():
        part = response.isel(a0=index).sel(branch=branch)
        draw_branch(axes, response["nu"], part["phase"], part["stable"], color=_COLOURS[index])
        place = places[number]
        _number(axes, number, place, float(part["phase"].interp(nu=place)), color=_COLOURS[index])
    set_phase_axis(axes)
    _name_amplitudes(axes, response, 2.0 if averaged else 1.0)
    axes.legend(loc="center right")
    axes.set_xlabel(r"frequency ratio $\nu = \Omega/\omega_0$")
    axes.set_ylabel(r"phase $\psi$, averaged [rad]" if averaged else r"phase $\psi$ [rad]")
    axes.set_xlim(0.0, float(response["nu"][-1]))
    return figure


@styled
def backbones(data: xr.Dataset) -> Figure:
    """Draw the two backbones, each with a forced response near it."""
    figure = new_figure(4.2)
    axes = figure.subplots()
    nu = data["nu"]
    axes.plot(nu, data["rolling_backbone"], color=BLUE, linestyle=_LIMIT, label="free rolling (5)")
    axes.plot(nu, data["planar_backbone"], color=VERMILION, linestyle=":", linewidth=1.6, label="free rocking (3)")
    for branch in data["branch"].to_numpy():
        part = data.sel(branch=branch)
        draw_branch(axes, nu, part["rolling"], part["rolling_stable"], color=BLUE)
    for orbit in data["orbit"].to_numpy():
        part = data.sel(orbit=orbit)
        draw_branch(axes, nu, part["planar"], part["planar_stable"], color=VERMILION)
    axes.plot([], [], color=BLUE, linewidth=STABLE_WIDTH, label=f"rolling on a circle, $a_0$ = {data.attrs['a0']:g}")
    axes.plot([], [], color=VERMILION, linewidth=STABLE_WIDTH, label=f"planar rocking, $a_1$ = {data.attrs['a1']:g}")
    axes.plot([], [], color=BLACK, linewidth=UNSTABLE_WIDTH, label="thin: unstable (rocking: within its plane)")
    axes.legend()
    axes.set_xlabel(r"frequency ratio $\nu$, $\omega/\omega_0$")
    axes.set_ylabel("peak tilt angle [rad]")
    axes.set_ylim(0.0, 1.2 * data.attrs["c"])
    return figure


@styled
def averaging(data: xr.Dataset) -> Figure:
    """Draw tilt against time by the full equations and the slow flow, for an accurate and a poor case."""
    figure = new_figure(5.4)
    for k, (nu, a1) in enumerate(zip(data.attrs["nu"], data.attrs["a1"], strict=True)):
        axes = figure.add_subplot(2, 1, k + 1)
        axes.plot(data[f"time_{k}"], data[f"full_{k}"], color=BLUE, linewidth=1.1, label="full motion (1)")
        axes.plot(
            data[f"time_{k}"], data[f"slow_{k}"], color=BLACK, linewidth=2.0, linestyle="--", label="averaged (10)"
        )
        overturned = bool(np.isnan(data[f"full_{k}"]).any())
        fate = "averaged motion stable, the column overturns" if overturned else "averaging follows the mean"
        axes.set_title(rf"$a_1$ = {a1:g}, $\nu$ = {nu:g}: {fate}")
        axes.set_ylabel(r"tilt angle $\theta$ [rad]")
        axes.set_ylim(0.0, 2.2 * data.attrs["c"] if overturned else None)
        axes.legend(loc="upper right")
    axes.set_xlabel(r"time $\tau = \omega_0 t$")
    return figure


@styled
def modulated(data: xr.Dataset) -> Figure:
    """Draw the modulated rolling below ν*: tilt over a few periods, and the cycle in the rotating frame."""
    figure = new_figure(3.6)
    history, cycle = figure.add_subplot(1, 2, 1), figure.add_subplot(1, 2, 2)
    for k, nu in enumerate(data.attrs["nu"]):
        line: dict[str, Any] = {"color": PALETTE[k], "linestyle": DASHES[k], "label": rf"$\nu$ = {nu:g}"}
        tau, tilt, phase = (data[f"{name}_{k}"].to_numpy() for name in ("tau", "amplitude", "phase"))
        turns = np.concatenate([tau[:-1] + n * tau[-1] for n in range(3)])
        history.plot(turns, np.tile(tilt[:-1], 3), **line)
        cycle.plot(tilt * np.cos(phase), tilt * np.sin(phase), **line)
        psi = float(data[f"steady_phase_{k}"])
        cycle.plot(np.cos(psi), np.sin(psi), marker="+", color=PALETTE[k])
    history.axhline(1.0, color=GREY, linewidth=0.9, linestyle=_LIMIT)
    history.set_xlabel(r"time $\tau = \omega_0 t$")
    history.set_ylabel(r"tilt over that of steady rolling, $\theta/\theta_+$")
    history.set_ylim(bottom=0.3)
    history.legend(loc="lower center", ncols=3, columnspacing=1.0, handlelength=1.6)
    cycle.set_aspect("equal", adjustable="box")
    cycle.set_xlabel(r"$\theta\,\cos\psi/\theta_+$")
    cycle.set_ylabel(r"$\theta\,\sin\psi/\theta_+$")
    cycle.set_title("frame of the base; + steady, unstable")
    return figure


@styled
def runaway(data: xr.Dataset) -> Figure:
    """Draw the azimuth of free motions that start progressively closer to a plane, and one path."""
    figure = new_figure(3.8)
    azimuth, path = figure.add_subplot(1, 2, 1), figure.add_subplot(1, 2, 2)
    for k, offset in enumerate(data["offset"].to_numpy()):
        part = data.sel(offset=offset)
        name = f"{offset:g}" if offset else "0: in its plane"
        azimuth.plot(part["time"], part["azimuth"] / np.pi, color=PALETTE[k], linestyle=DASHES[k], label=name)
    c = data.attrs["c"]
    shown = data.isel(offset=0)
    path.plot(shown["tilt"].sel(axis="x") / c, shown["tilt"].sel(axis="y") / c, color=PALETTE[0], linewidth=0.9)
    path.add_patch(Circle((0.0, 0.0), 1.0, fill=False, color=GREY, linestyle=_LIMIT))
    azimuth.set_xlabel(r"time $\tau = \omega_0 t$")
    azimuth.set_ylabel(r"azimuth $\beta$ [half turns]")
    azimuth.set_ylim(-1.5, 13.5)
    azimuth.legend(title="sideways rate at the start, in $c$", loc="upper left", ncols=2)
    path.set_aspect("equal", adjustable="datalim")
    path.set_xlabel(r"tilt $\theta_x/c$")
    path.set_ylabel(r"tilt $\theta_y/c$")
    path.set_title(f"path with sideways rate {float(data['offset'][0]):g} $c$")
    return figure


@styled
def critical(data: xr.Dataset) -> Figure:
    """Draw the critical frequency against the amplitude of circular base motion."""
    figure = new_figure(4.0)
    axes = figure.subplots()
    for k, eta in enumerate(data["eta"].to_numpy()):
        line: dict[str, Any] = {"color": PALETTE[k], "linestyle": DASHES[k], "label": rf"$\eta$ = {eta:g}"}
        axes.plot(data["a0"], data["nu"].sel(eta=eta), **line)
    dots: dict[str, Any] = {"marker": "o", "linestyle": "none", "markersize": 3.5, "color": BLACK}
    axes.plot(data["a0"][::12], data["undamped"][::12], label=r"$\eta$ = 0, closed form", **dots)
    axes.set_xlabel("amplitude of the base acceleration $a_0/g$")
    axes.set_ylabel(r"critical frequency $\nu^*$")
    axes.set_xlim(0.0, float(data["a0"][-1]))
    axes.set_ylim(0.0, None)
    axes.annotate("rolling stable above its curve", (0.3, 0.9), xycoords="axes fraction", color=GREY)
    axes.annotate("unstable, or no rolling, below", (0.35, 0.42), xycoords="axes fraction", color=GREY)
    axes.legend(loc="lower right", ncols=2)
    return figure


@styled
def pressure(data: xr.Dataset) -> Figure:
    """Draw the path of the centre of pressure under a standing column."""
    figure = new_figure(4.2)
    axes = figure.subplots()
    axes.add_patch(Circle((0.0, 0.0), 1.0, fill=False, color=BLACK, linewidth=3.0, alpha=0.35, label="rim"))
    for k, motion in enumerate(data["motion"].to_numpy()):
        part = data["path"].sel(motion=motion)
        label = re.sub(r"\ba(\d)\b", r"$a_\1$", str(motion))
        axes.plot(part.sel(axis="x"), part.sel(axis="y"), color=PALETTE[k], linestyle=DASHES[k], label=label)
    axes.set_aspect("equal")
    axes.set_xlim(-1.15, 1.15)
    axes.set_ylim(-1.15, 1.15)
    axes.set_xlabel("$x/r$")
    axes.set_ylabel("$y/r$")
    axes.legend(loc="upper left", bbox_to_anchor=(1.02, 1.0))
    return figure


@styled
def kicks(data: xr.Dataset) -> Figure:
    """Draw the sideways kick of one passage against its offset from the vertical, with the exact slope."""
    figure = new_figure(3.4)
    axes = figure.subplots()
    offset, kick = data["offset"].to_numpy(), data["kick"].to_numpy()
    axes.semilogx(offset, -kick, "o", color=BLUE, label="integrated")
    middle = len(offset) // 2
    line = -kick[middle] - data.attrs["slope"] * np.log(offset / offset[middle])
    axes.semilogx(offset, line, color=BLACK, linewidth=1.0, label="exact slope $2c/v$")
    axes.set_xlabel("offset $y_0$ from the vertical at the passage [rad]")
    axes.set_ylabel(r"sideways kick $-\Delta\dot y/y_0$")
    axes.legend()
    return figure


def _draw_full_motion(axes: Axes, straight: xr.Dataset) -> None:
    width = 0.02
    for index, a1 in enumerate(straight["a1"].to_numpy()):
        part = straight.sel(a1=a1)
        x = part["nu"].to_numpy() + (index - 0.5) * width
        mean, low, high = (part[name].to_numpy() for name in ("mean", "least", "largest"))
        axes.errorbar(
            x, mean, yerr=[mean - low, high - mean], fmt="o", markersize=3.5, capsize=2, linewidth=0.9,
            color=_COLOURS[index],
        )  # fmt: skip
        fallen = np.isnan(mean)
        axes.plot(x[fallen], np.full(fallen.sum(), 0.165 - 0.005 * index), "x", color=_COLOURS[index], markersize=6)
    axes.errorbar([], [], yerr=[], fmt="o", markersize=3.5, capsize=2, color=BLACK, label="full motion: mean, range")
    axes.plot([], [], "x", color=BLACK, label="full motion: overturned")


def _name_amplitudes(axes: Axes, response: xr.Dataset, factor: float) -> None:
    name = "$a_0$" if factor == 1.0 else "$a_1$"
    for index, a0 in enumerate(response["a0"].to_numpy()):
        axes.plot([], [], color=_COLOURS[index], linewidth=STABLE_WIDTH, label=f"{name} = {factor * a0:g}, stable")
        axes.plot([], [], color=_COLOURS[index], linewidth=UNSTABLE_WIDTH, label=f"{name} = {factor * a0:g}, unstable")


def _number(axes: Axes, number: int, x: float, y: float, color: str = GREY) -> None:
    axes.annotate(
        str(number),
        (x, y),
        ha="center",
        va="center",
        fontsize=9,
        fontweight="bold",
        color=color,
        bbox={"boxstyle": "circle,pad=0.15", "facecolor": "white", "edgecolor": "none"},
    )


@styled
def twist(data: xr.Dataset) -> Figure:
    """Draw steady rolling with free spin: tilt and spin against frequency, for several values of the spin damping."""
    figure = new_figure(3.6)
    tilt, spin = figure.subplots(1, 2)
    for k, zeta in enumerate(data["zeta"].to_numpy()):
        part = data.sel(zeta=zeta)
        stable = part["stable"]
        name = "no spin" if np.isinf(zeta) else rf"$\zeta$ = {zeta:g}"
        draw_branch(tilt, data["nu"], part["amplitude"], stable, color=PALETTE[k])
        draw_branch(spin, data["nu"], part["spin"], stable, color=PALETTE[k])
        tilt.plot([], [], color=PALETTE[k], linewidth=STABLE_WIDTH, label=name)
    tilt.set_ylabel(r"tilt angle $\theta$ [rad]")
    spin.set_ylabel(r"spin $\sigma/\omega_0$")
    for axes in (tilt, spin):
        axes.set_xlabel(r"frequency ratio $\nu = \Omega/\omega_0$")
        axes.set_xlim(float(data["nu"][0]), float(data["nu"][-1]))
    tilt.set_ylim(0.0, None)
    tilt.legend(title="bold: stable", ncols=1)
    return figure


@styled
def twist_boundary(data: xr.Dataset) -> Figure:
    """Draw the critical frequency against amplitude, damping and spin damping, and the upper frequency."""
    figure = new_figure(6.2)
    (amplitude, spin_damping), (damping, upper) = figure.subplots(2, 2)
    at, damped = f"$a_0$ = {data.attrs['a0']:g}", rf"$\eta$ = {data.attrs['eta']:g}"
    curves = {float(zeta): "no spin" if np.isinf(zeta) else rf"$\zeta$ = {zeta:g}" for zeta in data["zeta"].to_numpy()}
    _draw(amplitude, data["by_amplitude"], "zeta", curves)
    _draw(damping, data["by_damping"], "zeta", curves)
    _draw(spin_damping, data["by_spin_damping"], "axial_ratio", _shapes(data["axial_ratio"]))
    _draw(upper, data["upper"].where(np.isfinite(data["upper"])), "slim", _shapes(data["slim"]))
    _finish(amplitude, "amplitude of the base acceleration $a_0/g$", f"solid cylinder, {damped}", ncols=2)
    _finish(spin_damping, r"spin damping $\zeta$", f"{at}, {damped}")
    _finish(damping, r"damping $\eta$", f"solid cylinder, {at}")
    _finish(upper, r"spin damping $\zeta$", f"stability lost again: {at}, {damped}")
    spin_damping.axhline(data.attrs["without"], color=GREY, linewidth=0.9)
    for axes in (spin_damping, damping, upper):
        axes.set_xscale("log")
    least, limit = float(data["eta"][0]), data.attrs["weak_limit"]
    damping.plot(least, limit, "o", color=BLACK, clip_on=False)
    damping.annotate(r"$\sqrt{1 + 2a_0/c}$", (least, limit), (0.0, 7.0), textcoords="offset points", fontsize="small")
    damping.set_ylim(0.0, 1.2 * limit)
    amplitude.set_xlim(0.0, float(data["a0"][-1]))
    for k, highest in enumerate(data["upper_limit"].to_numpy()):
        upper.plot(data["least_spin_damping"][0], highest, "o", color=PALETTE[k], clip_on=False)
    upper.set_ylabel(r"upper frequency $\nu^{**}$")
    upper.set_ylim(0.0, 2.0 * float(data["upper_limit"][-1]))
    return figure


def _draw(axes: Axes, curves: xr.DataArray, over: str, labels: dict[float, str]) -> None:
    """Draw a curve for each value along the dimension `over`."""
    (along,) = (name for name in curves.dims if name != over)
    for k, (value, label) in enumerate(labels.items()):
        axes.plot(curves[along], curves.sel({over: value}), color=PALETTE[k], linestyle=DASHES[k], label=label)


def _shapes(ratios: xr.DataArray) -> dict[float, str]:
    return {float(ratio): f"$i_a$ = {ratio:g}" for ratio in ratios.to_numpy()}


def _finish(axes: Axes, label: str, title: str, ncols: int = 1) -> None:
    axes.set_xlabel(label)
    axes.set_ylabel(r"critical frequency $\nu^*$")
    axes.set_ylim(0.0, None)
    axes.set_title(title)
    axes.legend(ncols=ncols)
