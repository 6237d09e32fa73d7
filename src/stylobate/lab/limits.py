"""Limits of the laboratory: size and duration of requests, runs and jobs; refusals of requests."""

from collections.abc import Sequence
from dataclasses import dataclass

_HIGHEST_DEGREE = 20
"""Maximum degree of filters and baselines, which are badly conditioned far below it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """Limits on requests, runs and jobs; each refusal names its limit.

    Attributes
    ----------
    body
        Size of a request [bytes].
    records
        Size of a request with files of records [bytes].
    unpacked
        Size of a file of a record when it is unpacked [bytes].
    uploads
        Size of all stored records [bytes]; the oldest are removed first.
    duration
        Length of a run, and of the pauses before and after a record [s].
    steps
        Maximum number of integration steps of a run.
    points
        Frequencies of a response curve.
    cells
        Runs of a map or basin.
    run_time
        Time limit for the computation of a single run [s].
    wait
        Time limit for a single run to wait for a worker process [s]; on a busy machine processes start slowly.
    runs
        Single runs computed at once.
    jobs
        Number of jobs, such as maps, computed at once.
    waiting
        Number of waiting jobs.
    abandoned
        Time without requests after which a job is removed [s].
    """

    body: int = 1 << 20
    records: int = 24 << 20
    unpacked: int = 32 << 20
    uploads: int = 256 << 20
    duration: float = 3600.0
    steps: int = 200_000
    points: int = 2000
    cells: int = 40_000
    run_time: float = 60.0
    wait: float = 120.0
    runs: int = 3
    jobs: int = 2
    waiting: int = 8
    abandoned: float = 120.0

    def of_numbers(self) -> dict[str, tuple[float, str]]:
        """Return the maximum of each limited number of a description, with its unit, by name."""
        return {
            **dict.fromkeys(("duration", "tail", "before", "after", "length"), (self.duration, "s")),
            "max_steps": (self.steps, "steps"),
            "samples": (self.steps, "samples"),
            "points": (self.points, "frequencies"),
            "strobes": (self.points, "states"),
            **dict.fromkeys(("order", "degree"), (_HIGHEST_DEGREE, "")),
        }


class RefusedError(Exception):
    """A refused request.

    Attributes
    ----------
    status
        HTTP status of the answer.
    problems
        One line for each reason, with the remedy.
    """

    def __init__(self, status: int, problems: Sequence[str]) -> None:
        self.status = status
        self.problems = tuple(problems)
        super().__init__("\n".join(self.problems))
