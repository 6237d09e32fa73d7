"""The assessment of columns under a set of records."""

from stylobate.earthquakes.assessment.assess import assess

__all__ = ["assess"]
