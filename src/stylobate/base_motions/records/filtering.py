"""Butterworth filters of records."""

import math

import numpy as np
from scipy.signal import butter, sosfilt, sosfiltfilt

from stylobate.base_motions.records.record import Floats, Record
from stylobate.errors import ParameterError, require_positive, require_whole

# Zeros beside a record filtered in both directions: 1.5 times the order over the corner (Boore 2005).
_PAD = 1.5


def filtered(
    record: Record, *, highpass: float | None = None, lowpass: float | None = None, order: int = 4, causal: bool = False
) -> Record:
    """Return `record` through a Butterworth filter.

    Parameters
    ----------
    record
        The record.
    highpass
        Corner below which motion is removed [Hz].
    lowpass
        Corner above which motion is removed [Hz].
    order
        Order of each flank.
    causal
        Whether to filter forwards only: no motion before its cause, but phases shift. Otherwise forwards and backwards:
        no shift, twice the order, a quarter of the power (−6 dB) at a corner.

    Raises
    ------
    ParameterError
        If no corner is given, or they are not in order between 0 and half the sampling rate.

    Notes
    -----
    Both-way filtering is done between zeros of 1.5·order/corner seconds (D. M. Boore, "On pads and filters", BSSA 95,
    745-750, 2005), then cut back to the length of the record. To keep the filter's transients, as displacement wants,
    pad the record first: `record.padded(before=…, after=…).filtered(…)`.
    """
    order = require_whole("order", order, least=1)
    corners = {name: value for name, value in (("highpass", highpass), ("lowpass", lowpass)) if value is not None}
    if not corners:
        message = "highpass or lowpass must be given [Hz]"
        raise ParameterError(message)
    nyquist = 0.5 / record.step
    for name, value in corners.items():
        if require_positive(name, value, "Hz") >= nyquist:
            message = f"{name} must be below half the sampling rate, {nyquist!r} Hz, got {value!r} Hz"
            raise ParameterError(message)
    edges = list(corners.values())
    if len(edges) > 1 and edges[0] >= edges[1]:
        message = f"highpass must be below lowpass = {edges[1]!r} Hz, got {edges[0]!r} Hz"
        raise ParameterError(message)
    sections = _sections(edges, order, lowest=highpass is None, rate=1.0 / record.step)
    if causal:
        samples = sosfilt(sections, record.samples, axis=0)
    else:
        zeros = math.ceil(_PAD * order / edges[0] / record.step)
        wide = np.pad(record.samples, ((zeros, zeros), (0, 0)))
        samples = sosfiltfilt(sections, wide, axis=0, padlen=0)[zeros : zeros + len(record.samples)]
    corners_text = ", ".join(f"{name} {value!r} Hz" for name, value in corners.items())
    way = "forwards only" if causal else "forwards and backwards"
    return record.changed(f"Butterworth {corners_text}, order {order}, {way}", samples=samples)


def _sections(edges: list[float], order: int, *, lowest: bool, rate: float) -> Floats:
    """Return the filter between two corners, or below (`lowest`) or above one, as second-order sections."""
    if len(edges) > 1:
        return butter(order, edges, btype="bandpass", fs=rate, output="sos")
    return butter(order, edges[0], btype="lowpass" if lowest else "highpass", fs=rate, output="sos")
