"""Uncertainty exponent: share of uncertain initial conditions against their perturbation."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import axis_label
from stylobate.plots.style import BLUE, GREY, VERMILION, new_figure, styled

_HEIGHT = 3.8
# If the share of dropped starts is larger, the figure states it.
_MANY_DROPPED = 0.1
# Factor by which the axis extends below the lowest mark, for the arrow there.
_ROOM = 2.5


@figure_of("uncertainty exponent")
@styled
def plot_exponent(found: xr.Dataset) -> Figure:
    """Draw the share of uncertain initial conditions against the shift ε, on logarithmic axes, with the fit.

    Hollow circles are too near saturation for the fit. An arrow points down from the upper end of the interval if no
    initial condition was uncertain. If more than a tenth of the runs are dropped as undecided, the title states it.
    """
    figure = new_figure(_HEIGHT, width=5.4)
    axes = figure.subplots()
    epsilon, fraction = found["epsilon"].to_numpy(), found["fraction"].to_numpy()
    low, high = found["fraction_low"].to_numpy(), found["fraction_high"].to_numpy()
    counted, fitted = fraction > 0.0, found["fitted"].to_numpy()
    for part, fill, name in (
        (counted & fitted, BLUE, f"counted, {100.0 * float(found.attrs['confidence']):g} % interval"),
        (counted & ~fitted, "white", "near saturation, not fitted"),
    ):
        if part.any():
            spread = np.maximum([fraction[part] - low[part], high[part] - fraction[part]], 0.0)
            axes.errorbar(
                epsilon[part], fraction[part], yerr=spread, fmt="o", color=BLUE, mfc=fill, capsize=2.5, label=name
            )
    none = (fraction == 0.0) & (found["pairs"].to_numpy() > 0)
    if none.any():
        axes.plot(epsilon[none], high[none], linestyle="none", marker="v", color=GREY, label="none found: upper bound")
    if np.isfinite(float(found["uncertainty_exponent"])):
        axes.plot(
            epsilon,
            found["fit"].where(found["fit"] <= 1.0),
            color=VERMILION,
            linestyle="--",
            label=r"fit $\varepsilon^{\upsilon}$",
        )
    axes.set(xscale="log", yscale="log", ylabel="fraction of uncertain initial conditions")
    axes.set_xlabel(f"shift ε of {axis_label(found['epsilon'])}")
    axes.set_ylim(_lowest(found) / _ROOM, 1.3)
    axes.set_title(_title(found))
    axes.legend()
    return figure


def _title(found: xr.Dataset) -> str:
    return "\n".join([_law(found), *_dropped(found)])


def _law(found: xr.Dataset) -> str:
    exponent, error = float(found["uncertainty_exponent"]), float(found["standard_error"])
    if not np.isfinite(exponent):
        return "too few uncertain starts for an exponent"
    dimension = float(found["boundary_dimension"])
    return rf"$\upsilon$ = {exponent:.3f} ± {error:.3f}, dimension of the boundary {dimension:.3f}"


def _dropped(found: xr.Dataset) -> list[str]:
    dropped = int(found["dropped"].sum())
    total = dropped + int(found["pairs"].sum())
    if dropped <= _MANY_DROPPED * total:
        return []
    return [f"dropped: {100.0 * dropped / total:.0f} % of {total} starts, undecided at the end of their runs"]


def _lowest(found: xr.Dataset) -> float:
    """Return the lowest fraction that is marked."""
    marks = np.concatenate([found[name].to_numpy() for name in ("fraction", "fraction_low")])
    marks = np.append(marks, found["fraction_high"].where(found["fraction"] == 0.0))
    return float(np.min(marks, where=marks > 0.0, initial=1.0))
