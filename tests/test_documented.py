"""The reference describes every public name, command, option and key of a file."""

import doctest
import importlib
import re
import sys
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType
from typing import get_type_hints

import pytest

import stylobate
from stylobate.cli.commands import COMMANDS
from stylobate.earthquakes.config import verdict
from stylobate.run_arguments import RunOptions
from stylobate.studies.hierarchy_study import HierarchyArguments

DOCS = Path(__file__).parents[1] / "docs"
SOURCE = Path(stylobate.__file__).parent
PAGES = {page.name: page.read_text(encoding="utf-8") for page in (DOCS / "reference").glob("*.md")}

if not PAGES:
    pytest.skip("the documentation is not here", allow_module_level=True)


@pytest.fixture(scope="module")
def extensions():
    """The modules that make the tables of the reference."""
    sys.path.insert(0, str(DOCS / "extensions"))
    names = ["declared_fields", "declared_options", *(["laboratory_links"] if find_spec("sphinx") else [])]
    yield {name: importlib.import_module(name) for name in names}
    sys.path.remove(str(DOCS / "extensions"))


def public_modules(module=stylobate, seen=()):
    """The package and the public subpackages that are reached from it."""
    yield module
    for name in getattr(module, "__all__", ()):
        value = getattr(module, name)
        if isinstance(value, ModuleType) and value.__name__ not in seen:
            yield from public_modules(value, (*seen, module.__name__))


MODULES = {module.__name__: module for module in (*public_modules(), importlib.import_module("stylobate.lab"))}
DESCRIBED = re.compile(r"^\.\. (?:autofunction|autoclass|autoexception|autodata|py:data|py:type):: (\S+)", re.MULTILINE)


def described_names():
    return {name.rpartition(".")[2] for text in PAGES.values() for name in DESCRIBED.findall(text)}


def public_names(module):
    """The names that a package lists, without subpackages; the exceptions and warnings of the errors."""
    if module is stylobate.errors:
        return [name for name, value in vars(module).items() if is_public_exception(value)]
    listed = getattr(module, "__all__", ())
    return [name for name in listed if name[0] != "_" and not isinstance(getattr(module, name), ModuleType)]


def is_public_exception(value):
    return isinstance(value, type) and issubclass(value, BaseException) and value.__name__[0] != "_"


@pytest.mark.parametrize("name", MODULES)
def test_the_reference_describes_every_public_name(name):
    assert sorted(set(public_names(MODULES[name])) - described_names()) == []


def listing_modules():
    """The modules of the package that list their names, but for the start of the command line."""
    for path in sorted(SOURCE.rglob("__init__.py*")) + sorted(SOURCE.rglob("[!_]*.py")):
        module = ".".join(["stylobate", *path.relative_to(SOURCE).with_suffix("").parts]).removesuffix(".__init__")
        if module != "stylobate.cli" and re.search(r"^__all__ = ", path.read_text(encoding="utf-8"), re.MULTILINE):
            yield module


@pytest.mark.parametrize("name", [*listing_modules()])
def test_modules_list_public_names_only(name):
    assert sorted(set(public_names(importlib.import_module(name))) - described_names()) == []


def public_paths(module=stylobate, path="stylobate", seen=()):
    """The packages that users reach from `stylobate`, by the names that users type, such as `stylobate.records`."""
    yield path, module
    for name in getattr(module, "__all__", ()):
        value = getattr(module, name)
        if isinstance(value, ModuleType) and value.__name__ not in seen:
            yield from public_paths(value, f"{path}.{name}", (*seen, module.__name__))


def described_paths(text):
    """The names that a page describes, in full."""
    module = ""
    for directive, name in re.findall(
        r"^\.\. (currentmodule|auto(?:function|class|exception)):: (\S+)", text, re.MULTILINE
    ):
        if directive == "currentmodule":
            module = name
        else:
            yield name if name.startswith("stylobate.") else f"{module}.{name}"


@pytest.mark.parametrize("page", PAGES)
def test_names_are_described_as_users_type_them(page):
    homes = sorted(public_paths(), key=lambda home: home[0].count("."))
    for path in described_paths(PAGES[page]):
        name = path.rpartition(".")[2]
        shortest = [f"{home}.{name}" for home, module in homes if name in getattr(module, "__all__", ())]
        assert not shortest or path == shortest[0]


@pytest.mark.parametrize("options", [RunOptions, HierarchyArguments])
def test_options_that_many_functions_share_are_listed(options):
    listed = re.findall(r"`(\w+)`|^ +(\w+)$", options.__doc__, re.MULTILINE)
    assert set(get_type_hints(options)) <= {name for pair in listed for name in pair}


def test_every_page_of_the_reference_is_in_its_table_of_contents():
    listed = PAGES["index.md"].split()
    assert [page for page in PAGES if page != "index.md" and page.removesuffix(".md") not in listed] == []


COMMAND_PAGES = {page: text for page, text in PAGES.items() if page.startswith("command-")}


@pytest.mark.parametrize("name", COMMANDS)
def test_the_command_line_shows_every_command_under_its_usage(name, extensions):
    (page,) = (text for text in COMMAND_PAGES.values() if f"```{{command}} {name}\n" in text)
    assert f"## `{extensions['declared_options'].title(name)}`\n" in page


def test_the_first_page_of_the_command_line_lists_the_pages_of_the_commands():
    listed = re.findall(r"```\{command-list\} (\S+)\n", PAGES["command-line.md"])
    assert {f"{page}.md" for page in listed} == {
        page for page, text in COMMAND_PAGES.items() if "```{command} " in text
    }


def test_every_option_is_shared_or_shown_with_its_command(extensions):
    options = extensions["declared_options"]
    shared = {panel: {one.flag for one in rows} for panel, rows in options.shared_options().items()}
    for name, entry in COMMANDS.items():
        own, sharings = options.split(name)
        shown = [one.flag for one in own] + [flag for one in sharings for flag in one.taken]
        assert sorted(shown) == sorted(options.row(one).flag for one in options.options_of(entry.load()))
        assert all(set(one.taken) <= shared[one.panel] for one in sharings)


def test_the_text_about_the_command_line_names_options_that_exist(extensions):
    options = extensions["declared_options"]
    known = {options.row(one).flag for entry in COMMANDS.values() for one in options.options_of(entry.load())}
    known |= {"--help", "--version", "--stiffness"}  # the last one is of a model of the reader's own
    assert set(re.findall(r"(?<![\w-])--[a-z][a-z-]*", "".join(COMMAND_PAGES.values()))) <= known


TABLES = re.findall(r"```\{fields\} (\S+)", PAGES["descriptions.md"])


@pytest.mark.parametrize("place", TABLES)
def test_every_key_of_a_table_is_explained(place, extensions):
    fields = extensions["declared_fields"]
    rows = fields.fields_of(fields.table_of(place), ["column", "model", "motion"])
    assert rows
    assert [one.name for one in rows if not one.text] == []


@pytest.mark.parametrize("part", ["column", "model", "motion"])
def test_every_kind_and_number_is_on_the_page_of_the_files(part, extensions):
    fields = extensions["declared_fields"]
    assert f"```{{kinds}} {part}\n" in PAGES["descriptions.md"]
    assert f"```{{numbers}} {part}\n" in PAGES["descriptions.md"]
    listed = {one.name for one in fields.numbers(part)}
    named = {name for one in fields.kinds(part) for name in (*one.needed, *one.optional)}
    composed = {"motion", "motions", "parts", "elevations"}
    assert named - composed == listed
    assert all(f"`{name}`" in PAGES["descriptions.md"] for name in named & composed)


def test_every_spread_has_its_table():
    assert {f"earthquakes.config.verdict:{one.__name__}" for one in verdict._KINDS.values()} <= set(TABLES)


def test_examples_of_the_extensions_hold(extensions):
    for module in extensions.values():
        assert doctest.testmod(module).failed == 0


def test_the_doors_of_the_readme_lead_to_pages_that_show_figures_without_being_built():
    readme = (DOCS.parent / "README.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (?!-|You).*$", readme.partition("## Where to begin")[2].partition("\n## ")[0], re.MULTILINE)
    assert len(rows) == 6
    for row in rows:
        pages = [DOCS.parent / door for door in re.findall(r"\]\((\S+\.md)\)", row)]
        images = [
            (page, one) for page in pages for one in re.findall(r"!\[[^]]*\]\(([^)]+)\)", page.read_text("utf-8"))
        ]
        assert images
        assert all((page.parent / image).is_file() for page, image in images)
