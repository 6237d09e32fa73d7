"""The page in a real browser."""

import re
import statistics

import numpy as np
import pytest
from tests.lab.browser import enter, in_own_case, moved, new_page, shown
from tests.lab.conftest import laboratory

import stylobate as sb
from stylobate.config import SimulationConfig
from stylobate.lab.options import lessons, presets
from stylobate.records.reading import write_at2
from stylobate.results.run_rows import measure_rows

PRESETS = {preset.identity: preset for preset in presets()}
# What the page reads back from the drawn column: doubles, interpolated on samples of seven digits.
DRAWN = 2e-6


def test_it_loads_without_an_error_and_without_a_request_to_elsewhere(watched):
    assert watched.said == []
    assert watched.page.evaluate("() => window.stylobate.laboratory.answer.outcome") == "ROLLING"
    assert watched.page.get_by_text("once round in each of the last 10 periods").is_visible()


def test_a_record_is_uploaded_from_any_case_by_a_button(page, tmp_path):
    file = write_at2(sb.sample_record().trimmed(end=5.0), tmp_path / "own.AT2", axis="x")
    page.get_by_label("Preset").select_option("vase")
    page.locator(".record").wait_for(state="hidden")
    with page.expect_file_chooser() as chosen:
        page.get_by_role("button", name="Upload a record…").click()
    chosen.value.set_files(file)
    page.wait_for_function("() => window.stylobate.state().description.motion.kind === 'record'")
    assert page.locator(".record .hint").is_visible()


@pytest.mark.slow
@pytest.mark.parametrize("preset", ["spin-up", "shaker", "conveyor", "averaging-fails"])
def test_the_motion_drawn_is_the_motion_computed(watched, preset):
    described = PRESETS[preset]
    page = watched.page
    page.get_by_label("Preset").select_option(described.title)
    page.wait_for_function(f"() => window.stylobate.laboratory.answer.outcome === '{described.outcome}'")
    shown(page)
    page.evaluate("() => window.stylobate.laboratory.clock.pause()")
    setup = SimulationConfig.parse(described.description).build()
    run = sb.simulate(setup.model, setup.motion, **setup.options)
    times = page.evaluate("() => window.stylobate.laboratory.answer.drawn.time")
    radius = setup.model.column.radius
    for time in np.array(times)[np.linspace(0, len(times) - 1, 40).astype(int)][1:-1]:
        drawn = page.evaluate("t => (window.stylobate.stage.setTime(t), window.stylobate.stage.pose())", float(time))
        data = run.sample([float(time)]).isel(time=0)
        assert drawn["tilt"] == pytest.approx(data["tilt"].values, abs=DRAWN)
        if float(data["amplitude"]) > 1e-6:  # a column that stands touches with all of its rim
            assert drawn["contact"] == pytest.approx(data["contact_point"].values, abs=DRAWN * max(1.0, radius))
        if "twist" in data:
            turned = drawn["twist"] - float(data["twist"])
            assert np.remainder(turned + np.pi, 2.0 * np.pi) - np.pi == pytest.approx(0.0, abs=5.0 * DRAWN)
        if "spin" in data:
            told = page.evaluate(
                "t => { const d = window.stylobate.laboratory.answer.drawn; return d.spin[d.time.indexOf(t)]; }",
                float(time),
            )
            assert told == pytest.approx(float(data["spin"]), abs=1e-6, rel=1e-6)


def test_a_moved_slider_moves_motion_and_curves(watched):
    page = watched.page
    before = page.evaluate("() => window.stylobate.laboratory.answer.measures.peak_tilt")
    slider = page.get_by_label("Damping, slider")
    slider.focus()
    with page.expect_response(re.compile("/api/response")), page.expect_response(re.compile("/api/simulate")):
        slider.press("ArrowRight")
    page.wait_for_function(f"() => window.stylobate.laboratory.answer.measures.peak_tilt !== {before}")
    damping = page.evaluate("() => window.stylobate.state().description.model.damping")
    assert damping > 0.1
    page.wait_for_function(f"() => decodeURIComponent(location.hash).includes('damping:{damping}')")


def test_a_link_shows_the_same_again(watched):
    page = watched.page
    tilt = "window.stylobate.state().description.tilt[0]"
    before = page.evaluate(f"() => {tilt}")
    moved(page, "acceleration", 0.07)
    # On its branch the column starts elsewhere; the address follows a moment later.
    page.wait_for_function(f"() => {tilt} !== {before} && location.hash.includes(String({tilt}))")
    other = new_page(page.context)
    other.goto(page.evaluate("() => location.href"))
    shown(other)
    for part in ("state()", "laboratory.answer.outcome", "laboratory.answer.measures"):
        told = f"() => window.stylobate.{part}"
        assert other.evaluate(told) == page.evaluate(told)
    other.close()


def test_what_is_drawn_over_time_is_chosen_and_kept_in_the_link(watched):
    page = watched.page
    page.get_by_role("combobox", name="Lower history").select_option("Base acceleration along x")
    page.wait_for_function("() => location.hash.includes('histories=tilt,base_x')")
    other = new_page(page.context)
    other.goto(page.evaluate("() => location.href"))
    shown(other)
    chosen = "() => [...document.querySelectorAll('.time-chart select')].map(one => one.value)"
    assert other.evaluate(chosen) == ["tilt", "base_x"]
    other.close()


def test_a_part_that_slides_shows_how_far_and_the_numbers_of_the_command_line(watched):
    page = watched.page
    preset = PRESETS["conveyor"]
    page.get_by_label("Preset").select_option(preset.title)
    page.wait_for_function(f"() => window.stylobate.laboratory.answer.outcome === '{preset.outcome}'")
    upper = page.get_by_role("combobox", name="Upper history")
    assert upper.evaluate("one => one.value") == "displacement_x"
    page.get_by_role("tab", name="Numbers").click()
    setup = SimulationConfig.parse(preset.description).build()
    rows = measure_rows(sb.simulate(setup.model, setup.motion, **setup.options))
    table = page.get_by_role("region", name="Numbers of the run")
    moved_by = next(text for label, text in rows if label == "moved by")
    assert table.get_by_text(moved_by, exact=True).is_visible()


def test_a_run_lasts_as_long_as_it_needs_and_over_a_base_at_rest_needs_a_length(watched):
    page = watched.page
    duration = "window.stylobate.state().description.duration"
    moved(page, "duration", 20.0)
    page.wait_for_function(f"() => {duration} === 20")
    motions = page.get_by_label("Base motion", exact=True)
    motions.select_option("ricker")
    page.wait_for_function(f"() => {duration} === null")
    motions.select_option("rest")
    page.wait_for_function(f"() => {duration} > 0")


def test_while_another_case_is_computed_the_one_before_is_dimmed(watched):
    page = watched.page
    page.evaluate(
        """() => {
            const fetched = window.fetch;
            window.fetch = async (...asked) => {
                if (String(asked[0]).includes("simulate")) await new Promise((done) => { window.answerNow = done; });
                return fetched(...asked);
            };
        }"""
    )
    page.get_by_label("Preset").select_option(PRESETS["vase"].title)
    picture = "() => Number(getComputedStyle(document.querySelector('.stage canvas')).opacity)"
    page.wait_for_function(f"() => ({picture})() < 0.5")
    assert page.evaluate("() => window.stylobate.laboratory.answer.outcome") == "ROLLING"
    page.evaluate("() => window.answerNow()")
    page.wait_for_function("() => window.stylobate.laboratory.answer.outcome === 'AT_REST'")
    page.wait_for_function(f"() => ({picture})() === 1")


def test_a_broken_link_is_told_and_the_first_lesson_shown(browser, address):
    page = new_page(browser)
    enter(page, address, "#column=nonsense&motion=circular")
    shown(page)
    assert page.get_by_role("alert").filter(has_text="nonsense").is_visible()
    assert page.get_by_role("heading", name=lessons()[0].question).is_visible()
    assert page.evaluate("() => window.stylobate.laboratory.answer.outcome") == "AT_REST"
    page.close()


def test_a_run_that_takes_long_is_cancelled(watched):
    page = watched.page
    page.route(re.compile("/api/simulate"), lambda route: None)  # never answered
    with page.expect_request(re.compile("/api/simulate")):  # after the start on its branch is known
        moved(page, "damping", 0.2)
    with page.expect_event("requestfailed", lambda request: "simulate" in request.url):
        page.locator(".stage").get_by_role("button", name="Cancel").click()
    assert page.get_by_text("The run was cancelled.").first.is_visible()
    page.wait_for_function("() => !document.querySelector('.stage.busy')")


def test_a_broken_record_shows_its_one_line(watched):
    page = watched.page
    page.get_by_label("Base motion", exact=True).select_option("record")
    page.locator("input[type=file]").set_input_files(
        files=[{"name": "quake.AT2", "mimeType": "text/plain", "buffer": b"rubbish\r\n"}]
    )
    told = page.get_by_text("quake.AT2, line 1: not a number: 'rubbish'")
    told.first.wait_for()
    assert told.first.is_visible()


def test_the_keyboard_plays_and_pauses(watched):
    page = watched.page
    playing = "() => window.stylobate.laboratory.clock.playing"
    before = page.evaluate(playing)
    page.locator("body").press(" ")
    assert page.evaluate(playing) is not before


def test_who_wants_no_motion_gets_none_unasked(browser, address):
    context = browser.new_context(reduced_motion="reduce")
    page = new_page(context)
    enter(page, address)
    shown(page)
    assert page.evaluate("() => window.stylobate.laboratory.clock.playing") is False
    context.close()


@pytest.mark.parametrize(
    ("width", "scheme"),
    [
        (390, "dark"),
        (1280, "light"),
        pytest.param(390, "light", marks=pytest.mark.slow),
        pytest.param(1280, "dark", marks=pytest.mark.slow),
    ],
)
def test_nothing_overflows(browser, address, width, scheme):
    context = browser.new_context(viewport={"width": width, "height": 844}, color_scheme=scheme)
    page = new_page(context)
    enter(page, address)
    shown(page)
    assert page.evaluate("() => document.documentElement.scrollWidth") <= width
    context.close()


def test_every_control_has_a_name(watched):
    nameless = watched.page.evaluate(
        """() => [...document.querySelectorAll('input, select, button, canvas[tabindex]')]
          .filter(one => one.checkVisibility())
          .filter(one => !(one.ariaLabel || one.labels?.length || one.textContent.trim() || one.title
            || one.getAttribute('aria-labelledby')))
          .map(one => one.outerHTML.slice(0, 80))"""
    )
    assert nameless == []


@pytest.mark.slow
def test_the_page_tells_when_the_server_is_gone_and_recovers(browser):
    page = new_page(browser)
    with laboratory() as address:
        enter(page, address)
        shown(page)
        in_own_case(page)
    page.get_by_label("Damping, slider").press("ArrowRight")
    banner = page.get_by_text("The server does not answer")
    banner.wait_for()
    with laboratory(port=int(address.rpartition(":")[2])):
        banner.wait_for(state="hidden", timeout=60_000)
        damping = page.evaluate("() => window.stylobate.state().description.model.damping")
        assert damping > 0.1
        page.wait_for_function(f"() => window.stylobate.laboratory.answer.python.includes('damping={damping})')")
        page.close()


FRAMES_OF_A_SECOND = """() => new Promise((done) => {
    const { clock } = window.stylobate.laboratory, begun = performance.now();
    let frames = 0;
    const draw = (now) => {
        window.stylobate.stage.setTime(clock.to * ((frames += 1) % 100) / 100);
        if (now - begun < 1000) requestAnimationFrame(draw); else done(1000 * frames / (now - begun));
    };
    requestAnimationFrame(draw);
})"""

TIME_OF_A_STEP = """() => {
    const { laboratory } = window.stylobate, slider = document.activeElement;
    window.stepped = new Promise((done) => slider.addEventListener("input", () => {
        const begun = performance.now(), before = laboratory.answer;
        const look = () => laboratory.answer === before ? requestAnimationFrame(look) : done(performance.now() - begun);
        look();
    }, { capture: true, once: true }));
}"""

ANSWERS_ALONE = """async () => {
    const { tilt, tilt_rate, ...body } = window.stylobate.state().description, begun = performance.now();
    const asked = async (path, body) => (await fetch(path, {
        method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body),
    })).json();
    const { column, model, motion } = body;
    const start = await asked("/api/start", { column, model, motion, branch: "upper" });
    const run = await asked("/api/simulate", { ...body, tilt: start.tilt, tilt_rate: start.tilt_rate });
    if (run.outcome === undefined) throw new Error(JSON.stringify([start, run]));
    return performance.now() - begun;
}"""


@pytest.mark.slow
def test_curves_follow_a_slider_and_the_animation_runs(watched):
    """Times are compared with those of the browser and the server alone, on the same machine."""
    page = watched.page
    page.evaluate("() => { window.everyFrame(); window.stylobate.laboratory.clock.pause(); }")
    alone = statistics.median(page.evaluate(FRAMES_OF_A_SECOND) for _ in range(3))
    page.evaluate("() => window.stylobate.laboratory.clock.play()")
    rates = []
    for _ in range(3):
        page.wait_for_timeout(1000)
        rates.append(page.evaluate("() => window.stylobate.stage.frameRate()"))
    page.evaluate("() => window.stylobate.laboratory.clock.pause()")
    slider = page.get_by_label("Damping, slider")
    slider.focus()
    took, answers = [], []
    for _ in range(15):
        page.evaluate(TIME_OF_A_STEP)
        with page.expect_response(re.compile("/api/response")):
            slider.press("ArrowRight")
        took.append(page.evaluate("() => window.stepped"))
        answers.append(page.evaluate(ANSWERS_ALONE))
    assert statistics.median(rates) >= 0.5 * alone
    assert statistics.median(took) <= 4.0 * statistics.median(answers)
