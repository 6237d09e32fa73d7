"""Spectra: peaks of rocking, and the bands of amplitude that overturn, over size, slenderness, frequency."""

from stylobate.studies.spectra.bands import overturning_bands
from stylobate.studies.spectra.rocking import rocking_spectrum

__all__ = ["overturning_bands", "rocking_spectrum"]
