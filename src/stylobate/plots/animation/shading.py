"""Light: how bright a facet is, and where shadows fall."""

import numpy as np

from stylobate.plots.axonometry import direction
from stylobate.plots.pose import Floats

# Brightness of what the light does not reach, and what it adds; together a little more than colours can show.
_AMBIENT, _DIRECT = 0.52, 0.54
# The light's place beside the eye's azimuth and above the ground [rad].
_BESIDE, _ABOVE = np.radians(-62.0), np.radians(48.0)


def light_for(azimuth: float) -> Floats:
    """Return the unit vector towards the light of one who looks from this `azimuth` [rad]: from the left."""
    return direction(azimuth + float(_BESIDE), float(_ABOVE))


def lit(colours: Floats, normals: Floats, light: Floats) -> Floats:
    """Return colours under `light`, after Lambert, with some light from everywhere; shapes (n, 3), 0 to 255."""
    bright = _AMBIENT + _DIRECT * np.clip(normals @ light, 0.0, None)
    return np.clip(colours * bright[..., None], 0.0, 255.0)


def shadow(points: Floats, light: Floats, normal: Floats, height: float) -> Floats:
    """Return where `points`, shape (n, 3), throw their shadows on the plane n·x = `height`."""
    above = points @ normal - height
    return np.asarray(points - (above / (light @ normal))[:, None] * light)


def clipped(polygon: Floats, low: Floats, high: Floats) -> Floats:
    """Return the part of a convex polygon, shape (n, 2), inside a rectangle: Sutherland's and Hodgman's algorithm."""
    for along in range(2):
        for sign, bound in ((1.0, high[along]), (-1.0, -low[along])):
            if not len(polygon):
                return polygon
            polygon = _below(polygon, sign * polygon[:, along] - bound)
    return polygon


def _below(polygon: Floats, excess: Floats) -> Floats:
    """Return the part of a polygon where an affine function, known at its corners, is not positive."""
    kept = []
    for at, ahead, here, there in zip(polygon, np.roll(polygon, -1, axis=0), excess, np.roll(excess, -1), strict=True):
        if here <= 0.0:
            kept.append(at)
        if (here <= 0.0) != (there <= 0.0):
            kept.append(at + here / (here - there) * (ahead - at))
    return np.array(kept).reshape(-1, 2)
