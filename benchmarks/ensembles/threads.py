"""Speed-up by a second thread: alternating wall times of one and two threads, in a separate process.

The fastest round counts, since other load on the machine affects wall time.
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
    """Measure the speed-up of two threads for each workload; None with one core."""
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
    """Measure the ratio of the fastest wall times of `solve(threads=1)` and `solve(threads=2)`, on all cores."""
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
