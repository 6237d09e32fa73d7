"""Base motions: the acceleration of the base against time."""

from stylobate.motions.base import BaseMotion
from stylobate.motions.combined import BASE_AT_REST, Delayed, Rotated, Scaled, Sum, as_harmonic
from stylobate.motions.harmonic import Harmonic
from stylobate.motions.one_of import OneOf
from stylobate.motions.pulses.pulse import Pulse
from stylobate.motions.records.record import Record
from stylobate.motions.sweeps import Sweep

__all__ = [
    "BASE_AT_REST",
    "BaseMotion",
    "Delayed",
    "Harmonic",
    "OneOf",
    "Pulse",
    "Record",
    "Rotated",
    "Scaled",
    "Sum",
    "Sweep",
    "as_harmonic",
]
