"""Warnings of likely slips, collected for the page: nobody reads them in the terminal of the server."""

import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from stylobate.errors import UnlikelyInputWarning


@contextmanager
def remarks(values: Mapping[str, Any]) -> Iterator[list[str]]:
    """Collect each `UnlikelyInputWarning` warning that is issued inside, once, as a line; issue the others afterwards.

    Files of `values` go by their name, without the folder in which the server keeps them. The filters of warnings are
    those of the whole process: use it where no other thread computes.
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
