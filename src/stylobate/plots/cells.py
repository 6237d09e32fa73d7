"""Classes of maps, with one colour and texture each, the same in every figure; filled cells with their legend.

The hues are from Okabe and Ito's palette for colour-blind readers. The lightness of the usual classes differs by a
tenth of its range or more; textures tell the others apart in print without colour.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap, to_hex, to_rgb
from matplotlib.font_manager import FontProperties
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path
from matplotlib.ticker import FormatStrFormatter, LogLocator, MaxNLocator, NullFormatter

from stylobate.errors import Outcome
from stylobate.plots.style import AS_DRAWN
from stylobate.results.outcomes import NOT_COMPUTED


@dataclass(frozen=True, slots=True)
class Look:
    """A fill `colour`, and a `texture` (a hatch of Matplotlib) drawn on it in the colour `ink`, by default faint."""

    colour: str
    texture: str = ""
    ink: str = ""

    def __post_init__(self) -> None:
        if not self.ink:
            red, green, blue = to_rgb(self.colour)
            towards = 0.0 if 0.3 * red + 0.6 * green + 0.1 * blue > _DARK else 1.0
            mixed = ((1.0 - _FAINT) * np.array([red, green, blue]) + _FAINT * towards).tolist()
            object.__setattr__(self, "ink", to_hex(mixed))


# Contrast of a texture to its fill, and the brightness below which it is lighter than the fill.
_FAINT, _DARK = 0.2, 0.25
# Lightness L* in steps of ten, from standing to falling: 95, 84, 74, 63, 51, 41, then 5.
_CREAM, _LEAF, _SKY, _AMBER, _SEA, _BLUE, _NIGHT = (
    "#F6F1DA", "#B5D9BE", "#74C0EA", "#D58900", "#008B65", "#0063A0", "#1B0B16",
)  # fmt: skip
_MAUVE, _ROSE, _MINT, _PURPLE = "#A4558C", "#DDA6CD", "#7CCDB4", "#6E4A9E"
_GREY, _SAND, _LILAC, _STEEL = "#767676", "#E5BE8F", "#DAD2E8", "#4F9BD0"

_AT_REST, _ROCKING, _OVERTURNED = Look(_CREAM), Look(_SKY), Look(_NIGHT)
_ROLLING, _MODULATED, _APERIODIC = Look(_AMBER), Look(_SEA), Look(_MAUVE, "\\\\")
_UNSETTLED, _SLIDING, _FLYING = Look(_LILAC, "--"), Look(_SAND, "||"), Look(_GREY, "||")
UNFINISHED = Look("#ffffff", "//////", "#b0b0b0")
"""Runs that are not computed: white, finely hatched."""

# From standing to falling.
OUTCOME_LOOKS = {
    Outcome.AT_REST: _AT_REST,
    Outcome.ROCKING: _ROCKING,
    Outcome.ROLLING: _ROLLING,
    Outcome.PERIODIC: Look(_STEEL, "//"),
    Outcome.MODULATED: _MODULATED,
    Outcome.APERIODIC: _APERIODIC,
    Outcome.SURVIVED: Look(_LEAF),
    Outcome.STILL_MOVING: _UNSETTLED,
    Outcome.OVERTURNED: _OVERTURNED,
    Outcome.LIMIT_REACHED: replace(_OVERTURNED, texture="//"),
    Outcome.LIFTED_OFF: _FLYING,
    Outcome.SLID: _SLIDING,
    Outcome.STOPPED: Look("#ffffff", ".."),
    Outcome.FAILED: Look("#ffffff", "xx", "#D55E00"),
}

KIND_LOOKS = {
    "at rest": _AT_REST,
    "rocking": _ROCKING,
    "rolling anticlockwise": _ROLLING,
    "rolling clockwise": Look(_BLUE),
    "modulated anticlockwise": _MODULATED,
    "modulated clockwise": Look(_MINT, "\\\\"),
    "aperiodic anticlockwise": _APERIODIC,
    "aperiodic clockwise": Look(_ROSE, "||"),
    "aperiodic": Look(_PURPLE, "--"),
    "overturned": _OVERTURNED,
    "tilt limit reached": OUTCOME_LOOKS[Outcome.LIMIT_REACHED],
    "lifted off": OUTCOME_LOOKS[Outcome.LIFTED_OFF],
    "survived": OUTCOME_LOOKS[Outcome.SURVIVED],
    "not settled": _UNSETTLED,
}
# Textures of the second, third … attractor of a kind; after the last texture the first one follows.
_MORE_TEXTURES = ("//", "..", "||", "--", "\\\\", "++")


@dataclass(frozen=True, slots=True)
class MapClass:
    """A class of a map: its `code` in the array, its `name` and its `look`."""

    code: int
    name: str
    look: Look


UNFINISHED_CLASS = MapClass(NOT_COMPUTED, "not computed", UNFINISHED)


def classes_of(names: Iterable[object], looks: Iterable[Look]) -> tuple[MapClass, ...]:
    """Return classes of these names and looks, whose codes are their indices."""
    return tuple(MapClass(code, str(name), look) for code, (name, look) in enumerate(zip(names, looks, strict=True)))


def outcome_classes() -> tuple[MapClass, ...]:
    """Return the classes of outcomes, from standing to falling, and last the class of runs not computed."""
    return (*(MapClass(int(one), one.label, look) for one, look in OUTCOME_LOOKS.items()), UNFINISHED_CLASS)


def contact_classes(found: xr.Dataset) -> tuple[MapClass, ...]:
    """Return the classes of a contact map, from standing to falling, and last the class of runs not computed."""
    looks = (_AT_REST, _SLIDING, _ROCKING, Look(_BLUE), Look(_LILAC), _FLYING, _OVERTURNED)
    return (*classes_of(found["class_name"].to_numpy(), (*looks, OUTCOME_LOOKS[Outcome.FAILED])), UNFINISHED_CLASS)


def attractor_classes(found: xr.Dataset) -> tuple[MapClass, ...]:
    """Return the classes of attractors in a table over `attractor_index`, of runs not settled and not computed."""
    kinds = [str(kind) for kind in found["attractor_kind"].to_numpy()]
    return (*classes_of(found["attractor_name"].to_numpy(), _looks(kinds)), UNFINISHED_CLASS)


def _looks(kinds: Sequence[str]) -> list[Look]:
    looks = []
    for place, kind in enumerate(kinds):
        look, alike = KIND_LOOKS[kind], kinds[:place].count(kind)
        if alike:
            others = [texture for texture in _MORE_TEXTURES if texture != look.texture]
            look = replace(look, texture=others[(alike - 1) % len(others)])
        looks.append(look)
    return looks


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
_PANEL, _POINTS, _CHARACTER, _ROOM, _DARK_CELL = 0.85, 72.0, 0.55, 1.2, 0.45


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
    return "#ffffff" if 0.3 * red + 0.6 * green + 0.1 * blue < _DARK_CELL else "#222222"


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
