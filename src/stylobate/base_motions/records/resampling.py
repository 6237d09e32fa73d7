"""Band-limited resampling of a record to another step."""

from fractions import Fraction

import numpy as np
import numpy.typing as npt
from scipy.signal import resample_poly

from stylobate.errors import ParameterError, require_positive

_LARGEST_FACTOR = 1000
_RATIO_TOLERANCE = 1e-9


Floats = npt.NDArray[np.float64]


def resampled(samples: Floats, before: float, step: float) -> tuple[Floats, str]:
    """Resample `samples` from the step `before` to `step` [s]; return them and a log line, empty if both are equal.

    The result is band-limited: frequencies above the limit of the coarser step are removed.

    Raises
    ------
    ParameterError
        If the steps are not in a ratio of whole numbers up to 1000.

    Notes
    -----
    Polyphase resampling with SciPy's zero-phase low-pass filter (`scipy.signal.resample_poly`, Kaiser window β = 5,
    zeros beyond the ends). The motion between the old samples is no longer linear, so peaks may change slightly.
    """
    step = require_positive("step", step, "s")
    ratio = Fraction(before / step).limit_denominator(_LARGEST_FACTOR)
    up, down = ratio.numerator, ratio.denominator
    if not 0 < up <= _LARGEST_FACTOR or abs(before / step / float(ratio) - 1.0) > _RATIO_TOLERANCE:
        message = f"step must be in a ratio of whole numbers up to 1000 to {before!r} s, got {step!r} s"
        raise ParameterError(message)
    if up == down:
        return samples, ""
    note = f"resampled from {before!r} s to {step!r} s (polyphase {up}:{down}, anti-aliased)"
    return resample_poly(samples, up, down, axis=0), note
