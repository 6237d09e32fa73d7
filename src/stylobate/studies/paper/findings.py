"""What a check of the source paper finds: claims with their measurements, and the data of its figures."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum

import xarray as xr

from stylobate.column import Column
from stylobate.models import Slender

SLENDERNESS, DAMPING = 0.1, 0.1
"""c and η of the paper's figures."""

CIRCULAR_AMPLITUDES = (0.02, 0.065)
"""a0 of the paper's curves 2, 3 and 4, 5 [g]; for straight-line motion a1 is twice that."""


class Verdict(Enum):
    """How a statement of the paper fares."""

    HOLDS = "holds"
    SHARPENED = "holds, sharpened"
    LIMITED = "holds within limits"
    FAILS = "fails"
    ERRATUM = "misprint"
    NOT_CONFIRMED = "not confirmed here"


@dataclass(frozen=True, slots=True)
class Finding:
    """One statement of the paper, in our words, with what was measured and whether it holds."""

    source: str
    statement: str
    measured: str
    verdict: Verdict


@dataclass(frozen=True, slots=True)
class Section:
    """The findings of one part of the paper and the data of its figures."""

    findings: tuple[Finding, ...]
    data: Mapping[str, xr.Dataset] = field(default_factory=dict)


def paper_model(damping: float = DAMPING) -> Slender:
    """Return the paper's column, c = 0.1, in its own units (m = g = ω0 = 1)."""
    return Slender(Column.dimensionless(SLENDERNESS), damping=damping)


def judged(condition: bool, verdict: Verdict = Verdict.HOLDS) -> Verdict:
    """Return `verdict` if the measurement bears it out, NOT_CONFIRMED otherwise."""
    return verdict if condition else Verdict.NOT_CONFIRMED
