"""Times of the looks and pairs of runs under a periodic base motion."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from stylobate.engine.kernel.columns import EARLIER, LAGS, PAIRS, SLACK, Setup
from stylobate.engine.verdict import steady_periods
from stylobate.results import OutcomeRules

Floats = npt.NDArray[np.float64]

# Minimum mean number of periods from one pair to the next: pairs meet all phases of the base motion and do not overlap.
_LEAST_SPACING = 1.5
# Fraction of a run over which pairs are spread, and fraction between the two groups of looks. Periods too long for one
# run are then resolved by a longer one.
_PAIRED, _BETWEEN = 0.5, 0.25


@dataclass(frozen=True, slots=True)
class LookTimes:
    """Times of the looks and pairs of each run.

    Parameters
    ----------
    looks
        Number of looks in a row, 0 if no run is long enough for an outcome by its last periods.
    back, spacing
        `LOOKED_BACK` and `PAIR_SPACING` of each run, see `Setup`.
    """

    looks: int
    back: Floats
    spacing: Floats

    @classmethod
    def of(cls, end: npt.ArrayLike, period: npt.ArrayLike, rules: OutcomeRules) -> "LookTimes":
        """Return the times for runs of this duration; runs that are too short to need them have none."""
        held = periods_of(end, period)
        latest = rules.periods + LAGS
        back = np.maximum(latest + 1.0, np.floor(_BETWEEN * held))
        spacing = np.maximum((_PAIRED * held - 1.0) / (PAIRS - 1.0), _LEAST_SPACING)
        looks = EARLIER + latest + 1 if np.any(held >= rules.periods + 1.0) else 0
        steady = held >= steady_periods(rules)
        back = np.where(steady & (held >= back + EARLIER - 1.0), back, 0.0)
        return cls(looks, back, np.where(steady, spacing, 0.0))

    @property
    def notes(self) -> int:
        """Number of looks and pairs in a row."""
        return self.looks + PAIRS if self.looks else 0

    def fill(self, table: Floats) -> None:
        """Set the columns of the table."""
        table[:, Setup.LOOKS] = self.looks
        table[:, Setup.LOOKED_BACK] = self.back
        table[:, Setup.PAIR_SPACING] = self.spacing


def periods_of(end: npt.ArrayLike, period: npt.ArrayLike) -> Floats:
    """Return the number of periods of the base motion in runs of this duration; 0 without a period."""
    length = np.asarray(period, dtype=float)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(length > 0.0, np.asarray(end) * (1.0 + SLACK) / length, 0.0)
