"""Names of the base motions of a study."""

import math
from collections.abc import Mapping, Sequence
from typing import TypeAlias

from stylobate.base_motions import BaseMotion
from stylobate.errors import ParameterError

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
        pairs = [(_own_name(motion, place), motion) for place, motion in enumerate(records)]
    else:
        raise ParameterError(f"records must be a base motion, a sequence or a mapping of them, got {records!r}")
    if not pairs:
        raise ParameterError("records must hold at least one base motion, got none")
    named: dict[str, BaseMotion] = {}
    for name, motion in pairs:
        _require_ending(name, motion)
        if name in named:
            raise ParameterError(f"records must differ in name, got {name!r} twice; give a mapping of names to records")
        named[name] = motion
    return named


def _own_name(motion: object, place: int) -> str:
    return str(getattr(motion, "name", "") or f"motion {place + 1}")


def _require_ending(name: str, motion: object) -> None:
    if not isinstance(motion, BaseMotion):
        raise ParameterError(f"records must be base motions, such as those of read_records, got {motion!r} as {name!r}")
    if not 0.0 < motion.duration < math.inf:
        raise ParameterError(f"records must end after t = 0, got {name!r} with a duration of {motion.duration!r} s")
