"""Accelerations at equal steps, linear between them: exact integrals, filter, baseline correction, resampling."""

import math
from fractions import Fraction
from typing import Literal

import numpy as np
import numpy.typing as npt

from stylobate.errors import MOST_NUMBERS, ParameterError, require_positive, require_whole

Floats = npt.NDArray[np.float64]

# Length of the zeros around a record filtered in both directions: 1.5 times the order over the corner (Boore 2005).
_PAD = 1.5
# Largest whole number in a ratio of steps, and tolerance of the ratio.
_LARGEST_FACTOR = 1000
_RATIO_TOLERANCE = 1e-9


def samples_within_limit(argument: str, got: str, count: float, remedy: str) -> int:
    """Round a `count` of samples up.

    Parameters
    ----------
    argument, got
        Name of the argument that asks for so many samples, and its value with unit.
    count
        Number of samples that are needed.
    remedy
        Remedy in the message, as an imperative.

    Raises
    ------
    ParameterError
        If the count exceeds 10 million, which take 240 MB.
    """
    if count > MOST_NUMBERS.number:
        raise ParameterError(
            f"{argument}: {count:.3g} samples are needed, {MOST_NUMBERS.number:,} allowed (got {got}). {remedy}."
        )
    return math.ceil(count)


def integrals(samples: Floats, step: float) -> tuple[Floats, Floats]:
    """Compute velocity [m/s] and displacement [m] at the knots, both zero at the first knot.

    Parameters
    ----------
    samples
        Accelerations at the knots, shape (n, axes) [m/s²].
    step
        Time between knots [s].
    """
    left, right = samples[:-1], samples[1:]
    gain = 0.5 * step * (left + right)
    velocity = np.zeros_like(samples)
    np.cumsum(gain, axis=0, out=velocity[1:])
    displacement = np.zeros_like(samples)
    np.cumsum(step * velocity[:-1] + step**2 * (2.0 * left + right) / 6.0, axis=0, out=displacement[1:])
    return velocity, displacement


def energy(samples: Floats, step: float) -> Floats:
    """Compute ∫ a² dt of each component up to each knot, shape (n, axes) [m²/s³]."""
    left, right = samples[:-1], samples[1:]
    grown = np.zeros_like(samples)
    np.cumsum(step / 3.0 * (left**2 + left * right + right**2), axis=0, out=grown[1:])
    return grown


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
        If no corner is given, or they are not in order between 0 and half the sampling rate, or the zeros around the
        record are more than 10 million samples.

    Notes
    -----
    Filtering in both directions pads the record with zeros of 1.5·order/corner seconds (D. M. Boore, "On pads and
    filters", BSSA 95, 745-750, 2005) and removes the padding afterwards. To keep the filter's transients, which the
    displacement needs, pad the record first: `record.padded(before=…, after=…).filtered(…)`.
    """
    from scipy.signal import butter, sosfilt, sosfiltfilt

    order = require_whole("order", order, least=1)
    corners = {name: value for name, value in (("highpass", highpass), ("lowpass", lowpass)) if value is not None}
    if not corners:
        raise ParameterError("highpass or lowpass must be given [Hz]")
    nyquist = 0.5 / step
    for name, value in corners.items():
        if require_positive(name, value, "Hz") >= nyquist:
            raise ParameterError(f"{name} must be below half the sampling rate, {nyquist!r} Hz, got {value!r} Hz")
    edges = list(corners.values())
    if len(edges) > 1 and edges[0] >= edges[1]:
        raise ParameterError(f"highpass must be below lowpass = {edges[1]!r} Hz, got {edges[0]!r} Hz")
    if len(edges) > 1:
        sections = butter(order, edges, btype="bandpass", fs=1.0 / step, output="sos")
    else:
        one_sided: Literal["lowpass", "highpass"] = "lowpass" if highpass is None else "highpass"
        sections = butter(order, edges[0], btype=one_sided, fs=1.0 / step, output="sos")
    if causal:
        passed = sosfilt(sections, samples, axis=0)
    else:
        name = next(iter(corners))
        zeros = samples_within_limit(
            name, f"{edges[0]!r} Hz", _PAD * order / edges[0] / step, "Raise the corner, or filter with causal=True"
        )
        wide = np.pad(samples, ((zeros, zeros), (0, 0)))
        passed = sosfiltfilt(sections, wide, axis=0, padlen=0)[zeros : zeros + len(samples)]
    corners_text = ", ".join(f"{name} {value!r} Hz" for name, value in corners.items())
    way = "forwards only" if causal else "forwards and backwards"
    return passed, f"Butterworth {corners_text}, order {order}, {way}"


def baseline_corrected(samples: Floats, step: float, degree: int = 1) -> tuple[Floats, str]:
    """Subtract the derivative of a polynomial fitted to the velocity; return samples and a log line.

    Parameters
    ----------
    samples
        Accelerations, shape (n, 3) [m/s²].
    step
        Time step [s].
    degree
        Degree of the polynomial, 1 or more. The polynomial and the velocity are zero at the first sample; degree 1
        subtracts a constant from the acceleration.

    Notes
    -----
    Least squares over the velocities at the samples, for each component separately. The remaining velocity is small but
    not zero; a high-pass filter (`Record.filtered`) removes drift that is no polynomial.
    """
    degree = require_whole("degree", degree, least=1)
    time = np.linspace(0.0, 1.0, len(samples))[:, np.newaxis]
    powers = np.arange(1, degree + 1)
    velocity, _ = integrals(samples, step)
    fit, *_ = np.linalg.lstsq(time**powers, velocity, rcond=None)
    length = step * (len(samples) - 1)
    slope = (powers * time ** (powers - 1)) @ fit / length
    note = f"baseline: derivative of a polynomial of degree {degree} fitted to the velocity taken off"
    return samples - slope, note


def resampled(samples: Floats, before: float, step: float) -> tuple[Floats, str]:
    """Resample `samples` from the step `before` to `step` [s]; return them and a log line, empty if both are equal.

    The result is band-limited: frequencies above the limit of the coarser step are removed.

    Raises
    ------
    ParameterError
        If the steps are not in a ratio of whole numbers up to 1000, or the result has more than 10 million samples.

    Notes
    -----
    Polyphase resampling with SciPy's zero-phase low-pass filter (`scipy.signal.resample_poly`, Kaiser window β = 5,
    zeros beyond the ends). The motion between the old samples is no longer linear, so peaks may change slightly.
    """
    from scipy.signal import resample_poly

    step = require_positive("step", step, "s")
    ratio = Fraction(before / step).limit_denominator(_LARGEST_FACTOR)
    up, down = ratio.numerator, ratio.denominator
    if not 0 < up <= _LARGEST_FACTOR or abs(before / step / float(ratio) - 1.0) > _RATIO_TOLERANCE:
        raise ParameterError(f"step must be in a ratio of whole numbers up to 1000 to {before!r} s, got {step!r} s")
    if up == down:
        return samples, ""
    samples_within_limit(
        "step", f"{step!r} s", len(samples) * before / step, "Choose a longer step, or trim the record"
    )
    note = f"resampled from {before!r} s to {step!r} s (polyphase {up}:{down}, anti-aliased)"
    return resample_poly(samples, up, down, axis=0), note
