"""Outcomes in arrays: the attributes that explain the codes, and their words."""

from typing import Any

import numpy as np

from stylobate.errors import Outcome

NOT_COMPUTED = -1
"""The code of a run that has not been computed."""


def outcome_label(code: int) -> str:
    """Return the words for an outcome with this `code`, or for a run that has not been computed."""
    return "not computed" if code == NOT_COMPUTED else Outcome(code).label


def outcome_attributes() -> dict[str, Any]:
    """Return the attributes of a variable that holds codes, after the CF conventions' flags."""
    return {
        "long_name": "outcome",
        "flag_values": np.array([NOT_COMPUTED, *Outcome], dtype=np.int8),
        "flag_meanings": " ".join(["NOT_COMPUTED", *(outcome.name for outcome in Outcome)]),
    }
