"""Convergence of the estimates of Lyapunov exponents."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import axis_label, unit_label
from stylobate.plots.style import DASHES, GREY, PALETTE, new_figure, styled

_HEIGHT = 3.8
_LARGEST_PLACE = 9


@figure_of("Lyapunov exponents")
@styled
def plot_lyapunov(found: xr.Dataset) -> Figure:
    """Draw Lyapunov exponents against the periods over which they were computed, with their errors."""
    figure = new_figure(_HEIGHT)
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
