"""The tour: each lesson keeps what it says."""

import numpy as np
import pytest

import stylobate as sb
from stylobate import config
from stylobate.lab.curves import start
from stylobate.lab.grids import OFF_BRANCH
from stylobate.lab.options import lessons

LESSONS = lessons()
PLACES = 13


def outcome_of(lesson, change):
    """Return the outcome of the case of a lesson after a change of its description, from the start that it has."""
    values = {**lesson.description, **change}
    if "start" in lesson.view:
        case = {name: values[name] for name in ("column", "model", "motion")}
        begun = start({**case, "branch": lesson.view["start"]}, lambda _: None).model_dump(exclude={"warnings"})
        values |= {**begun, "tilt": [(1.0 + OFF_BRANCH) * one for one in begun["tilt"]]}
    built = config.SimulationConfig.parse(values).build()
    return sb.simulate(built.model, built.motion, **built.options).outcome.name


def changes(lesson):
    """Yield the changes that the control of a lesson offers."""
    control = lesson.control
    if control.options is not None:
        yield from (option.change for option in control.options)
        return
    part = next(name for name in ("motion", "model", "column") if control.number in lesson.description[name])
    for value in np.linspace(control.first, control.last, PLACES):
        yield {part: {**lesson.description[part], control.number: float(value)}}


def test_there_are_seven_lessons_and_one_opens():
    assert len(LESSONS) == 7
    assert [one.identity for one in LESSONS if one.opens] == ["critical"]


@pytest.mark.parametrize("lesson", LESSONS, ids=lambda one: one.identity)
def test_a_lesson_has_an_answer_for_each_outcome_that_its_control_leads_to(lesson):
    found = {outcome_of(lesson, change) for change in changes(lesson)}
    assert len(found) > 1  # something happens
    assert found <= set(lesson.said)
    assert outcome_of(lesson, {}) in lesson.said


def test_the_opening_lesson_falls_below_the_critical_frequency_and_not_above():
    lesson = next(one for one in LESSONS if one.opens)
    motion = lesson.description["motion"]
    outcomes = {
        frequency: outcome_of(lesson, {"motion": {**motion, "angular_frequency": frequency}})
        for frequency in (1.2, 1.38, 1.41, 2.0)
    }
    assert outcomes == {1.2: "OVERTURNED", 1.38: "MODULATED", 1.41: "ROLLING", 2.0: "ROLLING"}


def test_more_push_can_be_survived():
    lesson = next(one for one in LESSONS if one.identity == "rocks")
    motion = lesson.description["motion"]
    outcomes = [outcome_of(lesson, {"motion": {**motion, "acceleration": one}}) for one in (2.5, 5.0, 7.0, 9.0)]
    assert outcomes == ["SURVIVED", "OVERTURNED", "SURVIVED", "OVERTURNED"]
