"""The report of an assessment: its tables, its figures, and one page that holds all of it."""

from stylobate.earthquakes.assessment.report.document import assessment_report
from stylobate.earthquakes.assessment.report.tables import assessment_tables

__all__ = ["assessment_report", "assessment_tables"]
