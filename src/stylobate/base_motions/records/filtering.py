"""Butterworth filters of records."""

import math

import numpy as np
import numpy.typing as npt
from scipy.signal import butter, sosfilt, sosfiltfilt

from stylobate.errors import ParameterError, require_positive, require_whole

Floats = npt.NDArray[np.float64]

# Length of the zeros around a record filtered in both directions: 1.5 times the order over the corner (Boore 2005).
_PAD = 1.5


def filtered(
    samples: Floats,
    step: float,
    *,
    highpass: float | None = None,
    lowpass: float | None = None,
    order: int = 4,
    causal: bool = False,
) -> tuple[Floats, str]:
    """Filter `samples` by a Butterworth filter; return the result and a log line.

    Parameters
    ----------
    samples
        Accelerations, shape (n, 3) [m/s²].
    step
        Time step [s].
    highpass
        Corner below which motion is removed [Hz].
    lowpass
        Corner above which motion is removed [Hz].
    order
        Order of each corner.
    causal
        Whether to filter forwards only: no motion before its cause, but a phase shift. Otherwise forwards and
        backwards: no phase shift, twice the order, a quarter of the power (−6 dB) at a corner.

    Raises
    ------
    ParameterError
        If no corner is given, or they are not in order between 0 and half the sampling rate.

    Notes
    -----
    Filtering in both directions pads the record with zeros of 1.5·order/corner seconds (D. M. Boore, "On pads and
    filters", BSSA 95, 745-750, 2005) and removes the padding afterwards. To keep the filter's transients, which the
    displacement needs, pad the record first: `record.padded(before=…, after=…).filtered(…)`.
    """
    order = require_whole("order", order, least=1)
    corners = {name: value for name, value in (("highpass", highpass), ("lowpass", lowpass)) if value is not None}
    if not corners:
        message = "highpass or lowpass must be given [Hz]"
        raise ParameterError(message)
    nyquist = 0.5 / step
    for name, value in corners.items():
        if require_positive(name, value, "Hz") >= nyquist:
            message = f"{name} must be below half the sampling rate, {nyquist!r} Hz, got {value!r} Hz"
            raise ParameterError(message)
    edges = list(corners.values())
    if len(edges) > 1 and edges[0] >= edges[1]:
        message = f"highpass must be below lowpass = {edges[1]!r} Hz, got {edges[0]!r} Hz"
        raise ParameterError(message)
    sections = _sections(edges, order, lowest=highpass is None, rate=1.0 / step)
    if causal:
        passed = sosfilt(sections, samples, axis=0)
    else:
        zeros = math.ceil(_PAD * order / edges[0] / step)
        wide = np.pad(samples, ((zeros, zeros), (0, 0)))
        passed = sosfiltfilt(sections, wide, axis=0, padlen=0)[zeros : zeros + len(samples)]
    corners_text = ", ".join(f"{name} {value!r} Hz" for name, value in corners.items())
    way = "forwards only" if causal else "forwards and backwards"
    return passed, f"Butterworth {corners_text}, order {order}, {way}"


def _sections(edges: list[float], order: int, *, lowest: bool, rate: float) -> Floats:
    """Design the band-pass between two corners, or low-pass (`lowest`) or high-pass, as second-order sections."""
    if len(edges) > 1:
        return butter(order, edges, btype="bandpass", fs=rate, output="sos")
    return butter(order, edges[0], btype="lowpass" if lowest else "highpass", fs=rate, output="sos")
