"""Figures of columns in earthquakes: incremental analyses, fragility, spectra, verdicts."""
