"""Figures of a column with free spin: steady rolling, and its frequency limits of stability."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stylobate.plots.responses import draw_branch
from stylobate.plots.style import BLACK, DASHES, GREY, PALETTE, STABLE_WIDTH, new_figure, styled


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
