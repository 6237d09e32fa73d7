from .arclength import BranchEnd, StepControl
from .bifurcations import Bifurcation, BifurcationKind
from .branch import Branch, continue_branch, switch_branch
from .curves import BifurcationCurve, bifurcation_curve
from .finding import periodic_orbit, periodic_orbits
from .orbit import PeriodicOrbit

__all__ = [
    "Bifurcation",
    "BifurcationCurve",
    "BifurcationKind",
    "Branch",
    "BranchEnd",
    "PeriodicOrbit",
    "StepControl",
    "bifurcation_curve",
    "continue_branch",
    "periodic_orbit",
    "periodic_orbits",
    "switch_branch",
]
