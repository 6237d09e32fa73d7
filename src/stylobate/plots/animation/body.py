"""The column as a body of facets: a fluted shaft with one flute marked, so that rolling and spin are seen."""

from dataclasses import dataclass
from typing import Self

import numpy as np
import numpy.typing as npt

from stylobate.plots.pose import Floats
from stylobate.plots.shape import Shape

# Flutes by the width of the shaft [pixels of the picture]: a Doric column has 20; finer than can be seen they flicker.
_FLUTES = ((60.0, 20), (30.0, 12), (0.0, 8))
# Facets across a flute, and how far their normals turn away from that of its middle [rad].
_FACETS, _HOLLOW = 6, 0.85
# Rims are cut into an even number of facets: what is drawn of them alone needs no more than every third.
COARSE = 3
MARK = -0.5 * np.pi
"""Where on the body the marked flute is: azimuth from its x [rad]. It faces the viewer where there is no twist."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Body:
    """Facets of a shaft in its own frame, the origin at the centre of its base, z along its axis.

    Attributes
    ----------
    bottom, top
        Corners of the facets on the two rims, shape (n, 3) [m]; facet i lies between corners i and i + 1.
    normals
        Unit normals by which facets are shaded, those of a hollow flute although the body is convex, shape (n, 3).
    marked
        Facets of the marked flute, shape (n,).
    """

    bottom: Floats
    top: Floats
    normals: Floats
    marked: npt.NDArray[np.bool_]

    @classmethod
    def fluted(cls, shape: Shape, width: float) -> Self:
        """Return the body of this `shape`, seen `width` pixels wide."""
        flutes = next(number for least, number in _FLUTES if width >= least)
        count = flutes * _FACETS
        # Half a flute back: the middle of the first is the mark.
        corners = MARK + (np.arange(count) / _FACETS - 0.5) * (2.0 * np.pi / flutes)
        flute, place = np.divmod(np.arange(count), _FACETS)
        across = (place + 0.5) / _FACETS - 0.5
        facing = MARK + flute * (2.0 * np.pi / flutes) - 2.0 * _HOLLOW * across
        rise = np.full(count, (shape.radius - shape.top_radius) / shape.height)
        normals = np.stack([np.cos(facing), np.sin(facing), rise], axis=-1)
        return cls(
            bottom=_circle(corners, shape.radius, 0.0),
            top=_circle(corners, shape.top_radius, shape.height),
            normals=normals / np.linalg.norm(normals, axis=-1, keepdims=True),
            marked=flute == 0,
        )

    @property
    def rims(self) -> Floats:
        """Corners of both rims, every third."""
        return np.concatenate([self.bottom[::COARSE], self.top[::COARSE]])


def _circle(angles: Floats, radius: float, height: float) -> Floats:
    return np.stack([radius * np.cos(angles), radius * np.sin(angles), np.full(angles.size, height)], axis=-1)
