"""Timed trials of the model hierarchy: each model with and without demands, two by Taylor series, one by SciPy."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

from . import ours, scipy_loop
from .answers import Answer
from .level_loads import Level
from .workloads import MIX_DISTINCT, Workload

COUNT, _LOOPED = 8 * MIX_DISTINCT, 8
"""Number of runs of an ensemble and of SciPy's loop."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Trial:
    """A model with a solver.

    Parameters
    ----------
    key, name
        Names in files and in tables.
    level
        Key of the model.
    solve
        Function that computes a workload.
    counts
        Number of runs of each supported workload.
    beside
        Key of the trial for the comparison of speed.
    demanding
        Key of the same trial with demands, or None.
    in_table
        Whether the trial has its own row.
    """

    key: str
    name: str
    level: str
    solve: Callable[[Workload], Answer]
    counts: Mapping[str, int]
    beside: str = "slender"
    demanding: str | None = None
    in_table: bool = True


def all_trials(levels: Mapping[str, Level], shorter: int = 1) -> list[Trial]:
    """Return the trials in the order of the tables."""
    both = dict.fromkeys(("rolling", "mix"), COUNT // shorter)
    trials = []
    for key, level in levels.items():
        solve, demanding = partial(ours.solve, threads=1, model=level.model), f"{key}, demands"
        shared = {"name": level.name, "level": key, "counts": both, "beside": level.beside}
        trials.append(Trial(key=key, solve=solve, demanding=demanding, **shared))
        trials.append(Trial(key=demanding, solve=partial(solve, demands=True), in_table=False, **shared))
    for key in ("slender", "rolling"):
        solve = partial(ours.solve, threads=1, model=levels[key].model, method="taylor")
        trials.append(
            Trial(key=f"{key}, taylor", name=f"{levels[key].name}, Taylor", level=key, solve=solve, counts=both)
        )
    looped = partial(scipy_loop.solve_model, levels["rolling"].model)
    name, few = f"{levels['rolling'].name}, {scipy_loop.NAME}", {"rolling": _LOOPED}
    return [*trials, Trial(key="rolling, scipy", name=name, level="rolling", solve=looped, counts=few)]
