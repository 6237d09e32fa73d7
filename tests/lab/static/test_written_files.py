"""The files of the laboratory for a web server: what is recorded, and what is written."""

import json
import re

import pytest
from tests.lab.static.cases import FOLDER, LESSONS, OPENING, PRESETS, contents

from stylobate.errors import FileError
from stylobate.lab import answers, kernels, recorded, static_site


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


def test_what_is_loaded_before_the_first_motion_stays_small(written):
    _, sizes = written
    assert sizes.first < 310e3  # the page on the laboratory states its size
    assert sizes.single < 6e6


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
    "offline.js": "const known = offline.files;",
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
def test_the_worker_that_works_offline_knows_all_files_and_whether_one_has_changed(tmp_path, monkeypatch):
    def written(name):
        static_site.write(tmp_path / name, progress=False)
        line = (tmp_path / name / "offline.js").read_text(encoding="utf-8").partition("\n")[0]
        return json.loads(line.removeprefix("const offline = ").removesuffix(";"))

    first = written("first")
    found = {path.relative_to(tmp_path / "first").as_posix() for path in (tmp_path / "first").rglob("*.*")}
    assert {*first["files"], "offline.js", static_site.SINGLE_FILE} == found
    monkeypatch.setitem(PAGE, "main.css", "body { color: blue }")
    second = written("second")
    assert second["files"] == first["files"]
    assert second["version"] != first["version"]
    assert 'name="offline"' not in (tmp_path / "first" / static_site.SINGLE_FILE).read_text(encoding="utf-8")


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
