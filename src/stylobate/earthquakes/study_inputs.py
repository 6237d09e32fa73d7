"""Inputs that all studies of records share: named records, the free vibration after them, warnings of unlikely ones."""

import math
import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TypeAlias

from stylobate.base_motions import BaseMotion
from stylobate.column import Column
from stylobate.errors import ParameterError, UnlikelyInputWarning, require_not_negative, require_printable
from stylobate.run_arguments import FREE_TAIL

Records: TypeAlias = BaseMotion | Sequence[BaseMotion] | Mapping[str, BaseMotion]


def named_records(records: Records) -> dict[str, BaseMotion]:
    """Map names to motions: names of the mapping, else names of the records, else "motion 1" and so on.

    Raises
    ------
    ParameterError
        If `records` is empty, a value is no base motion or never ends, or two motions have the same name.
    """
    if isinstance(records, BaseMotion):
        records = [records]
    if isinstance(records, Mapping):
        pairs = [(str(name), motion) for name, motion in records.items()]
    elif isinstance(records, Sequence) and not isinstance(records, (str, bytes)):
        pairs = [
            (str(getattr(motion, "name", "") or f"motion {place + 1}"), motion) for place, motion in enumerate(records)
        ]
    else:
        raise ParameterError(f"records must be a base motion, a sequence or a mapping of them, got {records!r}")
    if not pairs:
        raise ParameterError("records must hold at least one base motion, got none")
    named: dict[str, BaseMotion] = {}
    for name, motion in pairs:
        require_printable("records: the name", name)
        _require_ending(name, motion)
        if name in named:
            raise ParameterError(f"records must differ in name, got {name!r} twice; give a mapping of names to records")
        named[name] = motion
    return named


def _require_ending(name: str, motion: object) -> None:
    if not isinstance(motion, BaseMotion):
        raise ParameterError(f"records must be base motions, such as those of read_records, got {motion!r} as {name!r}")
    if not 0.0 < motion.duration < math.inf:
        raise ParameterError(f"records must end after t = 0, got {name!r} with a duration of {motion.duration!r} s")


def tail_of(column: Column, tail: float | None = None) -> float:
    """Return the free-vibration time of `column` after the end of a record [s]: `tail`, or by default 20/p.

    Near the unstable equilibrium at the tilt α_c a deviation grows as exp(pt), p = √(m g R/K): by 5·10⁸ in 20/p. So
    only a column that the record left within about 10⁻⁸ α_c of this equilibrium is still undecided after 20/p.

    Raises
    ------
    ParameterError
        If `tail` is negative.
    """
    return FREE_TAIL / column.frequency_parameter if tail is None else require_not_negative("tail", tail, "s")


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
