"""Outcomes in arrays: small integers, and the attributes that explain them."""

from typing import Any

import numpy as np

from stylobate.errors import Outcome, ParameterError, require_whole

NOT_COMPUTED = -1
"""The code of a run that has not been computed."""

_ORDER = tuple(Outcome)
_CODES = {outcome: code for code, outcome in enumerate(_ORDER)}


def code_of(outcome: Outcome) -> int:
    """Return the code of `outcome`: its place in `list(Outcome)`.

    Raises
    ------
    ParameterError
        If it is no Outcome.
    """
    if not isinstance(outcome, Outcome):
        message = f"outcome must be an Outcome such as Outcome.{_ORDER[0].name}, got {outcome!r}"
        raise ParameterError(message)
    return _CODES[outcome]


def outcome_of(code: int) -> Outcome | None:
    """Return the outcome with this `code`, or None for a run that has not been computed.

    Raises
    ------
    ParameterError
        If there is no such code.
    """
    known = require_whole("code", code, least=NOT_COMPUTED)
    if known >= len(_ORDER):
        message = f"code must be {NOT_COMPUTED} for not computed, or 0 to {len(_ORDER) - 1}; got {code!r}"
        raise ParameterError(message)
    return None if known == NOT_COMPUTED else _ORDER[known]


def outcome_attributes() -> dict[str, Any]:
    """Return the attributes of a variable that holds codes, after the CF conventions' flags."""
    names = ["NOT_COMPUTED", *(outcome.name for outcome in _ORDER)]
    return {
        "long_name": "outcome",
        "flag_values": np.arange(NOT_COMPUTED, len(_ORDER), dtype=np.int8),
        "flag_meanings": " ".join(names),
    }
