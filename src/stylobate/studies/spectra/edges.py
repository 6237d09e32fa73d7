"""Edges between neighbouring scales of different ends: found in a scan, and halved until they are narrow."""

from dataclasses import dataclass
from typing import Any, Self

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.studies.boundary import overturned_or_not
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

    def differ(self, other: "Ends") -> Flags:
        """Return where one overturns and the other does not, or both do in directions more than a right angle apart."""
        apart = np.cos(self.direction - other.direction) < 0.0
        return np.asarray((self.state != other.state) | ((self.state == 1) & apart))


def joined(*parts: Ends) -> Ends:
    """Return what all the runs came to, one part after another."""
    names = ("scale", "state", "direction", "uncertain")
    return Ends(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))


@dataclass(frozen=True, slots=True, eq=False)
class Edges:
    """Changes along the scale, in order of case and scale: between the runs `low` and `high` something changes.

    Either overturning begins or ends there, or its direction turns round, and there may be a safe gap between. An edge
    is `stuck` where the run in its middle told nothing.
    """

    case: Integers
    low: Ends
    high: Ends
    stuck: Flags

    @classmethod
    def between(cls, scan: Ends) -> Self:
        """Return the edges of a scan, whose arrays have the shape (cases, scales), scales increasing."""
        case, place = np.nonzero(scan.state >= 0)
        known = scan[case, place]
        neighbours = np.flatnonzero((np.diff(case) == 0) & known[:-1].differ(known[1:]))
        low, high = known[neighbours], known[neighbours + 1]
        return cls(case[neighbours], low, high, np.zeros(neighbours.size, dtype=bool))

    @property
    def middle(self) -> Floats:
        """Geometric means of the ends."""
        return np.asarray(np.sqrt(self.low.scale * self.high.scale))

    @property
    def turns(self) -> Flags:
        """Where the column overturns on either side."""
        return np.asarray((self.low.state == 1) & (self.high.state == 1))

    def wide(self, width: float) -> Flags:
        """Return which edges are wider than this part of themselves, and can be halved."""
        return np.asarray((self.high.scale > self.low.scale * (1.0 + width)) & ~self.stuck)

    def halvings(self, width: float) -> int:
        """Return how many runs it takes to halve all of them until none is wide, if no more are found."""
        wide = self.wide(width)
        ratio = np.log(self.high.scale[wide] / self.low.scale[wide]) / np.log1p(width)
        return int(np.ceil(np.log2(ratio)).sum())

    def halved(self, chosen: Flags, middle: Ends) -> "Edges":
        """Return the edges with those `chosen` cut where the runs `middle` were made: of each the parts that differ."""
        case, low, high = self.case[chosen], self.low[chosen], self.high[chosen]
        known = middle.state >= 0
        below, above = known & low.differ(middle), known & middle.differ(high)
        cases = np.concatenate([self.case[~chosen], case[~known], case[below], case[above]])
        lower = joined(self.low[~chosen], low[~known], low[below], middle[above])
        upper = joined(self.high[~chosen], high[~known], middle[below], high[above])
        stuck = np.concatenate(
            [self.stuck[~chosen], np.ones(int((~known).sum()), bool), np.zeros(int(below.sum() + above.sum()), bool)]
        )
        order = np.lexsort((lower.scale, cases))
        return Edges(cases[order], lower[order], upper[order], stuck[order])
