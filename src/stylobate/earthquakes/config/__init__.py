"""File formats of studies of earthquakes: assessments and fragilities."""

from stylobate.earthquakes.config.assess import AssessConfig, AssessmentSetup
from stylobate.earthquakes.config.fragility import FragilityConfig, FragilitySetup
from stylobate.earthquakes.config.verdict import VerdictConfig

__all__ = ["AssessConfig", "AssessmentSetup", "FragilityConfig", "FragilitySetup", "VerdictConfig"]
