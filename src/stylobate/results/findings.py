"""Result of checking a publication: its claims with measurements and verdicts, and the data of its figures."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum

import xarray as xr

from stylobate.equality import ByContent
from stylobate.errors import Named
from stylobate.results.plain import ByName


class ClaimStatus(Named, Enum):
    """The verdict on a statement of a publication."""

    HOLDS = "holds"
    SHARPENED = "holds, sharpened"
    LIMITED = "holds within limits"
    DOES_NOT_HOLD = "does not hold"
    ERRATUM = "misprint"
    NOT_CONFIRMED = "not confirmed here"


@dataclass(frozen=True, slots=True)
class Finding:
    """A statement in the words of this project, with the measurement and the verdict."""

    source: str
    statement: str
    measured: str
    verdict: ClaimStatus


@dataclass(frozen=True, slots=True, eq=False)
class PaperSection(ByContent):
    """The findings of one section and the data of its figures, by name."""

    findings: tuple[Finding, ...]
    data: Mapping[str, xr.Dataset] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, eq=False)
class PaperCheck(ByContent):
    """Check of a publication: `sections` by heading, in the order of the publication."""

    sections: Mapping[str, PaperSection]

    def __post_init__(self) -> None:
        object.__setattr__(self, "sections", ByName(self.sections))

    @property
    def findings(self) -> tuple[Finding, ...]:
        """All findings."""
        return tuple(finding for section in self.sections.values() for finding in section.findings)

    @property
    def data(self) -> Mapping[str, xr.Dataset]:
        """The data of all figures, by name."""
        return ByName({name: data for section in self.sections.values() for name, data in section.data.items()})

    @property
    def summary(self) -> str:
        """One line that counts the verdicts."""
        counts = Counter(finding.verdict for finding in self.findings)
        counted = "; ".join(f"{verdict.value}: {counts[verdict]}" for verdict in ClaimStatus if counts[verdict])
        return f"{counts.total()} checks of the paper's statements. {counted}."
