"""The laboratory as static files: the page with recorded answers, from a web server and from one file."""

import base64
import json
import re
import threading
import tomllib
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer

import numpy as np
import pytest
from tests.lab.browser import Watched, found_browser, moved, new_page, open_sections, shown
from tests.lab.test_jobs import followed
from tests.lab.test_page_mistakes import EXACT

import stylobate as sb
from stylobate.errors import FileError
from stylobate.lab import answers, kernels, recorded, static_site
from stylobate.lab.links import link_to
from stylobate.lab.options import lessons, presets
from stylobate.records.reading import write_at2

LESSONS, PRESETS = lessons(), presets()
OPENING = next(one for one in LESSONS if one.opens)
OUTCOME = "window.stylobate.laboratory.answer.outcome"
REFUSED = "This page has no answer for"
FOLDER = "some/where"


class Quiet(SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


def contents(page):
    """Return the list of answers in a page."""
    found = re.search('<script id="answers" type="application/json">(.*?)</script>', page)
    return json.loads(found[1])


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """Write the files, with exact orbits that are not computed; give the folder of the server and the sizes."""
    found_browser()
    root = tmp_path_factory.mktemp("site")
    programs = kernels.run_programs()
    needed = {kernels.program_of(case.values) for case in recorded.cases()} | {
        "slender_rest",
        "slender_smooth",
        "planar_rocking_harmonic",
    }
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(recorded._ANSWERED, "exact", lambda _: json.dumps(EXACT).encode())
        patch.setattr(kernels, "run_programs", lambda: {name: programs[name] for name in programs if name in needed})
        sizes = static_site.write(root / FOLDER, progress=False)
    return root, sizes


@pytest.fixture(scope="module")
def site(written):
    return written[0]


@pytest.fixture(scope="module")
def served(site):
    """Serve the files below a folder of a web server, and give the address."""
    with ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=str(site))) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        yield f"http://127.0.0.1:{server.server_port}/{FOLDER}/"
        server.shutdown()
        thread.join()


@pytest.fixture(params=["folder", "one file"])
def place(request, site):
    """Give the address of the page: in a folder of a web server, and in one file on disk."""
    if request.param == "folder":
        return request.getfixturevalue("served")
    return (site / FOLDER / static_site.SINGLE_FILE).as_uri()


@pytest.fixture
def opened(browser, place):
    context = browser.new_context(viewport={"width": 1280, "height": 860})
    found = Watched(new_page(context), place)
    asked = []
    found.page.on("request", lambda request: asked.append(request.url))
    found.page.goto(place)
    shown(found.page)
    yield found
    context.close()
    assert found.foreign == []
    assert found.said == []
    if place.startswith("file:"):
        # a worker's script is read from the page itself
        assert {address.partition("#")[0] for address in asked if not address.startswith("blob:null/")} == {place}


def refusals(page):
    """Return the texts of the page that say that it has no answer."""
    return page.evaluate(
        "words => [...document.querySelectorAll('.problems, .note, .said, .old-note, .plane-panel .problem, .shares')]"
        ".filter((one) => !one.hidden && one.textContent.includes(words)).map((one) => one.className)",
        REFUSED,
    )


def test_it_opens_on_the_first_lesson_and_moves(opened):
    page = opened.page
    assert page.get_by_role("heading", name=OPENING.question).is_visible()
    page.wait_for_function("() => window.stylobate.laboratory.clock.time > 0.5")
    page.wait_for_function("() => document.querySelector('.said').textContent.includes('1.397')")
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
        slider.press("PageDown")
    page.wait_for_function(f"() => {OUTCOME} === 'OVERTURNED'")
    page.get_by_text("the disturbance grows until the column falls").wait_for()
    assert page.evaluate("window.stylobate.state().description.motion.angular_frequency") < 1.39
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


def test_basins_and_animations_are_refused_where_they_are_asked_for(opened):
    page = opened.page
    page.get_by_role("tab", name="Basin").click()
    page.locator(".plane-panel.basin").get_by_role("button", name="Compute").click()
    page.locator(".plane-panel.basin .problem").get_by_text(f"{REFUSED} basins").wait_for()
    page.get_by_text("Export").click()
    page.get_by_role("button", name="Animation (GIF)").click()
    page.locator(".export-note").get_by_text(f"{REFUSED} animations").wait_for()


def test_the_map_is_computed_and_a_click_shows_its_run(opened):
    page = opened.page
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
    page = new_page(browser)
    page.route(re.compile("simulate-conveyor"), lambda route: route.abort())
    page.goto(served)
    shown(page)
    page.get_by_label("Preset").select_option("conveyor")
    page.locator(".problems").get_by_text("simulate-conveyor.json of this page cannot be loaded").wait_for()
    page.close()


def test_the_folder_opened_from_disk_names_the_file_to_open(site, browser):
    page = new_page(browser)
    page.goto((site / FOLDER / "index.html").as_uri())
    page.get_by_role("link", name=static_site.SINGLE_FILE).click()
    shown(page)
    page.close()


def test_the_policy_allows_nothing_but_the_page_itself(site):
    for name, scripts, workers in (
        ("index.html", "'self' 'wasm-unsafe-eval'", "'self'"),
        (static_site.SINGLE_FILE, "'sha256-", "blob:"),
    ):
        page = (site / FOLDER / name).read_text(encoding="utf-8")
        policy = dict(
            one.split(" ", 1) for one in re.search('Content-Security-Policy" content="(.*?)"', page)[1].split("; ")
        )
        assert policy["default-src"] == "'none'"
        assert policy["script-src"].startswith(scripts)
        assert "blob:" not in policy["script-src"]
        assert policy["worker-src"] == workers
        assert policy["connect-src"] == ("'self'" if name == "index.html" else "'none'")
        assert "unsafe-inline" not in str(policy)
        assert "unsafe-eval" not in str(policy).replace("wasm-unsafe-eval", "")


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
    for name in set(shown_here["measures"]) - {"steps"}:
        known = answer["measures"][name]
        loads = name in ("peak_friction_demand", "peak_pivoting_demand", "minimum_normal_force")
        known = known if known is None else pytest.approx(known, rel=5e-3 if loads else 1e-4, abs=1e-6)
        assert shown_here["measures"][name] == known, name
    rows = dict(answer["summary"])
    assert {label: text for label, text in shown_here["summary"] if label in ("column", "uplifts above", "events")} == {
        label: rows[label] for label in ("column", "uplifts above", "events")
    }


BLOCK = {"shape": "solid", "radius": 0.3, "height": 3.0, "density": 2500.0}
EL_CENTRO = {"kind": "record", "sample": "el centro 1940"}
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


def test_own_files_are_read_in_the_page_and_shake_the_column(opened, tmp_path, client):
    quake = sb.sample_record().trimmed(end=20.0)
    files = [write_at2(quake, tmp_path / name, axis=axis) for name, axis in (("Q000.AT2", "x"), ("Q270.AT2", "y"))]
    page = opened.page
    page.get_by_label("Preset").select_option("temple")
    page.wait_for_function("() => window.stylobate.laboratory.answer.toml.includes('el centro')")
    open_sections(page)
    page.locator("input[type=file]").set_input_files(files)
    page.wait_for_function("() => window.stylobate.laboratory.answer.toml.includes('Q000.AT2')")
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


@pytest.fixture(scope="module")
def page_of_sources(served, browser):
    """Open a page whose source is asked."""
    page = new_page(browser)
    page.goto(served)
    page.wait_for_function("() => window.stylobate?.source")
    yield page
    page.close()


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


MAP = {
    "column": {"shape": "dimensionless", "slenderness": 0.1},
    "model": {"kind": "slender", "damping": 0.1},
    "motion": {"kind": "circular", "acceleration": 0.065, "angular_frequency": 1.8},
    "tilt": [0.03, 0.01],
    "periods": 40,
    "map": {
        "x": {"name": "angular_frequency", "from": 0.6, "to": 3.4, "number": 9},
        "y": {"name": "acceleration", "from": 0.02, "to": 0.18, "number": 8},
    },
}


MAPPED = """async (asked) => {
    const job = await window.stylobate.source.startJob("map", asked);
    for (;;) {
        const report = await job.report(0);
        if (report.state !== "running") return report;
        await new Promise((resolve) => setTimeout(resolve, 20));
    }
}"""


def without_workers(page):
    """Wait until a page has no worker; return whether it has none."""
    for _ in range(100):
        if not page.workers:
            return True
        page.wait_for_timeout(50)
    return False


@pytest.mark.parametrize("start", [None, "upper"])
def test_computed_maps_are_those_of_the_server(start, place, browser, client):
    page = new_page(browser)
    page.goto(place)
    shown(page)
    asked = {"description": MAP, **({} if start is None else {"start": start})}
    with page.expect_worker() as worker:
        found = page.evaluate(MAPPED, asked)
    assert worker.value.url.startswith("blob:" if place.startswith("file:") else place)
    assert without_workers(page)  # they end with the map
    page.close()
    known = followed(client, client.post("/api/jobs", json={"kind": "map", **asked}).json()["id"])
    assert found["result"]["codes"] == known["result"]["codes"]
    (ours, _), (theirs, _) = (one["events"][:2] for one in (found, known))
    assert ours["names"] == theirs["names"]
    for axis in "xy":
        values = [one["axes"][axis].pop("values") for one in (ours, theirs)]
        assert values[0] == pytest.approx(values[1])
        assert ours["axes"][axis] == theirs["axes"][axis]
    shares = [{one["name"]: one["share"] for one in job["result"]["classes"] if one["share"]} for job in (found, known)]
    assert shares[0] == pytest.approx(shares[1])
    assert (found["done"], found["total"]) == (72, 72)


@pytest.mark.parametrize(
    ("kind", "motion", "axes"),
    [
        ("slender", {"kind": "one_sine", "angular_frequency": 6.0}, {"acceleration": (2.0, 9.0), "height": (1.5, 4.0)}),
        ("wobbling", EL_CENTRO, {"scale": (0.4, 2.4), "damping": (0.005, 0.05)}),
    ],
)
def test_computed_maps_under_pulses_and_records_are_those_of_the_server(kind, motion, axes, page_of_sources, client):
    (x, across), (y, up) = axes.items()
    plan = {
        "x": {"name": x, "from": across[0], "to": across[1], "number": 6},
        "y": {"name": y, "from": up[0], "to": up[1], "number": 5},
    }
    start = {"acceleration": 2.0} if kind == "slender" else {"scale": 1.0}
    asked = {
        "description": {
            "column": BLOCK,
            "model": {"kind": kind, "damping": 0.02},
            "motion": {**motion, **start},
            "map": plan,
        }
    }
    found = page_of_sources.evaluate(MAPPED, asked)
    known = followed(client, client.post("/api/jobs", json={"kind": "map", **asked}).json()["id"])
    assert (found["state"], found["problems"]) == ("done", [])
    codes, theirs = (np.array(one["result"]["codes"]) for one in (found, known))
    assert len(set(theirs.ravel().tolist())) > 1
    np.testing.assert_array_equal(codes, theirs)


def test_a_cancelled_map_stops_at_once(place, browser):
    page = new_page(browser)
    page.goto(place)
    shown(page)
    axes = {axis: {**one, "number": 40} for axis, one in MAP["map"].items()}
    stopped, later = page.evaluate(
        """async (asked) => {
            const job = await window.stylobate.source.startJob("map", asked);
            while ((await job.report(0)).done === 0) await new Promise((resolve) => setTimeout(resolve, 5));
            await job.cancel();
            const stopped = await job.report(0);
            await new Promise((resolve) => setTimeout(resolve, 300));
            return [stopped, await job.report(0)];
        }""",
        {"description": {**MAP, "periods": 400, "map": axes}},
    )
    assert stopped["state"] == later["state"] == "cancelled"
    assert stopped["done"] == later["done"] < 40 * 40
    assert without_workers(page)
    page.close()


NO_WORKERS = {
    "forbidden": "window.Worker = class { constructor() { throw new Error('forbidden'); } };",
    "not loaded": "window.Worker = class extends window.Worker { constructor() { super('missing.js'); } };",
    "without modules": "Worker.prototype.postMessage = ((post) => function (data) {"
    " post.call(this, 'runs' in data ? data : {}); })(Worker.prototype.postMessage);",
}


def test_several_workers_share_a_map(served, browser):
    maps = []
    for cores in (2, 4):
        page = new_page(browser)
        page.add_init_script(f"Object.defineProperty(navigator, 'hardwareConcurrency', {{ value: {cores} }});")
        workers = []
        page.on("worker", lambda worker, workers=workers: workers.append(worker.url))
        page.goto(served)
        shown(page)
        maps.append(page.evaluate(MAPPED, {"description": MAP})["result"])
        assert len(workers) == cores - 1
        page.close()
    assert maps[0] == maps[1]


@pytest.mark.parametrize("script", NO_WORKERS.values(), ids=NO_WORKERS)
def test_a_page_whose_workers_cannot_start_computes_maps_itself(script, served, browser):
    maps = []
    for one in ("", script):
        page = new_page(browser)
        page.add_init_script(one)
        page.goto(served)
        shown(page)
        maps.append(page.evaluate(MAPPED, {"description": MAP})["result"])
        page.close()
    assert maps[0] == maps[1]


def test_what_is_loaded_before_the_first_motion_stays_small(written):
    _, sizes = written
    assert sizes.first < 300e3  # the page on the laboratory states its size
    assert sizes.single < 6e6


# Without a browser


def test_the_opening_lesson_is_recorded_first_and_all_presets_and_lessons_are():
    cases = [one.identity for one in recorded.cases()]
    assert cases[0] == OPENING.identity
    assert {one.identity for one in (*PRESETS, *LESSONS)} <= set(cases)


def test_a_new_preset_is_recorded(monkeypatch):
    motion = {"kind": "circular", "acceleration": 0.05, "angular_frequency": 7.0}
    description = {**PRESETS[0].description, "motion": motion}
    new = PRESETS[0].model_copy(update={"identity": "new", "description": description})
    monkeypatch.setattr(recorded, "presets", lambda: [*PRESETS, new])
    found = {one.ask: one.values for one in recorded.questions() if one.name.endswith("-new")}
    assert kernels.program_of(description) == "slender_harmonic"  # so the page computes it
    assert found["response"]["angular_frequency_range"] == [0.2, 10.0]  # wide enough for its frequency
    assert set(found) == {"variations", "response", "exact"}


def test_a_refusal_is_recorded():
    values = {**PRESETS[0].description, "model": {"kind": "slender", "damping": -1.0}}
    answer = recorded.answer_to(recorded.Question("simulate", values, "refused"))
    (problem,) = answers.Problems.model_validate_json(answer).problems
    assert problem.startswith("model: damping must be zero or positive")


@pytest.fixture
def one_case(monkeypatch):
    """Record one case only, and no exact orbits."""
    first = next(recorded.cases())
    monkeypatch.setattr(recorded, "cases", lambda: [first])
    monkeypatch.setitem(recorded._ANSWERED, "exact", lambda _: b"{}")
    monkeypatch.setattr(kernels, "files", lambda: {f"{name}.wasm": b"module" for name in kernels.ALWAYS})
    monkeypatch.setattr(static_site, "_page_file", PAGE.__getitem__)
    monkeypatch.setattr(static_site, "page_is_built", lambda: True)


PAGE = {
    "index.html": f"{static_site._HEAD}{static_site._STYLE}{static_site._SCRIPT}{static_site._WAITING}</body>",
    "main.css": "body { color: red }",
    "main.js": 'const end = "</script><!-- ";',
    "worker.js": 'const end = "</script>";',
}


@pytest.mark.usefixtures("one_case")
def test_the_same_files_are_written_each_time(tmp_path):
    found = []
    for name in ("first", "second"):
        sizes = static_site.write(tmp_path / name, progress=False)
        files = {
            path.relative_to(tmp_path / name).as_posix(): path.read_bytes()
            for path in (tmp_path / name).rglob("*")
            if path.is_file()
        }
        found.append(files)
    first, second = found
    assert first == second
    single = first.pop(static_site.SINGLE_FILE)
    assert (sizes.files, sizes.folder) == (len(first), sum(map(len, first.values())))
    assert sizes.single == len(single)
    held = len(contents(single.decode())["answers"]) + len(kernels.ALWAYS)
    assert single.count(b"</script>") == 1 + held + 2


@pytest.mark.usefixtures("one_case")
def test_a_folder_that_cannot_be_made_is_refused_before_anything_is_computed(tmp_path, monkeypatch):
    monkeypatch.setattr(static_site, "answer_to", lambda _: pytest.fail("computed"))
    (tmp_path / "file").touch()
    with pytest.raises(FileError, match="cannot be made"):
        static_site.write(tmp_path / "file", progress=False)


def test_a_page_that_is_not_built_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(static_site, "page_is_built", lambda: False)
    with pytest.raises(FileError, match="make page"):
        static_site.write(tmp_path, progress=False)
