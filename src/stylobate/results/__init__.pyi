from .assessment import Assessment
from .findings import ClaimStatus, Finding, PaperCheck, Section
from .known_orbits import KnownOrbit
from .report_details import DesignSpectrum, ReportDetails
from .response import Event, Response
from .rules import OutcomeRules
from .storage import read_dataset, write_netcdf
from .tables import to_dataframe
from .verdict import Verdict, VerdictWord, percent

__all__ = [
    "Assessment",
    "ClaimStatus",
    "DesignSpectrum",
    "Event",
    "Finding",
    "KnownOrbit",
    "OutcomeRules",
    "PaperCheck",
    "ReportDetails",
    "Response",
    "Section",
    "Verdict",
    "VerdictWord",
    "percent",
    "read_dataset",
    "to_dataframe",
    "write_netcdf",
]
