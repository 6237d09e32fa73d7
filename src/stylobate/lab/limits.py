"""How much one request, and all together, may ask of the laboratory."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """What the laboratory refuses to exceed; each refusal names the limit.

    Attributes
    ----------
    body
        Size of a request [bytes].
    records
        Size of a request with files of records [bytes].
    unpacked
        Size of a file of a record when it is unpacked [bytes].
    receiving
        How long a request may take to arrive [s].
    connections
        Connections at once.
    uploads
        Size of all records kept [bytes]; the oldest go first.
    duration
        Length of a run [s].
    steps
        Steps of the integration of a run, at most.
    usual_steps
        Steps of a run that states no `max_steps`: a run that needs more ends as failed, with its motion so far, well
        before `run_time`.
    points
        Frequencies of a response curve.
    cells
        Runs of a map or basin.
    motions
        Motions of which a base motion is made.
    record_samples
        Samples of all its records together.
    run_time
        How long a single run may be computed [s].
    wait
        How long a single run may wait for one of the processes that compute them [s]; on a busy machine they start
        slowly.
    runs
        Single runs computed at once.
    jobs
        Maps and the like computed at once.
    waiting
        Jobs that wait.
    abandoned
        A job is dropped when nobody has asked for it for so long [s].
    """

    body: int = 1 << 20
    records: int = 24 << 20
    unpacked: int = 32 << 20
    receiving: float = 30.0
    connections: int = 128
    uploads: int = 256 << 20
    duration: float = 3600.0
    steps: int = 200_000
    usual_steps: int = 50_000
    points: int = 2000
    cells: int = 40_000
    motions: int = 100
    record_samples: int = 4_000_000
    run_time: float = 60.0
    wait: float = 120.0
    runs: int = 3
    jobs: int = 2
    waiting: int = 8
    abandoned: float = 120.0

    def of_numbers(self) -> dict[str, tuple[float, str]]:
        """Return the largest value of each number of a run that is limited, with its unit, by name."""
        return {
            "duration": (self.duration, "s"),
            "max_steps": (self.steps, "steps"),
            "samples": (self.steps, "samples"),
            "points": (self.points, "frequencies"),
            "strobes": (self.points, "states"),
        }
