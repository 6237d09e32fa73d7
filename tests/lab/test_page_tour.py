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
    assert opened.get_by_role("heading", name=LESSONS[0].question).is_visible()
    assert opened.locator("input.number:visible").count() == 1
    assert opened.evaluate(f"() => {OUTCOME}") == "AT_REST"


def test_a_lesson_is_written_in_metres_hertz_and_degrees_without_symbols(opened):
    for lesson in LESSONS:
        opened.evaluate(f"() => {{ location.hash = '#lesson={lesson.identity}'; }}")
        opened.get_by_role("heading", name=lesson.question).wait_for()
        opened.wait_for_function("() => document.querySelector('.said').textContent !== ''")
        panels = (f"{name}:visible" for name in (".lesson", ".show", ".times", ".response"))
        text = opened.locator(", ".join(panels)).all_inner_texts()
        assert not re.search("ω₀|rad/s|ψ|θ|backbone|both senses", "".join(text)), lesson.identity
        assert opened.locator(".response").is_visible() == lesson.curves
        for field in opened.locator(".lesson input.number").all():
            assert len(field.input_value()) <= 4
    to_lesson(opened, "critical")
    opened.get_by_role("button", name="Close the tour").click()
    opened.locator(".response .phase").wait_for()


def test_the_lesson_that_stands_has_its_column_half_as_large(opened):
    opened.get_by_label("0.4 m × 2 m").check()
    opened.wait_for_function("() => window.stylobate.laboratory.answer.drawn.column.height === 2")
    field = opened.locator(".lesson input.number")
    for acceleration, outcome in (("1.95", "AT_REST"), ("1.97", "ROCKING"), ("3.5", "OVERTURNED")):
        field.fill(acceleration)
        opened.wait_for_function(f"() => {OUTCOME} === '{outcome}'")
    assert opened.get_by_role("button", name="Back to the lesson").is_hidden()


def to_lesson(page, identity):
    """Open a lesson, and wait for its answer."""
    page.evaluate(f"() => {{ location.hash = '#lesson={identity}'; }}")
    lesson = next(one for one in LESSONS if one.identity == identity)
    page.get_by_role("heading", name=lesson.question).wait_for()
    page.wait_for_function("() => document.querySelector('.said').textContent !== ''")
    return lesson


def test_slower_shaking_is_answered_in_words_when_the_line_is_crossed(opened):
    lesson = to_lesson(opened, "critical")
    said = opened.locator(".said")
    field = opened.locator(".lesson input.number")
    for frequency, outcome in ((0.431, "ROLLING"), (0.423, "MODULATED"), (0.37, "OVERTURNED")):
        field.fill(str(frequency))
        field.press("Enter")
        opened.wait_for_function(f"() => {OUTCOME} === '{outcome}'")
        wanted = lesson.said[outcome].partition("{")[0].strip()
        opened.wait_for_function("wanted => document.querySelector('.said').textContent.startsWith(wanted)", arg=wanted)
        assert "0.429 Hz" in said.text_content()


def test_the_critical_frequency_follows_the_shaking(opened):
    to_lesson(opened, "critical")
    label = opened.locator(".plot.amplitude")
    opened.locator(".plot.amplitude[aria-label*='0.4289 Hz']").wait_for()
    before = label.get_attribute("aria-label")
    opened.locator("details.section summary").filter(has_text="Base motion").click()
    field = opened.locator(".controls input.number[id^='acceleration']")
    field.fill("0.9")
    opened.wait_for_function(
        "before => document.querySelector('.plot.amplitude').getAttribute('aria-label') !== before", arg=before
    )
    found = re.search(r"stable from ([\d.]+) Hz", label.get_attribute("aria-label"))
    assert float(found[1]) > 0.45


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


@pytest.fixture
def phone(browser, address):
    context = browser.new_context(viewport={"width": 390, "height": 844}, has_touch=True, is_mobile=True)
    page = new_page(context)
    enter(page, address)
    shown(page)
    yield page
    context.close()


def boxes(page, names):
    """Return the boxes of these elements, all of which are seen in the window."""
    found = {name: page.locator(name).first.bounding_box() for name in names}
    for box in found.values():
        assert box["y"] >= 0.0
        assert box["y"] + box["height"] <= page.viewport_size["height"]
    return found


def test_on_a_phone_slider_column_and_tilt_are_seen_without_scrolling_and_a_finger_finds_its_buttons(phone):
    boxes(phone, (".lesson .slider", ".stage canvas", ".times .chart .plot"))
    assert phone.evaluate("() => document.documentElement.scrollWidth") <= 390
    for button in phone.locator(".lesson button:visible, .scene-bar button:visible, .transport button").all():
        box = button.bounding_box()
        assert min(box["width"], box["height"]) >= 44.0, button.text_content()


def test_a_link_shows_the_scene_alone_and_charts_where_they_are_asked_for(phone, address):
    phone.goto("about:blank")
    enter(phone, address, "#lesson=rocks&view=scene")
    shown(phone)
    found = boxes(phone, (".lesson .slider", ".stage canvas", ".transport", ".verdict"))
    assert found[".stage canvas"]["height"] > 0.3 * 844
    for name in (".top", ".controls", ".planes", ".times"):
        assert phone.locator(name).is_hidden()
    phone.get_by_role("button", name="Charts").click()
    boxes(phone, (".stage canvas", ".times .chart .plot"))
    field = phone.locator(".lesson input.number")
    field.fill("5")
    phone.wait_for_function(f"() => {OUTCOME} === 'OVERTURNED'")
    phone.get_by_role("button", name="Reset").click()
    phone.wait_for_function(f"() => {OUTCOME} === 'SURVIVED'")
    phone.wait_for_function("() => location.hash.includes('view=scene')")
    phone.get_by_role("button", name="All panels").click()
    assert phone.locator(".controls").is_visible()
    phone.wait_for_function("() => !location.hash.includes('view=scene')")
    phone.locator(".stage canvas").press("f")
    assert phone.locator(".controls").is_hidden()
    phone.locator(".stage canvas").press("Escape")
    assert phone.locator(".controls").is_visible()


def test_a_map_follows_the_branch_of_each_frequency_and_says_so(opened):
    to_lesson(opened, "critical")
    opened.get_by_role("tab", name="Overturning map").click()
    opened.get_by_text("each from the upper branch of its own motion").wait_for()
    result = opened.evaluate(
        "() => { const { axes, filled } = window.stylobate.laboratory.plane('map');"
        " return axes.x.values.map((x, i) => [x, axes.y.values.map((y, j) => [y, filled.at(i, j)])]); }"
    )
    # At the acceleration of the case: rolling above the critical frequency, and nothing but that.
    for frequency, cells in result:
        nearest = min(cells, key=lambda cell: abs(cell[0] - 0.65))
        if frequency > 3.3:
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
