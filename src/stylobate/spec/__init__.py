"""Descriptions: plain values, as in TOML and JSON, and the objects they stand for."""

from stylobate.spec.assess import AssessDescription, AssessmentSetup
from stylobate.spec.basin import BasinDescription
from stylobate.spec.drift import DriftDescription
from stylobate.spec.fragility import FragilityDescription, FragilitySetup
from stylobate.spec.ladder import LadderDescription
from stylobate.spec.map import MapDescription
from stylobate.spec.record_collection import EventDescription, RecordsDescription
from stylobate.spec.record_files import relocated
from stylobate.spec.records import DescribedRecord, RecordMotion
from stylobate.spec.response import ResponseDescription
from stylobate.spec.simulation import (
    Setup,
    SimulationDescription,
    description_of,
    provenance_of_run,
    read_description,
)
from stylobate.spec.snippets import as_python, as_toml
from stylobate.spec.spectrum import SpectrumDescription

__all__ = [
    "AssessDescription",
    "AssessmentSetup",
    "BasinDescription",
    "DescribedRecord",
    "DriftDescription",
    "EventDescription",
    "FragilityDescription",
    "FragilitySetup",
    "LadderDescription",
    "MapDescription",
    "RecordMotion",
    "RecordsDescription",
    "ResponseDescription",
    "Setup",
    "SimulationDescription",
    "SpectrumDescription",
    "as_python",
    "as_toml",
    "description_of",
    "provenance_of_run",
    "read_description",
    "relocated",
]
