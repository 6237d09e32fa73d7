"""Two columns side by side in a real browser."""

import pytest
from tests.lab.browser import moved, new_page, shown

import stylobate as sb
from stylobate.config import SimulationConfig

SECOND = "window.stylobate.laboratory.secondAnswer"
VIEW = "window.stylobate.state()"
DRAWN = 2e-6  # of a pose that is read back from the drawn column


def compared(page, differs: str) -> None:
    """Set a second column that differs in this, and wait for its run."""
    page.get_by_label("Compare with", exact=True).select_option(differs)
    page.wait_for_function(f"() => {SECOND} !== null")


def simulated(case: dict) -> sb.Run:
    """Run a case without the page."""
    setup = SimulationConfig.parse(case).build()
    return sb.simulate(setup.model, setup.motion, **setup.options)


def test_the_second_column_is_drawn_and_judged_as_it_is_computed(page):
    moved(page, "tilt_x", 0.05)  # as set: both columns start alike
    page.wait_for_function(f"() => {VIEW}.start === null")
    shown(page)
    compared(page, "damping")
    page.get_by_role("textbox", name="Second damping").fill("0.3")
    page.wait_for_function(f"() => {VIEW}.compared.value === 0.3 && {SECOND}.python.includes('damping=0.3')")
    case = {name: value for name, value in page.evaluate(f"() => {VIEW}.description").items() if value is not None}
    second = simulated({**case, "model": {**case["model"], "damping": 0.3}})
    assert page.evaluate(f"() => {SECOND}.outcome") == second.outcome.name
    page.evaluate("() => window.stylobate.laboratory.clock.pause()")
    time = float(page.evaluate(f"() => {SECOND}.drawn.time[40]"))
    page.evaluate("t => window.stylobate.stage.setTime(t)", time)
    tilt = page.evaluate("() => window.stylobate.stage.pose(1).tilt")
    assert tilt == pytest.approx(second.sample([time]).isel(time=0)["tilt"].values, abs=DRAWN)
    assert page.evaluate("() => window.stylobate.stage.pose(0).tilt") != pytest.approx(tilt, abs=1e-3)
    assert page.get_by_label("Second column").get_by_text("Damping 0.3:").is_visible()
    assert page.get_by_role("region", name="Upper history").get_by_text("damping 0.3", exact=True).is_visible()


def test_a_comparison_is_in_the_link_and_the_way_back_leads_to_one_column(page):
    compared(page, "slenderness")
    page.wait_for_function("() => location.hash.includes('beside=slenderness:0.15')")
    other = new_page(page.context)
    other.goto(page.evaluate("() => location.href"))
    shown(other)
    other.wait_for_function(f"() => {SECOND} !== null")
    assert other.evaluate(f"() => {SECOND}.measures") == page.evaluate(f"() => {SECOND}.measures")
    other.close()
    page.go_back()
    page.wait_for_function(f"() => {VIEW}.compared === null && {SECOND} === null")
    page.go_forward()
    page.wait_for_function(f"() => {SECOND} !== null")
    page.get_by_role("button", name="Remove").click()
    page.wait_for_function(f"() => {SECOND} === null && !location.hash.includes('beside')")
    assert page.locator(".figure-label").count() == 0


def test_a_second_column_that_is_refused_says_why_and_leaves_the_first(page):
    before = page.evaluate("() => window.stylobate.laboratory.answer.measures")
    page.get_by_label("Compare with", exact=True).select_option("model")
    page.get_by_label("Model of the second column").select_option("planar_rocking")  # under a circle
    line = page.get_by_label("Second column").get_by_text("No second column:")
    line.wait_for()
    assert "planar rocking" in line.inner_text()
    assert page.evaluate(f"() => {SECOND}") is None
    assert page.evaluate("() => window.stylobate.laboratory.answer.measures") == before
