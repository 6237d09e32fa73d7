"""A column in pictures: colours, facets of a fluted shaft under light, and the artists that draw them."""

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Self

import numpy as np
import numpy.typing as npt
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.patches import Polygon

from stylobate.plots.geometry import Floats, Shape, View, direction
from stylobate.plots.style import AS_DRAWN, BLUE, VERMILION, paper

BACKGROUND, GROUND_LINE = "#f5f7fa", "#c3ccd8"
SLAB, SLAB_SIDE, SLAB_LINE = "#e3e8ef", "#aeb8c6", "#aab6c6"
STONE, FOOTPRINT, INK = "#f1ebde", "#5d6b7d", "#3c4856"
MARK = VERMILION
"""The marked flute and the radius to it, which turn with the body."""

CONTACT, CONTACT_OLD = BLUE, "#9cc3de"
"""The path of the contact point, recent and old, and the footprint of a column that stands."""

PALE = FOOTPRINT
"""Secondary text."""

CONTACT_POINT = "#0b1622"
"""The present contact point."""

SHADOW, SHADOW_STRENGTH = "#1d2733", 0.3


def mixed(first: str, second: str, fraction: float) -> tuple[float, ...]:
    """Mix two colours with this fraction of the second; return red, green and blue."""
    pairs = zip(to_rgb(first), to_rgb(second), strict=True)
    return tuple((1.0 - fraction) * one + fraction * other for one, other in pairs)


SLAB_LIT = mixed(SLAB_SIDE, SLAB, 0.4)
"""A side of the slab that the light reaches."""


# A Doric column has 20 flutes; facets across each, and angle from the normal of a flute's middle to its edge [rad].
_FLUTES, _FACETS, _HOLLOW = 20, 4, 0.85
# Corners of the outline of a shaft that has flutes, a cylinder or frustum.
_PLAIN = 2
# Facets across the width of a flute on a drawn outline, which has many strips of facets.
_FACETS_OF_OUTLINE = 2
# Rings of the facets of a drawn outline; more corners are left out.
_MOST_RINGS = 48
MARKED = -0.5 * np.pi
"""Azimuth of the marked flute from the body's x [rad]: without twist the flute faces the viewer."""

# Ambient brightness, and brightness that the light adds.
_AMBIENT, _DIRECT = 0.52, 0.54
# The light's azimuth relative to the viewer, and its elevation [rad].
_BESIDE, _HIGH = math.radians(-62.0), math.radians(48.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class FlutedColumn:
    """Facets of a shaft in its own frame, the origin at the centre of its base, z along its axis.

    A body with a drawn profile has no flutes, only the mark.

    Attributes
    ----------
    rings
        Corners of the facets on each ring from the base up, shape (k, n, 3) [m]; facet i of a strip lies between
        corners i and i + 1 of two rings.
    normals
        Unit normals that shade the facets, shape (k − 1, n, 3); those of a hollow flute although the body is convex.
    colours
        Red, green and blue of each facet of a strip without light, shape (n, 3).
    """

    rings: Floats
    normals: Floats
    colours: Floats

    @classmethod
    def of(cls, shape: Shape) -> Self:
        """Return the facets of a body of this `shape`."""
        outline = shape.corners
        if len(outline) > _MOST_RINGS:
            kept = np.linspace(0, len(outline) - 1, _MOST_RINGS).round().astype(int)
            outline = tuple(outline[place] for place in kept)
        facets = _FACETS if len(outline) == _PLAIN else _FACETS_OF_OUTLINE
        count, width = _FLUTES * facets, 2.0 * np.pi / _FLUTES
        # Half a flute back: the middle of the first is the mark.
        corners = MARKED + (np.arange(count) / facets - 0.5) * width
        flute, place = np.divmod(np.arange(count), facets)
        hollow = _HOLLOW if len(outline) == _PLAIN else -0.5 * width
        facing = MARKED + flute * width - 2.0 * hollow * ((place + 0.5) / facets - 0.5)
        normals = np.stack(
            [
                np.stack([(high - low) * np.cos(facing), (high - low) * np.sin(facing), np.full(count, a - b)], axis=-1)
                for (low, a), (high, b) in pairwise(outline)
            ]
        )
        return cls(
            rings=np.stack([ring(corners, radius, height) for height, radius in outline]),
            normals=normals / np.linalg.norm(normals, axis=-1, keepdims=True),
            colours=np.where((flute == 0)[:, None], to_rgb(MARK), to_rgb(STONE)),
        )

    @property
    def bottom(self) -> Floats:
        """Corners on the rim of the base, shape (n, 3) [m]."""
        return np.asarray(self.rings[0])

    @property
    def top(self) -> Floats:
        """Corners on the rim of the top, shape (n, 3) [m]."""
        return np.asarray(self.rings[-1])

    @property
    def wedge(self) -> npt.NDArray[np.intp]:
        """Indices of the corners of the marked flute."""
        return np.arange(self.rings.shape[1] // _FLUTES + 1)


def ring(angles: Floats, radius: float, height: float) -> Floats:
    """Return points of a horizontal circle about the z axis, shape (n, 3)."""
    return np.stack([radius * np.cos(angles), radius * np.sin(angles), np.full(angles.size, height)], axis=-1)


def lit(colours: Floats, normals: Floats, light: Floats) -> Floats:
    """Return colours under `light`, after Lambert, with ambient light; shapes (n, 3), 0 to 1."""
    bright = _AMBIENT + _DIRECT * np.clip(normals @ light, 0.0, None)
    return np.clip(colours * bright[..., None], 0.0, 1.0)


def _rgb(colour: str) -> Floats:
    return np.array(to_rgb(colour), dtype=float)


def light_for(view: View) -> Floats:
    """Return the unit vector towards the light, which stands beside the viewer."""
    return direction(view.azimuth + _BESIDE, _HIGH)


class ColumnArtists:
    """A lit column in axes of a `view`: the shaft, the face that is seen, and the mark on this face.

    A `strength` below 1 mixes all colours with the background, for a column that stood there before.
    """

    def __init__(self, axes: Axes, shape: Shape, view: View, strength: float = 1.0) -> None:
        self.body, self._view, self._light = FlutedColumn.of(shape), view, light_for(view)
        self._strength, self._background = strength, np.array(paper())
        self._shaft = axes.add_collection(PolyCollection([], linewidths=0.4), autolim=False)
        edge = self._mixed(_rgb(SLAB_SIDE))
        self._face = Polygon(np.zeros((3, 2)), facecolor=STONE, edgecolor=edge, linewidth=0.6)
        self._wedge = Polygon(np.zeros((3, 2)), facecolor=MARK, linewidth=0.0)
        axes.add_patch(self._face)
        axes.add_patch(self._wedge)
        for one in self.artists:
            one.set_gid(AS_DRAWN)

    @property
    def artists(self) -> tuple[Artist, ...]:
        """The artists, in the order in which they cover each other."""
        return self._shaft, self._face, self._wedge

    def place(self, frame: Floats, centre: Floats) -> list[Floats]:
        """Place the column by the matrix of its axes and the centre of its base; return its projected rings."""
        body, project = self.body, self._view.project
        placed = [rim @ frame.T + centre for rim in body.rings]
        rims = [project(rim) for rim in placed]
        bottom, top = rims[0], rims[-1]
        strips = [np.stack([a, np.roll(a, -1, axis=0), np.roll(b, -1, axis=0), b], axis=1) for a, b in pairwise(rims)]
        shades = [lit(body.colours, normals @ frame.T, self._light) for normals in body.normals]
        facets = np.concatenate(strips)
        across, up = facets[:, 1] - facets[:, 0], facets[:, 3] - facets[:, 0]
        seen = np.flatnonzero(across[:, 0] * up[:, 1] - across[:, 1] * up[:, 0] > 0.0)
        if len(strips) > 1:  # parts of a body that is not convex cover each other: the nearest last
            depth = np.concatenate([(a + b) @ self._view.eye for a, b in pairwise(placed)])
            seen = seen[np.argsort(depth[seen], kind="stable")]
        colours = self._mixed(np.concatenate(shades)[seen])
        self._shaft.set(verts=list(facets[seen]), facecolor=colours, edgecolor=colours)
        faces = [(rim, outward) for rim, outward in ((bottom, -frame[:, 2]), (top, frame[:, 2]))]
        shown = [(rim, outward) for rim, outward in faces if outward @ self._view.eye > 0.0]
        for patch in (self._face, self._wedge):
            patch.set_visible(bool(shown))
        for rim, outward in shown:
            stone, mark = self._mixed(lit(np.stack([_rgb(STONE), _rgb(MARK)]), outward[None], self._light))
            self._face.set(xy=rim, facecolor=stone)
            self._wedge.set(xy=np.concatenate([rim.mean(axis=0)[None], rim[body.wedge]]), facecolor=mark)
        return rims

    def _mixed(self, colours: Floats) -> Floats:
        return colours if self._strength == 1.0 else self._background + self._strength * (colours - self._background)
