"""Studies of many runs: most are functions that return a sweep and the labelling of its runs.

The decorator `study` adds what they share: the arguments of runs, store, executor, resumption and progress.
"""

import inspect
import json
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ParamSpec, TypedDict, cast, get_args

from stylobate.config.study import Analysis, Study, declared_numbers
from stylobate.progress import Progress, shows_progress
from stylobate.run_arguments import Argument, RunOptions, defaults_of, takes
from stylobate.studies.sweeps.executors import Executor

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    import xarray as xr

    from stylobate.studies.sweeps.running import Label
    from stylobate.studies.sweeps.sweep import Sweep

_P = ParamSpec("_P")


class Computing(TypedDict, total=False):
    """How the runs of a study are computed."""

    store: Annotated[
        str | Path | None,
        Argument(None, 'Folder of a Zarr store of the runs, such as "map.zarr"; None keeps them in memory.'),
    ]
    executor: Annotated[Executor | None, Argument(None, "`Threads()`, the default, or `Dask(…)`.")]
    resume: Annotated[
        bool, Argument(default=False, says="Continue the store if it exists: only missing runs are computed.")
    ]
    progress: Annotated[
        Progress,
        Argument(
            None,
            "A function that is called with the number of runs done and of all runs, or False. By default a bar "
            "appears after two seconds if stderr is a terminal, or in a notebook.",
        ),
    ]


class Lengths(TypedDict, total=False):
    """How long runs last."""

    duration: Annotated[
        float | None,
        Argument(
            None,
            "Duration of each run [s]. If all base motions end, the default is that of the longest one and a "
            "free-vibration tail of 20/p, where p is `model.column.frequency_parameter`.",
        ),
    ]
    periods: Annotated[
        float | None, Argument(None, "Duration of each run in periods of the base motion, in place of `duration`.")
    ]


class Described(Lengths, RunOptions, total=False):
    """The arguments that describe the runs of a sweep."""


class StudyArguments(Described, Computing, total=False):
    """The arguments of a study of many runs besides its own."""


class RunsOfOwnLength(RunOptions, Computing, total=False):
    """The arguments of a study whose own arguments state how long runs last, such as a number of periods."""


def described(run: StudyArguments) -> Described:
    """Return the arguments that describe the runs, without those of their computation."""
    how = defaults_of(Computing)
    return cast("Described", {name: value for name, value in run.items() if name not in how})


def options_of(run: RunsOfOwnLength) -> RunOptions:
    """Return the options of the runs, without the arguments of their computation."""
    return cast("RunOptions", described(cast("StudyArguments", run)))


_OPTIONS = f"""    **options
        Arguments of all runs, as in `simulate` and `simulate_ensemble`: {", ".join(defaults_of(RunOptions))}; see
        `RunOptions`.
"""


def study(
    word: str, declared: Study | None = None
) -> "Callable[[Callable[_P, tuple[Sweep, Label] | xr.Dataset]], Callable[_P, xr.Dataset]]":
    """Make a study of a function that returns its sweep, and the function that labels the runs; a decorator.

    The function takes `**run: Unpack[StudyArguments]`, or another group in place of `StudyArguments`, and gets all
    arguments of the group. A function that computes several sweeps returns its result instead.

    Parameters
    ----------
    word
        Name of the computation beside the bar.
    declared
        Description in files and command of the study.
    """

    def decorated(function: "Callable[_P, tuple[Sweep, Label] | xr.Dataset]") -> "Callable[_P, xr.Dataset]":
        signature = inspect.signature(function)
        (group,) = get_args(signature.parameters["run"].annotation)
        how = defaults_of(Computing)

        @wraps(function)
        def computed(*arguments: _P.args, **named: _P.kwargs) -> "xr.Dataset":
            from stylobate.studies.sweeps.running import labelled_sweep

            found = function(*arguments, **named)
            if isinstance(found, tuple):
                found = labelled_sweep(*found, **{name: named[name] for name in how})  # type: ignore[arg-type]
            if declared is None:
                return found
            given = signature.bind(*arguments, **named).arguments
            return _with_numbers(
                found, declared.name, {name: given[name] for name in declared_numbers(made) if name in given}
            )

        computed.__signature__ = signature.replace(return_annotation="xr.Dataset")  # type: ignore[attr-defined]
        computed.__doc__ = (function.__doc__ or "").replace("    **run\n", f"    **run\n{_OPTIONS}")
        groups = (Lengths, Computing) if "duration" in group.__annotations__ else (Computing,)
        made = shows_progress(word)(takes(group, described=groups)(computed))
        made.study = declared  # type: ignore[attr-defined]  # read by `study_of`
        return made

    return decorated


def analysis(declared: Analysis) -> "Callable[[Callable[_P, xr.Dataset]], Callable[_P, xr.Dataset]]":
    """Declare a study that is computed at once; a decorator."""

    def decorated(function: "Callable[_P, xr.Dataset]") -> "Callable[_P, xr.Dataset]":
        function.study = declared  # type: ignore[attr-defined]  # read by `study_of`
        return function

    return decorated


def _with_numbers(found: "xr.Dataset", name: str, numbers: "Mapping[str, Any]") -> "xr.Dataset":
    """Return a result whose provenance has the study's own numbers that were given, unless it has them already."""
    provenance = json.loads(found.attrs.get("provenance", "{}"))
    given = {one: value for one, value in numbers.items() if value is not None and one not in provenance}
    if not given or name in provenance:
        return found
    return found.assign_attrs(provenance=json.dumps({**provenance, name: given}))
