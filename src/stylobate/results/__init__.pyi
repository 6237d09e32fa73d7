from .assessment import Assessment
from .findings import Finding, PaperCheck, Section, Verdict
from .report_details import DesignSpectrum, ReportDetails
from .response import Event, Response
from .rules import OutcomeRules
from .storage import read_dataset, write_netcdf

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
    "read_dataset",
    "write_netcdf",
]
