from .component import Direction
from .evolving_noise import EvolvingNoise
from .grouping import Lengths, Steps, read_records
from .horizontal_components import HorizontalComponent
from .intensity import (
    arias_intensity,
    cumulative_absolute_velocity,
    intensity_measures,
    rocking_measures,
    significant_duration,
)
from .oscillator import oscillator_response
from .reading import RecordFormat, read_record
from .record import Record
from .samples import sample_record
from .spectra import response_spectra
from .spectral_representation import CloughPenzien, random_vibration
from .writing import write_at2, write_csv

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
