"""Waveform formats read by ObsPy if installed: miniSEED, SAC, K-NET and others."""

import io
from pathlib import Path
from typing import Any

import numpy as np

from stylobate.base_motions.records.asc import direction_of_channel
from stylobate.base_motions.records.component import Component, Direction
from stylobate.errors import FileError, UnsupportedError

# ObsPy's calibration of these formats is in m/s².
_IN_SI = ("KNET",)


def read_waveform(path: Path, content: bytes) -> Component:
    """Read the component in a waveform file with ObsPy.

    Raises
    ------
    UnsupportedError
        If ObsPy is not installed.
    FileError
        If ObsPy cannot read the file, or the file holds no trace or several.

    Notes
    -----
    Samples are counts times the calibration in the header (`trace.stats.calib`); the instrument's response is not
    removed.
    """
    try:
        import obspy
    except ImportError:
        message = (
            f'{path}: no text. To read a waveform such as miniSEED, install ObsPy: pip install "stylobate[records]"'
        )
        raise UnsupportedError(message) from None
    try:
        stream = obspy.read(io.BytesIO(content))
    except Exception as error:  # ObsPy's readers raise exceptions of any type; their texts name temporary files
        message = (
            f"{path}: ObsPy cannot read it: its format is unknown or its content damaged. Download the file again, or "
            "export the record as text or miniSEED"
        )
        raise FileError(message) from error
    if len(stream) != 1:
        remedy = "Write each trace to a file of its own, and fill its gaps"
        message = f"{path}: the file must hold one trace without gaps, got {len(stream)} traces. {remedy}"
        raise FileError(message)
    (trace,) = stream
    stats = trace.stats
    samples = np.ma.filled(np.ma.asarray(trace.data, dtype=float), np.nan) * float(stats.calib)
    if len(samples) < 2 or not np.all(np.isfinite(samples)):  # noqa: PLR2004  a step has two ends
        remedy = "Download the file again, or fill its gaps"
        message = f"{path}: the trace must have at least two finite samples without gaps. {remedy}"
        raise FileError(message)
    return Component(
        samples=samples,
        step=float(stats.delta),
        unit="m/s²" if stats.get("_format") in _IN_SI else None,
        direction=_direction(stats),
        title=f"{trace.id} {stats.starttime}",
    )


def _direction(stats: Any) -> Direction | None:
    sac = stats.get("sac", {})
    if "cmpaz" in sac and "cmpinc" in sac:
        if float(sac["cmpinc"]) == 0.0:
            return Direction(vertical=1)
        return Direction.of(float(sac["cmpaz"]))
    channel = str(stats.channel)
    return direction_of_channel(channel)
