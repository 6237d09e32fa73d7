"""Check the values of a file before they are parsed: depth, kinds that are not words, and NUL characters."""

from collections.abc import Iterator, Mapping
from itertools import islice
from typing import Any

from stylobate.errors import ConfigError

DEEPEST = 60
"""Maximum depth of nested tables and lists: each level of a motion takes several calls, and Python allows 1000."""

# Keys whose word chooses one of several descriptions.
_CHOOSING = ("kind", "shape", "method")
_SHOWN, _LONGEST = 4, 60


def check_file_values(values: Mapping[str, Any]) -> None:
    """Raise ConfigError for values that no description can have, with one line for each mistake."""
    problems = list(islice(_problems(values), _SHOWN))
    if problems:
        raise ConfigError(problems)


def _problems(values: Mapping[str, Any]) -> Iterator[str]:
    waiting: list[tuple[str, str, Any, int]] = [("", "", values, 0)]
    while waiting:
        place, key, value, depth = waiting.pop()
        shown = repr(place[:_LONGEST])[1:-1]
        if depth > DEEPEST:
            yield f"{shown}…: nested too deeply (got more than {DEEPEST} levels). Describe it with fewer."
            return
        if "\0" in key or (isinstance(value, str) and "\0" in value):
            yield f"{shown}: holds a NUL character (got {(key if chr(0) in key else value)[:_LONGEST]!r}). Remove it."
        elif key in _CHOOSING and not isinstance(value, str):
            yield f"{shown}: must be a word (got {_short(value)}). Write it in quotation marks."
        members = value.items() if isinstance(value, Mapping) else enumerate(value) if isinstance(value, list) else ()
        waiting += [
            (f"{place}.{name}" if place else str(name), str(name), one, depth + 1) for name, one in reversed([*members])
        ]


def _short(value: Any) -> str:
    if isinstance(value, Mapping):
        return "a table"
    return "a list" if isinstance(value, list) else repr(value)[:_LONGEST]
