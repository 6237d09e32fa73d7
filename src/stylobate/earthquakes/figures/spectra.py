"""Figures of records and of rocking spectra."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from stylobate.base_motions import Record
from stylobate.base_motions.record import AXES
from stylobate.errors import Outcome, ParameterError
from stylobate.plots.base_motion import COMPONENT_LOOKS, draw_spectra
from stylobate.plots.cells import set_scale
from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import axis_label, literal
from stylobate.plots.result_figure import WIDTH
from stylobate.plots.style import BLACK, DASHES, GREY, PALETTE, new_figure, styled

_HEIGHT_OF_RECORD = 2.1


@styled
def plot_records(records: Sequence[Record], spectra: Mapping[str, xr.Dataset]) -> Figure:
    """Draw each record in a row: accelerations over time on the left, response spectra on the right.

    Parameters
    ----------
    records
        Records with nonzero acceleration.
    spectra
        Spectra from `response_spectra`, by name of the record.
    """
    figure = new_figure(_HEIGHT_OF_RECORD * len(records) + 0.4, width=1.3 * WIDTH)
    grid = figure.subplots(len(records), 2, squeeze=False, width_ratios=(2, 1))
    for (left, right), record in zip(grid, records, strict=True):
        _history(left, record)
        draw_spectra(right, spectra[record.name])
    grid[-1][0].set_xlabel("time [s]")
    grid[-1][1].set_xlabel("period [s]")
    return figure


def _history(axes: Axes, record: Record) -> None:
    for axis in record.axes:
        place = AXES.index(axis)  # the vertical component lies behind
        look: dict[str, Any] = {"linewidth": 0.6, "zorder": 3.0 - place, "label": axis} | COMPONENT_LOOKS[place]
        axes.plot(record.times, record.samples[:, place], **look)
    axes.set_title(literal(record.name))
    axes.set_ylabel("acceleration [m/s²]")
    axes.legend(loc="upper right", ncols=3)


Floats = npt.NDArray[np.float64]

_PLANE = 2
# Maximum number of names of motions with horizontal text; more are vertical.
_SHORT = 3


class Horizontal(NamedTuple):
    """Values along the horizontal axis, their label, and names in place of numbers, if any."""

    values: Floats
    label: str
    names: tuple[str, ...] = ()


def split(found: xr.Dataset, dims: list[str], most: int, what: str) -> tuple[str | None, str | None]:
    """Return the dimension along the axis (the longest) and the dimension of the panels or curves.

    Raises
    ------
    ParameterError
        If there are more than two dimensions, or more than `most` values along the second.
    """
    ordered = sorted(dims, key=lambda dim: -found.sizes[dim])
    if len(ordered) > _PLANE or (len(ordered) == _PLANE and found.sizes[ordered[1]] > most):
        raise ParameterError(
            f"a figure of {what} has one dimension, or two with up to {most} values along one of them; got "
            f"{ {dim: found.sizes[dim] for dim in dims} }: choose some by found.sel(...) or found.isel(...)"
        )
    return (ordered[0] if ordered else None), (ordered[1] if len(ordered) == _PLANE else None)


def named(found: xr.Dataset, dim: str, place: int) -> str:
    """Return the name of one value along a dimension, such as "slenderness 0.1"."""
    if dim == "motion":
        return str(found["motion_name"][place].item())
    return f"{axis_label(found[dim]).partition(' [')[0]} {found[dim][place].item():.4g}"


def motion_names(found: xr.Dataset) -> Horizontal:
    """Return the positions of several motions with their names."""
    names = tuple(str(name) for name in found["motion_name"].to_numpy())
    return Horizontal(np.arange(float(len(names))), "base motion", names)


def finish(axes: Axes, along: Horizontal) -> None:
    """Set scale, ticks and label of the horizontal axis."""
    if along.names:
        rotation = 0 if len(along.names) <= _SHORT else 90
        axes.set_xticks(along.values, along.names, rotation=rotation)
    else:
        set_scale(axes, "x", along.values)
    axes.set_xlabel(along.label)


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
