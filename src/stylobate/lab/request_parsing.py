"""Parsing of requests: the names of the command line, without files of this machine, and within the limits."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from stylobate.lab.limits import Limits
from stylobate.lab.refusals import RefusedError
from stylobate.lab.size_limits import number_of, problems_of_size
from stylobate.lab.uploads import Upload, Uploads

_DEEPEST = 24
"""Maximum depth of nested values; a copy of a sum of motions takes three."""


@dataclass(frozen=True, slots=True)
class Described:
    """Plain values of a description: `values` to compute with, `shown` for users, with the file names of uploads."""

    values: dict[str, Any]
    shown: dict[str, Any]


def described(body: Mapping[str, Any], uploads: Uploads, limits: Limits) -> Described:
    """Parse the description in the `body` of a request.

    Raises
    ------
    RefusedError
        If the description names files of this machine or a missing upload, or exceeds a limit.
    """
    found = Described(
        dict(_with_uploads(body, lambda digest: uploads[digest], Upload.motion)),
        dict(_with_uploads(body, lambda digest: uploads[digest], Upload.as_json)),
    )
    problems = [*_beyond(body, limits), *problems_of_size(body, uploads, limits)]
    if problems:
        raise RefusedError(422, problems)
    return found


def _with_uploads(
    values: Mapping[str, Any],
    find: Callable[[object], Upload],
    describe: Callable[[Upload], dict[str, Any]],
    depth: int = 0,
) -> dict[str, Any]:
    """Return `values` with the motion `upload` replaced by its record, at any depth."""
    if values.get("kind") == "record" or (set(values) & {"path", "upload", "file_sha256"}):
        _refuse_files(values)
        if "upload" in values:
            rest = {name: value for name, value in values.items() if name not in ("kind", "upload")}
            values = {**describe(find(values["upload"])), **rest}

    def inside(value: object, depth: int) -> object:
        if depth > _DEEPEST:
            raise RefusedError(422, [f"values may be nested to a depth of at most {_DEEPEST}"])
        if isinstance(value, Mapping):
            return _with_uploads(value, find, describe, depth)
        return [inside(one, depth + 1) for one in value] if isinstance(value, list) else value

    return {name: inside(value, depth + 1) for name, value in values.items()}


def _refuse_files(values: Mapping[str, Any]) -> None:
    for name in ("path", "file_sha256", "source"):
        if name in values:
            raise RefusedError(422, [f"{name}: the laboratory does not read files of this machine. Upload the record."])


def _beyond(body: Mapping[str, Any], limits: Limits) -> list[str]:
    """Return a line for each number beyond its limit."""
    problems = [
        f"{name} may be at most {bound:g} {unit} in the laboratory, got {body[name]!r}. Use Python for more."
        for name, (bound, unit) in limits.of_numbers().items()
        if number_of(body.get(name)) > bound
    ]
    plane = body.get("map") or body.get("basin")
    axes = [plane.get(place) for place in "xy"] if isinstance(plane, Mapping) else []
    cells = number_of(plane.get("random")) if isinstance(plane, Mapping) else 0.0
    if any(axes):
        cells = max(cells, math.prod(_length(axis) for axis in axes))
    if cells > limits.cells:
        problems.append(f"a map may have {limits.cells} runs in the laboratory, got {cells:g}. Use stylobate map.")
    return problems


def _length(axis: object) -> float:
    if not isinstance(axis, Mapping):
        return 1.0
    listed = axis.get("values")
    return len(listed) if isinstance(listed, list) else max(number_of(axis.get("number")), 1.0)
