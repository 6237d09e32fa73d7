"""What the text of a flow's module takes as constants."""

from enum import IntEnum

import numpy as np

from stylobate.engine import dop853

STAGES = 12

DOP_A = np.vstack([np.pad(dop853.A, ((0, 0), (0, 1))), np.pad(dop853.B, (0, 1))])
"""Weights of the slopes in each stage, shape (13, 13); the last stage is the end of the step."""
DOP_C = np.append(dop853.C, 1.0)
DOP_E3, DOP_E5 = np.array(dop853.E3), np.array(dop853.E5)


class Status(IntEnum):
    """How a flow ended."""

    DONE = 0
    LOST = 1
    """It came to the upright, where the derivatives do not exist."""
    GONE = 2
    """It went beyond the peak tilt."""
    FAILED = 3
    """The steps became too many or too short."""
