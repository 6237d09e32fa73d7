"""Warnings about unlikely input, collected for the page, since users do not see the terminal of the server."""

import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from stylobate.errors import UnlikelyInputWarning


@contextmanager
def remarks(values: Mapping[str, Any]) -> Iterator[list[str]]:
    """Collect each `UnlikelyInputWarning` issued in the context, once, as a line; issue other warnings afterwards.

    The lines contain the names of files in `values` without the server's folder. The filters of warnings apply to the
    whole process: use this context only if no other thread computes.
    """
    lines: list[str] = []
    with warnings.catch_warnings(record=True) as issued:
        warnings.simplefilter("always", UnlikelyInputWarning)
        yield lines
    folders = set(_folders(values))
    for one in issued:
        if not issubclass(one.category, UnlikelyInputWarning):
            warnings.warn_explicit(one.message, one.category, one.filename, one.lineno)
            continue
        line = str(one.message)
        for folder in folders:
            line = line.replace(folder, "")
        if line not in lines:
            lines.append(line)


def _folders(values: Any) -> Iterator[str]:
    """Yield the folders of all files named as `path`, at any depth."""
    if isinstance(values, list | tuple):
        for one in values:
            yield from _folders(one)
    elif isinstance(values, Mapping):
        for name, value in values.items():
            if name == "path":
                for path in [value] if isinstance(value, str) else value or ():
                    yield f"{Path(path).parent}/"
            else:
                yield from _folders(value)
