"""The report of an assessment: tables, figures, and one page with both."""

from stylobate.earthquakes.assessment.report.document import assessment_report
from stylobate.earthquakes.assessment.report.tables import assessment_tables

__all__ = ["assessment_report", "assessment_tables"]
