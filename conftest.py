"""The code blocks of README.md and of the documentation run as tests, each file in a folder of its own."""

import os
import tempfile
from collections.abc import Mapping
from doctest import ELLIPSIS, NORMALIZE_WHITESPACE
from pathlib import Path
from typing import Any

from sybil import Sybil
from sybil.parsers.myst import PythonCodeBlockParser, SkipParser

# Parts of kernels make sense behind the head that is written for each kernel only.
collect_ignore_glob = ["src/stylobate/engine/lanes/pattern/*", "src/stylobate/engine/flow/pattern.py"]


def _enter_folder(namespace: dict[str, Any]) -> None:
    namespace["_folder"] = tempfile.TemporaryDirectory(prefix="stylobate-")
    namespace["_home"] = Path.cwd()
    os.chdir(namespace["_folder"].name)


def _leave_folder(namespace: Mapping[str, Any]) -> None:
    os.chdir(namespace["_home"])
    namespace["_folder"].cleanup()


pytest_collect_file = Sybil(
    parsers=[PythonCodeBlockParser(doctest_optionflags=ELLIPSIS | NORMALIZE_WHITESPACE), SkipParser()],
    patterns=["README.md", "docs/*.md", "docs/*/*.md"],
    excludes=["docs/_build/*"],
    setup=_enter_folder,
    teardown=_leave_folder,
).pytest()
