"""Processor time and memory of an ensemble versus number of runs, each number in its own process."""

import json
import resource
import subprocess
import sys
import time
from dataclasses import asdict, dataclass
from pathlib import Path

from . import ours
from .one_core import use_one_core
from .workloads import WORKLOADS

COUNTS = (100, 1_000, 10_000, 100_000, 1_000_000)
_STATUS, _FORGET = Path("/proc/self/status"), Path("/proc/self/clear_refs")


@dataclass(frozen=True, slots=True)
class Cost:
    """Cost of an ensemble of `count` runs on one core.

    Parameters
    ----------
    workload, count
        Computed workload and number of runs.
    seconds
        Processor time.
    peak
        Peak memory of the process [bytes].
    added
        Peak memory minus the memory with loaded packages and created input [bytes].
    """

    workload: str
    count: int
    seconds: float
    peak: int
    added: int


def costs(workload: str, *, largest: int = COUNTS[-1]) -> list[Cost]:
    """Measure the costs of all counts up to the `largest`."""
    return [_in_own_process(workload, count) for count in COUNTS if count <= largest]


def _in_own_process(workload: str, count: int) -> Cost:
    command = [sys.executable, "-m", __spec__.name, workload, str(count)]
    done = subprocess.run(command, check=True, capture_output=True, text=True)  # noqa: S603
    return Cost(**json.loads(done.stdout))


def _measure(workload: str, count: int) -> Cost:
    use_one_core()
    runs = WORKLOADS[workload](count)
    ours.solve(runs.take(slice(0, 64)), threads=1)  # loads the kernel
    if _FORGET.exists():
        _FORGET.write_text("5", encoding="ascii")  # resets the peak of loading
    before = _memory("VmRSS")
    seconds = []
    for _ in range(1 if count >= 100_000 else 5):
        begun = time.process_time()
        ours.solve(runs, threads=1)
        seconds.append(time.process_time() - begun)
    peak = _memory("VmHWM")
    return Cost(workload, count, sorted(seconds)[len(seconds) // 2], peak, peak - before)


def _memory(field: str) -> int:
    """Return the memory of this process [bytes]: now (VmRSS) or at most (VmHWM)."""
    if _STATUS.exists():
        for line in _STATUS.read_text(encoding="ascii").splitlines():
            if line.startswith(field):
                return 1024 * int(line.split()[1])
    largest = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return largest if sys.platform == "darwin" else 1024 * largest


if __name__ == "__main__":
    print(json.dumps(asdict(_measure(sys.argv[1], int(sys.argv[2])))))
