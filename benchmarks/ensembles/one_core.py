"""One core for everything that follows, or all of them again."""

import os


def use_one_core() -> str:
    """Keep this process, and the libraries it has yet to load, on one core; return how, in words."""
    os.environ["XLA_FLAGS"] = "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1"
    for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"):
        os.environ[variable] = "1"
    if not hasattr(os, "sched_setaffinity"):
        return "with one thread each"
    os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    return "bound to one core"


def use_all_cores() -> None:
    """Let this process, whose caller may be bound to one core, and its threads to come run on all."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, range(os.cpu_count() or 1))
