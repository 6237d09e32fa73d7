"""Results: what a computation returns, saved and loaded with everything needed to repeat it."""

from stylobate.results.assessment import Assessment
from stylobate.results.findings import Finding, PaperCheck, Section, Verdict
from stylobate.results.outcomes import code_of, outcome_of
from stylobate.results.response import Event, Response
from stylobate.results.rules import OutcomeRules
from stylobate.results.storage import load

__all__ = [
    "Assessment",
    "Event",
    "Finding",
    "OutcomeRules",
    "PaperCheck",
    "Response",
    "Section",
    "Verdict",
    "code_of",
    "load",
    "outcome_of",
]
