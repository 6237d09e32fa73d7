"""Differences between the description of a stored sweep and of the present sweep, in words."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

# Maximum number of listed differences; more show that the sweeps are unrelated.
_LISTED = 3


def differences(stored: Mapping[str, Any], given: Mapping[str, Any]) -> list[str]:
    """Return one phrase for each of the first differences, with the version first; empty if there is none."""
    if stored.get("version") != given.get("version"):
        return [f"the store was made by stylobate {stored.get('version')}, this is {given.get('version')}"]
    before, now = dict(_leaves(_by_name(stored))), dict(_leaves(_by_name(given)))
    names = [*now, *(name for name in before if name not in now)]
    found = [_difference(name, before.get(name), now.get(name)) for name in names if before.get(name) != now.get(name)]
    more = [f"and {len(found) - _LISTED} more differences"] if len(found) > _LISTED else []
    return [*found[:_LISTED], *more]


def _by_name(values: Any) -> Any:
    """Return `values` with records identified by name and content, independent of their folder."""
    if isinstance(values, list):
        return [_by_name(value) for value in values]
    if not isinstance(values, Mapping):
        return values
    found = {name: _by_name(value) for name, value in values.items()}
    if isinstance(values.get("file_sha256"), Mapping) and values["file_sha256"]:
        found.pop("path", None)
        found["file_sha256"] = {Path(path).name: digest for path, digest in values["file_sha256"].items()}
    return found


def _leaves(values: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    for name, value in values.items():
        if isinstance(value, Mapping) and "sha256" not in value:
            # Quantities that vary have their own names.
            yield from _leaves(value, "" if name == "values" else f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}", value


def _difference(name: str, before: Any, now: Any) -> str:
    if name.endswith("_sha256"):
        return f"{name.removesuffix('_sha256').replace('.', ' ')} changed"
    shown = _shown(before), _shown(now)
    return f"{name} was {shown[0]}, is {shown[1]}" if shown[0] != shown[1] else f"{name} has other values than before"


def _shown(value: Any) -> str:
    if isinstance(value, Mapping) and "sha256" in value:
        ends = f" from {value['first']!r} to {value['last']!r}" if value["count"] else ""
        return f"{value['count']} values{ends}"
    return "not given" if value is None else repr(value)
