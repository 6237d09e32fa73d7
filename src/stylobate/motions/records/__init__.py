"""Records: base motions given by accelerations at equal steps, read from files, processed, measured, synthesized.

Names are imported when they are first used: only `Record` comes without SciPy and xarray.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from stylobate.motions.records.record import Record

if TYPE_CHECKING:
    from stylobate.motions.records.component import Direction
    from stylobate.motions.records.evolving_noise import EvolvingNoise
    from stylobate.motions.records.grouping import Lengths, Steps, read_records
    from stylobate.motions.records.horizontal_components import HorizontalComponent
    from stylobate.motions.records.intensity import (
        arias_intensity,
        cumulative_absolute_velocity,
        intensity_measures,
        rocking_measures,
        significant_duration,
    )
    from stylobate.motions.records.oscillator import oscillator_response
    from stylobate.motions.records.reading import RecordFormat, read_record
    from stylobate.motions.records.samples import sample_record
    from stylobate.motions.records.spectra import response_spectra
    from stylobate.motions.records.spectral_representation import CloughPenzien, random_vibration
    from stylobate.motions.records.writing import write_at2, write_csv

__all__ = [
    "CloughPenzien",
    "Direction",
    "EvolvingNoise",
    "HorizontalComponent",
    "Lengths",
    "Record",
    "RecordFormat",
    "Steps",
    "arias_intensity",
    "cumulative_absolute_velocity",
    "intensity_measures",
    "oscillator_response",
    "random_vibration",
    "read_record",
    "read_records",
    "response_spectra",
    "rocking_measures",
    "sample_record",
    "significant_duration",
    "write_at2",
    "write_csv",
]

_HOMES = {
    "CloughPenzien": "spectral_representation",
    "Direction": "component",
    "EvolvingNoise": "evolving_noise",
    "HorizontalComponent": "horizontal_components",
    "Lengths": "grouping",
    "RecordFormat": "reading",
    "Steps": "grouping",
    "arias_intensity": "intensity",
    "cumulative_absolute_velocity": "intensity",
    "intensity_measures": "intensity",
    "oscillator_response": "oscillator",
    "random_vibration": "spectral_representation",
    "read_record": "reading",
    "read_records": "grouping",
    "response_spectra": "spectra",
    "rocking_measures": "intensity",
    "sample_record": "samples",
    "significant_duration": "intensity",
    "write_at2": "writing",
    "write_csv": "writing",
}


def __getattr__(name: str) -> Any:
    if name in _HOMES:
        return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
    message = f"module {__name__!r} has no attribute {name!r}"
    raise AttributeError(message)


def __dir__() -> list[str]:
    return sorted(__all__)
