"""Options of commands that read a table of objects: defaults for its cells, and columns that it only carries."""

from collections.abc import Mapping
from typing import Any

from stylobate.cli.options import Options
from stylobate.config.options import Option
from stylobate.errors import ParameterError

OBJECT_TABLE = (
    Option(
        "default",
        "value for empty cells and missing columns of the table, such as damping=housner; repeat it",
        list[str],
        metavar="NAME=VALUE",
    ),
    Option("carry", "heading to carry through although it is or resembles a known name; repeat it", list[str]),
)
"""Options that state what a table of objects does not."""


def with_object_table(values: Mapping[str, Any], options: Options) -> dict[str, Any]:
    """Return the values of a study with the defaults and carried headings that options state.

    Raises
    ------
    ParameterError
        If a default has no name or no value.
    """
    result = dict(values)
    defaults = dict(map(_default, options["default"] or ()))
    if defaults:
        result["defaults"] = {**_table(values.get("defaults")), **defaults}
    if options["carry"]:
        result["carry"] = (*values.get("carry", ()), *options["carry"])
    return result


def _table(given: Any) -> Mapping[str, Any]:
    return given if isinstance(given, Mapping) else {}


def _default(text: str) -> tuple[str, float | str]:
    name, equals, value = (part.strip() for part in text.partition("="))
    if not (name and equals and value):
        raise ParameterError(f"--default: must be NAME=VALUE (got {text!r}). Write it such as damping=housner.")
    return name, value
