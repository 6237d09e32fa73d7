"""Suggestions for misspelt names in a description."""

import re
from collections.abc import Sequence
from typing import Annotated, Any, get_args, get_origin

from pydantic import BaseModel

from stylobate.text import did_you_mean

_NOT_KNOWN = re.compile(r"(?P<problem>(?P<path>\S+) (is not known here|does not belong to \w+ '\w+')); .*")


def with_suggestions(description: type[BaseModel], problems: Sequence[str]) -> list[str]:
    """Return the lines on mistakes, with a suggestion in each line on an unknown name.

    Parameters
    ----------
    description
        Class of the description.
    problems
        One line for each mistake.
    """
    return [_suggesting(description, line) for line in problems]


def _suggesting(description: type[BaseModel], line: str) -> str:
    found = _NOT_KNOWN.fullmatch(line)
    if found is None:
        return line
    *path, name = found["path"].split(".")
    question = did_you_mean(name, _names(description, path))
    return f"{found['problem']}; {question}" if question and f" {name}?" not in question else line


def _names(annotation: Any, path: Sequence[str]) -> set[str]:
    """Return the allowed names at a path below a field with this annotation; empty for an unknown path."""
    found: set[str] = set()
    for one in _alternatives(annotation):
        if get_origin(one) is dict and path:
            found |= _names(get_args(one)[1], path[1:])
        if not (isinstance(one, type) and issubclass(one, BaseModel)):
            continue
        fields = {field.alias or name: field.annotation for name, field in one.model_fields.items()}
        if not path:
            found |= set(fields)
        elif path[0] in fields:
            found |= _names(fields[path[0]], path[1:])
    return found


def _alternatives(annotation: Any) -> list[Any]:
    """Return the alternative types of an annotation."""
    origin = get_origin(annotation)
    if origin is dict or not get_args(annotation):
        return [annotation]
    inner = get_args(annotation)[:1] if origin is Annotated else get_args(annotation)
    return [one for part in inner for one in _alternatives(part)]
