"""Sweeps with labelled results, also after an interruption."""

from collections.abc import Callable
from pathlib import Path

import xarray as xr

from stylobate.errors import Interrupted
from stylobate.progress import Progress
from stylobate.studies.sweeps import Executor, Sweep, run_sweep

Label = Callable[[xr.Dataset], xr.Dataset]


def labelled_sweep(
    sweep: Sweep,
    label: Label,
    *,
    store: str | Path | None = None,
    executor: Executor | None = None,
    resume: bool = False,
    progress: Progress = None,
) -> xr.Dataset:
    """Run `sweep` and return its runs labelled by `label`; the other arguments are those of `run_sweep`.

    Raises
    ------
    Interrupted
        On Ctrl-C; `partial` is also labelled, unless the labelling was interrupted.
    """
    try:
        runs = run_sweep(sweep, store=store, executor=executor, resume=resume, progress=progress)
    except Interrupted as stop:
        raise Interrupted(str(stop), label(stop.partial)) from None
    try:
        return label(runs)
    except Interrupted:
        raise
    except KeyboardInterrupt:
        message = "interrupted during the labelling; `partial` has all runs, without labels"
        raise Interrupted(message, runs) from None
