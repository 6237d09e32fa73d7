"""The ranges of the numbers of models: for models, for what studies vary, and for the schema of the laboratory."""

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from stylobate.errors import LARGEST


class Bounds(NamedTuple):
    """The values that a number can have.

    Parameters
    ----------
    least, most
        Smallest and largest value.
    """

    least: float = 0.0
    most: float = LARGEST

    def accepts(self, values: npt.ArrayLike) -> npt.NDArray[np.bool_]:
        """Return which values are inside; NaN and infinities are not."""
        array = np.asarray(values, dtype=float)
        inside: npt.NDArray[np.bool_] = np.isfinite(array) & (array >= self.least) & (array <= self.most)
        return inside

    @property
    def demand(self) -> str:
        """The range in words, behind "must"."""
        return "be zero or positive" if self.most == LARGEST else f"be zero or positive, at most {self.most:.6g}"


# Beyond this Coulomb friction is not resolved; a column that never slips is another model.
MOST_FRICTION = 1e8

BOUNDS: Mapping[str, Bounds] = {
    "damping": Bounds(),
    "spin_friction": Bounds(),
    "rolling_resistance": Bounds(),
    "restitution": Bounds(most=1.0),
    "passage_tilt": Bounds(),
    "patch": Bounds(),
    "friction_coefficient": Bounds(most=MOST_FRICTION),
    "static_friction_coefficient": Bounds(most=MOST_FRICTION),
    "incline": Bounds(most=math.nextafter(0.5 * math.pi, 0.0)),
}
"""By the names of the fields of models."""
