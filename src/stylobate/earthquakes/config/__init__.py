"""File formats of studies of earthquakes: assessments, fragilities and spectra."""

from stylobate.earthquakes.config.assess import AssessConfig, AssessmentSetup
from stylobate.earthquakes.config.fragility import FragilityConfig, FragilitySetup, SpectrumConfig
from stylobate.earthquakes.config.verdict import VerdictConfig

__all__ = ["AssessConfig", "AssessmentSetup", "FragilityConfig", "FragilitySetup", "SpectrumConfig", "VerdictConfig"]
