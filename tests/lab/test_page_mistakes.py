"""What the page says of mistakes, of what it changes by itself, and how room is left for it, in a real browser."""

import re

import pytest
from tests.lab.browser import shown

STATE = "window.stylobate.state()"


def field_of(page, name):
    return page.locator(f".controls input.number[id^='{name}']").first


def described(page, field):
    return page.locator(f"#{field.get_attribute('aria-describedby')}").inner_text()


def test_a_text_that_is_no_number_has_its_line_in_place_of_an_earlier_one(page):
    damping = field_of(page, "damping")
    damping.fill("-1")
    problems = page.locator(".problems")
    problems.get_by_text("damping must be zero or positive").wait_for()
    for name, text, line in (
        ("damping", "abc", "damping: 'abc' is not a number. Enter a number such as 0.1."),
        ("tilt_x", "NaN", "tilt x: 'NaN' is not a number."),
        ("acceleration", "1e400", "acceleration: '1e400' is not a finite number."),
    ):
        field = field_of(page, name)
        field.fill(text)
        assert line in described(page, field)
        assert line in problems.inner_text()
        assert "zero or positive" not in problems.inner_text()
        field.blur()
        assert "zero or positive" in problems.inner_text()  # the field shows the number of the case again
        assert "zero or positive" in described(page, damping)


def test_a_frequency_beyond_the_range_is_an_arrow_at_its_edge(page):
    marker = page.get_by_role("slider", name="Angular frequency of the base motion")
    assert marker.get_attribute("data-side") == "inside"
    for which, value in (("from", "3"), ("to", "4")):
        field = page.get_by_label(f"Response {which} angular frequency")
        field.fill(value)
        field.press("Enter")
    page.locator(".marker[data-side=below]").wait_for()
    assert marker.get_attribute("aria-valuetext").endswith("below the range that is shown")
    assert marker.evaluate("one => getComputedStyle(one).backgroundColor") == "rgba(0, 0, 0, 0)"


EXACT = {
    "families": [
        {
            "angular_frequency": [1.2, 2.0, 2.8],
            "mean_tilt": [0.03, 0.04, 0.05],
            "phase": [0.1, 0.2, 0.3],
            "stable": [False, False, True],
            "tilt": [[0.01, 0.0]] * 3,
            "tilt_rate": [[0.0, 0.01]] * 3,
        }
    ],
    "bifurcations": [{"kind": "fold", "angular_frequency": 2.4, "mean_tilt": 0.045}],
}


def test_exact_orbits_are_whole_circles_and_their_text_stays_while_they_do(page):
    report = {"id": "one", "kind": "exact", "state": "done", "done": 1, "total": 1, "note": "", "events": []}
    report |= {"next": 0, "problems": [], "result": EXACT}
    page.route(re.compile(r"/api/jobs"), lambda route: route.fulfill(status=200, json=report))
    page.evaluate(
        """() => {
            const { arc, stroke } = CanvasRenderingContext2D.prototype;
            window.dashes = [];
            CanvasRenderingContext2D.prototype.arc = function (...given) { this.round = true; arc.apply(this, given); };
            CanvasRenderingContext2D.prototype.stroke = function (...given) {
                const drawn = this.round && this.canvas.closest(".response");
                if (drawn) window.dashes.push(this.getLineDash().length);
                this.round = false;
                stroke.apply(this, given);
            };
        }"""
    )
    page.get_by_role("button", name="Exact orbits").click()
    note = page.locator(".response > .note")
    note.get_by_text("1 family of exact orbits; fold at 2.4").wait_for()
    page.wait_for_function("() => window.dashes.length > 0")
    assert set(page.evaluate("() => window.dashes")) == {0}
    field = page.get_by_label("Response to angular frequency")
    with page.expect_response(re.compile("/api/response")):
        field.fill("3")
        field.press("Enter")
    page.wait_for_timeout(300)
    assert "fold at 2.4" in note.inner_text()


def test_planar_rocking_says_what_it_changes_and_another_model_brings_it_back(page):
    model = page.get_by_label("Model", exact=True)
    before = page.evaluate(f"() => {STATE}.description")
    model.select_option("planar_rocking")
    line = page.get_by_text("the motion is now straight and the initial condition lies in its plane")
    line.wait_for()
    assert page.evaluate(f"() => {STATE}.description.motion.kind") == "straight"
    shown(page)
    model.select_option("slender")
    line.wait_for(state="hidden")
    after = page.evaluate(f"() => {STATE}.description")
    assert after["motion"] == before["motion"]
    assert after["tilt"] == before["tilt"]
    assert after["tilt_rate"] == before["tilt_rate"]


def test_a_run_that_was_cancelled_leaves_the_speed_and_is_computed_again_on_request(page):
    speed = page.get_by_label("Speed", exact=True)
    usual = speed.input_value()
    never = re.compile("/api/simulate")
    page.route(never, lambda route: None)  # never answered
    with page.expect_request(never):  # the start on the branch is asked for first
        field_of(page, "angular_frequency").fill("30")
    with page.expect_event("requestfailed", lambda request: "simulate" in request.url):
        page.locator(".stage").get_by_role("button", name="Cancel").click()
    assert speed.input_value() == usual
    page.unroute(never)
    page.get_by_role("button", name="Compute again").click()
    page.locator(".old-note").wait_for(state="hidden")
    page.wait_for_function(f"() => {STATE}.description.motion.angular_frequency === 30")
    page.wait_for_function("() => !document.querySelector('.stage.busy') && document.querySelector('.problems').hidden")
    assert speed.input_value() != usual


def test_a_refusal_leaves_the_column_in_sight(page):
    field_of(page, "damping").fill("-1")
    note = page.locator(".old-note")
    note.get_by_text("damping must be zero or positive").wait_for()
    canvas = page.locator(".stage canvas").first
    page.wait_for_timeout(300)  # the stage takes its new size
    stage = page.locator(".stage").bounding_box()
    assert canvas.bounding_box()["height"] == pytest.approx(stage["height"], abs=1.0)
    assert stage["y"] + stage["height"] <= note.bounding_box()["y"] + 0.5


def test_the_ends_of_a_long_range_are_read_whole(page):
    for which, value in (("to", "1000000"), ("from", "200000")):
        field = page.get_by_label(f"Response {which} angular frequency")
        field.fill(value)
        field.press("Enter")
        field.blur()
        assert field.evaluate("one => one.scrollWidth <= one.clientWidth")
    page.wait_for_function(
        """() => {
            const plot = document.querySelector(".response .amplitude");
            const over = plot.querySelector(".u-over").getBoundingClientRect();
            return plot.getBoundingClientRect().right - over.right >= 24;
        }"""
    )


LONG = (
    "It moved to the end of the run, its rocking has died away to less than a tenth of what it was, and the record has "
    "not ended: whether it stands can be decided only after the strongest shaking, which is still to come, and after "
    "the time that the motion then needs to die away; set duration to at least 96.5 s"
)


def test_a_long_verdict_and_its_button_are_read_whole(page):
    def answer(route):
        found = route.fetch()
        warnings = ["the rim would slip from 1.25 s on: the friction needed reaches 0.42"]
        route.fulfill(response=found, json={**found.json(), "reason": LONG, "warnings": warnings})

    page.route(re.compile("/api/simulate"), answer)
    field_of(page, "duration").fill("60")
    button = page.get_by_role("button", name="Simulate until decided")
    button.wait_for()
    verdict = page.locator(".verdict")
    for height in (860, 720):
        page.set_viewport_size({"width": 1280, "height": height})
        page.wait_for_timeout(300)  # the stage takes its new size
        assert verdict.evaluate("one => one.scrollHeight <= one.clientHeight")
        (box, inner) = (verdict.bounding_box(), button.bounding_box())
        assert box["y"] <= inner["y"] <= inner["y"] + inner["height"] <= box["y"] + box["height"]
        assert page.locator(".stage").bounding_box()["height"] > 150
