"""Outcomes and other codes in arrays: their attributes and labels."""

from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from stylobate.errors import Outcome

NUMERICALLY_UNCERTAIN = "numerically uncertain: rounding or the rest threshold could alter it"
"""What `uncertain` means, in the same words everywhere."""

NOT_COMPUTED = -1
"""The code of a run that has not been computed."""


def outcome_label(code: int) -> str:
    """Return the label of the outcome with this `code`, or of a run that has not been computed."""
    return "not computed" if code == NOT_COMPUTED else Outcome(code).label


def outcome_attributes() -> dict[str, Any]:
    """Return the attributes of a variable that holds outcomes."""
    flags = flag_attributes("outcome", ["NOT_COMPUTED", *(outcome.name for outcome in Outcome)], first=NOT_COMPUTED)
    return flags | {"comment": "compare with a member, outcome == stylobate.Outcome.OVERTURNED, never with a text"}


def flag_attributes(
    long_name: str, meanings: Iterable[str], *, first: int = 0, dtype: npt.DTypeLike = np.int8
) -> dict[str, Any]:
    """Return the attributes of a variable that holds the codes `first`, `first` + 1, …, after the CF conventions.

    Parameters
    ----------
    long_name
        Quantity that the codes represent.
    meanings
        Meaning of each code, one word without spaces.
    first
        The first code.
    dtype
        Type of the codes among the attributes.
    """
    words = list(meanings)
    values = np.arange(first, first + len(words), dtype=dtype)
    return {"long_name": long_name, "flag_values": values, "flag_meanings": " ".join(words)}
