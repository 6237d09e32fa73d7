"""Equal time steps of a column of times, also of times that were printed with few digits."""

from collections.abc import Iterator
from decimal import Decimal

import numpy as np
import numpy.typing as npt

from stylobate.base_motions.signal_processing import Floats
from stylobate.records.text_files import SECOND, Text, TimeUnit

# Tolerance of times that are printed with few digits, as a fraction of a step.
_TIME_SLACK = 0.02
# Two missing samples can look like a rounded grid; three must lie at equal distances to within a sample.
_LEAST_EXCEPTIONS = 3
# Less frequent gaps of two steps are also missing samples, even at equal distances: buffers lose samples in this way.
_RARE = 0.05
# Tolerance for rounding of the differences, relative to the last printed digit.
_SLACK = 1e-6
_LONGEST_DECIMAL = 12
_HALVINGS = 60


def equal_steps(
    text: Text, times: Floats, places: list[int], step: float | None, unit: TimeUnit = SECOND
) -> tuple[float, float]:
    """Return first time and step [s] of equally spaced `times` in `unit`; `step` [s] is the given step, or None.

    The times may be rounded to the printed digits. `places` are the indices of their lines.

    Raises
    ------
    FileError
        If the steps are not equal, or differ from the given step.
    """
    require_two(text, places)
    own = float(times[-1] - times[0]) / (len(times) - 1)
    steps = np.diff(times)
    typical = float(np.median(steps))
    wrong = np.abs(steps - typical) > _TIME_SLACK * abs(typical)
    if own <= 0.0 or typical <= 0.0 or np.any(wrong):
        start, own = _rounded(text, times, places, None if step is None else step / unit.seconds, unit)
    elif step is not None and abs(own * unit.seconds - step) > _TIME_SLACK * step:
        problem = f"the times are in steps of {own:g} {unit.symbol}, not of the step given, {step:g} s"
        raise text.fault(places[1], f"{problem}. Correct step, or leave it out")
    else:
        start, own = float(times[0]), _as_printed(own)
    return unit.in_seconds(start), float(step if step is not None else unit.in_seconds(own))


def _rounded(text: Text, times: Floats, places: list[int], step: float | None, unit: TimeUnit) -> tuple[float, float]:
    """Return first time and step of unequal times that may be rounded from equal steps, all in `unit`."""
    if (grid := even_grid(times, step)) is not None:
        return grid
    steps = np.diff(times)
    common = float(np.median(steps))
    wrong = np.abs(steps - common) > _TIME_SLACK * common if common > 0.0 else steps <= 0.0
    first = int(np.argmax(wrong))
    problem = f"unequal time steps: {times[first]:g} {unit.symbol} to {times[first + 1]:g} {unit.symbol}"
    problem += f" is {steps[first]:.3g} {unit.symbol}"
    problem += f", most are {common:.3g} {unit.symbol}" if common > 0.0 else ""
    remedy = "Resample the file" + (", or state step, in s, if its times are rounded" if step is None else "")
    raise text.fault(places[first + 1], f"{problem}. {remedy}")


def require_two(text: Text, places: list[int]) -> None:
    """Raise FileError if a table has fewer than two rows, whose line indices are `places`."""
    if len(places) < 2:  # noqa: PLR2004  a step has two ends
        raise text.fault(
            places[-1] if places else len(text.lines) - 1, "the file is too short: one sample. Give two or more"
        )


def _as_printed(step: float) -> float:
    # A quotient of sums is 0.02 except for rounding; the intended step has few digits.
    short = float(f"{step:.9g}")
    return short if abs(short - step) <= 1e-9 * step else step


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
