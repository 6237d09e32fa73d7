"""Real base motions: what a set of records does to a column, how close it was, and how sure that is."""

from stylobate.studies.shaking.changes import (
    SMALL_CHANGES,
    Change,
    ChangeOf,
    ComponentScaled,
    DissipationScaled,
    Filtered,
    Polarity,
    Resampled,
    RestEnergy,
    ScaledRecord,
    Shifted,
    SizeScaled,
    SlendernessScaled,
    ToleranceScaled,
    TurnedRecord,
    WithoutVertical,
)
from stylobate.studies.shaking.fragility_study import FragilityStudy
from stylobate.studies.shaking.incremental import incremental_dynamic_analysis
from stylobate.studies.shaking.intensities import Intensity, SpectralAcceleration
from stylobate.studies.shaking.planar_bias import planar_bias
from stylobate.studies.shaking.property_spreads import (
    LognormalSpread,
    NormalSpread,
    Spread,
    UniformSpread,
    property_samples,
)
from stylobate.studies.shaking.robustness import robustness
from stylobate.studies.shaking.run_fragility import fragility_of_runs

__all__ = [
    "SMALL_CHANGES",
    "Change",
    "ChangeOf",
    "ComponentScaled",
    "DissipationScaled",
    "Filtered",
    "FragilityStudy",
    "Intensity",
    "LognormalSpread",
    "NormalSpread",
    "Polarity",
    "Resampled",
    "RestEnergy",
    "ScaledRecord",
    "Shifted",
    "SizeScaled",
    "SlendernessScaled",
    "SpectralAcceleration",
    "Spread",
    "ToleranceScaled",
    "TurnedRecord",
    "UniformSpread",
    "WithoutVertical",
    "fragility_of_runs",
    "incremental_dynamic_analysis",
    "planar_bias",
    "property_samples",
    "robustness",
]
