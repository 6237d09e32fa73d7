"""The tour: a question, one control, and an answer in words."""

import re

import pytest
from tests.lab.browser import enter, new_page, shown

from stylobate.lab.options import lessons

LESSONS = lessons()
OUTCOME = "window.stylobate.laboratory.answer.outcome"


@pytest.fixture
def opened(browser, address):
    context = browser.new_context(viewport={"width": 1280, "height": 860})
    page = new_page(context)
    enter(page, address)
    shown(page)
    yield page
    context.close()


def test_it_opens_with_a_question_and_one_control_in_view(opened):
    lesson = next(one for one in LESSONS if one.opens)
    assert opened.get_by_role("heading", name=lesson.question).is_visible()
    assert opened.locator("input.number:visible").count() == 3  # the control, and the ends of the range of the response
    assert opened.evaluate(f"() => {OUTCOME}") == "ROLLING"


def test_slower_shaking_is_answered_in_words_when_the_line_is_crossed(opened):
    said = opened.locator(".said")
    field = opened.locator(".lesson input.number")
    for frequency, outcome in ((1.41, "ROLLING"), (1.38, "MODULATED"), (1.2, "OVERTURNED")):
        field.fill(str(frequency))
        field.press("Enter")
        opened.wait_for_function(f"() => {OUTCOME} === '{outcome}'")
        wanted = next(one for one in LESSONS if one.opens).said[outcome].partition("{")[0].strip()
        opened.wait_for_function("wanted => document.querySelector('.said').textContent.startsWith(wanted)", arg=wanted)
        assert "1.397" in said.text_content()


def test_the_critical_frequency_follows_the_shaking(opened):
    label = opened.locator(".plot.amplitude")
    before = label.get_attribute("aria-label")
    assert "1.397" in before
    opened.locator("details.section summary").filter(has_text="Base motion").click()
    field = opened.locator(".controls input.number[id^='acceleration']")
    field.fill("0.09")
    opened.wait_for_function(
        "before => document.querySelector('.plot.amplitude').getAttribute('aria-label') !== before", arg=before
    )
    assert "1.572" in label.get_attribute("aria-label")


def test_each_lesson_is_a_link_with_an_answer_and_the_way_back_leads_to_the_one_before(opened):
    for place, lesson in enumerate(LESSONS):
        opened.get_by_role("button", name=f"Lesson {place + 1}: {lesson.title}").click()
        opened.get_by_role("heading", name=lesson.question).wait_for()
        opened.wait_for_function(f"() => location.hash.includes('lesson={lesson.identity}')")
        opened.wait_for_function("() => document.querySelector('.said').textContent !== ''")
        assert opened.locator("[aria-current=step]").text_content() == str(place + 1)
    opened.go_back()
    opened.get_by_role("heading", name=LESSONS[-2].question).wait_for()


def test_a_column_that_may_spin_comes_to_rest(opened):
    opened.get_by_role("button", name=re.compile("Free to spin")).click()
    opened.get_by_label("may spin").check()
    opened.wait_for_function(f"() => {OUTCOME} === 'AT_REST'")
    opened.get_by_text("Rolling spins it up.").wait_for()


def test_the_tour_is_closed_and_opened_again(opened):
    opened.get_by_role("button", name="Close the tour").click()
    assert opened.locator(".lesson").is_hidden()
    opened.get_by_label("Preset").select_option("lesson rolls")
    opened.get_by_role("heading", name=LESSONS[2].question).wait_for()


def test_on_a_phone_slider_column_and_response_are_seen_without_scrolling(browser, address):
    context = browser.new_context(viewport={"width": 390, "height": 844})
    page = new_page(context)
    enter(page, address)
    shown(page)
    for name in (".lesson .slider", ".stage canvas", ".plot.amplitude", ".plot.phase"):
        box = page.locator(name).bounding_box()
        assert box["y"] >= 0.0
        assert box["y"] + box["height"] <= 844.0
    assert page.evaluate("() => document.documentElement.scrollWidth") <= 390
    context.close()


def test_a_map_follows_the_branch_of_each_frequency_and_says_so(opened):
    opened.get_by_role("tab", name="Overturning map").click()
    opened.get_by_text("each from the upper branch of its own motion").wait_for()
    result = opened.evaluate(
        "() => { const { axes, filled } = window.stylobate.laboratory.plane('map');"
        " return axes.x.values.map((x, i) => [x, axes.y.values.map((y, j) => [y, filled.at(i, j)])]); }"
    )
    # At the acceleration of the case: rolling above the critical frequency, and nothing but that.
    for frequency, cells in result:
        nearest = min(cells, key=lambda cell: abs(cell[0] - 0.065))
        if frequency > 1.7:
            assert nearest[1] == 2, (frequency, nearest)


def test_small_variations_of_an_earthquake_are_counted_and_drawn(opened):
    opened.get_by_role("button", name=re.compile("An earthquake")).click()
    field = opened.locator(".lesson input.number")
    field.fill("1.0")
    opened.wait_for_function(f"() => {OUTCOME} === 'OVERTURNED'")
    opened.get_by_role("button", name="Vary it").click()
    opened.get_by_text(re.compile(r"64 small variations, .*: Overturned 92 % \(83 to 97\), Survived 8 %")).wait_for()
    field.fill("0.4")
    opened.wait_for_function(f"() => {OUTCOME} === 'AT_REST'")
    assert opened.locator(".shares").is_hidden()  # they were those of the run before
