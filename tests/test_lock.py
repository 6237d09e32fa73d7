"""The lock file states the requirements of pyproject.toml, and locks each package that it names."""

import tomllib
from collections import Counter
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).parents[1]
LOCK = tomllib.loads((ROOT / "uv.lock").read_text(encoding="utf-8"))
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
PACKAGES = {package["name"]: package for package in LOCK["package"]}
METADATA = PACKAGES["stylobate"]["metadata"]


def declared(lines, extra=""):
    """Return requirements as the lock writes them: name, extras, versions, marker."""
    for requirement in map(Requirement, lines):
        marker = " and ".join(filter(None, [str(requirement.marker or ""), extra and f"extra == '{extra}'"]))
        name, extras = canonicalize_name(requirement.name), frozenset(requirement.extras)
        yield name, extras, frozenset(map(str, requirement.specifier)), marker.replace('"', "'")


def locked(entries):
    for entry in entries:
        extras, versions = frozenset(entry.get("extras", [])), frozenset(entry.get("specifier", "").split(","))
        yield entry["name"], extras, versions, entry.get("marker", "")


def group(name):
    """Return the lines of a dependency group, with those of the groups that it includes."""
    for line in PROJECT["dependency-groups"][name]:
        yield from group(line["include-group"]) if isinstance(line, dict) else [line]


def test_the_lock_states_the_requirements_and_extras_of_the_project():
    requirements = set(declared(PROJECT["project"]["dependencies"]))
    for extra, lines in PROJECT["project"]["optional-dependencies"].items():
        requirements |= set(declared(lines, extra))
    assert set(locked(METADATA["requires-dist"])) == requirements


def test_the_lock_states_the_dependency_groups_of_the_project():
    groups = {name: set(declared(group(name))) for name in PROJECT["dependency-groups"]}
    assert {name: set(locked(entries)) for name, entries in METADATA["requires-dev"].items()} == groups


def test_each_dependency_in_the_lock_names_one_package():
    versions = Counter(package["name"] for package in LOCK["package"])
    for package in LOCK["package"]:
        for dependency in package.get("dependencies", []):
            name = dependency["name"]
            assert versions[name] == 1 or ("version" in dependency and "source" in dependency), (package["name"], name)
