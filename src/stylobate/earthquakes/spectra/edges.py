"""Edges between neighbouring scales of different ends: found in a scan, and halved until they are narrow."""

from dataclasses import dataclass
from typing import Any, Self

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.studies.maps.uncertainty_exponent import overturned_or_not
from stylobate.studies.sweeps.quantities import Floats

Integers = npt.NDArray[np.int64]
Flags = npt.NDArray[np.bool_]


@dataclass(frozen=True, slots=True, eq=False)
class Ends:
    """What runs at these `scale` came to, arrays of one shape.

    `state` is 1 where the column overturned, towards the azimuth `direction` [rad]; 0 where it did not, negative where
    that is not known.
    """

    scale: Floats
    state: Integers
    direction: Floats
    uncertain: Flags

    @classmethod
    def of(cls, runs: xr.Dataset, scale: Floats) -> Self:
        """Return what the `runs` came to, which were made at these scales, one after another."""
        direction, uncertain = (runs[name].to_numpy().reshape(scale.shape) for name in ("direction", "uncertain"))
        return cls(scale, overturned_or_not(runs).reshape(scale.shape), direction, uncertain.astype(bool))

    def __getitem__(self, chosen: Any) -> "Ends":
        return Ends(*(array[chosen] for array in (self.scale, self.state, self.direction, self.uncertain)))

    @property
    def decided(self) -> Flags:
        """Whether it is known if the column overturned."""
        return self.state >= 0

    def differ(self, other: "Ends") -> Flags:
        """Return where the states differ, undecided being one state, or both overturn more than a right angle apart."""
        apart = np.cos(self.direction - other.direction) < 0.0
        unlike = np.maximum(self.state, -1) != np.maximum(other.state, -1)
        return np.asarray(unlike | ((self.state == 1) & apart))


def joined(*parts: Ends) -> Ends:
    """Return what all the runs came to, one part after another."""
    names = ("scale", "state", "direction", "uncertain")
    return Ends(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))


@dataclass(frozen=True, slots=True, eq=False)
class Edges:
    """Changes along the scale, in order of case and scale: between the runs `low` and `high` something changes.

    Overturning begins or ends there; or decided runs end or begin; or the direction of overturning turns round, and
    there may be a safe gap between.
    """

    case: Integers
    low: Ends
    high: Ends

    @classmethod
    def between(cls, scan: Ends) -> Self:
        """Return the edges of a scan, whose arrays have the shape (cases, scales), scales increasing."""
        case, place = np.nonzero(scan[:, :-1].differ(scan[:, 1:]))
        return cls(case, scan[case, place], scan[case, place + 1])

    @property
    def middle(self) -> Floats:
        """Geometric means of the ends."""
        return np.asarray(np.sqrt(self.low.scale * self.high.scale))

    @property
    def turns(self) -> Flags:
        """Where the column overturns on either side."""
        return np.asarray((self.low.state == 1) & (self.high.state == 1))

    def wide(self, width: float) -> Flags:
        """Return which edges are wider than this fraction of their scale."""
        return np.asarray(self.high.scale > self.low.scale * (1.0 + width))

    def halvings(self, width: float) -> int:
        """Return how many runs it takes to halve all of them until none is wide, if no more are found."""
        wide = self.wide(width)
        ratio = np.log(self.high.scale[wide] / self.low.scale[wide]) / np.log1p(width)
        return int(np.ceil(np.log2(ratio)).sum())

    def halved(self, chosen: Flags, middle: Ends) -> "Edges":
        """Return the edges with those `chosen` cut where the runs `middle` were made: of each the parts that differ."""
        case, low, high = self.case[chosen], self.low[chosen], self.high[chosen]
        below, above = low.differ(middle), middle.differ(high)
        cases = np.concatenate([self.case[~chosen], case[below], case[above]])
        lower = joined(self.low[~chosen], low[below], middle[above])
        upper = joined(self.high[~chosen], middle[below], high[above])
        order = np.lexsort((lower.scale, cases))
        return Edges(cases[order], lower[order], upper[order])
