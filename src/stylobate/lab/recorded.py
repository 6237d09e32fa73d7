"""Recorded answers: what the page asks when a preset or a lesson is opened, with the answers of this package.

A page without a server shows these answers. The bodies of the questions are those of `web/src/page/server/requests.ts`.
"""

import json
import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from stylobate import config
from stylobate.base_motions import Harmonic
from stylobate.base_motions.declared import kinds_by_acceleration, kinds_with_response
from stylobate.config.simulation import Setup
from stylobate.errors import StylobateError
from stylobate.lab import answers
from stylobate.lab.curves import exact_curves, response, start
from stylobate.lab.grids import OFF_BRANCH
from stylobate.lab.kernels import program_of
from stylobate.lab.messages import Message
from stylobate.lab.options import lessons, presets
from stylobate.lab.requests import Description
from stylobate.lab.tasks import run
from stylobate.lab.variations import variations

AT_ONCE = ("start", "simulate", "response")
"""What the page asks when a case is opened; it asks the other questions at a click."""


@dataclass(frozen=True, slots=True)
class Question:
    """A question of the page.

    Attributes
    ----------
    ask
        What is asked: a task of the server, or a kind of job.
    values
        The plain values that are sent.
    name
        Name of the answer, after the first case that asks.
    """

    ask: str
    values: Mapping[str, Any]
    name: str


@dataclass(frozen=True, slots=True)
class Case:
    """A case that opens at a click: a preset, a lesson, or one of the choices of a lesson.

    Attributes
    ----------
    identity
        Identity of the preset or lesson.
    values
        Its description.
    branch
        Branch of steady rolling on which it starts, if the description has no initial condition.
    """

    identity: str
    values: Mapping[str, Any]
    branch: str | None = None


def cases() -> Iterator[Case]:
    """Yield the cases that the page opens at a click, first the lessons."""
    for lesson in lessons():
        yield _case(lesson)
        for number, choice in enumerate(lesson.control.options or ()):
            yield Case(f"{lesson.identity}-{number + 1}", {**lesson.description, **choice.change})
    for preset in presets():
        yield _case(preset)


def _case(listed: answers.Preset | answers.Lesson) -> Case:
    branch = None if "tilt" in listed.description else listed.view.get("start")
    return Case(listed.identity, listed.description, branch)


def questions() -> Iterator[Question]:
    """Yield each question that the page asks about its cases, once."""
    known = set()
    for case in cases():
        for one in _asked_of(case):
            text = json.dumps([one.ask, one.values], sort_keys=True)
            if text not in known:
                known.add(text)
                yield one


def _asked_of(case: Case) -> Iterator[Question]:
    def asked(ask: str, values: Mapping[str, Any]) -> Question:
        return Question(ask, values, f"{ask}-{case.identity}")

    values = dict(case.values)
    parts = {name: values[name] for name in ("column", "model", "motion")}
    if case.branch is not None:
        from_branch = {**parts, "branch": case.branch}
        yield asked("start", from_branch)
        values |= _off_branch(start(from_branch, _unheard))
    if program_of(values) is None:  # else the page computes it
        yield asked("simulate", values)
    yield asked("variations", values)
    setup = config.SimulationConfig.parse(values).build()
    if _responds(setup, values["motion"]):
        exact = {
            "column": values["column"],
            "model": values["model"],
            "motion": _without_frequency(values["motion"]),
            "angular_frequency_range": _usual_range(setup),
        }
        slender = {"kind": "slender", "damping": values["model"].get("damping", 0)}
        yield asked("response", {**exact, "model": slender, "points": POINTS})
        yield asked("exact", {"description": exact})


def _off_branch(begun: answers.Start) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(begun.as_json())
    del found["warnings"]
    return {**found, "tilt": [one * (1.0 + OFF_BRANCH) for one in found["tilt"]]}


# What the page asks about the response

POINTS = 400
"""Points of a response curve, about one to a pixel."""
RANGE = (0.2, 3.5)
"""Ends of the range of frequencies of a response curve, over the frequency scale of the column."""
BEYOND = 1.2
"""The range also includes the frequency of the case, and goes beyond it by this factor."""


def _responds(setup: Setup, motion: Mapping[str, Any]) -> bool:
    """Return whether the page draws response curves of a motion."""
    return (
        motion["kind"] in kinds_with_response() and isinstance(setup.motion, Harmonic) and not setup.motion.amplitude[2]
    )


_BEGINNING = ("start_phase", "ramp")
"""How a harmonic motion begins, which its steady response does not depend on."""


def _without_frequency(motion: Mapping[str, Any]) -> Mapping[str, Any]:
    if motion["kind"] not in kinds_by_acceleration():
        return motion
    return {name: value for name, value in motion.items() if name not in (*_BEGINNING, "angular_frequency")}


def _usual_range(setup: Setup) -> list[float]:
    scale, frequency = setup.model.column.frequency_scale, setup.motion.highest_frequency
    low, high = _nice_below(RANGE[0] * scale), _nice_above(RANGE[1] * scale)
    if frequency < low:
        low = _nice_below(frequency / BEYOND)
    if frequency > high:
        high = _nice_above(frequency * BEYOND)
    return [low, high]


_CLOSE = 1e-12


def _nice_above(value: float) -> float:
    """Return the next number above of the kind 1, 2 or 5 times a power of ten."""
    power = 10.0 ** math.floor(math.log10(value))
    factor = next((one for one in (1, 2, 5) if one * power >= value * (1.0 - _CLOSE)), 10)
    return float(f"{factor * power:.6g}")


def _nice_below(value: float) -> float:
    power = 10.0 ** math.floor(math.log10(value) + _CLOSE)
    factor = next((one for one in (5, 2) if one * power <= value * (1.0 + _CLOSE)), 1)
    return float(f"{factor * power:.6g}")


# The answers, as the server gives them


def answer_to(question: Question) -> bytes:
    """Compute the answer to a question, or the lines of its refusal, as JSON."""
    try:
        return _ANSWERED[question.ask](question.values)
    except StylobateError as error:
        return answers.Problems(problems=str(error).splitlines()).as_json()


def _unheard(message: Message) -> None:
    del message


def _both(values: Mapping[str, Any]) -> Description:
    return Description(dict(values), dict(values))


_ANSWERED: Mapping[str, Callable[[Mapping[str, Any]], bytes]] = {
    "simulate": lambda values: run(_both(values), _unheard),
    "variations": lambda values: variations(values, _unheard).as_json(),
    "response": lambda values: response(values).as_json(),
    "start": lambda values: start(values, _unheard).as_json(),
    "exact": lambda values: exact_curves(values["description"], _unheard).as_json(),
}
