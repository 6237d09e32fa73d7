"""The report of an assessment: its tables, its figures, and one page that holds all of it."""

from stylobate.earthquakes.figures.assessment.report import assessment_report
from stylobate.earthquakes.figures.assessment.tables import assessment_tables

__all__ = ["assessment_report", "assessment_tables"]
