"""How a run is integrated alone, and why it ended."""

import math
from dataclasses import dataclass
from enum import Enum, auto

from stylobate.base_motions import BaseMotion
from stylobate.engine.tolerances import ATOL_SHARE
from stylobate.models import Model


@dataclass(frozen=True, slots=True, kw_only=True)
class Method:
    """How to integrate: tolerances of DOP853, its longest step, the most steps and the end of a run."""

    rtol: float
    atol: float
    max_step: float
    max_steps: int
    end: float = math.inf


class Reason(Enum):
    """Why a stretch of motion ended."""

    STOP = auto()
    """The time was up."""
    RESTED = auto()
    OVERTURNED = auto()
    LIMIT = auto()
    LIFTED = auto()
    CROSSED = auto()
    """The upright was passed in a plane, or came so near that it is passed in closed form."""
    STRUCK = auto()
    """The upright was passed so closely, out of a plane, that the passage costs energy."""
    FAILED = auto()
    TERMINATED = auto()
    """A terminal event function of the user."""


def method_of(model: Model, motion: BaseMotion, rtol: float, max_steps: int, end: float) -> Method:
    """Return how a run is integrated up to the dimensionless time `end`."""
    # Half the shortest period: no step can miss the forcing.
    frequency = motion.highest_frequency * model.time_scale
    longest = math.pi / frequency if frequency > 0.0 else math.inf
    atol = ATOL_SHARE * rtol * model.column.slenderness
    return Method(rtol=rtol, atol=atol, max_step=longest, max_steps=max_steps, end=end)
