"""Exact periodic orbits: found by shooting, followed over parameters, with their bifurcations."""

from stylobate.orbits.bifurcations import Bifurcation, Kind
from stylobate.orbits.branch import Branch, continue_branch
from stylobate.orbits.curves import BifurcationCurve, bifurcation_curve
from stylobate.orbits.finding import periodic_orbit, periodic_orbits
from stylobate.orbits.orbit import PeriodicOrbit
from stylobate.orbits.storage import load
from stylobate.orbits.switching import switch_branch
from stylobate.orbits.tracing import End, StepControl

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
    "load",
    "periodic_orbit",
    "periodic_orbits",
    "switch_branch",
]
