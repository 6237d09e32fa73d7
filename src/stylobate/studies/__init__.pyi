from .hierarchy_study import model_hierarchy
from .loading import load
from .maps.attractor_search import AttractorRules
from .maps.attractors import attractors, label_attractors
from .maps.basin_fractions import basin_fractions
from .maps.basins import basins
from .maps.integrity import erosion, integrity
from .maps.outcome_differences import Comparison, outcome_differences
from .maps.overturning import overturning_map
from .maps.uncertainty_exponent import uncertainty_exponent
from .responses.after_bifurcation import after_bifurcation
from .responses.averaging_map import averaging_map
from .responses.exact_response import exact_response
from .responses.lyapunov import lyapunov_exponents
from .responses.poincare_sections import poincare_section
from .responses.response_curves import response_curves, steady_start
from .responses.slow_sweep import slow_sweep
from .responses.stability_boundary import stability_boundary
from .sweeps import Dask, Sweep, Threads, run_sweep

GRIDS: tuple[str, ...]

__all__ = [
    "AttractorRules",
    "Comparison",
    "Dask",
    "Sweep",
    "Threads",
    "after_bifurcation",
    "attractors",
    "averaging_map",
    "basin_fractions",
    "basins",
    "erosion",
    "exact_response",
    "integrity",
    "label_attractors",
    "load",
    "lyapunov_exponents",
    "model_hierarchy",
    "outcome_differences",
    "overturning_map",
    "poincare_section",
    "response_curves",
    "run_sweep",
    "slow_sweep",
    "stability_boundary",
    "steady_start",
    "uncertainty_exponent",
]
