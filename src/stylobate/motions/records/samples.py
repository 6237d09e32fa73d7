"""Records that come with the package."""

from importlib.resources import as_file, files

from stylobate.errors import ParameterError
from stylobate.motions.records.grouping import read_records
from stylobate.motions.records.record import Record

_FILES = {"el centro 1940": ("elcentro_1940_NS.dat.gz", "elcentro_1940_EW.dat.gz", "elcentro_1940_UP.dat.gz")}
_SOURCES = {
    "el centro 1940": (
        "Imperial Valley earthquake, 18 May 1940, El Centro terminal substation, corrected data (vibrationdata.com, "
        "after the U.S. strong-motion archives; public domain)"
    )
}


def sample_names() -> tuple[str, ...]:
    """Return the names of the records that come with the package."""
    return tuple(_FILES)


def sample_record(name: str = "el centro 1940") -> Record:
    """Return a record that comes with the package.

    Parameters
    ----------
    name
        "el centro 1940": the three components of the Imperial Valley earthquake of 18 May 1940 at El Centro, x north,
        y west, z up, 53.44 s at 0.02 s.

    Raises
    ------
    ParameterError
        If there is none of that name.

    Notes
    -----
    There are several digitizations of this record. The peaks of this one are 0.3487 g (north-south), 0.2141 g
    (east-west) and 0.2101 g (up); the version of textbooks with 0.319 g is another.

    Examples
    --------
    >>> sample_record("el centro 1940")
    Record('el centro 1940', 2674 samples every 0.02 s, x y z, peak 3.42 m/s², ...)
    """
    key = " ".join(name.lower().split()) if isinstance(name, str) else name
    if key not in _FILES:
        message = f"name must be one of {', '.join(map(repr, _FILES))}, got {name!r}"
        raise ParameterError(message)
    folder = files("stylobate.motions.records") / "data"
    with as_file(folder) as here:
        (record,) = read_records([here / file for file in _FILES[key]], units="g")
    return Record(samples=record.samples, step=record.step, name=key, provenance=(_SOURCES[key], *record.provenance))
