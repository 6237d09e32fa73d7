"""What users ask: response curves, overturning maps, basins and their boundaries, sweeps, the source paper checked."""

from stylobate.studies.attractors import attractors, label_attractors
from stylobate.studies.averaged_motion import averaged_motion
from stylobate.studies.basin_fractions import basin_fractions
from stylobate.studies.basins import basins
from stylobate.studies.boundary import uncertainty_exponent
from stylobate.studies.integrity import erosion, integrity
from stylobate.studies.overturning import overturning_map
from stylobate.studies.paper import check_paper
from stylobate.studies.response_curves import response_curves
from stylobate.studies.starts import Start, steady_start
from stylobate.studies.strobes import AttractorRules
from stylobate.studies.sweeps import Dask, Sweep, Threads, executor_from, open_sweep, run_sweep

__all__ = [
    "AttractorRules",
    "Dask",
    "Start",
    "Sweep",
    "Threads",
    "attractors",
    "averaged_motion",
    "basin_fractions",
    "basins",
    "check_paper",
    "erosion",
    "executor_from",
    "integrity",
    "label_attractors",
    "open_sweep",
    "overturning_map",
    "response_curves",
    "run_sweep",
    "steady_start",
    "uncertainty_exponent",
]
