"""Results: what a computation returns, saved and loaded with everything needed to repeat it.

Names are imported when they are first used: those who need a rule or a code wait for no labelled arrays.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from stylobate.results.assessment import Assessment
    from stylobate.results.findings import Finding, PaperCheck, Section, Verdict
    from stylobate.results.outcomes import code_of, outcome_of
    from stylobate.results.report_details import DesignSpectrum, ReportDetails
    from stylobate.results.response import Event, Response
    from stylobate.results.rules import OutcomeRules
    from stylobate.results.storage import load, read_dataset, write_netcdf

__all__ = [
    "Assessment",
    "DesignSpectrum",
    "Event",
    "Finding",
    "OutcomeRules",
    "PaperCheck",
    "ReportDetails",
    "Response",
    "Section",
    "Verdict",
    "code_of",
    "load",
    "outcome_of",
    "read_dataset",
    "write_netcdf",
]

_HOMES = {
    "Assessment": "assessment",
    **dict.fromkeys(("Finding", "PaperCheck", "Section", "Verdict"), "findings"),
    **dict.fromkeys(("code_of", "outcome_of"), "outcomes"),
    **dict.fromkeys(("DesignSpectrum", "ReportDetails"), "report_details"),
    **dict.fromkeys(("Event", "Response"), "response"),
    "OutcomeRules": "rules",
    **dict.fromkeys(("load", "read_dataset", "write_netcdf"), "storage"),
}


def __getattr__(name: str) -> Any:
    if name in _HOMES:
        return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
    message = f"module {__name__!r} has no attribute {name!r}"
    raise AttributeError(message)


def __dir__() -> list[str]:
    return sorted(__all__)
