"""Spectra: peaks of rocking, and overturning intervals of the amplitude, over size, slenderness and frequency."""

from stylobate.earthquakes.spectra.bands import overturning_bands
from stylobate.earthquakes.spectra.rocking import rocking_spectrum

__all__ = ["overturning_bands", "rocking_spectrum"]
