from .assessment import Assessment
from .known_orbits import KnownOrbit
from .outcomes import ContactClass
from .report_details import DesignSpectrum, ReportDetails
from .rules import OutcomeRules
from .run import Event, Run
from .tables import to_dataframe, write_table
from .verdict import Verdict, VerdictWord

__all__ = [
    "Assessment",
    "ContactClass",
    "DesignSpectrum",
    "Event",
    "KnownOrbit",
    "OutcomeRules",
    "ReportDetails",
    "Run",
    "Verdict",
    "VerdictWord",
    "to_dataframe",
    "write_table",
]
