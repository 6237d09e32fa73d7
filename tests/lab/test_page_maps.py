"""Overturning maps and basins of the page, in a real browser."""

import re

import pytest
from tests.lab.browser import moved, new_page, shown


@pytest.mark.slow
def test_a_click_in_the_map_starts_that_motion_and_its_link_restores_it(watched):
    page = watched.page
    page.get_by_role("tab", name="Overturning map").click()
    plane = "window.stylobate.laboratory.plane('map')"
    panel = page.locator(".plane-panel.map")
    panel.locator("summary").click()
    panel.get_by_label("cells").select_option(index=0)
    panel.get_by_role("button", name="Compute").click()
    page.wait_for_function(f"() => {plane}.axes && !{plane}.running", timeout=180_000)
    x, y = page.evaluate(f"() => {plane}.clientPlace([3, 1])")
    axes = page.evaluate(f"() => {plane}.axes")
    page.mouse.click(x, y)
    frequency = "window.stylobate.state().description.motion.angular_frequency"
    page.wait_for_function(f"() => Math.abs({frequency} - {axes['x']['values'][3]}) < 1e-9")
    shown(page)
    motion = page.evaluate("() => window.stylobate.state().description.motion")
    assert motion["acceleration"] == pytest.approx(axes["y"]["values"][1])
    cell = page.evaluate(f"() => {plane}.filled")
    assert cell is not None
    other = new_page(page.context)
    other.goto(page.evaluate("() => location.href"))
    shown(other)
    assert other.evaluate("() => window.stylobate.state().description.motion") == motion
    other.close()


AXES = {
    "x": {"name": "angular_frequency", "values": [1.0, 2.0, 3.0], "units": "rad s-1"},
    "y": {"name": "acceleration", "values": [0.02, 0.05, 0.1], "units": "m s-2"},
}


def job_that_never_ends(page, note=""):
    """Answer the page's jobs with one that never ends, and return the requests that end it."""
    ended = []
    events = [{"axes": AXES, "names": [[1, "overturned"]]}, {"stride": 1, "cells": [[1, 1, 1]]}]
    done = 0 if note else 1

    def answer(route):
        request = route.request
        if request.method == "DELETE":
            ended.append(request.url)
        report = {
            "id": "one",
            "kind": "map",
            "state": "running",
            "done": done,
            "total": 9,
            "note": note,
            "events": events if "after=0" in request.url else [],
            "next": 2,
            "problems": [],
            "result": None,
        }
        route.fulfill(status=202 if request.method == "POST" else 200, json=report)

    page.route(re.compile(r"/api/jobs"), answer)
    page.get_by_role("tab", name="Overturning map").click()  # of the slender model: it fills in unasked
    return ended


def test_a_map_of_an_earlier_case_is_marked_cancelled_and_no_longer_clickable(watched):
    page = watched.page
    ended = job_that_never_ends(page)
    plane = "window.stylobate.laboratory.plane('map')"
    page.wait_for_function(f"() => {plane}.filled")
    moved(page, "damping", 0.2)
    panel = page.locator(".plane-panel.map.stale")
    panel.get_by_text("This picture shows an earlier case").wait_for()
    assert len(ended) == 1
    shown(page)  # the start is on the branch at the new damping
    before = page.evaluate("() => window.stylobate.state().description")
    page.mouse.click(*page.evaluate(f"() => {plane}.clientPlace([2, 2])"))
    assert page.evaluate("() => window.stylobate.state().description") == before


def test_a_map_that_has_computed_nothing_yet_says_why(watched):
    job_that_never_ends(watched.page, note="compiling rolling, space motion")
    watched.page.locator(".plane-panel.map .readout").get_by_text("Compiling rolling, space motion…").wait_for()


def test_nothing_is_computed_over_an_axis_that_is_none(page):
    plane = "window.stylobate.laboratory.plane('map')"
    page.get_by_role("tab", name="Overturning map").click()
    page.wait_for_function(f"() => {plane}.axes && !{plane}.running", timeout=180_000)
    panel = page.locator(".plane-panel.map")
    panel.locator("summary").click()
    start, end = panel.get_by_label("x from"), panel.get_by_label("x to")
    compute = panel.get_by_role("button", name="Compute")
    kept = start.input_value()
    for text, line in (("9999", "does not rise"), ("abc", "'abc' is not a number")):
        start.fill(text)
        start.press("Enter")
        panel.locator(".problem").get_by_text("angular frequency: ").filter(has_text=line).wait_for()
        assert compute.is_disabled()
        assert start.get_attribute("aria-invalid") == end.get_attribute("aria-invalid") == "true"
    moved(page, "damping", 0.12)  # another answer leaves what is written, and why it is refused
    shown(page)
    assert start.input_value() == "abc"
    assert compute.is_disabled()
    start.fill(kept)
    start.press("Enter")
    panel.locator(".problem").wait_for(state="hidden")
    assert compute.is_enabled()


def test_a_basin_fills_in_unasked_and_holds_the_standing_column(page):
    page.get_by_role("tab", name="Basin").click()
    plane = "window.stylobate.laboratory.plane('basin')"
    page.wait_for_function(f"() => {plane}.axes && !{plane}.running", timeout=180_000)
    for place in "xy":
        values = page.evaluate(f"() => {plane}.axes.{place}.values")
        assert min(values, key=abs) == pytest.approx(0.0, abs=1e-12)
    (left, low), (right, high) = (page.evaluate(f"() => {plane}.clientPlace({cell})") for cell in ([0, 0], [9, 9]))
    assert right - left == pytest.approx(low - high, rel=1e-6)


COLUMN = "#column=dimensionless,slenderness:0.1"
PLANAR = f"{COLUMN}&model=planar_rocking&motion=straight,acceleration:0.2,angular_frequency:4"
SHAKEN_UP = f"{COLUMN}&model=slender,damping:0.1&motion=vertical,acceleration:0.4,angular_frequency:2"


@pytest.mark.parametrize("case", [f"{PLANAR}&tilt=0.02,0", f"{SHAKEN_UP}&tilt=0.02,0.01"], ids=["planar", "vertical"])
def test_a_basin_that_is_offered_is_computed(page, address, case):
    page.goto("about:blank")
    page.goto(f"{address}/{case}")
    shown(page)
    assert page.locator(".response").is_visible() is ("straight" in case)  # no card of curves that there are not
    upper = page.locator(".controls option[value=upper]")
    assert upper.first.is_disabled()  # a start on a branch would be refused
    page.get_by_role("tab", name="Basin").click()
    panel = page.locator(".plane-panel.basin")
    if panel.get_by_role("button", name="Compute").is_visible():
        panel.locator("summary").click()
        panel.get_by_label("cells").select_option("25")
        panel.get_by_role("button", name="Compute").click()
    panel.get_by_text("625 runs of").wait_for()
    assert panel.locator(".problem").is_hidden()
