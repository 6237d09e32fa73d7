"""Remarks on what is no mistake, but looks like one: a column as high as a tower, two records of nearly one name."""

import warnings
from collections.abc import Iterable, Iterator, Mapping

from stylobate.column import Column
from stylobate.errors import UnlikelyInputWarning

# Columns are seldom higher [m]: a larger number is perhaps in another unit.
_HIGHEST = 60.0


def remark_on(columns: Mapping[str, Column], records: Iterable[str]) -> None:
    """Warn with UnlikelyInputWarning of each column of more than 60 m, and of records whose names differ by case only.

    Parameters
    ----------
    columns
        By the name that labels their results.
    records
        Names of records.
    """
    for message in (*_of_heights(columns), *_of_names(records)):
        warnings.warn(message, UnlikelyInputWarning, stacklevel=3)


def _of_heights(columns: Mapping[str, Column]) -> Iterator[str]:
    for name, column in columns.items():
        if column.height is not None and column.height > _HIGHEST:
            yield f"{name}: a height of {column.height:g} m; lengths are in metres, is this one?"
        elif column.height is None and column.mass_height > 0.5 * _HIGHEST:
            yield f"{name}: a mass centre at {column.mass_height:g} m; lengths are in metres, is this one?"


def _of_names(records: Iterable[str]) -> Iterator[str]:
    alike: dict[str, list[str]] = {}
    for name in records:
        alike.setdefault(name.casefold(), []).append(name)
    for names in alike.values():
        if len(names) > 1:
            quoted = " and ".join(map(repr, names))
            yield (
                f"records: {quoted} differ by case only and are taken as different ones; if they are components of one "
                "event, list their files as one event"
            )
