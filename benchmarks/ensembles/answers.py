"""Result of an engine, and its error."""

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
        x, y and their rates, shape (n, 4); then the spin for models with spin.
    time
        End time of the run.
    overturned
        Whether the run ended at the point of no return.
    steps
        Total number of accepted steps, if the engine reports it.
    """

    end: Array
    time: Array
    overturned: npt.NDArray[np.bool_]
    steps: int | None = None

    def take(self, index: Any) -> "Answer":
        """Return the runs of this index."""
        return Answer(self.end[index], self.time[index], self.overturned[index])


def errors(answer: Answer, truth: Answer) -> Array:
    """Compute the largest error of tilt and rate at the end of each run."""
    return np.abs(answer.end - truth.end).max(axis=1)
