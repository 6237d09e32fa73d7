"""Runs in doubt: criteria, and the tolerances with which such runs are repeated.

The outcome of a run depends on three numbers of the method: the energy below which the column counts as standing, the
tilt below which a passage of the vertical loses energy, and the tolerance of the integrator. The tilt matters if a
passage below it would be above half of it: this passage then loses no energy. The other numbers matter if a small
change of the state can grow until it decides the outcome. In
6000 runs of columns under an earthquake, and as many of planar blocks under two more, a finer rest threshold changed
outcomes only of columns that had come to rest, were uplifted again, and overturned or tilted beyond half of their
tipping angle. Another tolerance changed three outcomes, each of a column beyond its tipping angle. In 7200 runs under
long harmonic shaking it changed outcomes of columns that overturned late or were still moving at the end.
"""

import numpy as np
import numpy.typing as npt

from stylobate.errors import Outcome
from stylobate.run_arguments import RTOL_RANGE

FINER_REST = 0.01
"""Factor of the rest energy when a run is repeated."""

FINER_PASSAGE = 0.5
"""Factor of the passage tilt when a run is repeated."""

LARGE_TILT = 0.5
"""A column that is uplifted from rest again is in doubt if it tilts beyond this fraction of its tipping angle."""

NEAR_BALANCE = 0.95
"""A column that comes back from beyond this fraction of its tipping angle is in doubt."""

LATE = 40.0
"""A column that overturns after this many units of its time is in doubt, because small changes had time to grow."""

FALLEN = (Outcome.OVERTURNED, Outcome.LIMIT_REACHED)
"""Outcomes that differ from all others: only a change from these to others, or back, makes a run uncertain."""

UNSETTLED = (Outcome.AT_REST, Outcome.SURVIVED, Outcome.STILL_MOVING, Outcome.APERIODIC)
"""Outcomes of motions whose peak tilt is that of a transient or of an aperiodic motion."""

MANY_PASSAGES = 40
"""A single run that passes the vertical more often is repeated: at each passage small changes can grow."""

FIRST_DIGIT = 0.1
"""A peak tilt that changes by this fraction when the run is repeated has no certain digit."""

_OTHER_TOLERANCE = 10.0


def in_doubt(
    *,
    overturned: npt.ArrayLike,
    decided: npt.ArrayLike,
    peak_tilt: npt.ArrayLike,
    released_again: npt.ArrayLike,
    widest_loss: npt.ArrayLike,
    passage_tilt: npt.ArrayLike,
    slenderness: npt.ArrayLike,
) -> npt.NDArray[np.bool_]:
    """Return whether finer thresholds or another tolerance could give another outcome; arguments of one shape.

    Parameters
    ----------
    overturned
        Whether the column overturned.
    decided
        Dimensionless time at which the outcome was decided.
    peak_tilt
        Peak tilt [rad].
    released_again
        Whether the column came to rest in the run and was uplifted again.
    widest_loss, passage_tilt
        Largest distance from the vertical of the passages that lost energy, and the limit of such distances [rad].
    slenderness
        c = tan α_c.
    """
    fell, again = np.asarray(overturned), np.asarray(released_again)
    share = np.asarray(peak_tilt) / np.arctan(np.asarray(slenderness, dtype=float))
    resting = again & (fell | (share > LARGE_TILT))
    moving = np.where(fell, np.asarray(decided) > LATE, share > NEAR_BALANCE)
    passing = np.asarray(widest_loss) > FINER_PASSAGE * np.asarray(passage_tilt)
    return np.asarray(resting | moving | passing)


def other_tolerance(rtol: float) -> float:
    """Return the relative tolerance for a repeated run: ten times `rtol`, at most the largest valid tolerance."""
    return min(_OTHER_TOLERANCE * rtol, RTOL_RANGE[1])
