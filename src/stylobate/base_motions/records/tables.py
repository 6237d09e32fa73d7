"""Text files of numbers: one column of accelerations, or time and acceleration."""

import numpy as np

from stylobate.base_motions.records.component import Component
from stylobate.base_motions.records.lines import REMARKS, Floats, Text
from stylobate.base_motions.records.rounded_times import even_grid
from stylobate.base_motions.records.units import SECOND, TimeUnit

# Tolerance of times that are printed with few digits, as a fraction of a step.
_TIME_SLACK = 0.02
_TIME_AND_ACCELERATION = 2


def read_table(text: Text, step: float | None) -> Component:
    """Read the component of a text file with one or two columns; comments begin with #, %, ! or //.

    Raises
    ------
    FileError
        If a token is no number, lines differ in length, times are not in equal steps, or a single column lacks `step`
        [s].
    """
    tokens = [(at, line.replace(",", " ").replace(";", " ").split()) for at, line in enumerate(text.lines)]
    tokens = [(at, row) for at, row in tokens if row and not row[0].startswith(REMARKS)]
    if not tokens:
        raise text.fault(len(text.lines) - 1, "the file has no numbers. Export it again")
    width = len(tokens[0][1])
    if width > _TIME_AND_ACCELERATION:
        text.rows(tokens[:1])
        what = "one (acceleration) or two (time, acceleration) are expected. Name them in the first line"
        raise text.fault(tokens[0][0], f"{width} columns: {what}")
    for at, row in tokens:
        if len(row) != width:
            text.rows([(at, row)])
            raise text.fault(at, f"{len(row)} columns, the lines before have {width}. Correct the line")
    values = text.rows(tokens)
    places = [at for at, _ in tokens]
    if width == 1:
        if step is None:
            raise text.fault(places[0], "a single column has no time step: state step, in s")
        _require_two(text, places)
        return Component(samples=values[:, 0], step=step, unit=None, states_time_unit=False)
    start, own = equal_steps(text, values[:, 0], places, step)
    return Component(samples=values[:, 1], step=own, start=start, unit=None, states_time_unit=False)


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
    _require_two(text, places)
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


def _require_two(text: Text, places: list[int]) -> None:
    if len(places) < 2:  # noqa: PLR2004  a step has two ends
        raise text.fault(
            places[-1] if places else len(text.lines) - 1, "the file is too short: one sample. Give two or more"
        )


def _as_printed(step: float) -> float:
    # A quotient of sums is 0.02 except for rounding; the intended step has few digits.
    short = float(f"{step:.9g}")
    return short if abs(short - step) <= 1e-9 * step else step
