"""The page of the laboratory as static files: what it opens, computes, refuses and saves."""

import base64
import re
import tomllib
import zipfile

import numpy as np
import pytest
from tests.lab.browser import moved, new_page, open_sections, shown
from tests.lab.static.cases import FOLDER, LESSONS, OPENING, PRESETS, REFUSED, refusals

import stylobate as sb
from stylobate.lab import static_site
from stylobate.lab.links import link_to
from stylobate.records.reading import write_at2

OUTCOME = "window.stylobate.laboratory.answer.outcome"


def test_it_opens_on_the_first_lesson_and_moves(opened):
    page = opened.page
    assert page.get_by_role("heading", name=OPENING.question).is_visible()
    page.wait_for_function("() => window.stylobate.laboratory.clock.time > 0.5")
    page.get_by_text("It stands, however long you wait.").wait_for()
    assert refusals(page) == []


def test_every_preset_opens_with_its_outcome_its_curves_and_its_orbits(opened):
    page = opened.page
    for preset in PRESETS:
        page.get_by_label("Preset").select_option(preset.identity)
        page.wait_for_function(
            f"() => window.stylobate.laboratory.answer.toml.includes('{preset.description['model']['kind']}')"
        )
        page.wait_for_function(f"() => {OUTCOME} === '{preset.outcome}'")
        shown(page)
        exact = page.get_by_role("button", name="Exact orbits")
        if exact.is_visible() and exact.is_enabled():
            page.wait_for_function("() => document.querySelector('.response .note').textContent.startsWith('Steady')")
            exact.click()
            page.locator(".response .note").get_by_text("1 family of exact orbits").wait_for()
        page.get_by_role("button", name="Vary it").click()
        page.locator(".shares").get_by_text("64 small variations").wait_for()
        assert refusals(page) == [], preset.identity


def test_every_lesson_and_preset_is_a_link_and_every_choice_has_an_answer(opened, place):
    page = opened.page
    for lesson in LESSONS:
        page.goto(f"{place}#lesson={lesson.identity}")
        page.get_by_role("heading", name=lesson.question).wait_for()
        page.wait_for_function("() => document.querySelector('.said').textContent !== ''")
        assert refusals(page) == []
    for preset in PRESETS:
        page.goto(f"{place}#case={preset.identity}")
        page.wait_for_function(f"() => {OUTCOME} === '{preset.outcome}'")
        assert refusals(page) == []
    page.goto(f"{place}#lesson=spin")
    page.get_by_label("may spin").check()
    page.wait_for_function(f"() => {OUTCOME} === 'AT_REST'")
    assert refusals(page) == []


def test_the_page_computes_the_runs_of_other_numbers(opened):
    page = opened.page
    slider = page.locator(".lesson .slider")
    slider.focus()
    for _ in range(20):
        slider.press("PageUp")
    page.wait_for_function(f"() => {OUTCOME} === 'ROCKING'")
    page.get_by_text("A column that lifts need not fall").wait_for()
    assert page.evaluate("window.stylobate.state().description.motion.acceleration") > 1.97
    assert page.locator(".problems").is_hidden()
    assert page.evaluate("window.stylobate.laboratory.answer.drawn.time.length") > 100


def test_numbers_without_an_answer_are_refused_in_one_line_and_the_page_goes_on(opened, place):
    page = opened.page
    page.get_by_label("Preset").select_option("conveyor")
    page.wait_for_function("() => window.stylobate.laboratory.answer.toml.includes('oblique')")
    open_sections(page)
    moved(page, "angle", 0.4)
    problems = page.locator(".problems")
    problems.get_by_text(f"{REFUSED} these numbers. Install stylobate and run").wait_for()
    assert problems.locator("p").count() == 1
    assert page.locator(".banner").is_hidden()
    page.goto(f"{place}#lesson=stands")
    page.get_by_text("It stands, however long you wait.").wait_for()
    assert problems.is_hidden()
    open_sections(page)
    moved(page, "acceleration", 1.25)
    page.wait_for_function("() => window.stylobate.laboratory.answer.toml.includes('acceleration = 1.25')")
    assert problems.is_hidden()
    page.wait_for_function(f"() => !document.querySelector('.response .note').textContent.includes('{REFUSED}')")
    assert refusals(page) == []


def tabs(page):
    return page.locator("[role=tab]:visible").all_inner_texts()


def test_only_what_the_page_can_answer_is_offered(opened, place):
    page = opened.page
    exact, vary = (page.get_by_role("button", name=name) for name in ("Exact orbits", "Vary it"))
    page.get_by_label("Preset").select_option("circle-strong")
    exact.wait_for()
    assert vary.is_visible()
    assert tabs(page) == ["Tilt path", "Overturning map", "Numbers"]
    page.get_by_text("Export").click()
    assert page.get_by_role("button", name="Python…").is_visible()
    assert page.get_by_role("button", name="Animation (GIF)").is_hidden()
    open_sections(page)
    moved(page, "damping", 0.07)  # a case with its own curves, of which nothing was recorded
    exact.wait_for(state="hidden")
    vary.wait_for(state="hidden")
    page.get_by_label("Preset").select_option("conveyor")  # its model slides
    vary.wait_for()
    assert tabs(page) == ["Tilt path", "Numbers"]
    assert page.locator(".response").is_hidden()
    page.goto("about:blank")
    page.goto(f"{place}#case=circle-strong&tab=basin")  # of a page with a server
    shown(page)
    assert page.get_by_role("tab", name="Tilt path").get_attribute("aria-selected") == "true"


def test_the_map_is_computed_and_a_click_shows_its_run(opened):
    page = opened.page
    page.get_by_label("Preset").select_option("circle-strong")
    page.get_by_role("tab", name="Overturning map").click()
    panel = page.locator(".plane-panel.map")
    panel.get_by_text("625 runs of").wait_for()
    assert panel.get_by_text("rolling").first.is_visible()
    assert refusals(page) == []


def test_a_link_to_an_unrecorded_case_shows_the_first_lesson_and_says_why(opened, place):
    page = opened.page
    page.goto("about:blank")
    page.goto(f"{place}#column=dimensionless,slenderness:0.2&model=sliding&motion=rest&duration=3")
    shown(page)
    page.locator(".problems").get_by_text(f"This link cannot be opened: {REFUSED} these numbers").wait_for()
    assert page.get_by_role("heading", name=OPENING.question).is_visible()


LINKED = [one for one in PRESETS if one.identity in ("line-strong", "shaker", "temple")]


@pytest.mark.parametrize("preset", LINKED, ids=lambda one: one.identity)
def test_a_link_that_python_writes_opens_the_described_case(preset, served, browser):
    page = new_page(browser)
    page.goto(f"{served}#{link_to(preset.description)}")
    shown(page)
    assert page.evaluate("() => window.stylobate.state().description") == preset.description
    assert page.evaluate("() => window.stylobate.state().lesson") is None
    page.close()


def test_program_and_link_of_a_case_are_shown(opened, place):
    page = opened.page
    dialog = page.locator(".export dialog")
    for item, text in (("Python…", "import stylobate"), ("Link to this view…", f"{place}#column=")):
        page.get_by_text("Export").click()
        page.get_by_role("button", name=item).click()
        dialog.get_by_text(text).wait_for()
        dialog.get_by_role("button", name="Close").click()


def test_a_picture_is_saved_and_the_policy_lets_webassembly_be_compiled(opened):
    page = opened.page
    page.get_by_text("Export").click()
    with page.expect_download() as saved:
        page.get_by_role("button", name="Picture of the motion (PNG)").click()
    assert saved.value.suggested_filename == "stylobate.png"
    module = "new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0])"
    assert page.evaluate(f"async () => (await WebAssembly.compile({module})) instanceof WebAssembly.Module")


def test_a_missing_file_of_answers_is_reported(served, browser):
    context = browser.new_context(service_workers="block")  # it would have loaded the file already
    page = new_page(context)
    page.route(re.compile("simulate-conveyor"), lambda route: route.abort())
    page.goto(served)
    shown(page)
    page.get_by_label("Preset").select_option("conveyor")
    page.locator(".problems").get_by_text("simulate-conveyor.json of this page cannot be loaded").wait_for()
    context.close()


def test_the_folder_opened_from_disk_names_the_file_to_open(site, browser):
    page = new_page(browser)
    page.goto((site / FOLDER / "index.html").as_uri())
    page.get_by_role("link", name=static_site.SINGLE_FILE).click()
    shown(page)
    page.close()


def test_own_files_are_read_in_the_page_and_shake_the_column(opened, tmp_path, client):
    quake = sb.sample_record().trimmed(end=20.0)
    files = [write_at2(quake, tmp_path / name, axis=axis) for name, axis in (("Q000.AT2", "x"), ("Q270.AT2", "y"))]
    page = opened.page
    page.get_by_label("Preset").select_option("temple")
    page.wait_for_function("() => window.stylobate.laboratory.answer.toml.includes('el centro')")
    open_sections(page)
    packed = tmp_path / "PEER.zip"
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for path in files:
            archive.write(path, path.name)
    page.locator("input[type=file]").set_input_files(packed)
    page.wait_for_function("() => window.stylobate.laboratory.answer.toml.includes('PEER.zip/Q000.AT2')")
    page.locator("input[type=file]").set_input_files(files)
    page.wait_for_function("() => window.stylobate.laboratory.answer.toml.includes('\"Q000.AT2')")
    found = page.evaluate("() => window.stylobate.laboratory.answer")
    values = tomllib.loads(found["toml"])
    assert values["motion"] == {"kind": "record", "path": ["Q000.AT2", "Q270.AT2"], "one_component": True, "scale": 1}
    contents = [{"name": path.name, "content": base64.b64encode(path.read_bytes()).decode()} for path in files]
    upload = client.post("/api/records", json={"files": contents, "units": None, "step": None}).json()
    assert page.locator(".record .hint").inner_text().startswith(f"{upload['name']}: {upload['samples']} samples")
    asked = {**values, "motion": {"kind": "record", "upload": upload["upload"], "scale": 1}}
    known = client.post("/api/simulate", json=asked).json()
    assert (found["outcome"], found["reason"]) == (known["outcome"], known["reason"])
    np.testing.assert_allclose(found["drawn"]["tilt"], known["drawn"]["tilt"], rtol=1e-6, atol=2e-6)
    assert refusals(page) == []
