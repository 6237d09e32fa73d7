"""Sample records of the package."""

from dataclasses import replace
from functools import cache
from importlib.resources import as_file, files

from stylobate.base_motions.records.grouping import read_records
from stylobate.base_motions.records.origin import RecordOrigin
from stylobate.base_motions.records.record import Record
from stylobate.errors import ParameterError
from stylobate.text import did_you_mean

_FILES = ("elcentro_1940_NS.dat.gz", "elcentro_1940_EW.dat.gz", "elcentro_1940_UP.dat.gz")
_SOURCE = (
    "Imperial Valley earthquake, 18 May 1940, El Centro terminal substation, corrected data (vibrationdata.com, "
    "after the U.S. strong-motion archives; public domain)"
)
_EL_CENTRO, _WITHOUT_DRIFT = "el centro 1940", "el centro 1940 corrected"
# Rest before and after [s] for the transients of the filter; corner [Hz] and order of the filter.
_REST, _CORNER, _ORDER = 20.0, 0.1, 2


def sample_names() -> tuple[str, ...]:
    """Return the names of the sample records of the package."""
    return _EL_CENTRO, _WITHOUT_DRIFT


def sample_record(name: str = "el centro 1940") -> Record:
    """Load a sample record of the package.

    Parameters
    ----------
    name
        "el centro 1940": the three components of the Imperial Valley earthquake of 18 May 1940 at El Centro, x north,
        y west, z up, 53.46 s at 0.02 s. "el centro 1940 corrected": the same without its drift, between 20 s of rest.

    Raises
    ------
    ParameterError
        If the name is unknown.

    Notes
    -----
    Several digitizations of this record exist. The peaks of this version are 0.3487 g (north-south), 0.2141 g
    (east-west) and 0.2101 g (up); textbooks use another version with 0.319 g.

    The published record drifts: integration moves the ground by 6.3 m along y and leaves a velocity of 0.11 m/s. The
    drift does not affect the column, but PGV, PGD and figures. The corrected record is the published record after
    `padded(before=20.0, after=20.0).filtered(highpass=0.1, order=2)`; its peak accelerations differ by less than 0.5 %.

    Examples
    --------
    >>> sample_record("el centro 1940")
    Record('el centro 1940', 2674 samples every 0.02 s, x y z, peak 3.42 m/s², ...)
    """
    key = " ".join(name.lower().split()) if isinstance(name, str) else name
    if key not in sample_names():
        question = did_you_mean(str(key), sample_names())
        message = f"name must be one of {', '.join(map(repr, sample_names()))}, got {name!r}"
        message += f"; {question}" if question else ""
        raise ParameterError(message)
    return _read(key)


@cache
def _read(key: str) -> Record:
    folder = files("stylobate.base_motions.records") / "data"
    with as_file(folder) as here:
        (record,) = read_records([here / file for file in _FILES], units="g")
    record = replace(record, name=key, provenance=(_SOURCE, *record.provenance))
    if key == _WITHOUT_DRIFT:
        record = record.padded(before=_REST, after=_REST).filtered(highpass=_CORNER, order=_ORDER)
    return replace(record, origin=RecordOrigin({"sample": key}))
