"""Checks of what models are made with."""

from typing import Any

from stylobate.column import Column
from stylobate.errors import ParameterError, require_not_negative
from stylobate.models.bounds import BOUNDS


def require_column(value: object) -> None:
    """Raise ParameterError if `value` is no Column."""
    if not isinstance(value, Column):
        message = f"column must be a Column, such as Column.solid(...), got {value!r}"
        raise ParameterError(message)


def require_frictions(model: object, *names: str) -> None:
    """Make these attributes of a frozen model floats; raise ParameterError if one is negative or not finite."""
    for name in names:
        object.__setattr__(model, name, require_not_negative(name, getattr(model, name)))


def require_loss(model: Any) -> None:
    """Check `restitution`, from 0 to 1, of a frozen model, and `passage_tilt` where one is given.

    Raises
    ------
    ParameterError
        If one of them is out of range.
    """
    require_restitution(model)
    if model.passage_tilt is not None:
        require_frictions(model, "passage_tilt")


def require_restitution(model: Any) -> None:
    """Make `restitution` of a frozen model a float; raise ParameterError if it lies outside 0 to 1."""
    require_frictions(model, "restitution")
    value = model.restitution
    if not BOUNDS["restitution"].accepts(value):
        message = f"restitution must lie between 0 and 1, 1 for no loss, got {value!r}"
        raise ParameterError(message)


def require_coefficient(model: Any, name: str) -> float:
    """Make a friction coefficient of a frozen model a float, and return it.

    Raises
    ------
    ParameterError
        If it is negative, or so large that the column never slips.
    """
    value, most = require_not_negative(name, getattr(model, name)), BOUNDS[name].most
    if value > most:
        message = f"{name}: must be at most {most:g} (got {value!r}). Use Rolling for a column that never slips."
        raise ParameterError(message)
    object.__setattr__(model, name, value)
    return value
