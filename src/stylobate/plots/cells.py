"""Maps of classes: filled and textured cells, with their legend."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Literal

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap, to_rgb
from matplotlib.font_manager import FontProperties
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path
from matplotlib.ticker import FormatStrFormatter, LogLocator, MaxNLocator, NullFormatter

from stylobate.plots.classes import Look, MapClass
from stylobate.plots.style import AS_DRAWN

Floats = npt.NDArray[np.float64]
Integers = npt.NDArray[np.integer]

_TICKS = 7
_FRAME = "#555555"
# Relative tolerance: values with equal ratios but unequal differences are spaced geometrically.
_EQUAL = 1e-6
_LEAST_FOR_SPACING = 3
# Fine maps have this many cells or more each way. There, a cell has a texture only if its class fills this fraction
# of the cells within so many to each side: elsewhere the texture would look like noise. A class has no texture if
# less than the last fraction of its cells qualifies.
_FINE, _FILLED, _ABOUT, _LEAST = 60, 0.97, 4, 0.5
# Names within areas: part of the panel that legend and labels leave, points per inch, width of a character of the font
# size, room about a name [of its half width and height], and the brightness below which it is white.
_PANEL, _POINTS, _CHARACTER, _ROOM, _DARK = 0.85, 72.0, 0.55, 1.2, 0.45


def cell_edges(values: npt.ArrayLike) -> Floats:
    """Return the edges of the cells about increasing `values`: midway between neighbours, the outer ones mirrored.

    Geometrically spaced values have edges midway in the logarithm.
    """
    centres = np.asarray(values, dtype=float)
    if centres.size == 1:
        half = 0.5 * abs(float(centres[0])) or 0.5
        return np.array([centres[0] - half, centres[0] + half])
    if is_geometric(centres):
        return np.asarray(np.exp(cell_edges(np.log(centres))))
    middles = (centres[1:] + centres[:-1]) / 2.0
    return np.concatenate([[2.0 * centres[0] - middles[0]], middles, [2.0 * centres[-1] - middles[-1]]])


def is_geometric(values: npt.ArrayLike) -> bool:
    """Return whether `values` are spaced geometrically."""
    centres = np.asarray(values, dtype=float)
    if centres.size < _LEAST_FOR_SPACING or np.any(centres <= 0.0):
        return False
    steps, ratios = np.diff(centres), np.diff(np.log(centres))
    return bool(np.ptp(ratios) <= _EQUAL * abs(ratios.mean()) and np.ptp(steps) > _EQUAL * abs(steps.mean()))


def draw_cells(axes: Axes, x: npt.ArrayLike, y: npt.ArrayLike, codes: Integers, classes: Sequence[MapClass]) -> None:
    """Fill the cells about increasing `x` and `y` with the looks of their classes.

    Parameters
    ----------
    codes
        Shape (y, x).
    classes
        The classes of the codes; cells with other codes stay white.
    """
    x_edges, y_edges = cell_edges(x), cell_edges(y)
    places = np.full(codes.shape, -1)
    for place, one in enumerate(classes):
        places[codes == one.code] = place
    colours = ListedColormap([one.look.colour for one in classes])
    shown = np.ma.masked_less(places, 0)
    axes.pcolormesh(x_edges, y_edges, shown, cmap=colours, vmin=-0.5, vmax=len(classes) - 0.5, rasterized=True)
    for place, one in enumerate(classes):
        inside = _coherent(places == place) if one.look.texture else np.zeros((1, 1), dtype=bool)
        if np.any(inside):
            axes.add_patch(_texture(_outline(x_edges, y_edges, inside), one.look))
    _name_areas(axes, x_edges, y_edges, places, classes)
    set_scale(axes, "x", x)
    set_scale(axes, "y", y)
    axes.set_xlim(x_edges[0], x_edges[-1])
    axes.set_ylim(y_edges[0], y_edges[-1])
    axes.grid(visible=False)


def _name_areas(axes: Axes, x_edges: Floats, y_edges: Floats, places: Integers, classes: Sequence[MapClass]) -> None:
    """Write the name of each class into its widest area, where the area has room for it."""
    from scipy.ndimage import distance_transform_edt

    rows, columns = places.shape
    figure = axes.get_figure(root=True)
    assert figure is not None
    extent = axes.get_position()
    width, height = (
        _PANEL * _POINTS * part * side
        for part, side in zip((extent.width, extent.height), figure.get_size_inches(), strict=True)
    )
    size = float(FontProperties(size="small").get_size_in_points())
    for place, one in enumerate(classes):
        inside = np.pad(places == place, 1)  # the frame bounds an area too
        # Cells to each side of the middle that the name covers.
        across = int(np.ceil(0.5 * _CHARACTER * size * (len(one.name) + 2) * columns / width))
        along = int(np.ceil(0.9 * size * rows / height))
        room = distance_transform_edt(inside, sampling=(1.0 / along, 1.0 / across))
        row, column = np.unravel_index(int(np.argmax(room)), room.shape)
        if room[row, column] < _ROOM:
            continue
        middle = x_edges[column - 1 : column + 1].mean(), y_edges[row - 1 : row + 1].mean()
        axes.annotate(
            one.name, middle, ha="center", va="center", fontsize="small", color=ink_on(one.look.colour), gid=AS_DRAWN
        )


def ink_on(colour: Any) -> str:
    """Return the colour of text on a ground of this colour: white on dark, nearly black on light."""
    red, green, blue = to_rgb(colour)
    return "#ffffff" if 0.3 * red + 0.6 * green + 0.1 * blue < _DARK else "#222222"


def set_scale(axes: Axes, name: Literal["x", "y"], values: npt.ArrayLike) -> None:
    """Make an axis logarithmic if its `values` are spaced geometrically, with few plain numbers as ticks."""
    axis = axes.xaxis if name == "x" else axes.yaxis
    if is_geometric(values):
        axes.set(**{f"{name}scale": "log"})
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.set_major_formatter(FormatStrFormatter("%g"))
        axis.set_minor_formatter(NullFormatter())
    else:
        axis.set_major_locator(MaxNLocator(nbins=_TICKS, steps=[1, 2, 2.5, 5, 10]))


def _coherent(inside: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
    """Return the cells of a class surrounded by cells of the same class; on a coarse map, all of its cells."""
    if min(inside.shape) < _FINE:
        return inside
    window = 2 * _ABOUT + 1
    padded = np.pad(inside.astype(float), _ABOUT, mode="edge")
    filled = np.lib.stride_tricks.sliding_window_view(padded, (window, window)).mean(axis=(2, 3)) >= _FILLED
    around = np.lib.stride_tricks.sliding_window_view(np.pad(filled, _ABOUT), (window, window)).any(axis=(2, 3))
    found = np.logical_and(inside, around)
    return np.asarray(found if np.sum(found) >= _LEAST * np.sum(inside) else np.zeros_like(inside))


def _texture(outline: Path, look: Look) -> PathPatch:
    # The edge has no width; its colour sets the colour of the hatch.
    return PathPatch(outline, facecolor="none", edgecolor=look.ink, hatch=look.texture, linewidth=0.0)


def _outline(x_edges: Floats, y_edges: Floats, inside: npt.NDArray[np.bool_]) -> Path:
    """Return the cells `inside` as one path: a rectangle for each unbroken row of cells along x."""
    padded = np.pad(inside, ((0, 0), (1, 1))).astype(np.int8)
    changes = np.diff(padded, axis=1)
    rows, starts = np.nonzero(changes == 1)
    ends = np.nonzero(changes == -1)[1]
    left, right, low, high = x_edges[starts], x_edges[ends], y_edges[rows], y_edges[rows + 1]
    corners = np.stack([[left, low], [right, low], [right, high], [left, high], [left, low]])
    vertices = np.moveaxis(corners, 2, 0).reshape(-1, 2)
    codes = np.tile([Path.MOVETO, Path.LINETO, Path.LINETO, Path.LINETO, Path.CLOSEPOLY], rows.size)
    return Path(vertices, codes)


def fill_options(look: Look) -> dict[str, Any]:
    """Return Matplotlib options that give patches and bars a `look`."""
    return {
        "facecolor": look.colour,
        "edgecolor": look.ink if look.texture else _FRAME,
        "hatch": look.texture,
        "linewidth": 0.5,
    }


def class_legend(codes: Integers, classes: Sequence[MapClass]) -> list[Patch]:
    """Return a patch for each class in `codes`, labelled with its share of all runs, computed or not."""
    entries = []
    for one in classes:
        count = int(np.count_nonzero(codes == one.code))
        if count:
            plain = one.look.texture and not _coherent(codes == one.code).any()
            look = replace(one.look, texture="") if plain else one.look
            entries.append(Patch(label=f"{one.name}  {percent(count, codes.size)}", **fill_options(look)))
    return entries


def percent(count: int, total: int) -> str:
    """Return the share in percent, with one more digit if it is small but not zero."""
    share = 100.0 * count / total
    tiny = 0.05
    return "< 0.1 %" if 0.0 < share < tiny else f"{share:.1f} %"
