"""Waveform files that ObsPy reads, such as miniSEED and SAC: the channels of stations, in m/s² by their responses."""

import io
import warnings
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from stylobate.errors import FileError, UnsupportedError
from stylobate.records.agencies import Channel
from stylobate.records.databases import direction_of_channel
from stylobate.records.directions import Component, Direction
from stylobate.records.text_files import NoRecordError

# ObsPy's calibration of these formats is in m/s².
_IN_SI = ("KNET",)
_ACCELERATION = ("M/S**2", "M/S2", "M/S/S", "M/(S**2)", "(M/S)/S")
_UP, _LEVEL = -90.0, 0.0
_MOST_TILTED = 5.0  # degrees by which a channel may differ from level or upright


def is_waveform(content: bytes) -> bool:
    """Return whether a text is one that ObsPy reads: K-NET; binary files are left to it anyway."""
    return content.startswith(b"Origin Time")


def read_waveform(path: Path, content: bytes, response: Path | None = None) -> list[Channel]:
    """Read the channels in a waveform file with ObsPy.

    Parameters
    ----------
    path, content
        The file.
    response
        StationXML, or another file of station metadata that ObsPy reads: its sensitivities convert counts to m/s², and
        its orientations are those of the channels. None takes the samples times the calibration in the header.

    Raises
    ------
    UnsupportedError
        If ObsPy is not installed.
    FileError
        If ObsPy cannot read a file, a channel has a gap, or its samples are raw counts without a response.
    """
    obspy = _obspy(path)
    try:
        stream = obspy.read(io.BytesIO(content))
    except Exception as error:  # ObsPy's readers raise exceptions of any type; their texts name temporary files
        raise NoRecordError(
            f"{path}: ObsPy cannot read it: its format is unknown or its content damaged. Download the file again, or "
            "export the record as text or miniSEED"
        ) from error
    stream.merge(method=-1)  # joins pieces that follow one another
    inventory = None if response is None else _inventory(obspy, response)
    stations: dict[str, list[Any]] = {}
    for trace in stream:
        stations.setdefault(_station(trace), []).append(trace)
    channels = []
    for station, traces in stations.items():
        _require_no_gaps(path, traces)
        begin = max(trace.stats.starttime for trace in traces)
        for trace in sorted(traces, key=lambda one: str(one.id)):
            component = _component(path, trace, begin, None if inventory is None else (response, inventory))
            channels.append(Channel(station, trace.id.strip(".") or path.name, component))
    if not channels:
        raise NoRecordError(f"{path}: the file holds no trace. Download it again")
    return channels


def _obspy(path: Path) -> Any:
    try:
        import obspy
    except ImportError:
        raise UnsupportedError(
            f'{path}: no text. To read a waveform such as miniSEED, install ObsPy: pip install "stylobate[records]"'
        ) from None
    return obspy


def _inventory(obspy: Any, response: Path) -> Any:
    try:
        return obspy.read_inventory(str(response))
    except Exception as error:
        reason = "it is missing" if not response.is_file() else "ObsPy finds no station in it"
        raise FileError(f"{response}: no response can be read: {reason}. Download the StationXML again") from error


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


def _component(path: Path, trace: Any, begin: Any, response: tuple[Path | None, Any] | None) -> Component:
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
        unit="m/s²" if response is not None or stats.get("_format") in _IN_SI else None,
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
    return float(found.value), _oriented(orientation["azimuth"], orientation["dip"])


def _oriented(azimuth: float | None, dip: float | None) -> Direction | None:
    if azimuth is None or dip is None:
        return None
    if abs(abs(dip) + _UP) <= _MOST_TILTED:
        return Direction(vertical=1 if dip < 0.0 else -1)
    return Direction.of(float(azimuth)) if abs(dip - _LEVEL) <= _MOST_TILTED else None


def _direction(stats: Any) -> Direction | None:
    sac = stats.get("sac", {})
    if "cmpaz" in sac and "cmpinc" in sac:
        if float(sac["cmpinc"]) == 0.0:
            return Direction(vertical=1)
        return Direction.of(float(sac["cmpaz"]))
    return direction_of_channel(str(stats.channel))
