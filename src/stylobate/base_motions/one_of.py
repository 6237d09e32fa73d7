"""Selection of one of several motions by number: one ensemble for runs under different records."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, Self

from stylobate.base_motions.combined import BaseMotion, Following, Transformed, require_motion
from stylobate.base_motions.numbers import Chosen
from stylobate.errors import ParameterError


@dataclass(frozen=True, slots=True, kw_only=True)
class OneOf(Following):
    """One of several base motions: number `chosen` of `motions`, from 0; ensembles vary it as `motion`.

    Parameters
    ----------
    motions
        Base motions, at least one.
    chosen
        Number of the motion.

    Raises
    ------
    ParameterError
        If `motions` is empty or has no motion with this number.

    Examples
    --------
    >>> import stylobate as sb
    >>> weak, strong = (sb.Pulse.one_sine(acceleration=a, angular_frequency=3.0) for a in (1.0, 5.0))
    >>> model = sb.Slender(sb.Column.solid(radius=0.2, height=2.0, density=2700.0))
    >>> shaken = sb.OneOf(motions=(weak, strong))
    >>> sb.with_parameters(model, shaken, motion=1)[1].peak_horizontal()
    5.0
    """

    motions: tuple[BaseMotion, ...]
    chosen: Chosen = 0

    def validate(self) -> None:
        """Raise ParameterError unless a motion with the number `chosen` exists."""
        object.__setattr__(self, "motions", tuple(self.motions))
        for motion in self.motions:
            require_motion("motions", motion)
        count, number = len(self.motions), self.chosen
        if not (0 <= number < count and float(number).is_integer()):
            message = f"motion must be a whole number from 0 to {count - 1}, of {count} motions; got {number!r}"
            raise ParameterError(message)
        object.__setattr__(self, "chosen", int(number))

    def made_by(self) -> tuple[Callable[..., BaseMotion], Mapping[str, Any]]:
        """Return the constructor: the selection by number, with its arguments."""
        return OneOf, {"motions": self.motions, "chosen": self.chosen}

    def choose(self, number: float) -> Self:
        """Choose the motion with another `number`."""
        return replace(self, chosen=number)  # type: ignore[arg-type]  # checked at construction

    @property
    def followed(self) -> BaseMotion:
        """The chosen motion."""
        return self.motions[self.chosen]


def members_of(motion: BaseMotion) -> tuple[BaseMotion, ...]:
    """Return all motions that `motion` selects from, transformed like `motion`; only `motion` without selection."""
    if isinstance(motion, OneOf):
        return motion.motions
    if isinstance(motion, Transformed):
        return tuple(replace(motion, motion=member) for member in members_of(motion.motion))
    return (motion,)


def number_of(motion: BaseMotion) -> int:
    """Return the index of `motion` in `members_of`."""
    if isinstance(motion, OneOf):
        return motion.chosen
    return number_of(motion.motion) if isinstance(motion, Transformed) else 0


def with_choice(motion: BaseMotion, number: float) -> BaseMotion | None:
    """Return `motion` with another `number` chosen, or None if it is not one of several."""
    if isinstance(motion, OneOf):
        return motion.choose(number)
    if not isinstance(motion, Transformed):
        return None
    inner = with_choice(motion.motion, number)
    return None if inner is None else replace(motion, motion=inner)
