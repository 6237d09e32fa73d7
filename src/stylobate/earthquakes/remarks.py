"""Warnings of unlikely inputs: columns as high as towers, records whose names differ by case only."""

import warnings
from collections.abc import Iterable, Iterator, Mapping

from stylobate.column import Column
from stylobate.errors import UnlikelyInputWarning

# Columns are seldom higher [m]: a larger number may be in another unit.
_HIGHEST = 60.0


def remark_on(columns: Mapping[str, Column], records: Iterable[str]) -> None:
    """Warn with UnlikelyInputWarning of each column of more than 60 m, and of records whose names differ by case only.

    Parameters
    ----------
    columns
        Columns by name.
    records
        Names of records.
    """
    for message in (*_of_heights(columns), *_of_names(records)):
        warnings.warn(message, UnlikelyInputWarning, stacklevel=3)


def _of_heights(columns: Mapping[str, Column]) -> Iterator[str]:
    for name, column in columns.items():
        if column.height is not None and column.height > _HIGHEST:
            yield f"{name}: unlikely height (got {column.height:g} m). Check that it is in metres."
        elif column.height is None and column.mass_height > 0.5 * _HIGHEST:
            height = f"{column.mass_height:g} m"
            yield f"{name}: unlikely height of the centre of mass (got {height}). Check that it is in metres."


def _of_names(records: Iterable[str]) -> Iterator[str]:
    alike: dict[str, list[str]] = {}
    for name in records:
        alike.setdefault(name.casefold(), []).append(name)
    for names in alike.values():
        if len(names) > 1:
            quoted = " and ".join(map(repr, names))
            yield (
                f"records: {quoted} differ by case only and count as different records. If they are components of one "
                "event, list their files as one event."
            )
