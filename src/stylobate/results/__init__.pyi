from .assessment import Assessment
from .findings import ClaimStatus, Finding, PaperCheck, Section
from .known_orbits import KnownOrbit
from .outcomes import ContactClass, contact_classes
from .report_details import DesignSpectrum, ReportDetails
from .response import Event, Response
from .rules import OutcomeRules
from .storage import read_dataset, write_netcdf
from .tables import to_dataframe
from .verdict import Verdict, VerdictWord, percent

__all__ = [
    "Assessment",
    "ClaimStatus",
    "ContactClass",
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
    "contact_classes",
    "percent",
    "read_dataset",
    "to_dataframe",
    "write_netcdf",
]
