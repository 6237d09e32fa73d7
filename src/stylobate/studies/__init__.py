"""What users ask: response curves, overturning maps, basins and their boundaries, sweeps, the source paper checked."""

from stylobate.studies.assessment import assess
from stylobate.studies.attractors import attractors, label_attractors
from stylobate.studies.averaged_motion import averaged_motion
from stylobate.studies.averaging_map import averaging_map
from stylobate.studies.basin_fractions import basin_fractions
from stylobate.studies.basins import basins
from stylobate.studies.boundary import uncertainty_exponent
from stylobate.studies.contact_map import ContactClass, contact_classes, contact_map
from stylobate.studies.drift import drift
from stylobate.studies.exact_response import exact_response
from stylobate.studies.fate import fates
from stylobate.studies.fragility import (
    Counting,
    FitStatus,
    HazardCurve,
    Samples,
    annual_rate,
    dispersion_parts,
    fit_fragility,
    limit_states,
    lognormal_fragility,
    reached_bands,
)
from stylobate.studies.integrity import erosion, integrity
from stylobate.studies.ladder_outcomes import Comparison, outcome_differences
from stylobate.studies.ladder_study import ladder
from stylobate.studies.lyapunov import lyapunov_exponents
from stylobate.studies.overturning import overturning_map
from stylobate.studies.paper import check_paper
from stylobate.studies.response_curves import response_curves
from stylobate.studies.sections import poincare_section
from stylobate.studies.shaking import (
    SMALL_CHANGES,
    Change,
    ChangeOf,
    ComponentScaled,
    DissipationScaled,
    Filtered,
    FragilityStudy,
    Intensity,
    LognormalSpread,
    NormalSpread,
    Polarity,
    Resampled,
    RestEnergy,
    ScaledRecord,
    Shifted,
    SizeScaled,
    SlendernessScaled,
    SpectralAcceleration,
    Spread,
    ToleranceScaled,
    TurnedRecord,
    UniformSpread,
    WithoutVertical,
    fragility_of_runs,
    incremental_dynamic_analysis,
    planar_bias,
    property_samples,
    robustness,
)
from stylobate.studies.slipping_boundary import SteadyRolling, slipping_boundary
from stylobate.studies.slow_sweep import slow_sweep
from stylobate.studies.spectra import overturning_bands, rocking_spectrum
from stylobate.studies.stability_boundary import stability_boundary
from stylobate.studies.start_boundary import start_boundary
from stylobate.studies.starts import Start, TurningStart, steady_start
from stylobate.studies.strobes import AttractorRules
from stylobate.studies.sweeps import Dask, Sweep, Threads, executor_from, open_sweep, run_sweep

__all__ = [
    "SMALL_CHANGES",
    "AttractorRules",
    "Change",
    "ChangeOf",
    "Comparison",
    "ComponentScaled",
    "ContactClass",
    "Counting",
    "Dask",
    "DissipationScaled",
    "Filtered",
    "FitStatus",
    "FragilityStudy",
    "HazardCurve",
    "Intensity",
    "LognormalSpread",
    "NormalSpread",
    "Polarity",
    "Resampled",
    "RestEnergy",
    "Samples",
    "ScaledRecord",
    "Shifted",
    "SizeScaled",
    "SlendernessScaled",
    "SpectralAcceleration",
    "Spread",
    "Start",
    "SteadyRolling",
    "Sweep",
    "Threads",
    "ToleranceScaled",
    "TurnedRecord",
    "TurningStart",
    "UniformSpread",
    "WithoutVertical",
    "annual_rate",
    "assess",
    "attractors",
    "averaged_motion",
    "averaging_map",
    "basin_fractions",
    "basins",
    "check_paper",
    "contact_classes",
    "contact_map",
    "dispersion_parts",
    "drift",
    "erosion",
    "exact_response",
    "executor_from",
    "fates",
    "fit_fragility",
    "fragility_of_runs",
    "incremental_dynamic_analysis",
    "integrity",
    "label_attractors",
    "ladder",
    "limit_states",
    "lognormal_fragility",
    "lyapunov_exponents",
    "open_sweep",
    "outcome_differences",
    "overturning_bands",
    "overturning_map",
    "planar_bias",
    "poincare_section",
    "property_samples",
    "reached_bands",
    "response_curves",
    "robustness",
    "rocking_spectrum",
    "run_sweep",
    "slipping_boundary",
    "slow_sweep",
    "stability_boundary",
    "start_boundary",
    "steady_start",
    "uncertainty_exponent",
]
