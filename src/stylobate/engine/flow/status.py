"""Status of a flow at its end."""

from enum import IntEnum


class Status(IntEnum):
    """Status of a flow at its end."""

    DONE = 0
    LOST = 1
    """The motion came to the vertical, where the derivatives do not exist."""
    GONE = 2
    """The motion exceeded the peak tilt."""
    FAILED = 3
    """There were too many steps, or a step was too short."""


class Record(IntEnum):
    """Places of the record of a flow."""

    LEAST_TILT = 0
    PEAK_TILT = 1
    """Minimum and maximum tilt so far."""
    STEPS = 2
    """Number of steps."""
    SIDE = 3
    """Side of the vertical in planar motion."""
    TURNS = 4
    """Turns of the tilt vector."""
