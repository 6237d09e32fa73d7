"""The tour: each lesson keeps what it says."""

from pathlib import Path

import numpy as np
import pytest

import stylobate as sb
from stylobate import config
from stylobate.lab.curves import exact_curves, response, start
from stylobate.lab.grids import OFF_BRANCH
from stylobate.lab.options import lessons, presets

LESSONS = lessons()
PLACES = 13
WORKSHEET = Path(__file__).parents[2] / "docs" / "how-to" / "worksheet.md"


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
    for choice in [option.change for option in control.options or ()] or [{}]:
        description = {**lesson.description, **choice}
        if control.number is None:
            yield choice
            continue
        part = next(name for name in ("motion", "model", "column") if control.number in description[name])
        for value in np.linspace(control.first, control.last, PLACES):
            yield {**choice, part: {**description[part], control.number: float(value)}}


def test_there_are_seven_lessons_of_columns_with_lengths():
    assert len(LESSONS) == 7
    assert {one.description["column"]["shape"] for one in LESSONS} == {"solid"}


def test_no_preset_has_the_title_of_another_or_of_a_lesson():
    titles = [one.title.casefold() for one in (*LESSONS, *presets())]
    assert len(set(titles)) == len(titles)


@pytest.mark.parametrize("lesson", LESSONS, ids=lambda one: one.identity)
def test_a_lesson_has_an_answer_for_each_outcome_that_its_control_leads_to(lesson):
    found = {outcome_of(lesson, change) for change in changes(lesson)}
    assert len(found) > 1  # something happens
    assert found <= set(lesson.said)
    assert outcome_of(lesson, {}) in lesson.said


def named(identity):
    return next(one for one in LESSONS if one.identity == identity)


def test_slower_shaking_falls_below_the_critical_frequency_and_not_above():
    lesson = named("critical")
    motion = lesson.description["motion"]
    case = {name: lesson.description[name] for name in ("column", "model")}
    without = {name: value for name, value in motion.items() if name != "angular_frequency"}
    found = response({**case, "motion": without, "angular_frequency_range": [2.0, 5.0], "points": 50})
    critical = next(one.angular_frequency for one in found.critical if one.angular_frequency is not None)
    assert "In lesson 4 that is at 0.429 Hz" in WORKSHEET.read_text("utf-8")
    assert critical / (2.0 * np.pi) == pytest.approx(0.429, abs=5e-4)
    outcomes = [
        outcome_of(lesson, {"motion": {**motion, "angular_frequency": share * critical}})
        for share in (0.86, 0.99, 1.01, 1.4)
    ]
    assert outcomes == ["OVERTURNED", "MODULATED", "ROLLING", "ROLLING"]


def test_a_small_column_lifts_at_the_acceleration_of_a_large_one_of_its_shape_and_falls_first():
    lesson = named("stands")
    motion = lesson.description["motion"]
    uplift = 0.2 * 9.80665
    for option, strong in zip(lesson.control.options, ("ROCKING", "OVERTURNED"), strict=True):
        outcomes = [
            outcome_of(lesson, {**option.change, "motion": {**motion, "acceleration": one}})
            for one in (0.999 * uplift, 1.001 * uplift, 3.5)
        ]
        assert outcomes == ["AT_REST", "ROCKING", strong]


def test_averaging_calls_stable_what_loses_its_stability_where_the_lesson_says():
    lesson = named("averaging")
    motion = {name: value for name, value in lesson.description["motion"].items() if name != "angular_frequency"}
    case = {**{name: lesson.description[name] for name in ("column", "model")}, "motion": motion}
    found = exact_curves({**case, "angular_frequency_range": [2.9, 3.3]}, lambda _: None)
    loss = max(one.angular_frequency for one in found.bifurcations)
    assert f"below {loss / (2.0 * np.pi):.3f} Hz" in lesson.said["OVERTURNED"]
    assert f"below {loss / (2.0 * np.pi):.3f} Hz" in WORKSHEET.read_text("utf-8")


def test_more_push_can_be_survived():
    lesson = named("rocks")
    motion = lesson.description["motion"]
    outcomes = [outcome_of(lesson, {"motion": {**motion, "acceleration": one}}) for one in (2.5, 5.0, 7.0, 9.0)]
    assert outcomes == ["SURVIVED", "OVERTURNED", "SURVIVED", "OVERTURNED"]
