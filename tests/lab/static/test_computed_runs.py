"""Runs, curves and starts that the page computes, against those of the server."""

import tomllib

import numpy as np
import pytest
from tests.lab.browser import new_page, shown
from tests.lab.static.cases import BLOCK, EL_CENTRO, FOLDER, LESSONS, MAP, contents

from stylobate.lab import kernels

PARTS = 20


def assert_same_envelope(one, other, end):
    """Compare the highest and the lowest extreme in each part of a run."""
    (at, values), (other_at, other_values) = np.array(one).T, np.array(other).T
    height = max(values.max(), 0.0) - min(values.min(), 0.0)
    for place in range(PARTS):
        inside, there = (np.floor(PARTS * time / end) == place for time in (at, other_at))
        if inside.sum() > 4 and there.sum() > 4:
            for of in (np.max, np.min):
                assert of(values[inside]) == pytest.approx(of(other_values[there]), abs=5e-3 * height)


def test_the_answers_are_those_of_the_server(served, site, browser, client):
    page = new_page(browser)
    page.goto(f"{served}#case=conveyor")
    shown(page)
    listed = contents((site / FOLDER / "index.html").read_text(encoding="utf-8"))["answers"]
    asked = {one["ask"]: one["question"] for one in listed if one["name"].endswith("-conveyor")}
    assert set(asked) == {"simulate", "variations"}
    answer = client.post("/api/simulate", json=asked["simulate"]).json()
    for part in ("outcome", "drawn", "series", "measures", "summary", "toml"):
        assert page.evaluate(f"() => window.stylobate.laboratory.answer.{part}") == answer[part]
    page.close()


@pytest.mark.parametrize(
    "lesson", [one for one in LESSONS if kernels.program_of(one.description)], ids=lambda one: one.identity
)
def test_computed_answers_are_those_of_the_server(lesson, served, browser, client):
    page = new_page(browser)
    page.goto(f"{served}#lesson={lesson.identity}")
    shown(page)
    page.wait_for_function(
        f"() => window.stylobate.laboratory.answer.toml.includes('{lesson.description['motion']['kind']}')"
    )
    shown_here = page.evaluate("() => window.stylobate.laboratory.answer")
    page.close()
    answer = client.post("/api/simulate", json=tomllib.loads(shown_here["toml"])).json()
    for part in ("outcome", "label", "reason", "uncertain", "planar"):
        assert shown_here[part] == answer[part]
    assert shown_here["column"] == pytest.approx(answer["column"], rel=1e-13)
    assert [one["kind"] for one in shown_here["events"]] == [one["kind"] for one in answer["events"]]
    for name in ("tilt", "base", "contact_point", "rotation", "centre", "twist", "resting", "time"):
        np.testing.assert_allclose(shown_here["drawn"][name], answer["drawn"][name], rtol=1e-6, atol=2e-6, err_msg=name)
    for name in ("amplitude", "base_acceleration", "friction_demand", "normal_force"):
        known = np.array(answer["series"][name], dtype=float)
        np.testing.assert_allclose(np.array(shown_here["series"][name], dtype=float), known, rtol=1e-5, atol=2e-6)
    for name, here in shown_here["series"]["extremes"].items():
        assert_same_envelope(here, answer["series"]["extremes"][name], shown_here["drawn"]["time"][-1])
    for name in set(shown_here["measures"]) - {"steps"}:
        known = answer["measures"][name]
        loads = name in ("peak_friction_demand", "peak_pivoting_demand", "minimum_normal_force")
        known = known if known is None else pytest.approx(known, rel=5e-3 if loads else 1e-4, abs=1e-6)
        assert shown_here["measures"][name] == known, name
    rows = dict(answer["summary"])
    assert {label: text for label, text in shown_here["summary"] if label in ("column", "uplifts above", "events")} == {
        label: rows[label] for label in ("column", "uplifts above", "events")
    }


SHAKEN = {
    "a record that is survived": {"motion": {**EL_CENTRO, "scale": 0.7}},
    "a record that overturns": {"motion": {**EL_CENTRO, "scale": 2.0}},
    "a rotated record with a tail": {"motion": {**EL_CENTRO, "rotation": 0.7, "tail": 3.0}},
    "a part of a record": {"motion": {**EL_CENTRO, "scale": 1.1}, "duration": 7.0},
    "a pulse in a plane": {
        "motion": {"kind": "one_sine", "acceleration": 3.0, "angular_frequency": 6.0},
        "model": {"kind": "planar_rocking"},
    },
    "a pulse with a vertical part": {
        "motion": {"kind": "ricker", "acceleration": 3.0, "angular_frequency": 6.0, "vertical": 0.3, "direction": 0.4},
        "model": {"kind": "rolling", "damping": 0.02},
    },
    "a wavelet": {"motion": {"kind": "gabor", "velocity": 0.5, "frequency": 1.0, "oscillations": 3.0}},
    "a sweep": {"motion": {"kind": "linear_sweep", "acceleration": 1.2, "frequencies": [0.5, 3.0], "length": 10.0}},
    "a ramp": {
        "motion": {"kind": "circular", "acceleration": 0.8, "angular_frequency": 6.0, "ramp": 3.0},
        "tilt": [0.02, 0.0],
    },
    "a pulse that would lift the column off": {
        "motion": {"kind": "half_sine", "acceleration": 7.0, "angular_frequency": 6.0, "direction": 0.4},
        "model": {"kind": "rolling", "damping": 0.02},
    },
    "no motion, with little energy": {"motion": {"kind": "rest"}, "tilt": [0.05, 0.02], "duration": 5.0},
}


@pytest.mark.parametrize("name", SHAKEN)
def test_computed_runs_under_any_motion_are_those_of_the_server(name, served, page_of_sources, client):
    kind = "wobbling" if "record" in name else "slender"
    asked = {"column": BLOCK, "model": {"kind": kind, "damping": 0.02}, **SHAKEN[name]}
    found = page_of_sources.evaluate("(asked) => window.stylobate.source.simulate(asked)", asked)
    known = client.post("/api/simulate", json=asked).json()
    for part in ("outcome", "reason", "uncertain", "planar"):
        assert found[part] == known[part]
    assert [one["kind"] for one in found["events"]] == [one["kind"] for one in known["events"]]
    assert found["measures"]["peak_tilt"] == pytest.approx(known["measures"]["peak_tilt"], rel=1e-6)
    for load in ("peak_friction_demand", "minimum_normal_force"):  # just before impacts the page sees more
        value = known["measures"][load]
        assert found["measures"][load] == (None if value is None else pytest.approx(value, rel=5e-3, abs=5e-4)), load
    for part in ("time", "tilt", "base"):
        np.testing.assert_allclose(found["drawn"][part], known["drawn"][part], rtol=1e-6, atol=2e-6, err_msg=part)


@pytest.mark.parametrize("limit", [0.05, 0.15, 2.0])
def test_warnings_about_the_contact_are_those_of_the_server(limit, page_of_sources, client):
    lifting = SHAKEN["a pulse that would lift the column off"]
    asked = {"column": BLOCK, **lifting, "friction_coefficient": limit}
    found = page_of_sources.evaluate("(asked) => window.stylobate.source.simulate(asked)", asked)
    known = client.post("/api/simulate", json=asked).json()
    assert found["warnings"] == known["warnings"]
    assert any(line.startswith("it would lift off from") for line in found["warnings"])
    assert found["drawn"]["friction_coefficient"] == known["drawn"]["friction_coefficient"] == limit


def test_motions_that_never_end_need_a_duration_and_impossible_ones_are_refused(page_of_sources):
    asked = {"column": BLOCK, "model": {"kind": "slender"}, "motion": {"kind": "rest"}, "tilt": [0.02, 0.0]}
    say = "(asked) => window.stylobate.source.simulate(asked).catch((error) => error.message)"
    assert page_of_sources.evaluate(say, asked).startswith("duration is missing: length of a run [s]")
    both = {"kind": "linear_sweep", "acceleration": 1.0, "displacement": 0.1, "frequencies": [1.0, 2.0], "length": 3.0}
    assert page_of_sources.evaluate(say, {**asked, "motion": both}).startswith("these numbers contradict each other")
    lost = {"kind": "record", "upload": "abc"}
    wanted = "motion.upload: record 'abc' is not stored (any more). Upload its files again."
    known = page_of_sources.evaluate(say, {**asked, "model": {"kind": "wobbling"}, "motion": lost})
    assert known == wanted


def test_computed_curves_and_starts_are_those_of_the_server(served, browser, client):
    page = new_page(browser)
    page.goto(served)
    shown(page)
    parts = {
        "column": {"shape": "dimensionless", "slenderness": 0.12},
        "model": {"kind": "slender", "damping": 0.07},
        "motion": {"kind": "elliptic", "amplitude": [0.08, 0.05], "phase": 0.7},
    }
    asked = {**parts, "angular_frequency_range": [0.2, 5.0], "points": 60}
    moving = {**parts, "motion": {**parts["motion"], "angular_frequency": 2.5}, "branch": "lower"}
    signal = "new AbortController().signal"
    ask = "window.stylobate.source"
    found = page.evaluate(f"(asked) => {ask}.response(asked, {signal})", asked)
    known = client.post("/api/response", json=asked).json()
    for name in ("angular_frequency", "backbone"):
        np.testing.assert_allclose(found[name], known[name], rtol=1e-8)  # the server rounds to nine digits
    assert found["averaged"] == known["averaged"]
    for ours, theirs in zip(found["branches"], known["branches"], strict=True):
        assert [ours[name] for name in ("sense", "branch", "stable")] == [
            theirs[name] for name in ("sense", "branch", "stable")
        ]
        for name in ("amplitude", "phase"):
            numbers = [np.array(one[name], dtype=float) for one in (ours, theirs)]
            np.testing.assert_allclose(*numbers, rtol=1e-8, atol=1e-12)
    for ours, theirs in zip(found["critical"], known["critical"], strict=True):
        assert ours["sense"] == theirs["sense"]
        assert ours["angular_frequency"] == pytest.approx(theirs["angular_frequency"], rel=1e-8)
    start = page.evaluate(f"(asked) => {ask}.steadyStart(asked, {signal})", moving)
    answer = client.post("/api/start", json=moving).json()
    for name in ("tilt", "tilt_rate"):
        assert start[name] == pytest.approx(answer[name], rel=1e-8)
    assert bool(start["warnings"]) == bool(answer["warnings"])
    page.close()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"model": {"kind": "slender", "damping": -1.0}}, "damping must be zero or positive, got -1"),
        (
            {"column": {"shape": "solid", "radius": 0.0, "height": 2.0, "density": 2500.0}},
            "radius must be positive, got 0",
        ),
        (
            {"column": {"shape": "hollow", "radius": 0.3, "inner_radius": 0.4, "height": 2.0, "density": 2e3}},
            "contradict",
        ),
        ({"column": {"shape": "frustum", "radius": 0.3, "height": 2.0, "density": 2500.0}}, "top_radius is missing"),
        ({"tilt": [2.0, 0.0]}, "tilt must be below π/2"),
        ({"motion": {"kind": "orbit", "diameter": 0.1, "rpm": 60.0, "sense": 3}}, "sense must be 1 or -1, got 3"),
    ],
)
def test_impossible_numbers_are_refused_before_they_are_computed(change, words, served, browser):
    page = new_page(browser)
    page.goto(served)
    shown(page)
    case = {**{name: MAP[name] for name in ("column", "model", "motion", "tilt")}, "duration": 5.0, **change}
    problems = page.evaluate(
        "(asked) => window.stylobate.source.simulate(asked, new AbortController().signal)"
        ".then(() => [], (error) => error.problems)",
        case,
    )
    page.close()
    assert len(problems) == 1
    assert words in problems[0]


@pytest.mark.parametrize(
    "change",
    [
        {"spin": 1.5},
        {"model": {"kind": "planar_rocking"}},
        {"model": {"kind": "rolling", "damping": 0.1}, "tilt": [0.0, 0.0], "spin": 1.5},
    ],
    ids=["a column that cannot turn", "out of its plane", "a standing column that turns"],
)
def test_starts_are_refused_in_the_words_of_the_server(change, page_of_sources, client):
    case = {**{name: MAP[name] for name in ("column", "model", "motion", "tilt")}, "duration": 5.0, **change}
    found = page_of_sources.evaluate(
        "(asked) => window.stylobate.source.simulate(asked).then(() => [], (error) => error.problems)", case
    )
    assert found == client.post("/api/simulate", json=case).json()["problems"]
    assert len(found) == 1
