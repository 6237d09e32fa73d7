"""Sweeps with their answers labelled, those of an interrupted one too."""

from collections.abc import Callable
from pathlib import Path

import xarray as xr

from stylobate.errors import Interrupted
from stylobate.studies.sweeps import Executor, Sweep, run_sweep
from stylobate.studies.sweeps.computing import Progress

Label = Callable[[xr.Dataset], xr.Dataset]


def labelled_sweep(
    sweep: Sweep,
    label: Label,
    *,
    store: str | Path | None = None,
    executor: Executor | None = None,
    resume: bool = False,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Run `sweep` and return what `label` makes of its runs; the other arguments are those of `run_sweep`.

    Raises
    ------
    Interrupted
        On Ctrl-C; its `partial` is labelled too, unless that is what was interrupted.
    """
    try:
        runs = run_sweep(sweep, store=store, executor=executor, resume=resume, progress=progress)
    except Interrupted as stop:
        raise Interrupted(str(stop), label(stop.partial)) from None
    try:
        return label(runs)
    except KeyboardInterrupt:
        message = "interrupted while the runs were labelled; all of them are kept, without labels"
        raise Interrupted(message, runs) from None
