"""What an engine returns, and how far it is from the truth."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Answer:
    """The end of every run of a workload.

    Parameters
    ----------
    end
        x, y, their rates, shape (n, 4); behind them the spin, of levels that know it.
    time
        When the run ended.
    overturned
        Whether it ended at the tilt of no return.
    steps
        Accepted steps in all runs together, where the engine tells.
    """

    end: Array
    time: Array
    overturned: npt.NDArray[np.bool_]
    steps: int | None = None

    def take(self, index: Any) -> "Answer":
        """Return the runs of this index."""
        return Answer(self.end[index], self.time[index], self.overturned[index])


def errors(answer: Answer, truth: Answer) -> Array:
    """Return the largest error of tilt and rate at the end of each run."""
    return np.abs(answer.end - truth.end).max(axis=1)
