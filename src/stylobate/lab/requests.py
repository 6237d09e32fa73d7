"""Requests: JSON objects of limited size, and the descriptions and records in them, without files of this machine."""

import json
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from math import isnan, prod
from typing import Any, NoReturn

from starlette.requests import ClientDisconnect, Request

from stylobate.errors import LARGEST, SMALLEST
from stylobate.lab.limits import Limits, RefusedError
from stylobate.lab.uploads import Uploads
from stylobate.units import size_of, split

_DEEPEST = 24
"""Maximum depth of nested values; a copy of a sum of motions takes three."""

_SHOWN, _LONGEST_NAME = 4, 40


async def json_body(request: Request, limit: int) -> dict[str, Any]:
    """Return the JSON object in the body of `request`, at most `limit` bytes long.

    Raises
    ------
    RefusedError
        If the body has another type, is too large, is not JSON, or is not an object.
    """
    kind = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    if kind != "application/json":
        raise RefusedError(415, [f"content-type must be application/json, got {kind or 'none'}"])
    body = bytearray()
    try:
        async for part in request.stream():
            body += part
            if len(body) > limit:
                raise RefusedError(413, [f"a request may have at most {limit} bytes"])
        found = json.loads(body, parse_constant=_refuse_constant)
    except ClientDisconnect:
        raise RefusedError(400, ["the body ended early"]) from None
    except (ValueError, RecursionError) as error:
        raise RefusedError(400, [f"the body is not JSON: {error}"]) from None
    if not isinstance(found, dict):
        raise RefusedError(422, [f"the body must be a JSON object, got {type(found).__name__}"])
    return found


def _refuse_constant(name: str) -> NoReturn:
    raise ValueError(f"{name} is not a JSON number")


@dataclass(frozen=True, slots=True)
class Description:
    """Plain values of a description: `values` to compute with, `shown` for users, with the file names of uploads."""

    values: dict[str, Any]
    shown: dict[str, Any]


def described(body: Mapping[str, Any], uploads: Uploads, limits: Limits) -> Description:
    """Parse the description in the `body` of a request.

    Raises
    ------
    RefusedError
        If the description names files of this machine or a missing upload, or exceeds a limit.
    """
    found = Description(
        _with_uploads(body, lambda digest: uploads[digest].motion()),
        _with_uploads(body, lambda digest: uploads[digest].as_json()),
    )
    problems = [*problems_of_numbers(body, limits), *_problems_of_the_plane(body, limits)]
    if problems:
        raise RefusedError(422, problems)
    return found


def _with_uploads(
    values: Mapping[str, Any], recorded: Callable[[object], dict[str, Any]], depth: int = 0
) -> dict[str, Any]:
    """Return `values` with the motion `upload` replaced by its record, at any depth."""
    if values.get("kind") == "record" or (set(values) & {"path", "upload", "file_sha256"}):
        for name in ("path", "file_sha256", "source"):
            if name in values:
                problem = f"{name}: the laboratory does not read files of this machine. Upload the record."
                raise RefusedError(422, [problem])
        if "upload" in values:
            rest = {name: value for name, value in values.items() if name not in ("kind", "upload")}
            values = {**recorded(values["upload"]), **rest}

    def inside(value: object, depth: int) -> object:
        if depth > _DEEPEST:
            raise RefusedError(422, [f"values may be nested to a depth of at most {_DEEPEST}"])
        if isinstance(value, Mapping):
            return _with_uploads(value, recorded, depth)
        return [inside(one, depth + 1) for one in value] if isinstance(value, list) else value

    return {name: inside(value, depth + 1) for name, value in values.items()}


def problems_of_numbers(body: Mapping[str, Any], limits: Limits) -> list[str]:
    """Return one line for each of the first numbers, at any depth, of unreasonable size, with a unit, or too large."""
    bounds = limits.of_numbers()
    found = []
    for place, value in _values(body):
        number, bound = _number_of(value), bounds.get(place.rpartition(".")[2])
        unit = split(value)[1] if isinstance(value, str) else ""
        if unit and size_of(unit) is not None:
            found.append(f"{place}: the laboratory takes numbers in SI units (got {value!r}). Leave out the unit.")
        elif not (number == 0.0 or SMALLEST <= abs(number) <= LARGEST or isnan(number)):  # NaN is refused later
            found.append(f"{place} must be zero or between {SMALLEST:g} and {LARGEST:g} in size, got {number!r}")
        elif bound is not None and number > bound[0]:
            most = f"{bound[0]:g} {bound[1]}".rstrip()
            found.append(f"{place} may be at most {most} in the laboratory, got {value!r}. Use Python for more.")
    return found[:_SHOWN]


def _values(body: Mapping[str, Any]) -> Iterator[tuple[str, object]]:
    """Yield all values that are no tables and lists with their places, at any depth."""
    waiting: list[tuple[str, object]] = [("", body)]
    while waiting:
        place, value = waiting.pop()
        within = f"{place}." if place else ""
        if isinstance(value, Mapping):
            waiting += [(within + repr(str(name)[:_LONGEST_NAME])[1:-1], one) for name, one in value.items()]
        elif isinstance(value, list):
            waiting += [(f"{within}{index}", one) for index, one in enumerate(value)]
        else:
            yield place, value


def _number_of(value: object) -> float:
    """Return a plain value as a number if it is or spells one; else zero."""
    try:
        return float(value) if isinstance(value, (int, float, str)) else 0.0
    except ValueError:
        return 0.0
    except OverflowError:
        return LARGEST * 2.0


def _problems_of_the_plane(body: Mapping[str, Any], limits: Limits) -> list[str]:
    """Return a line if the map or basin has too many runs."""
    plane = body.get("map") or body.get("basin")
    if not isinstance(plane, Mapping):
        return []
    cells = max(_number_of(plane.get("random")), prod(_length(plane.get(place)) for place in "xy"))
    if cells <= limits.cells:
        return []
    return [f"a map may have {limits.cells} runs in the laboratory, got {cells:g}. Use stylobate map."]


def _length(axis: object) -> float:
    if not isinstance(axis, Mapping):
        return 1.0
    listed = axis.get("values")
    return len(listed) if isinstance(listed, list) else max(_number_of(axis.get("number")), 1.0)
