"""Text files of numbers: one column of accelerations, or time and acceleration."""

import numpy as np

from stylobate.motions.records.component import Component
from stylobate.motions.records.lines import Floats, Text

_REMARKS = ("#", "%", "!", "//")
# Times may be printed in a few digits: each may be this part of a step beside its place.
_TIME_SLACK = 0.02
_TIME_AND_ACCELERATION = 2


def read_table(text: Text, step: float | None) -> Component:
    """Return the component of a text file with one or two columns; remarks begin with #, %, ! or //.

    Raises
    ------
    FileError
        If a token is no number, lines differ in length, times are not in equal steps, or a single column comes
        without `step` [s].
    """
    tokens = [(at, line.replace(",", " ").replace(";", " ").split()) for at, line in enumerate(text.lines)]
    tokens = [(at, row) for at, row in tokens if row and not row[0].startswith(_REMARKS)]
    if not tokens:
        raise text.fault(len(text.lines) - 1, "the file has no numbers")
    width = len(tokens[0][1])
    for at, row in tokens:
        if len(row) != width:
            text.rows([(at, row)])
            raise text.fault(at, f"{len(row)} columns, the lines before have {width}")
    values = text.rows(tokens)
    if width > _TIME_AND_ACCELERATION:
        raise text.fault(tokens[0][0], f"{width} columns: one (acceleration) or two (time, acceleration) are wanted")
    places = [at for at, _ in tokens]
    if width == 1:
        if step is None:
            raise text.fault(places[0], "a single column tells no time step: state step, in s")
        _require_two(text, places)
        return Component(samples=values[:, 0], step=step, unit=None)
    start, own = equal_steps(text, values[:, 0], places, step)
    return Component(samples=values[:, 1], step=own, start=start, unit=None)


def equal_steps(text: Text, times: Floats, places: list[int], step: float | None) -> tuple[float, float]:
    """Return the first of equally spaced `times` and their step [s]; `step` is what somebody says it is, or None.

    `places` are the indices of their lines.

    Raises
    ------
    FileError
        If the steps are not equal, or not the one that was given.
    """
    _require_two(text, places)
    own = float(times[-1] - times[0]) / (len(times) - 1)
    typical = float(np.median(np.diff(times)))
    wrong = np.abs(np.diff(times) - typical) > _TIME_SLACK * abs(typical)
    if own <= 0.0 or typical <= 0.0 or np.any(wrong):
        first = int(np.argmax(wrong if np.any(wrong) else np.diff(times) <= 0.0)) + 1
        told = f"unequal time steps: {times[first - 1]:g} s to {times[first]:g} s among steps of {typical:g} s"
        raise text.fault(places[first], told)
    if step is not None and abs(own - step) > _TIME_SLACK * step:
        raise text.fault(places[1], f"the times are in steps of {own:g} s, not of the step given, {step:g} s")
    return float(times[0]), float(step if step is not None else _as_printed(own))


def _require_two(text: Text, places: list[int]) -> None:
    if len(places) < 2:  # noqa: PLR2004  a step has two ends
        raise text.fault(places[-1] if places else len(text.lines) - 1, "the file is too short: one sample")


def _as_printed(step: float) -> float:
    # A quotient of sums is 0.02 but for rounding; the step that was meant has few digits.
    short = float(f"{step:.9g}")
    return short if abs(short - step) <= 1e-9 * step else step
