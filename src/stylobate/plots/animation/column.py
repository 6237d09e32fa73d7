"""Facets of a fluted shaft with one marked flute, which makes rolling and spin visible."""

from dataclasses import dataclass
from typing import Self

import numpy as np
import numpy.typing as npt
from matplotlib.colors import to_rgb

from stylobate.plots.animation.palette import MARK, STONE
from stylobate.plots.pose import Floats
from stylobate.plots.shape import Shape

# A Doric column has 20 flutes; facets across each, and angle from the normal of a flute's middle to its edge [rad].
_FLUTES, _FACETS, _HOLLOW = 20, 4, 0.85
MARKED = -0.5 * np.pi
"""Azimuth of the marked flute from the body's x [rad]: without twist the flute faces the viewer."""

# Ambient brightness, and brightness that the light adds.
_AMBIENT, _DIRECT = 0.52, 0.54


@dataclass(frozen=True, slots=True, kw_only=True)
class FlutedColumn:
    """Facets of a shaft in its own frame, the origin at the centre of its base, z along its axis.

    Attributes
    ----------
    bottom, top
        Corners of the facets on the two rims, shape (n, 3) [m]; facet i lies between corners i and i + 1.
    normals
        Unit normals that shade the facets, those of a hollow flute although the body is convex, shape (n, 3).
    colours
        Red, green and blue of each facet without light, shape (n, 3).
    """

    bottom: Floats
    top: Floats
    normals: Floats
    colours: Floats

    @classmethod
    def of(cls, shape: Shape) -> Self:
        """Return the facets of a body of this `shape`."""
        count = _FLUTES * _FACETS
        width = 2.0 * np.pi / _FLUTES
        # Half a flute back: the middle of the first is the mark.
        corners = MARKED + (np.arange(count) / _FACETS - 0.5) * width
        flute, place = np.divmod(np.arange(count), _FACETS)
        facing = MARKED + flute * width - 2.0 * _HOLLOW * ((place + 0.5) / _FACETS - 0.5)
        rise = np.full(count, (shape.radius - shape.top_radius) / shape.height)
        normals = np.stack([np.cos(facing), np.sin(facing), rise], axis=-1)
        return cls(
            bottom=ring(corners, shape.radius, 0.0),
            top=ring(corners, shape.top_radius, shape.height),
            normals=normals / np.linalg.norm(normals, axis=-1, keepdims=True),
            colours=np.where((flute == 0)[:, None], to_rgb(MARK), to_rgb(STONE)),
        )

    @property
    def wedge(self) -> npt.NDArray[np.intp]:
        """Indices of the corners of the marked flute."""
        return np.arange(_FACETS + 1)


def ring(angles: Floats, radius: float, height: float) -> Floats:
    """Return points of a horizontal circle about the z axis, shape (n, 3)."""
    return np.stack([radius * np.cos(angles), radius * np.sin(angles), np.full(angles.size, height)], axis=-1)


def lit(colours: Floats, normals: Floats, light: Floats) -> Floats:
    """Return colours under `light`, after Lambert, with ambient light; shapes (n, 3), 0 to 1."""
    bright = _AMBIENT + _DIRECT * np.clip(normals @ light, 0.0, None)
    return np.clip(colours * bright[..., None], 0.0, 1.0)
