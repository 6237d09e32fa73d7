from .directions import Direction
from .intensities import (
    HorizontalComponent,
    arias_intensity,
    cumulative_absolute_velocity,
    intensity_measures,
    rocking_measures,
    significant_duration,
)
from .joining import Lengths, Steps, read_records, sample_record
from .reading import RecordFormat, read_record, write_at2, write_csv
from .spectra import oscillator_response, response_spectra
from .synthesis import CloughPenzien, EvolvingNoise, random_vibration

__all__ = [
    "CloughPenzien",
    "Direction",
    "EvolvingNoise",
    "HorizontalComponent",
    "Lengths",
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
