"""What a release holds: README as an index shows it, bundles of the laboratory's page, files of the sources."""

import hashlib
import importlib.util
import json
import shutil
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from pathlib import Path

import pytest
from hatchling.builders.sdist import SdistBuilder
from hatchling.builders.wheel import WheelBuilder
from markdown_it import MarkdownIt

ROOT = Path(__file__).parents[1]
WEB = "src/stylobate/lab/web"
BUNDLES = ("stylobate/lab/page/main.js", "stylobate/lab/page/worker.js", "stylobate/plots/animation/viewer.js")


def inline_tokens(text):
    """Return the words, links and images of a page."""
    blocks = MarkdownIt("commonmark").enable("table").parse(text)
    return [token for block in blocks for token in block.children or [] if token.type != "softbreak"]


def links_of(text):
    attributes = [token.attrs for token in inline_tokens(text)]
    return [str(attrs[name]) for attrs in attributes for name in ("href", "src") if name in attrs]


@pytest.fixture(scope="module")
def index_page():
    """The README in the metadata of a release."""
    asked = [sys.executable, "-m", "hatchling", "metadata"]
    return json.loads(subprocess.run(asked, cwd=ROOT, check=True, capture_output=True).stdout)["readme"]["text"]


def test_each_link_and_image_of_the_index_page_has_a_full_address(index_page):
    assert [link for link in links_of(index_page) if not link.startswith(("https://", "#"))] == []
    external = [link for link in links_of((ROOT / "README.md").read_text("utf-8")) if link.startswith("https://")]
    assert [link for link in links_of(index_page) if link in external] == external


def test_the_index_page_has_the_words_and_code_of_the_readme(index_page):
    readme = (ROOT / "README.md").read_text("utf-8")
    for kind in ("text", "code_inline"):
        pages = [
            [token.content for token in inline_tokens(text) if token.type == kind] for text in (readme, index_page)
        ]
        assert "".join(pages[0]) == "".join(pages[1])


def test_the_interpreters_of_the_classifiers_are_allowed_and_include_the_lowest():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    named = [line.rpartition(" ")[2] for line in project["classifiers"] if "Python :: 3." in line]
    assert project["requires-python"] == f">={named[0]}"


@pytest.fixture
def tree(tmp_path, monkeypatch):
    """A small package with this project's build files and current bundles, and no npm."""
    monkeypatch.setenv("PATH", "")
    monkeypatch.delenv("STYLOBATE_WITHOUT_PAGE", raising=False)
    for name in ("pyproject.toml", "hatch_build.py", "README.md", "LICENSE", ".gitignore"):
        shutil.copy(ROOT / name, tmp_path)
    sources = {"src/stylobate/__init__.py": "", f"{WEB}/build.mjs": "build()\n", f"{WEB}/src/page/main.ts": "main()\n"}
    for name, text in sources.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_bytes(text.encode())
    # Written out: one line for each source, sorted by name, hashed once more.
    hashed = {name: hashlib.sha256(text.encode()).hexdigest() for name, text in sources.items()}
    lines = "".join(f"{name} {hashed[f'{WEB}/{name}']}\n" for name in ("build.mjs", "src/page/main.ts"))
    for name in BUNDLES:
        bundle = tmp_path / "src" / name
        bundle.parent.mkdir(parents=True, exist_ok=True)
        bundle.write_bytes(f"/*! sources {hashlib.sha256(lines.encode()).hexdigest()} */\nmain()\n".encode())
    return tmp_path


def wheel_of(tree, version="standard"):
    built = list(WheelBuilder(str(tree)).build(directory=str(tree / "dist"), versions=[version]))
    with zipfile.ZipFile(built[0]) as wheel:
        return {name: wheel.read(name) for name in wheel.namelist()}


def change_a_source(tree):
    (tree / WEB / "src/page/main.ts").write_text("other()\n")


def add_a_source(tree):
    (tree / WEB / "src/page/other.ts").write_text("")


def rename_a_source(tree):
    (tree / WEB / "src/page/main.ts").rename(tree / WEB / "src/main.ts")


def remove_the_page(tree):
    shutil.rmtree(tree / "src/stylobate/lab/page")


def remove_the_viewer(tree):
    (tree / "src" / BUNDLES[-1]).unlink()


changed = pytest.mark.parametrize(
    "change", [change_a_source, add_a_source, rename_a_source, remove_the_page, remove_the_viewer]
)


def test_a_wheel_holds_bundles_of_the_present_sources(tree):
    assert set(BUNDLES) <= set(wheel_of(tree))
    assert not any("/web/" in name for name in wheel_of(tree))


@changed
@pytest.mark.parametrize("builder", [WheelBuilder, SdistBuilder])
def test_a_release_with_missing_or_stale_bundles_is_refused(tree, change, builder, capsys):
    change(tree)
    with pytest.raises(SystemExit):
        list(builder(str(tree)).build(directory=str(tree / "dist")))
    assert "Install Node 20 or newer and build again, or set STYLOBATE_WITHOUT_PAGE=1" in capsys.readouterr().err
    assert not list((tree / "dist").glob("*.whl"))


@changed
def test_a_wheel_without_the_page_is_built_on_request_and_holds_no_stale_bundle(tree, change, monkeypatch, capsys):
    change(tree)
    monkeypatch.setenv("STYLOBATE_WITHOUT_PAGE", "1")
    assert not set(BUNDLES) & set(wheel_of(tree))
    assert "without the laboratory's page" in capsys.readouterr().err


@changed
def test_an_editable_installation_needs_no_bundles(tree, change):
    change(tree)
    with (tree / "pyproject.toml").open("a") as project:  # else another package is needed to build it
        project.write('[tool.hatch.build]\ndev-mode-dirs = ["src"]\n')
    assert str(tree / "src").encode() in b"".join(wheel_of(tree, "editable").values())


@pytest.mark.system
@pytest.mark.skipif(shutil.which("node") is None, reason="Node is not here")
def test_node_and_python_compute_the_same_digest_of_the_sources():
    spec = importlib.util.spec_from_file_location("hatch_build", ROOT / "hatch_build.py")
    hook = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(hook)
    program = 'import { sourcesDigest } from "./digest.mjs"; console.log(await sourcesDigest("."))'
    asked = ["node", "--input-type=module", "--eval", program]
    found = subprocess.run(asked, cwd=ROOT / WEB, check=True, capture_output=True, text=True).stdout
    assert found.strip() == hook.sources_digest(ROOT / WEB)


def test_the_sources_of_a_release_hold_no_figures_of_the_documentation():
    included = [Path(file.relative_path) for file in SdistBuilder(str(ROOT)).recurse_included_files()]
    assert [path for path in included if path.parts[0] == "docs" and path.suffix in {".gif", ".png"}] == []
    assert {Path("docs/index.md"), Path("docs/_static/logo.svg"), Path("tests/conftest.py")} <= set(included)


@pytest.mark.slow
def test_the_sources_of_a_release_build_the_wheel_of_the_repository(tmp_path, monkeypatch):
    monkeypatch.setenv("STYLOBATE_WITHOUT_PAGE", "1")
    (sources,) = SdistBuilder(str(ROOT)).build(directory=str(tmp_path))
    with tarfile.open(sources) as archive:
        archive.extractall(tmp_path, filter="data")
    (unpacked,) = (path for path in tmp_path.iterdir() if path.is_dir())
    wheels = []
    for number, root in enumerate((ROOT, unpacked)):
        (built,) = WheelBuilder(str(root)).build(directory=str(tmp_path / str(number)), versions=["standard"])
        with zipfile.ZipFile(built) as wheel:
            wheels.append({name: wheel.read(name) for name in wheel.namelist()})
    assert wheels[0] == wheels[1]


def test_the_archive_of_the_site_holds_its_pages_and_is_the_same_twice(tmp_path):
    spec = importlib.util.spec_from_file_location("site_archive", ROOT / "tools" / "site_archive.py")
    tool = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(tool)
    site = tmp_path / "html"
    kept = ("how-to/page.html", "index.html", "laboratory/laboratory.html", "searchindex.js")
    for name in (*kept, ".doctrees/index.doctree", ".buildinfo"):
        (site / name).parent.mkdir(parents=True, exist_ok=True)
        (site / name).write_text(f"content of {name}")
    first = tool.pack(site, tmp_path, "pages-1.0-docs").read_bytes()
    (site / "index.html").touch()
    assert tool.pack(site, tmp_path, "pages-1.0-docs").read_bytes() == first
    with zipfile.ZipFile(tmp_path / "pages-1.0-docs.zip") as archive:
        assert archive.namelist() == [f"pages-1.0-docs/{name}" for name in kept]
        assert archive.read("pages-1.0-docs/index.html") == b"content of index.html"
    (site / "laboratory/laboratory.html").unlink()
    with pytest.raises(SystemExit, match="Run make site"):
        tool.pack(site, tmp_path, "pages-1.0-docs")
