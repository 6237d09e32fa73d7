"""Basin fractions along a parameter: stacked bands that fill the unit height."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from stylobate.plots.cells import Floats, cell_edges, fill_options, is_geometric, set_scale
from stylobate.plots.classes import Look, MapClass, attractor_classes
from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import axis_label
from stylobate.plots.style import BLACK, new_figure, styled
from stylobate.text import plural

_HEIGHT = 4.2
# Height of a line of the legend [inches]; number of lines besides those of the bands: two for intervals, and edges.
_ENTRY = 0.19
# Bands thinner than this fraction of the height have no error bar: the bar would look like a line.
_SEEN = 0.005
# If there are more bands than this, bands of one kind that stay narrower than this fraction are drawn as one.
_MOST, _NARROW = 10, 0.06
# Margin beside the first and last value, in widths of the bands.
_ROOM = 0.015


@figure_of("basin fractions")
@styled
def plot_fractions(found: xr.Dataset) -> Figure:
    """Return a figure of basin fractions along a parameter, stacked.

    A single value has one stacked bar. The line on the upper edge of a band is the interval of the height of this
    band. Runs that have not settled are the topmost band; values not computed stay white. If there are many
    attractors, narrow bands of one kind are drawn as one, labelled with their number.
    """
    (name,) = found["computed"].dims
    ordered = found.sortby(str(name)).isel({str(name): found.sortby(str(name))["computed"].to_numpy() > 0})
    x, classes = ordered[str(name)].to_numpy(), attractor_classes(found)[:-1]
    fraction, low, high = (
        ordered[key].transpose(name, "attractor_index").to_numpy()
        for key in ("fraction", "fraction_low", "fraction_high")
    )
    bands = _bands(fraction, [str(kind) for kind in found["attractor_kind"].to_numpy()], classes)
    figure = new_figure(max(_HEIGHT, _ENTRY * (len(bands) + 3)))
    axes = figure.subplots()
    legend: list[Patch | Line2D] = []
    bottom, errors = np.zeros(x.size), []
    for label, look, places in bands:
        top = bottom + fraction[:, places].sum(axis=1)
        _draw_band(axes, x, bottom, top, look)
        legend.append(Patch(label=label, **fill_options(look)))
        if len(places) == 1:
            errors.append((places[0], top))
        bottom = top
    for place, top in errors:
        shown = (fraction[:, place] > _SEEN) & (top < 1.0 - _SEEN)
        below, above = fraction[shown, place] - low[shown, place], high[shown, place] - fraction[shown, place]
        spread = np.maximum([below, above], 0.0)
        for colour, width in (("white", 2.6), (BLACK, 1.0)):
            axes.errorbar(x[shown], top[shown], yerr=spread, ecolor=colour, elinewidth=width, **_BAR)
    confidence = 100.0 * float(found.attrs["confidence"])
    legend.append(Line2D([], [], color=BLACK, marker="|", markersize=9, linestyle="none", label=_interval(confidence)))
    set_scale(axes, "x", x)
    axes.set(xlim=_limits(x), ylim=(0.0, 1.0))
    if x.size == 1:
        axes.set_xticks(x)
    axes.set_ylabel(f"fraction of {plural(int(found.attrs['starts']), 'start')}")
    axes.grid(visible=False)
    axes.set_xlabel(axis_label(found[str(name)]))
    figure.legend(handles=legend[::-1], loc="outside right upper")
    return figure


def _bands(fraction: Floats, kinds: list[str], classes: Sequence[MapClass]) -> list[tuple[str, Look, list[int]]]:
    """Return name, look and attractors of each band, from below; of many bands, narrow ones of a kind are joined."""
    present = [place for place in range(len(classes)) if fraction[:, place].any()]
    narrow = [place for place in present if fraction[:, place].max() < _NARROW] if len(present) > _MOST else []
    alike = {kind: [place for place in narrow if kinds[place] == kind] for kind in kinds}
    bands: list[tuple[str, Look, list[int]]] = []
    for place in present:
        together = alike[kinds[place]]
        if place not in together or len(together) == 1:
            bands.append((classes[place].name, classes[place].look, [place]))
        elif place == together[0]:
            alone = not any(kinds[one] == kinds[place] for one in set(present) - set(together))
            look = replace(classes[place].look, texture="" if alone else "....", ink="#333333")
            bands.append((f"{kinds[place]}, {len(together)}{'' if alone else ' others'}", look, together))
    return bands


def _draw_band(axes: Axes, x: Floats, low: Floats, high: Floats, look: Look) -> None:
    if x.size == 1:
        axes.bar(x, high - low, width=np.diff(cell_edges(x)), bottom=low, **fill_options(look))
    else:
        axes.fill_between(x, low, high, **fill_options(look))


def _limits(x: Floats) -> tuple[float, float] | None:
    """Return the limits of the axis, with margins for the intervals of the first and last values."""
    if not x.size:
        return None
    geometric, edges = is_geometric(x), cell_edges(x) if x.size == 1 else x[[0, -1]]
    low, high = np.log(edges) if geometric else edges
    ends = np.array([low, high]) + _ROOM * (high - low) * np.array([-1.0, 1.0])
    first, last = np.exp(ends) if geometric else ends
    return float(first), float(last)


_BAR: dict[str, Any] = {"fmt": "none", "capsize": 0.0, "zorder": 3}


def _interval(confidence: float) -> str:
    return f"{confidence:g} % interval\nof the band below"
