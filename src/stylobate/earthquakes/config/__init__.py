"""File formats of studies of earthquakes: assessments and fragilities."""
