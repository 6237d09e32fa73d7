from . import (
    base_motions,
    config,
    conveying,
    earthquakes,
    errors,
    models,
    orbits,
    paper,
    plots,
    practice,
    records,
    results,
    studies,
    theory,
)
from .base_motions import BaseMotion, Harmonic, MachineRun, OneOf, Pulse, Record, SineSweep
from .column import Column, Profile
from .earthquakes import calibrate, verdict
from .engine import EventFunction, simulate, simulate_ensemble, with_parameters
from .errors import Interrupted, Outcome
from .models import Contact, Model, PlanarRocking, Rolling, Slender, SlenderRolling, Sliding, Wobbling
from .plots import animate, plot
from .quantities import Quantity
from .records import read_record, read_records, sample_record
from .results import Event, KnownOrbit, OutcomeRules, Run
from .studies import load

__version__: str

__all__ = [
    "BaseMotion",
    "Column",
    "Contact",
    "Event",
    "EventFunction",
    "Harmonic",
    "Interrupted",
    "KnownOrbit",
    "MachineRun",
    "Model",
    "OneOf",
    "Outcome",
    "OutcomeRules",
    "PlanarRocking",
    "Profile",
    "Pulse",
    "Quantity",
    "Record",
    "Rolling",
    "Run",
    "SineSweep",
    "Slender",
    "SlenderRolling",
    "Sliding",
    "Wobbling",
    "__version__",
    "animate",
    "base_motions",
    "calibrate",
    "config",
    "conveying",
    "earthquakes",
    "errors",
    "load",
    "models",
    "orbits",
    "paper",
    "plot",
    "plots",
    "practice",
    "read_record",
    "read_records",
    "records",
    "results",
    "sample_record",
    "simulate",
    "simulate_ensemble",
    "studies",
    "theory",
    "verdict",
    "with_parameters",
]
