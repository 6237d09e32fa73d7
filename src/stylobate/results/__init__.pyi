from .assessment import Assessment
from .findings import Finding, PaperCheck, Section, Verdict
from .outcomes import code_of, outcome_of
from .report_details import DesignSpectrum, ReportDetails
from .response import Event, Response
from .rules import OutcomeRules
from .storage import load, read_dataset, write_netcdf

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
