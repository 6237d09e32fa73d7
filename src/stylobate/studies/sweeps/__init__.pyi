from .dask_executor import Dask, executor_from
from .executors import Executor, Threads
from .running import run_sweep
from .store import open_sweep
from .sweep import Sweep

__all__ = ["Dask", "Executor", "Sweep", "Threads", "executor_from", "open_sweep", "run_sweep"]
