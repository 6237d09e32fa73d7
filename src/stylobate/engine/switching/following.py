"""How a run is integrated alone, and why it ended."""

import math
from dataclasses import dataclass
from enum import Enum, auto


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
