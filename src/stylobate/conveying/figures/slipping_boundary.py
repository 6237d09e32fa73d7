"""Figure of steady rolling with and without slip: tilt over frequency, and regions of stability."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stylobate.errors import Outcome
from stylobate.plots.cells import KIND_LOOKS, OUTCOME_LOOKS, UNFINISHED, class_legend, classes_of, draw_cells
from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import axis_label
from stylobate.plots.style import (
    BLACK,
    BLUE,
    GREEN,
    PURPLE,
    STABLE_WIDTH,
    UNSTABLE_WIDTH,
    VERMILION,
    new_figure,
    styled,
)

_HEIGHT, _WIDTH = 7.0, 8.4
# Markers repeat the information of colours.
_MARKED = ((BLUE, "o"), (VERMILION, "s"), (GREEN, "^"), (PURPLE, "D"))
_DASHED = (0, (4, 2))
# No steady rolling, none stable, stable without slip, stable with slip, both stable.
_LOOKS = (
    UNFINISHED,
    OUTCOME_LOOKS[Outcome.STILL_MOVING],
    OUTCOME_LOOKS[Outcome.ROLLING],
    KIND_LOOKS["rolling clockwise"],
    OUTCOME_LOOKS[Outcome.MODULATED],
)


@figure_of("slipping boundary")
@styled
def plot_slipping_boundary(found: xr.Dataset, *, friction_coefficient: Sequence[float] | None = None) -> Figure:
    """Draw steady rolling with slip: tilt over frequency above, regions of stability below.

    Above: rolling without slip in black, rolling with slip in colours for a few friction coefficients. Stable parts are
    bold, unstable ones thin and dashed. A marker on the black line shows the limit of each coefficient.
    Below: regions of stability over frequency and friction coefficient, with the required friction of stable rolling
    without slip. Markers at the right show the coefficients of the curves above.

    Parameters
    ----------
    found
        Of the kind "slipping boundary".
    friction_coefficient
        Up to four friction coefficients for the curves; the nearest of `found` are drawn. By default four are chosen.
    """
    figure = new_figure(_HEIGHT, width=_WIDTH)
    tilt, plane = figure.subplots(2, 1, sharex=True)
    chosen = _nearest(found, friction_coefficient)
    _draw_held(tilt, found)
    for place, (colour, marker) in zip(chosen, _MARKED, strict=False):
        part = found.isel(friction_coefficient=place)
        friction = float(part["friction_coefficient"])
        _draw_slipping(tilt, part, colour)
        _mark_ends(tilt, part, colour, marker)
        slips = "" if part["slipping_amplitude"].isnull().all() else "slipping, "
        name = rf"{slips}$\mu$ = {friction:.3g}"
        tilt.plot([], [], color=colour, marker=marker, linewidth=STABLE_WIDTH, label=name)
        plane.plot(
            1.0, friction, color=colour, marker=marker, markersize=6, clip_on=False,
            transform=plane.get_yaxis_transform(), zorder=6,
        )  # fmt: skip
    tilt.plot([], [], color=BLACK, linewidth=UNSTABLE_WIDTH, linestyle=_DASHED, label="thin, dashed: unstable")
    tilt.set_ylabel(r"tilt $\theta$ [rad]")
    tilt.set_ylim(bottom=0.0)
    codes, classes = found["steady_rolling"].to_numpy(), classes_of(found["class_name"].to_numpy(), _LOOKS)
    draw_cells(plane, found["angular_frequency"], found["friction_coefficient"], codes, classes)
    _draw_required(plane, found)
    plane.set_ylabel(axis_label(found["friction_coefficient"]))
    plane.set_xlabel(axis_label(found["angular_frequency"]))
    lines = tilt.get_legend_handles_labels()[0]
    handles = [*class_legend(codes, classes), *plane.get_legend_handles_labels()[0]]
    if figure.get_figwidth() < _WIDTH:
        figure.legend(handles=[*lines, *handles], loc="outside lower left", ncols=2)
    else:
        tilt.legend(loc="center left", bbox_to_anchor=(1.02, 0.5))
        plane.legend(handles=handles, loc="center left", bbox_to_anchor=(1.04, 0.5))
    return figure


def _nearest(found: xr.Dataset, wanted: Sequence[float] | None) -> list[int]:
    """Return the indices of the frictions nearest to the requested ones, or of some spread over all."""
    values, most = found["friction_coefficient"].to_numpy(), len(_MARKED)
    if wanted is not None:
        return [int(np.abs(values - one).argmin()) for one in wanted][:most]
    if values.size <= most:
        return list(range(values.size))
    return [round((values.size - 1) * (place + 1) / (most + 1)) for place in range(most)]


def _draw_held(axes: Axes, found: xr.Dataset) -> None:
    x = found["angular_frequency"].to_numpy()
    for index in range(found.sizes["branch"]):
        branch = found.isel(branch=index)
        _draw(axes, x, branch["rolling_amplitude"].to_numpy(), branch["rolling_stable"].to_numpy(), BLACK)
    axes.plot([], [], color=BLACK, linewidth=STABLE_WIDTH, label="without slip")


def _draw_slipping(axes: Axes, part: xr.Dataset, colour: str) -> None:
    x, tilt, stable = (part[name].to_numpy() for name in ("angular_frequency", "slipping_amplitude", "slipping_stable"))
    count = np.isfinite(tilt).sum(axis=-1)
    # Branches are numbered from the lowest: when their count changes, a number may mean another branch.
    for first, last in _stretches(count):
        for index in range(int(count[first])):
            some = slice(first, last)
            _draw(axes, x[some], tilt[some, index], stable[some, index], colour)


def _stretches(count: npt.NDArray[np.integer]) -> list[tuple[int, int]]:
    edges = [0, *(np.flatnonzero(np.diff(count)) + 1).tolist(), count.size]
    return list(pairwise(edges))


def _draw(axes: Axes, x: np.ndarray, y: np.ndarray, stable: np.ndarray, colour: str) -> None:
    bold = stable.astype(bool)  # a file stores numbers
    axes.plot(x, np.where(bold, np.nan, y), color=colour, linewidth=UNSTABLE_WIDTH, linestyle=_DASHED)
    axes.plot(x, np.where(bold, y, np.nan), color=colour, linewidth=STABLE_WIDTH)


def _mark_ends(axes: Axes, part: xr.Dataset, colour: str, marker: str) -> None:
    """Mark the limits that friction sets to stable rolling without slip, inside the range stable for any friction."""
    x, stable = part["angular_frequency"].to_numpy(), part["rolling_stable"].to_numpy().astype(bool)
    slips = part["slips"].to_numpy().astype(bool)
    for index in range(part.sizes["branch"]):
        change = np.diff(slips[:, index].astype(int)) != 0
        inner = change & stable[1:, index] & stable[:-1, index]
        for place in np.flatnonzero(inner):
            needed = part["required_friction"].to_numpy()[place : place + 2, index]
            share = (float(part["friction_coefficient"]) - needed[0]) / (needed[1] - needed[0])
            tilt = part["rolling_amplitude"].to_numpy()[place : place + 2, index]
            at = x[place] + share * (x[place + 1] - x[place])
            axes.plot(at, tilt[0] + share * (tilt[1] - tilt[0]), marker=marker, color=colour, zorder=5)


def _draw_required(axes: Axes, found: xr.Dataset) -> None:
    x, low, high = found["angular_frequency"].to_numpy(), *axes.get_ylim()
    needed = np.where(found["rolling_stable"].to_numpy().astype(bool), found["required_friction"].to_numpy(), np.inf)
    least = needed.min(axis=-1)
    axes.plot(x, np.where((least >= low) & (least <= high), least, np.nan), color=BLACK, linewidth=1.4,
              label="needed without slip")  # fmt: skip
