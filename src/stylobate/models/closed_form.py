"""The closed form of steady rolling that holds for a model."""

from dataclasses import dataclass
from enum import Enum


class RollingLaw(Enum):
    """The closed forms of steady rolling, by the function of `theory` that computes each."""

    SLENDER = "steady_rolling"
    FREE_TWIST = "free_twist_rolling"
    WOBBLING = "wobbling_rolling"
    FULL = "full_rolling"
    SLIPPING = "slipping_rolling"


@dataclass(frozen=True, slots=True)
class ClosedForm:
    """The closed form of steady rolling of a model on a base that moves in a circle.

    Parameters
    ----------
    law
        The function that computes it.
    eta, zeta
        Damping η and spin damping ζ that it takes; ζ is infinite for a column that cannot turn about the vertical.
    requires
        Name of a number of the model that differs from the value that the closed form requires, and that value.
    """

    law: RollingLaw
    eta: float
    zeta: float = 0.0
    requires: tuple[str, float | str] | None = None


def zero(model: object, *names: str) -> tuple[str, float] | None:
    """Return the name of the first of these numbers of `model` that is not zero, and 0; None if all are zero."""
    return next(((name, 0) for name in names if getattr(model, name) != 0.0), None)
