"""Size limits: estimates of the size of a request's objects before they are built."""

import math
from collections.abc import Iterator, Mapping
from itertools import islice
from typing import Any

from stylobate.errors import LARGEST, SMALLEST, ParameterError
from stylobate.lab.limits import Limits
from stylobate.lab.uploads import Uploads
from stylobate.records.joining import sample_record
from stylobate.units import size_of, split

LEAST, MOST = SMALLEST, LARGEST
"""Minimum and maximum size of numbers other than zero."""

HIGHEST_DEGREE = 20
"""Maximum degree of filters and baselines, which are badly conditioned far below it."""

_SHOWN = 4
_LONGEST_NAME = 40


def number_of(value: object) -> float:
    """Return a plain value as a number if it is or spells one; else zero."""
    try:
        return float(value) if isinstance(value, (int, float, str)) else 0.0
    except ValueError:
        return 0.0
    except OverflowError:
        return math.inf


def problems_of_size(body: Mapping[str, Any], uploads: Uploads, limits: Limits) -> list[str]:
    """Return one line for each part of a description that is too large, and for each number of an unreasonable size.

    Raises
    ------
    RefusedError
        If the description names a missing upload.
    """
    problems = beyond_size(body)
    motions = list(islice(_motions(body), limits.motions + 1))
    if len(motions) > limits.motions:
        return [*problems, f"motion may combine {limits.motions} motions in the laboratory. Use Python for more."]
    problems += [line for motion in motions for line in (*_sweep(motion, limits), *_steps(motion))]
    if problems:
        return problems
    samples = sum(_samples(motion, uploads) for motion in motions)
    if samples > limits.record_samples:
        remedy = f"got {samples:.3g}. Shorten tail and padding, or take a larger step."
        problems.append(f"motion: records may have {limits.record_samples} samples together, {remedy}")
    return problems


def beyond_size(values: Mapping[str, Any]) -> list[str]:
    """Return one line for each of the first numbers, at any depth, whose size is unreasonable or that has a unit."""
    return list(islice(filter(None, (_problem(name, value) for name, value in _values(values))), _SHOWN))


def _problem(name: str, value: object) -> str:
    unit = split(value)[1] if isinstance(value, str) else ""
    if unit and size_of(unit) is not None:
        return f"{name}: the laboratory takes numbers in SI units (got {value!r}). Leave out the unit."
    number = number_of(value)
    if number == 0.0 or LEAST <= abs(number) <= MOST or math.isnan(number):  # NaN is refused later
        return ""
    return f"{name} must be zero or between {LEAST:g} and {MOST:g} in size, got {number!r}"


def _values(body: Mapping[str, Any]) -> Iterator[tuple[str, object]]:
    """Yield all values that are no tables and lists with their names, at any depth."""
    waiting: list[tuple[str, object]] = [("", body)]
    while waiting:
        name, value = waiting.pop()
        if isinstance(value, Mapping):
            waiting += [(f"{name}.{_shown(key)}" if name else _shown(key), one) for key, one in value.items()]
        elif isinstance(value, list):
            waiting += [(f"{name}.{place}", one) for place, one in enumerate(value)]
        else:
            yield name, value


def _shown(key: object) -> str:
    """Return a user's name on one line."""
    return repr(str(key)[:_LONGEST_NAME])[1:-1]


def _motions(body: Mapping[str, Any]) -> Iterator[Mapping[str, Any]]:
    """Yield the base motion and the motions that it combines."""
    waiting = [body.get("motion")]
    while waiting:
        motion = waiting.pop()
        if isinstance(motion, Mapping):
            yield motion
            members = motion.get("motions")
            waiting += [motion.get("motion"), *(members if isinstance(members, list) else ())]


def _sweep(motion: Mapping[str, Any], limits: Limits) -> list[str]:
    frequencies = motion.get("frequencies")
    if not isinstance(frequencies, list):
        return []
    cycles = max(map(number_of, frequencies), default=0.0) * number_of(motion.get("length"))
    if cycles <= limits.steps:
        return []
    return [f"motion: a sweep may have {limits.steps} cycles, got {cycles:.3g}. Shorten it or lower its frequencies."]


def _steps(motion: Mapping[str, Any]) -> list[str]:
    """Return a line for each step of processing with too high a degree."""
    return [
        f"motion.processing: {name} may be at most {HIGHEST_DEGREE}, got {step[name]!r}. Filters usually have 4."
        for step in _processing(motion)
        for name in ("order", "degree")
        if number_of(step.get(name)) > HIGHEST_DEGREE
    ]


def _processing(motion: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    steps = motion.get("processing")
    return [step for step in steps if isinstance(step, Mapping)] if isinstance(steps, list) else []


def _samples(motion: Mapping[str, Any], uploads: Uploads) -> float:
    """Return the maximum number of samples of a record during its processing; zero for another motion."""
    if motion.get("kind") != "record":
        return 0.0
    samples, step = _as_read(motion, uploads)
    most = samples
    for one in (*_processing(motion), {"method": "with_tail", "length": motion.get("tail")}):
        if step <= 0.0:
            break
        more, step = _after(one, samples, step)
        most = max(most, more)
        samples = samples if one.get("method") == "filtered" else more
    return most


def _as_read(motion: Mapping[str, Any], uploads: Uploads) -> tuple[float, float]:
    """Return number and step [s] of the samples of a record before processing."""
    if "upload" in motion:
        found = uploads[motion["upload"]]
        return found.samples, number_of(motion.get("step")) or found.step
    name = motion.get("sample")
    if not isinstance(name, str):
        return 0.0, 0.0
    try:
        sample = sample_record(name)
    except ParameterError:
        return 0.0, 0.0
    return len(sample.samples), sample.step


def _after(one: Mapping[str, Any], samples: float, step: float) -> tuple[float, float]:
    """Return number and step [s] of the samples in (a filter) or after one step of processing."""
    of = {
        name: number_of(one.get(name)) for name in ("before", "after", "length", "step", "order", "highpass", "lowpass")
    }
    match one.get("method"):
        case "padded" | "with_tail":
            return samples + (of["before"] + of["after"] + of["length"]) / step, step
        case "resampled" if of["step"] > 0.0:
            return samples * step / of["step"], of["step"]
        case "filtered":
            corner = of["highpass"] or of["lowpass"]
            return samples + (3.0 * (of["order"] or 4.0) / corner / step if corner > 0.0 else 0.0), step
    return samples, step
