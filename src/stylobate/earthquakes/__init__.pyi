from . import config
from .assessment.assess import assess
from .assessment.report import assessment_report, assessment_tables
from .figures.planar_bias import plot_directions
from .figures.records import plot_records
from .fragility.annual_rate import annual_rate
from .fragility.curves import lognormal_fragility
from .fragility.dispersion import Samples, dispersion_parts
from .fragility.fit import fit_fragility
from .fragility.hazard import HazardCurve
from .fragility.limit_states import limit_states
from .fragility.observations import Counting
from .fragility.probit import FitStatus
from .fragility.reached import reached_intervals
from .fragility_study import FragilityStudy
from .incremental import incremental_dynamic_analysis
from .intensities import Intensity, SpectralAcceleration
from .planar_comparison import planar_bias
from .property_spreads import (
    Choice,
    LognormalSpread,
    LogUniformSpread,
    NormalSpread,
    Spread,
    UniformSpread,
    property_samples,
)
from .run_fragility import fragility_of_runs
from .spectra.overturning import overturning_intervals
from .spectra.rocking import rocking_spectrum
from .variations import LABELS, VARIATIONS
from .verdict_study import repeat_verdict, verdict

__all__ = [
    "LABELS",
    "VARIATIONS",
    "Choice",
    "Counting",
    "FitStatus",
    "FragilityStudy",
    "HazardCurve",
    "Intensity",
    "LogUniformSpread",
    "LognormalSpread",
    "NormalSpread",
    "Samples",
    "SpectralAcceleration",
    "Spread",
    "UniformSpread",
    "annual_rate",
    "assess",
    "assessment_report",
    "assessment_tables",
    "config",
    "dispersion_parts",
    "fit_fragility",
    "fragility_of_runs",
    "incremental_dynamic_analysis",
    "limit_states",
    "lognormal_fragility",
    "overturning_intervals",
    "planar_bias",
    "plot_directions",
    "plot_records",
    "property_samples",
    "reached_intervals",
    "repeat_verdict",
    "rocking_spectrum",
    "verdict",
]
