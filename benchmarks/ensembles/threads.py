"""What a second thread brings: wall time of one and of two, in turns, in a process of its own.

The fastest of the rounds counts: wall time is at the mercy of whatever else the machine does.
"""

import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from functools import partial

from . import ours
from .one_core import use_all_cores
from .quiet import wait_for_quiet
from .workloads import WORKLOADS

_COUNTS = {"rolling": 16384, "mix": 65536}


def speed_up(*, repetitions: int, shorter: int = 1) -> dict[str, float] | None:
    """Return how many times as fast two threads are, for each workload; None where there is one core."""
    if (os.cpu_count() or 1) < 2:
        return None
    command = [sys.executable, "-m", __spec__.name, str(repetitions), str(shorter)]
    done = subprocess.run(command, check=True, capture_output=True, text=True, env=_all_threads())  # noqa: S603
    return json.loads(done.stdout)


def _all_threads() -> dict[str, str]:
    return {name: value for name, value in os.environ.items() if not name.endswith("_NUM_THREADS")}


def _measure(repetitions: int, shorter: int) -> dict[str, float]:
    found = {}
    for workload, count in _COUNTS.items():
        found[workload] = gain(partial(ours.solve, WORKLOADS[workload](count // shorter)), repetitions)
    return found


def gain(solve: Callable[..., object], repetitions: int) -> float:
    """Return the fastest wall time of `solve(threads=1)` over that of `solve(threads=2)`, on all cores."""
    use_all_cores()
    solve(threads=2)
    seconds: dict[int, list[float]] = {1: [], 2: []}
    for _ in range(repetitions):
        wait_for_quiet()
        for threads, taken in seconds.items():
            begun = time.perf_counter()
            solve(threads=threads)
            taken.append(time.perf_counter() - begun)
    return min(seconds[1]) / min(seconds[2])


if __name__ == "__main__":
    print(json.dumps(_measure(int(sys.argv[1]), int(sys.argv[2]))))
