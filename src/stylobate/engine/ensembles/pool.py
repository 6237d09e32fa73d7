"""Parallel computation of the parts of an ensemble on threads; Ctrl-C stops them within a step."""

import os
from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait

import numpy as np
import numpy.typing as npt

from stylobate.processes import end_all
from stylobate.progress import beat

Halt = npt.NDArray[np.uint8]

# Size of parts: small enough that every thread has one, all threads end together and progress is visible; large enough
# to fill the lanes and to keep the overhead of Python small.
_FEWEST, _ENOUGH, _MOST, _PARTS_PER_THREAD = 32, 512, 4096, 4


def parts_of(count: int, threads: int) -> list[slice]:
    """Return the slices of the parts of `count` runs."""
    share = -(-count // threads)
    size = min(max(_FEWEST, min(share, _ENOUGH), -(-share // _PARTS_PER_THREAD)), _MOST)
    return [slice(start, min(start + size, count)) for start in range(0, count, size)]


def usual_threads() -> int:
    """Return the number of threads that this process may run at a time."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def run_parts(
    parts: list[slice],
    compute: Callable[[slice, Halt], None],
    threads: int,
    done: Callable[[slice], None],
) -> bool:
    """Call `compute` for each part, and `done` in this thread as each is finished; return False after Ctrl-C.

    The second argument of `compute` is a flag that is set when it should stop. An exception of `compute` is raised here
    after all parts have stopped.
    """
    halt = np.zeros(1, dtype=np.uint8)
    waiting = iter(parts)
    with ThreadPoolExecutor(max_workers=threads, thread_name_prefix="stylobate") as pool:
        running: dict[Future[None], slice] = {}

        def start() -> None:
            part = next(waiting, None)
            if part is not None:
                running[pool.submit(compute, part, halt)] = part

        try:
            for _ in range(threads):
                start()
            while running:
                # The timeout lets Python react to Ctrl-C, which it can only do between its own steps.
                finished, _ = wait(running, timeout=0.1, return_when=FIRST_COMPLETED)
                beat()
                for future in finished:
                    part = running.pop(future)
                    future.result()
                    start()
                    done(part)
        except KeyboardInterrupt:
            halt[0] = 1
            while running and wait(running, timeout=0.1).not_done:
                end_all()  # a thread may wait for a compiler, and the next one may start another
            return False
        except BaseException:
            halt[0] = 1
            raise
    return True
