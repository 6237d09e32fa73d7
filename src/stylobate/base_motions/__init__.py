"""Base motions: acceleration of the base as a function of time."""

from stylobate.base_motions.combined import BASE_AT_REST, BaseMotion, OneOf, Sum
from stylobate.base_motions.harmonic import Harmonic
from stylobate.base_motions.machine_run import MachineRun
from stylobate.base_motions.pulses import Pulse
from stylobate.base_motions.record import Record
from stylobate.base_motions.sweeps import SineSweep

__all__ = [
    "BASE_AT_REST",
    "BaseMotion",
    "Harmonic",
    "MachineRun",
    "OneOf",
    "Pulse",
    "Record",
    "SineSweep",
    "Sum",
]
