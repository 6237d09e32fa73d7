"""Figures of rocking spectra: peak tilt and peak tilt rate over the period 2π/p."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from stylobate.earthquakes.figures.spectrum_axes import Horizontal, finish, motion_names, named, split
from stylobate.errors import Outcome
from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import axis_label
from stylobate.plots.style import BLACK, DASHES, GREY, PALETTE, new_figure, styled

_HEIGHT, _MOST_CURVES = 5.4, 6
# Height of the axis over the largest peak, with room for the marks of overturned runs.
_ROOM = 1.25
_MARKS = ("o", "s", "^", "D", "v", "P")
_FALLEN: dict[str, Any] = {"marker": 7, "linestyle": "none", "markersize": 6, "clip_on": False, "zorder": 4}
_UNCERTAIN: dict[str, Any] = {"marker": "o", "mfc": "none", "mec": BLACK, "linestyle": "none", "markersize": 8}
_OVERTURNED = Outcome.OVERTURNED


@figure_of("rocking spectrum")
@styled
def plot_rocking_spectrum(found: xr.Dataset) -> Figure:
    """Draw peak tilt over α_c and peak tilt rate over p, with one curve for each value of a second parameter.

    The horizontal axis is the period 2π/p if the size varies. Curves break where the column overturned; a mark at the
    upper edge shows these runs. Circles are uncertain runs.

    Raises
    ------
    ParameterError
        If the spectrum has more than two parameters or more than six curves: choose some by `found.sel`.
    """
    dims = [str(dim) for dim in found["peak_tilt_ratio"].dims]
    first = "size" if "size" in dims else None
    along, other = split(found, dims, _MOST_CURVES, "a rocking spectrum")
    if first is not None and first == other:
        along, other = other, along
    assert along is not None
    count = 1 if other is None else found.sizes[other]
    figure = new_figure(_HEIGHT)
    above, below = figure.subplots(2, 1, sharex=True)
    handles = []
    curves = [found if other is None else found.isel({other: place}) for place in range(count)]
    horizontals = [_horizontal(one, along) for one in curves]
    for axes, name in ((above, "peak_tilt_ratio"), (below, "peak_rate_ratio")):
        for place, (one, across) in enumerate(zip(curves, horizontals, strict=True)):
            _draw(axes, one, across, name, place, count)
        largest = float(found[name].max())
        axes.set_ylim(0.0, _ROOM * largest if largest > 0.0 else 1.0)
        axes.set_ylabel(axis_label(found[name]))
    if other is not None:
        handles = [_curve_mark(place, named(found, other, place)) for place in range(count)]
    if bool((found["outcome"] == _OVERTURNED).any()):
        handles.append(Line2D([], [], color=GREY, label="overturned", **_FALLEN))
    if bool(found["uncertain"].any()):
        handles.append(Line2D([], [], label="uncertain", **_UNCERTAIN))
    finish(below, horizontals[0])
    if handles:
        figure.legend(handles=handles, loc="outside right upper")
    return figure


def _curve_mark(place: int, label: str) -> Line2D:
    dash: Any = DASHES[place]
    return Line2D([], [], color=PALETTE[place], linestyle=dash, marker=_MARKS[place], markersize=3.5, label=label)


def _horizontal(one: xr.Dataset, along: str) -> Horizontal:
    if along == "motion":
        return motion_names(one)
    if along == "size":
        return Horizontal(one["rocking_period"].to_numpy(), axis_label(one["rocking_period"]))
    if "frequency_ratio" in one.coords and along == "angular_frequency":
        return Horizontal(one["frequency_ratio"].to_numpy(), "ω / p")
    return Horizontal(one[along].to_numpy(), axis_label(one[along]))


def _draw(axes: Axes, one: xr.Dataset, across: Horizontal, name: str, place: int, count: int) -> None:
    order = np.argsort(across.values)
    x, y = across.values[order], one[name].to_numpy()[order]
    dash: Any = DASHES[place] if not across.names else "none"
    axes.plot(x, y, color=PALETTE[place], linestyle=dash, marker=_MARKS[place], markersize=3.0, linewidth=1.4)
    unsure = one["uncertain"].to_numpy()[order]
    axes.plot(x[unsure], y[unsure], **_UNCERTAIN)
    fallen = one["outcome"].to_numpy()[order] == _OVERTURNED
    # Marks of several curves lie one below another.
    height = 1.0 - 0.035 * place if count > 1 else 1.0
    transform = axes.get_xaxis_transform()
    axes.plot(x[fallen], np.full(int(fallen.sum()), height), color=PALETTE[place], transform=transform, **_FALLEN)
