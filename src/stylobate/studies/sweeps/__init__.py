"""Sweeps: one description of many runs, divided into chunks, computed locally or on a cluster, stored and resumed."""

from stylobate.run_arguments import RunOptions
from stylobate.studies.sweeps.dask_executor import Dask
from stylobate.studies.sweeps.executors import Executor, Threads
from stylobate.studies.sweeps.named_executors import executor_from
from stylobate.studies.sweeps.running import run_sweep
from stylobate.studies.sweeps.store import open_sweep
from stylobate.studies.sweeps.sweep import Sweep

__all__ = ["Dask", "Executor", "RunOptions", "Sweep", "Threads", "executor_from", "open_sweep", "run_sweep"]
