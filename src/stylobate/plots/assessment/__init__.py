"""The report of an assessment: its tables, its figures, and one page that holds all of it."""

from stylobate.plots.assessment.report import assessment_report
from stylobate.plots.assessment.tables import assessment_tables

__all__ = ["assessment_report", "assessment_tables"]
