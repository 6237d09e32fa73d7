"""Spectra: peaks of rocking, and overturning intervals of the amplitude, over size, slenderness and frequency."""

from stylobate.earthquakes.spectra.overturning import overturning_intervals
from stylobate.earthquakes.spectra.rocking import rocking_spectrum

__all__ = ["overturning_intervals", "rocking_spectrum"]
