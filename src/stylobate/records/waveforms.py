"""Waveform files that ObsPy reads, such as miniSEED and SAC: the channels of stations, in m/s² by their responses.

ObsPy is never asked to find out what a file is: not all of its readers are made for files of strangers.
The first bytes decide, and the reader of that format gets the content, not a path.
"""

import io
import math
import re
import warnings
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from stylobate.errors import FileError, require_extra
from stylobate.records.agencies import Channel
from stylobate.records.contents import NoRecordError, is_binary, read_bytes, xml_root
from stylobate.records.databases import direction_of_channel
from stylobate.records.directions import Component, Direction

_ACCELERATION = ("M/S**2", "M/S2", "M/S/S", "M/(S**2)", "(M/S)/S")
_UP, _LEVEL = -90.0, 0.0
_MOST_TILTED = 5.0  # degrees by which a channel may differ from level or upright


class WaveformFormat(NamedTuple):
    """A format, and the module and function of ObsPy that read it from a stream of bytes.

    Each function was read before it was listed here: it computes, and it opens, imports and evaluates nothing.
    """

    name: str
    is_text: bool
    begins: Callable[[bytes], object]
    module: str
    function: str
    in_si: bool = False
    """Whether ObsPy's calibration is in m/s²."""


# A number of a record and the letter of its quality; the control header of a volume; a blank or zero.
_SEED = re.compile(rb"[0-9 \0]{6}(?:[DRQM][ \0]|V 010)")
_SAC_HEADER, _SAC_VERSION, _SAC_FLAG = 632, 304, 420
_SAC_VERSIONS, _SAC_FLAGS = (6, 7), (0, 1, -12345)


def _is_sac(content: bytes) -> bool:
    """Return whether the header has a version of SAC and four logical values, in either order of bytes."""
    if len(content) < _SAC_HEADER:
        return False
    version, flags = content[_SAC_VERSION : _SAC_VERSION + 4], content[_SAC_FLAG : _SAC_FLAG + 16]
    return any(
        np.frombuffer(version, order)[0] in _SAC_VERSIONS and np.isin(np.frombuffer(flags, order), _SAC_FLAGS).all()
        for order in ("<i4", ">i4")
    )


def _word(pattern: bytes) -> Callable[[bytes], object]:
    return re.compile(pattern).match


FORMATS = (
    WaveformFormat("miniSEED", False, _SEED.match, "obspy.io.mseed.core", "_read_mseed"),
    WaveformFormat("SAC", False, _is_sac, "obspy.io.sac.core", "_read_sac"),
    WaveformFormat("Kinemetrics EVT", False, _word(rb"K[\0\1]"), "obspy.io.kinemetrics.core", "read_evt"),
    WaveformFormat("K-NET", True, _word(rb"Origin Time"), "obspy.io.nied.knet", "_read_knet_ascii", in_si=True),
    WaveformFormat("GSE2", True, _word(rb"WID2 "), "obspy.io.gse2.core", "_read_gse2"),
    WaveformFormat("GSE1", True, _word(rb"(?:WID1|XW01) "), "obspy.io.gse2.core", "_read_gse1"),
    WaveformFormat("SLIST", True, _word(rb"TIMESERIES [^\n]{1,200}, SLIST,"), "obspy.io.ascii.core", "_read_slist"),
    WaveformFormat("TSPAIR", True, _word(rb"TIMESERIES [^\n]{1,200}, TSPAIR,"), "obspy.io.ascii.core", "_read_tspair"),
)
"""The formats that are read, with what their first bytes show."""


def waveform_format(content: bytes) -> WaveformFormat | None:
    """Return the format of which a file has the first bytes, or None."""
    is_text = not is_binary(content)
    return next((one for one in FORMATS if one.is_text == is_text and one.begins(content)), None)


def read_waveform(path: Path, content: bytes, response: Path | None = None) -> list[Channel]:
    """Read the channels in a waveform file with ObsPy.

    Parameters
    ----------
    path, content
        The file.
    response
        StationXML: its sensitivities convert counts to m/s², and its orientations are those of the channels. None takes
        the samples times the calibration in the header.

    Raises
    ------
    UnsupportedError
        If ObsPy is not installed.
    FileError
        If the format is not one of `FORMATS`, ObsPy cannot read the file, a channel has a gap, or its samples are raw
        counts without a response.
    """
    form = waveform_format(content)
    if form is None:
        listed = ", ".join(one.name for one in FORMATS)
        raise NoRecordError(
            f"{path}: neither a text nor a waveform of a known format ({listed}). Export the record as text or miniSEED"
        )
    inventory = None if response is None else _inventory(response)
    stations: dict[str, list[Any]] = {}
    for trace in _traces(path, content, form):
        stations.setdefault(_station(trace), []).append(trace)
    channels = []
    for station, traces in stations.items():
        _require_no_gaps(path, traces)
        begin = max(trace.stats.starttime for trace in traces)
        for trace in sorted(traces, key=lambda one: str(one.id)):
            component = _component(path, trace, begin, form, None if inventory is None else (response, inventory))
            channels.append(Channel(station, trace.id.strip(".") or path.name, component))
    if not channels:
        raise NoRecordError(f"{path}: the file holds no trace. Download it again")
    return channels


def _traces(path: Path, content: bytes, form: WaveformFormat) -> list[Any]:
    """Read the traces, with pieces that follow one another joined."""
    read = getattr(_obspy(form.module, path), form.function)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # ObsPy remarks on headers; what it cannot read raises an error
            stream = read(io.BytesIO(content))
            stream.merge(method=-1)
            traces = [_checked(trace) for trace in stream]
    except Exception as error:  # ObsPy's readers raise exceptions of any type
        raise NoRecordError(
            f"{path}: ObsPy cannot read it as {form.name}: its content is damaged. Download the file again, or export "
            "the record as text or miniSEED"
        ) from error
    return traces


def _checked(trace: Any) -> Any:
    """Return a trace, or raise ValueError if its samples or their step are no numbers."""
    if trace.data.dtype.kind not in "iuf" or not 0.0 < float(trace.stats.delta) < math.inf:
        raise ValueError(trace.id)
    return trace


def _obspy(module: str, path: Path) -> Any:
    remedy = 'To read it, install ObsPy: pip install "stylobate[records]"'
    return require_extra(module, f"{path}: a waveform or the StationXML of one. {remedy}")


_STATION_READER = "obspy.io.stationxml.core", "_read_stationxml"
_STATION_XML = "http://www.fdsn.org/xml/station/1 FDSNStationXML"


def _inventory(response: Path) -> Any:
    if not response.is_file():
        raise FileError(f"{response}: no response can be read: it is missing. Download the StationXML again")
    content = read_bytes(response)
    if xml_root(io.BytesIO(content)) != _STATION_XML:
        raise FileError(f"{response}: no StationXML: it does not begin with FDSNStationXML. Download the StationXML")
    read = getattr(_obspy(_STATION_READER[0], response), _STATION_READER[1])
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # ObsPy remarks on what it leaves out; then a response is missing below
            return read(io.BytesIO(content))
    except Exception as error:
        raise FileError(
            f"{response}: no response can be read: ObsPy finds no station in it. Download the StationXML again"
        ) from error


def _station(trace: Any) -> str:
    """Return network, station, location and instrument: what the channels of one event have in common."""
    return str(trace.id).strip(".")[:-1] if trace.stats.channel else str(trace.id).strip(".")


def _require_no_gaps(path: Path, traces: Iterable[Any]) -> None:
    """Raise FileError at the first gap in a channel."""
    last: dict[str, Any] = {}
    for trace in sorted(traces, key=lambda one: one.stats.starttime):
        before = last.setdefault(trace.id, trace)
        if before is not trace:
            gap = trace.stats.starttime - before.stats.endtime - before.stats.delta
            what = f"a gap of {gap:g} s" if gap > 0.0 else f"two pieces that overlap by {-gap:g} s"
            raise FileError(
                f"{path}: {trace.id} has {what} after {before.stats.endtime}. Fill it, or cut the record beside it"
            )
        if np.ma.is_masked(trace.data):
            raise FileError(
                f"{path}: {trace.id} has samples that are missing. Fill them, or cut the record beside them"
            )


def _component(
    path: Path, trace: Any, begin: Any, form: WaveformFormat, response: tuple[Path | None, Any] | None
) -> Component:
    stats = trace.stats
    first = round((begin - stats.starttime) / stats.delta)
    samples = np.asarray(trace.data, dtype=float)[first:] * float(stats.calib)
    if len(samples) < 2 or not np.all(np.isfinite(samples)):  # noqa: PLR2004  a step has two ends
        remedy = "Download the file again, or fill its gaps"
        raise FileError(f"{path}: {trace.id} must have at least two finite samples without gaps. {remedy}")
    direction = _direction(stats)
    if response is not None:
        sensitivity, stated = _response(path, trace, *response)
        samples, direction = np.asarray(trace.data, dtype=float)[first:] / sensitivity, stated or direction
    elif np.issubdtype(trace.data.dtype, np.integer) and float(stats.calib) == 1.0:
        raise FileError(
            f"{path}: {trace.id} has raw counts of a digitizer, no accelerations. State response, the StationXML of "
            "the station, or remove the response with ObsPy and write m/s² as floating-point numbers"
        )
    return Component(
        samples=samples,
        step=float(stats.delta),
        unit="m/s²" if response is not None or form.in_si else None,
        direction=direction,
        title=f"{trace.id} {begin}",
    )


def _response(path: Path, trace: Any, file: Path | None, inventory: Any) -> tuple[float, Direction | None]:
    """Return counts in 1 m/s², and the direction that the response states."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # ObsPy remarks on responses of which only the sensitivity counts here
            found = inventory.get_response(trace.id, trace.stats.starttime).instrument_sensitivity
            orientation = inventory.get_orientation(trace.id, trace.stats.starttime)
    except Exception as error:  # ObsPy raises a bare Exception
        raise FileError(
            f"{file}: no response of {trace.id} at {trace.stats.starttime}, in {path}. Download the StationXML of that "
            "channel and time"
        ) from error
    units = str(found.input_units).upper() if found is not None else "nothing"
    if found is None or units not in _ACCELERATION:
        raise FileError(
            f"{file}: {trace.id} responds to {units.lower()}, not to acceleration. Remove the response with ObsPy, "
            "differentiate if need be, and write m/s²"
        )
    value = found.value
    if value is None or not math.isfinite(value) or value == 0.0:
        stated = "no number" if value is None else f"{value:g}"
        raise FileError(
            f"{file}: the sensitivity of {trace.id} must be a finite number other than 0 (got {stated}). Download the "
            "StationXML again, or correct it"
        )
    return float(value), _oriented(orientation["azimuth"], orientation["dip"])


def _oriented(azimuth: float | None, dip: float | None) -> Direction | None:
    if azimuth is None or dip is None or not (math.isfinite(azimuth) and math.isfinite(dip)):
        return None
    if abs(abs(dip) + _UP) <= _MOST_TILTED:
        return Direction(vertical=1 if dip < 0.0 else -1)
    return Direction.of(float(azimuth)) if abs(dip - _LEVEL) <= _MOST_TILTED else None


def _direction(stats: Any) -> Direction | None:
    sac = stats.get("sac", {})
    if "cmpinc" in sac and math.isfinite(azimuth := float(sac.get("cmpaz", math.nan))):
        return Direction(vertical=1) if float(sac["cmpinc"]) == 0.0 else Direction.of(azimuth)
    return direction_of_channel(str(stats.channel))
