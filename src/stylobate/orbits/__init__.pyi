from .arclength import End, StepControl
from .bifurcations import Bifurcation, Kind
from .branch import Branch, continue_branch, switch_branch
from .curves import BifurcationCurve, bifurcation_curve
from .finding import periodic_orbit, periodic_orbits
from .orbit import PeriodicOrbit

__all__ = [
    "Bifurcation",
    "BifurcationCurve",
    "Branch",
    "End",
    "Kind",
    "PeriodicOrbit",
    "StepControl",
    "bifurcation_curve",
    "continue_branch",
    "periodic_orbit",
    "periodic_orbits",
    "switch_branch",
]
