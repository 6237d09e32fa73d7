"""Statistics of fragility: probabilities of limit states over the intensity, and annual rates.

The functions accept runs of any origin: they need intensity, record and limit state of each run.
"""

from stylobate.earthquakes.fragility.annual_rate import HazardCurve, annual_rate
from stylobate.earthquakes.fragility.dispersion import SampleDesign, dispersion_parts
from stylobate.earthquakes.fragility.empirical_rate import empirical_rate
from stylobate.earthquakes.fragility.export import export_fragility
from stylobate.earthquakes.fragility.fit import fit_fragility, lognormal_fragility
from stylobate.earthquakes.fragility.likelihood import FitStatus
from stylobate.earthquakes.fragility.observations import Counting, limit_states, reached_intervals

__all__ = [
    "Counting",
    "FitStatus",
    "HazardCurve",
    "SampleDesign",
    "annual_rate",
    "dispersion_parts",
    "empirical_rate",
    "export_fragility",
    "fit_fragility",
    "limit_states",
    "lognormal_fragility",
    "reached_intervals",
]
