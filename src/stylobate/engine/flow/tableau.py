"""Constants for the text of a flow module: coefficients of DOP853, and the status of a flow."""

from enum import IntEnum

import numpy as np

from stylobate.engine import dop853

STAGES = 12

DOP_A = np.vstack([np.pad(dop853.A, ((0, 0), (0, 1))), np.pad(dop853.B, (0, 1))])
"""Weights of the slopes in each stage, shape (13, 13); the last stage is the end of the step."""
DOP_C = np.append(dop853.C, 1.0)
DOP_E3, DOP_E5 = np.array(dop853.E3), np.array(dop853.E5)


class Status(IntEnum):
    """Status of a flow at its end."""

    DONE = 0
    LOST = 1
    """The motion came to the vertical, where the derivatives do not exist."""
    GONE = 2
    """The motion exceeded the peak tilt."""
    FAILED = 3
    """There were too many steps, or a step was too short."""
