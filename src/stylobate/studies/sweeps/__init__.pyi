from .dask_executor import Dask
from .executors import Executor, Threads
from .running import run_sweep
from .sweep import Sweep

__all__ = ["Dask", "Executor", "Sweep", "Threads", "run_sweep"]
