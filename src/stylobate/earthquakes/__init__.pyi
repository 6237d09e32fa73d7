from .assessment.assess import assess
from .assessment.report import assessment_report, assessment_tables
from .calibration import Calibration, calibrate, reliability, scores
from .config.assess import AssessConfig
from .config.inventory import InventoryConfig
from .figures.incremental import plot_directions
from .figures.spectra import plot_records
from .fragility.annual_rate import HazardCurve, annual_rate
from .fragility.dispersion import SampleDesign, dispersion_parts
from .fragility.displacement_limits import LimitState
from .fragility.empirical_rate import empirical_rate
from .fragility.export import export_fragility
from .fragility.fit import fit_fragility, fragility_of_runs, lognormal_fragility
from .fragility.likelihood import FitStatus
from .fragility.observations import Counting, limit_states, reached_intervals
from .incremental import incremental_dynamic_analysis
from .intensities import SpectralAcceleration
from .intensity_comparison import compare_intensities
from .inventories.export import export_inventory
from .inventories.objects import InventoryObject, InventorySite
from .inventories.study import inventory
from .inventories.table import read_inventory
from .planar_comparison import planar_bias
from .practice_study import compare_rules
from .property_spreads import (
    Choice,
    LognormalSpread,
    LogUniformSpread,
    NormalSpread,
    UniformSpread,
    inertia_spreads,
    property_samples,
)
from .record_selection import select_records
from .slip_paths import slip_paths
from .slip_study import slip_analysis
from .spectrum_study import overturning_intervals, rocking_spectrum
from .verdict_study import repeat_verdict, verdict

__all__ = [
    "AssessConfig",
    "Calibration",
    "Choice",
    "Counting",
    "FitStatus",
    "HazardCurve",
    "InventoryConfig",
    "InventoryObject",
    "InventorySite",
    "LimitState",
    "LogUniformSpread",
    "LognormalSpread",
    "NormalSpread",
    "SampleDesign",
    "SpectralAcceleration",
    "UniformSpread",
    "annual_rate",
    "assess",
    "assessment_report",
    "assessment_tables",
    "calibrate",
    "compare_intensities",
    "compare_rules",
    "dispersion_parts",
    "empirical_rate",
    "export_fragility",
    "export_inventory",
    "fit_fragility",
    "fragility_of_runs",
    "incremental_dynamic_analysis",
    "inertia_spreads",
    "inventory",
    "limit_states",
    "lognormal_fragility",
    "overturning_intervals",
    "planar_bias",
    "plot_directions",
    "plot_records",
    "property_samples",
    "reached_intervals",
    "read_inventory",
    "reliability",
    "repeat_verdict",
    "rocking_spectrum",
    "scores",
    "select_records",
    "slip_analysis",
    "slip_paths",
    "verdict",
]
