"""A column pulled by hand in a real browser."""

import math

import pytest
from tests.lab.browser import enter, shown

DESCRIPTION = "window.stylobate.state().description"
CURSOR = "() => window.stylobate.stage.canvas.style.cursor"
DRAWN = "() => new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn)))"


def on_the_column(page) -> tuple[float, float]:
    """Pause, and move the pointer to where the picture says that the column can be pulled."""
    page.evaluate("() => { window.stylobate.laboratory.clock.pause(); window.stylobate.laboratory.clock.seek(0); }")
    page.evaluate(DRAWN)
    box = page.locator(".stage canvas").bounding_box()
    y = box["y"] + 0.3 * box["height"]
    for step in range(-20, 21):
        x = box["x"] + 0.5 * box["width"] + 4.0 * step
        page.mouse.move(x, y)
        if page.evaluate(CURSOR) == "grab":
            page.mouse.move(x + 4.0, y)
            page.evaluate(DRAWN)  # the view may still have been turning
            if page.evaluate(CURSOR) == "grab":
                return x + 4.0, y
    pytest.fail("the pointer found no column")


def pulled(page, by: tuple[float, float]) -> tuple[list[float], list[float]]:
    """Pull the column so many pixels and let go; return the tilt in the hand and the one that the case has then."""
    x, y = on_the_column(page)
    answer = page.evaluate_handle("() => window.stylobate.laboratory.answer")
    page.mouse.down()
    page.mouse.move(x + 0.5 * by[0], y + 0.5 * by[1])
    page.mouse.move(x + by[0], y + by[1])
    held = page.evaluate("() => window.stylobate.stage.pose().tilt")
    page.mouse.up()
    page.wait_for_function("before => window.stylobate.laboratory.answer !== before", arg=answer)
    shown(page)
    return held, page.evaluate(f"() => {DESCRIPTION}.tilt")


def test_a_column_that_is_let_go_starts_from_rest_at_the_tilt_in_the_hand(page):
    held, tilt = pulled(page, (12.0, 0.0))
    assert tilt == pytest.approx(held, rel=1e-3)
    drawn = page.evaluate("() => window.stylobate.laboratory.answer.drawn")
    assert drawn["tilt"][0] == pytest.approx(tilt, abs=1e-6)
    assert drawn["tilt_rate"][0] == pytest.approx([0.0, 0.0], abs=1e-6)
    assert page.evaluate("() => window.stylobate.state().start") is None
    assert page.evaluate(f"() => {DESCRIPTION}.tilt_rate ?? null") is None
    assert page.evaluate("() => window.stylobate.laboratory.clock.time") < 10.0  # it began again
    page.wait_for_function("tilt => location.hash.includes(`tilt=${tilt.join()}`)", arg=tilt)


def test_a_lesson_says_nothing_of_a_case_that_is_not_its_own(page, address):
    page.goto("about:blank")
    enter(page, address, "#lesson=critical")
    shown(page)
    said, back = page.locator(".said"), page.get_by_role("button", name="Back to the lesson")
    said.get_by_text("We set it rolling").wait_for()
    assert back.is_hidden()
    pulled(page, (30.0, 0.0))
    assert said.inner_text().startswith("This case is no longer that of the lesson")
    back.click()
    said.get_by_text("We set it rolling").wait_for()
    assert back.is_hidden()


def test_a_drag_beside_the_column_turns_the_view_and_no_pull_overturns_it(page):
    before = page.evaluate(f"() => {DESCRIPTION}.tilt")
    x, y = on_the_column(page)
    page.mouse.move(x + 150.0, y)
    assert page.evaluate(CURSOR) == ""
    page.mouse.down()
    page.mouse.move(x + 140.0, y + 10.0, steps=2)
    page.mouse.up()
    assert page.evaluate(f"() => {DESCRIPTION}.tilt") == before
    _, tilt = pulled(page, (300.0, 20.0))
    assert math.hypot(*tilt) == pytest.approx(0.95 * math.atan(0.1), rel=1e-3)


def test_a_model_of_one_plane_is_pulled_along_its_line(page):
    page.get_by_label("Model", exact=True).select_option("planar_rocking")
    page.wait_for_function("() => window.stylobate.laboratory.answer.python.includes('PlanarRocking')")
    shown(page)
    _, tilt = pulled(page, (-12.0, 15.0))
    assert tilt[1] == 0.0
    assert tilt[0] != 0.0
