"""Parameters of the source paper's figures, and its column."""

from stylobate.column import Column
from stylobate.models import Slender
from stylobate.results.findings import ClaimStatus

SLENDERNESS, DAMPING = 0.1, 0.1
"""c and η of the paper's figures."""

CIRCULAR_AMPLITUDES = (0.02, 0.065)
"""a0 of the paper's curves 2, 3 and 4, 5 [g]; for straight-line motion a1 is twice that."""


def paper_model(damping: float = DAMPING) -> Slender:
    """Create the model of the paper's column, c = 0.1, in dimensionless units (m = g = ω0 = 1)."""
    return Slender(Column.dimensionless(SLENDERNESS), damping=damping)


def judged(condition: bool, verdict: ClaimStatus = ClaimStatus.HOLDS) -> ClaimStatus:
    """Return `verdict` if the measurement confirms it, NOT_CONFIRMED otherwise."""
    return verdict if condition else ClaimStatus.NOT_CONFIRMED
