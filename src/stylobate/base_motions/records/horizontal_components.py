"""Definitions of the horizontal component of intensity measures and hazard curves, such as RotD50."""

import math
from enum import Enum

import numpy as np
import numpy.typing as npt

from stylobate.errors import ParameterError

Floats = npt.NDArray[np.float64]

_DEGREES = np.arange(180)


class HorizontalComponent(Enum):
    """Definition of one peak for the two horizontal components of a motion.

    D. M. Boore, "Orientation-independent, nongeometric-mean measures of seismic intensity from two horizontal
    components of motion", BSSA 100 (2010).
    """

    ROTD50 = "RotD50"
    """The median over all horizontal directions, 1° apart, of the peak along each."""
    ROTD100 = "RotD100"
    """The maximum over all directions: the peak of the horizontal vector."""
    GEOMETRIC_MEAN = "geometric mean"
    """√(peak along x · peak along y), of the components as recorded."""
    LARGER = "larger component"
    """The larger of the peaks along x and y, as recorded."""

    @classmethod
    def named(cls, name: "str | HorizontalComponent", argument: str = "component") -> "HorizontalComponent":
        """Find the definition with this name; letter case and spaces do not matter.

        Raises
        ------
        ParameterError
            If the name is not known; the message names the `argument`.

        Examples
        --------
        >>> HorizontalComponent.named("rotd50"), HorizontalComponent.named("vector")
        (<HorizontalComponent.ROTD50: 'RotD50'>, <HorizontalComponent.ROTD100: 'RotD100'>)
        """
        if isinstance(name, HorizontalComponent):
            return name
        plain = "".join(str(name).lower().split())
        found = next((one for one in cls if "".join(one.value.lower().split()) == plain), _ALIASES.get(plain))
        if found is None:
            known = ", ".join(repr(one.value) for one in cls)
            message = f"{argument}: unknown definition of the horizontal component (got {name!r}). Use one of {known}."
            raise ParameterError(message)
        return found

    def peak(self, x: Floats, y: Floats) -> float:
        """Compute the peak of horizontal values (x, y), two arrays of one length, in this definition.

        Examples
        --------
        >>> angle = np.linspace(0.0, 2.0 * np.pi, 2001)
        >>> straight = np.cos(angle), np.zeros(2001)
        >>> [round(one.peak(*straight), 4) for one in HorizontalComponent]  # cos 45° of the peak, …
        [0.7071, 1.0, 0.0, 1.0]
        """
        match self:
            case HorizontalComponent.ROTD50:
                return float(over_directions(x, y, (50.0,))[0])
            case HorizontalComponent.ROTD100:
                return float(np.hypot(x, y).max())
            case HorizontalComponent.GEOMETRIC_MEAN:
                return math.sqrt(float(np.abs(x).max() * np.abs(y).max()))
            case HorizontalComponent.LARGER:
                return float(max(np.abs(x).max(), np.abs(y).max()))


_ALIASES = {
    "vector": HorizontalComponent.ROTD100,
    "vectormaximum": HorizontalComponent.ROTD100,
    "geomean": HorizontalComponent.GEOMETRIC_MEAN,
    "gm": HorizontalComponent.GEOMETRIC_MEAN,
    "larger": HorizontalComponent.LARGER,
}


def over_directions(x: Floats, y: Floats, percentiles: tuple[float, ...]) -> Floats:
    """Return `percentiles` over the directions, 1° apart, of the peak projection of (x, y)."""
    from scipy.spatial import ConvexHull, QhullError

    points = np.stack([x, y], axis=-1)
    try:  # only corners of the hull can be farthest
        corners = points[ConvexHull(points).vertices]
    except QhullError:  # all on one line: its ends
        corners = points[[x.argmin(), x.argmax(), y.argmin(), y.argmax()]]
    angles = np.radians(_DEGREES)
    largest = np.abs(corners @ np.stack([np.cos(angles), np.sin(angles)])).max(axis=0)
    return np.asarray(np.percentile(largest, percentiles))
