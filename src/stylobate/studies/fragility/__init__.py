"""Statistics of fragility: how often a column reaches a limit state at an intensity, and how often in a year.

However the runs were made: what is needed is the intensity of each, whether it reached the limit state, and its record.
"""

from stylobate.studies.fragility.annual_rate import annual_rate
from stylobate.studies.fragility.bands import reached_bands
from stylobate.studies.fragility.curves import lognormal_fragility
from stylobate.studies.fragility.dispersion import Samples, dispersion_parts
from stylobate.studies.fragility.fit import fit_fragility
from stylobate.studies.fragility.hazard import HazardCurve
from stylobate.studies.fragility.limit_states import limit_states
from stylobate.studies.fragility.observations import Counting
from stylobate.studies.fragility.probit import FitStatus

__all__ = [
    "Counting",
    "FitStatus",
    "HazardCurve",
    "Samples",
    "annual_rate",
    "dispersion_parts",
    "fit_fragility",
    "limit_states",
    "lognormal_fragility",
    "reached_bands",
]
