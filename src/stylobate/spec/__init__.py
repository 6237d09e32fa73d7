"""Descriptions: plain values, as in TOML and JSON, and the objects they stand for."""

from stylobate.spec.basin import BasinDescription
from stylobate.spec.drift import DriftDescription
from stylobate.spec.ladder import LadderDescription
from stylobate.spec.map import MapDescription
from stylobate.spec.response import ResponseDescription
from stylobate.spec.simulation import (
    Setup,
    SimulationDescription,
    description_of,
    provenance_of_run,
    read_description,
)

__all__ = [
    "BasinDescription",
    "DriftDescription",
    "LadderDescription",
    "MapDescription",
    "ResponseDescription",
    "Setup",
    "SimulationDescription",
    "description_of",
    "provenance_of_run",
    "read_description",
]
