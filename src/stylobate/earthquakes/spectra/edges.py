"""Edges between neighbouring scales with different outcomes, found in a scan and bisected."""

from dataclasses import dataclass
from typing import Any, Self

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.studies.maps.uncertainty_exponent import overturned_or_not
from stylobate.studies.sweeps.designs import Floats

Integers = npt.NDArray[np.int64]
Flags = npt.NDArray[np.bool_]


@dataclass(frozen=True, slots=True, eq=False)
class Ends:
    """Outcomes of runs at these values of `scale`, as arrays of equal shape.

    `state` is 1 if the column overturned, towards the azimuth `direction` [rad]; 0 if it did not; negative if the run
    is undecided.
    """

    scale: Floats
    state: Integers
    direction: Floats
    uncertain: Flags

    @classmethod
    def of(cls, runs: xr.Dataset, scale: Floats) -> Self:
        """Collect the outcomes of `runs` at these scales, in the same order."""
        direction, uncertain = (runs[name].to_numpy().reshape(scale.shape) for name in ("direction", "uncertain"))
        return cls(scale, overturned_or_not(runs).reshape(scale.shape), direction, uncertain.astype(bool))

    def __getitem__(self, chosen: Any) -> "Ends":
        return Ends(*(array[chosen] for array in (self.scale, self.state, self.direction, self.uncertain)))

    def reshaped(self, shape: tuple[int, ...]) -> "Ends":
        """Return the same outcomes as arrays of another shape."""
        scale, state, direction, uncertain = self.scale, self.state, self.direction, self.uncertain
        return Ends(scale.reshape(shape), state.reshape(shape), direction.reshape(shape), uncertain.reshape(shape))

    @property
    def decided(self) -> Flags:
        """Whether each run is decided."""
        return self.state >= 0

    def differ(self, other: "Ends") -> Flags:
        """Flag pairs with different states (undecided is one state) or overturning more than a right angle apart."""
        apart = np.cos(self.direction - other.direction) < 0.0
        unlike = np.maximum(self.state, -1) != np.maximum(other.state, -1)
        return np.asarray(unlike | ((self.state == 1) & apart))


def joined(*parts: Ends) -> Ends:
    """Concatenate outcomes."""
    names = ("scale", "state", "direction", "uncertain")
    return Ends(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))


@dataclass(frozen=True, slots=True, eq=False)
class Edges:
    """Changes of the outcome along the scale between the runs `low` and `high`, in order of case and scale.

    At an edge overturning begins or ends, or decided runs end or begin, or the direction of overturning reverses; a
    reversal may hide a safe gap.
    """

    case: Integers
    low: Ends
    high: Ends

    @classmethod
    def between(cls, case: Integers, runs: Ends) -> Self:
        """Find the edges between successive runs of each case; flat arrays, in order of case and scale."""
        place = np.flatnonzero((case[:-1] == case[1:]) & runs[:-1].differ(runs[1:]))
        return cls(case[place], runs[place], runs[place + 1])

    @property
    def middle(self) -> Floats:
        """Geometric means of the ends."""
        return np.asarray(np.sqrt(self.low.scale * self.high.scale))

    @property
    def turns(self) -> Flags:
        """Whether the column overturns on both sides of an edge."""
        return np.asarray((self.low.state == 1) & (self.high.state == 1))

    def wide(self, width: float) -> Flags:
        """Flag the edges that are wider than this fraction of their scale."""
        return np.asarray(self.high.scale > self.low.scale * (1.0 + width))

    def halvings(self, width: float) -> int:
        """Return the number of runs that bisect all edges to this width, if no further edges are found."""
        wide = self.wide(width)
        ratio = np.log(self.high.scale[wide] / self.low.scale[wide]) / np.log1p(width)
        return int(np.ceil(np.log2(ratio)).sum())

    def halved(self, chosen: Flags, middle: Ends) -> "Edges":
        """Cut the `chosen` edges at the runs `middle`; keep the halves whose ends differ."""
        case, low, high = self.case[chosen], self.low[chosen], self.high[chosen]
        below, above = low.differ(middle), middle.differ(high)
        cases = np.concatenate([self.case[~chosen], case[below], case[above]])
        lower = joined(self.low[~chosen], low[below], middle[above])
        upper = joined(self.high[~chosen], middle[below], high[above])
        order = np.lexsort((lower.scale, cases))
        return Edges(cases[order], lower[order], upper[order])
