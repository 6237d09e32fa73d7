"""Recovery of equal time steps from times that were printed with few digits."""

from collections.abc import Iterator
from decimal import Decimal

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]

# Two missing samples can look like a rounded grid; three must lie at equal distances to within a sample.
_LEAST_EXCEPTIONS = 3
# Less frequent gaps of two steps are also missing samples, even at equal distances: buffers lose samples in this way.
_RARE = 0.05
# Tolerance for rounding of the differences, relative to the last printed digit.
_SLACK = 1e-6
_LONGEST_DECIMAL = 12
_HALVINGS = 60


def even_grid(times: Floats, step: float | None = None) -> tuple[float, float] | None:
    """Find the even grid whose rounded values are `times`.

    Parameters
    ----------
    times
        Times as printed, in order, at least two [s].
    step
        Required step of the grid [s]; None searches for the shortest decimal, or one over a whole number.

    Returns
    -------
    tuple
        First time and step [s], or None if no even grid lies within half a unit of the last digit of all times.

    Notes
    -----
    Without `step`, at least three steps must differ from the most frequent step: a single different step means a
    missing sample. If less than one step in twenty is at least twice the most frequent step, and none is shorter,
    samples are missing as well: rounding to the step itself has this effect only for unusual steps, such as 0.01002 s.
    """
    half = _last_digits(times) / 2.0
    places = np.arange(len(times))
    if step is None:
        steps, counts = np.unique(np.round(np.diff(times) / half.min()), return_counts=True)
        common = steps[np.argmax(counts)]
        exceptions, gaps = len(times) - 1 - counts.max(), counts[steps >= 2.0 * common].sum()
        missing = common > 0.0 and exceptions == gaps < _RARE * (len(times) - 1)
        if times[-1] <= times[0] or exceptions < _LEAST_EXCEPTIONS or missing:
            return None
    slack = _SLACK * float(half.max())
    for candidate in _simplest(_middle_step(times, half, places)) if step is None else (step,):
        first, last, _ = _gap(candidate, times, half, places)
        if first <= last + slack:
            start = float(times[0])
            return (start if first - slack <= start <= last + slack else (first + last) / 2.0), candidate
    return None


def _gap(step: float, times: Floats, half: Floats, places: npt.NDArray[np.int_]) -> tuple[float, float, int]:
    """Return the interval of first times of an even grid that agrees with all times, and the sign of the step error."""
    rest = times - step * places
    low, high = int(np.argmax(rest - half)), int(np.argmin(rest + half))
    return float(rest[low] - half[low]), float(rest[high] + half[high]), low - high


def _middle_step(times: Floats, half: Floats, places: npt.NDArray[np.int_]) -> float:
    """Return the step of the even grid closest to all times: the minimum of a convex function, by bisection."""
    mean = float(times[-1] - times[0]) / (len(times) - 1)
    reach = 2.0 * float(half.max()) / (len(times) - 1)
    low, high = max(0.0, mean - reach), mean + reach
    for _ in range(_HALVINGS):
        step = 0.5 * (low + high)
        side = _gap(step, times, half, places)[2]
        low, high = (step, high) if side > 0 else (low, step)
    return 0.5 * (low + high)


def _last_digits(times: Floats) -> Floats:
    """Return the unit of the last digit of each time [s]; later times reveal trailing zeros."""
    exponents = [min(0, int(Decimal(repr(time)).normalize().as_tuple().exponent)) for time in times.tolist()]
    return np.asarray(10.0 ** np.minimum.accumulate(exponents[::-1])[::-1].astype(float))


def _simplest(step: float) -> Iterator[float]:
    """Yield steps close to `step`, the simplest first: decimals, and a rate such as 128 Hz before 0.00781 s."""
    for digits in range(1, _LONGEST_DECIMAL):
        if short := float(f"{step:.{digits}g}"):
            yield short
        if digits == 2 and 0.0 < step < 1.0:  # noqa: PLR2004
            yield 1.0 / round(1.0 / step)
    yield step
