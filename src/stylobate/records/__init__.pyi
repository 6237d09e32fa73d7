from .intensities import (
    intensity_measures,
    rocking_measures,
)
from .intensity_table import intensity_table
from .joining import Lengths, Steps, read_record, read_records, sample_record
from .reading import RecordFormat, write_at2, write_csv
from .spectra import response_spectra
from .synthesis import CloughPenzien, EvolvingNoise, random_vibration

__all__ = [
    "CloughPenzien",
    "EvolvingNoise",
    "Lengths",
    "RecordFormat",
    "Steps",
    "intensity_measures",
    "intensity_table",
    "random_vibration",
    "read_record",
    "read_records",
    "response_spectra",
    "rocking_measures",
    "sample_record",
    "write_at2",
    "write_csv",
]
