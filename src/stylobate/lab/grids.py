"""Maps and basins, shown progressively during their computation."""

import os
import time
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import repeat
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate import config
from stylobate.base_motions import BASE_AT_REST, Harmonic
from stylobate.config.simulation import Setup
from stylobate.config.study import Study, declared_numbers, study_of
from stylobate.engine.parameters import COLUMN_NAMES, present_value, with_parameters
from stylobate.errors import Outcome, ParameterError, UnsupportedError
from stylobate.lab import answers
from stylobate.lab.messages import Emit, Found, Progress
from stylobate.lab.options import CASE_NUMBERS
from stylobate.models import Model
from stylobate.parameter_quantities import attributes_of
from stylobate.progress import Report
from stylobate.studies.responses.response_curves import steady_start
from stylobate.studies.sweeps import Executor, Sweep
from stylobate.studies.sweeps.chunks import Arrays, Computed, Task
from stylobate.studies.sweeps.executors import Work
from stylobate.studies.sweeps.running import labelled_sweep

Cells = npt.NDArray[np.int64]
Floats = npt.NDArray[np.float64]


def grid(function: Callable[..., xr.Dataset], values: Mapping[str, Any], emit: Emit) -> answers.GridResult:
    """Compute the grid of a study that `values` describe, and emit the outcomes as soon as they are known.

    Raises
    ------
    ConfigError, ParameterError
        If the description is invalid, or of a random sample.
    """
    study = study_of(function)
    branch = values.get("start")
    values = {name: value for name, value in values.items() if name != "start"}
    setup = config.study_config(function).parse(values).build()
    if "count" in setup.options:
        raise ParameterError(
            f"{study.name}.random: the laboratory computes grids only. Give {study.name}.x and {study.name}.y, or use "
            "the command line."
        )
    over = setup.options["over"]
    axes = {
        place: answers.PlaneAxis(name=name, values=along, **(attributes_of(name) or {"units": units_of(name)}))
        for place, (name, along) in zip("xy", over.items(), strict=True)
    }
    names = [(int(outcome), outcome.label) for outcome in Outcome]
    emit(Found(answers.PlaneBegun(axes=answers.PlaneAxes(**axes), names=names)))

    def show(stride: int, places: Cells, outcomes: Cells) -> None:
        emit(Found(answers.PlaneCells(stride=stride, cells=np.column_stack([places, outcomes]).tolist())))

    def report(done: int, total: int) -> None:
        emit(Progress(done, total))

    shape = tuple(len(along) for along in over.values())
    of_case = branch is not None or bool(case_numbers(values, over))  # runs of one row
    executor = Refining(show, threads=max(1, (os.cpu_count() or 2) // 2), shape=shape if of_case else None)
    if of_case:
        found = case_grid(function, setup, values, branch=branch, executor=executor, progress=report)
    else:
        found = function(setup.model, setup.motion, **setup.options, executor=executor, progress=report)
    return _answered(found, study, shape)


def _answered(found: xr.Dataset, study: Study, shape: tuple[int, ...]) -> answers.GridResult:
    of = next(one for one in study.classes if one.codes in found)
    shares = (
        answers.numbers(found[name]) if name in found else repeat(None)
        for name in (of.share, f"{of.share}_low", f"{of.share}_high")
    )
    classes = zip(found[of.names].to_numpy(), *shares, strict=False)
    return answers.GridResult(
        runs=found["outcome"].size,
        uncertain=int(found["uncertain"].sum()),
        codes=found[of.codes].transpose(*found["outcome"].dims).to_numpy().reshape(shape).tolist(),
        classes=[
            answers.CellClass(code=code, name=str(name), share=share, low=low, high=high)
            for code, (name, share, low, high) in enumerate(classes)
        ],
    )


# The executor: every eighth run along each axis first, then the runs between them

_STRIDES = (8, 4, 2, 1)
_FIRST_PIECE, _LARGEST_PIECE = 32, 4096
_SHOWN_EVERY = 0.4
"""Time between updates [s]; the pieces grow until they take about this long."""


@dataclass(frozen=True, slots=True)
class Refining:
    """Executor with threads of this process that compute a plane of runs from coarse to fine.

    Parameters
    ----------
    show
        Called with the stride, the indices of runs in the plane, shape (n, 2), and their outcomes, shape (n,).
    threads
        Number of threads; None for all cores.
    shape
        Shape of the plane if the runs form one row, with the second axis varying fastest; None if they form a grid.
    """

    show: Callable[[int, Cells, Cells], None]
    threads: int | None = None
    shape: tuple[int, ...] | None = None

    def results(
        self, work: Work, tasks: Iterable[Task], progress: Report | None = None
    ) -> Generator[tuple[Task, Computed], None, None]:
        """Yield each task with its result when all are computed."""
        asked = list(tasks)
        places = np.concatenate([_places(task) for task in asked])
        if self.shape is not None:
            places = np.stack(np.unravel_index(places[:, 0], self.shape), axis=-1)
        values = {name: np.concatenate([task.values[name] for task in asked]) for name in asked[0].values}
        found: Arrays = {}
        done = 0
        for stride, chosen in _pieces(places):
            piece = Task(asked[0].block, {name: every[chosen] for name, every in values.items()})
            result = work(piece, threads=self.threads, progress=None)
            _put(found, chosen, result.arrays, len(places))
            done += len(chosen)
            self.show(stride, places[chosen], result.arrays["outcome"])
            if progress is not None:
                progress(done, len(places))
        ends = np.cumsum([task.block.size for task in asked])
        for task, end in zip(asked, ends, strict=True):
            own = slice(end - task.block.size, end)
            yield task, Computed({name: array[own] for name, array in found.items()})


def _places(task: Task) -> Cells:
    """Return the indices in the plane of each run of `task`, shape (n, 2)."""
    across = np.meshgrid(*(np.arange(part.start, part.stop) for part in task.block.slices), indexing="ij")
    return np.stack([axis.ravel() for axis in across], axis=-1)


def _pieces(places: Cells) -> Iterator[tuple[int, Cells]]:
    """Yield each stride with some of the runs that it adds; fast pieces are followed by larger ones."""
    seen = np.zeros(len(places), dtype=bool)
    size = _FIRST_PIECE
    for stride in _STRIDES:
        new = np.flatnonzero(~seen & (places % stride == 0).all(axis=1))
        seen[new] = True
        while len(new):
            begun = time.monotonic()
            yield stride, new[:size]
            new = new[size:]
            if time.monotonic() - begun < 0.5 * _SHOWN_EVERY:
                size = min(2 * size, _LARGEST_PIECE)


def _put(found: Arrays, chosen: Cells, arrays: Mapping[str, npt.NDArray[np.generic]], runs: int) -> None:
    for name, values in arrays.items():
        if name not in found:
            found[name] = np.zeros((runs, *values.shape[1:]), dtype=values.dtype)
        found[name][chosen] = values


# Maps over numbers of a description that sweeps do not support, such as revolutions per minute or a height

_BODY = tuple(name for name in COLUMN_NAMES if name not in ("slenderness", "size"))
_MOVED = ("angular_frequency", "acceleration")


def units_of(name: str) -> str:
    """Return the unit of a number of a description; empty for a name that the study refuses."""
    return next((part[name].cf_units for part in CASE_NUMBERS.values() if name in part), "")


def case_numbers(values: Mapping[str, Any], over: Mapping[str, Floats]) -> dict[str, tuple[str, ...]]:
    """Return the axes that are numbers of the described column or motion, by part; empty if sweeps support them all.

    Sweeps can vary the radius of a body with given mass and inertia; for other bodies mass and inertia depend on it.
    """
    given = values["column"].get("shape") == "given"
    found = {
        part: tuple(name for name in over if name in values.get(part, {}))
        for part, names in CASE_NUMBERS.items()
        if any(name in values.get(part, {}) for name in over if name in names)
    }
    return {part: names for part, names in found.items() if not (part == "column" and given)}


def case_grid(
    function: Callable[..., xr.Dataset],
    setup: Setup,
    values: Mapping[str, Any],
    *,
    branch: str | None = None,
    executor: Executor,
    progress: Report | None = None,
) -> xr.Dataset:
    """Compute the grid of a study whose axes are numbers of the described case, or whose runs start on a branch.

    Each run has the column and motion of the case with the numbers of its cell.

    Parameters
    ----------
    function, setup, values
        The study; model, motion and options of its runs; and the plain values that describe them.
    branch
        Branch of steady rolling on which each run starts, a little off it; it stands where its motion has none. None:
        all start as the case does.
    executor, progress
        As in `run_sweep`. The runs form one row, with the second axis varying fastest.

    Returns
    -------
    xarray.Dataset
        The result of the study over `run`.

    Raises
    ------
    ConfigError, ParameterError
        If an axis has an impossible value.
    """
    study: Study = study_of(function)
    own = {"over", *declared_numbers(function)}
    options = {name: value for name, value in setup.options.items() if name not in own}
    at = _at(values, setup.options["over"])
    if branch is not None:
        at |= starts_on_branch(setup, values, branch)
    sweep = Sweep.points(_without_height(setup.model), setup.motion, at=at, **options)

    def label(runs: xr.Dataset) -> xr.Dataset:
        return study.completed(runs, lambda: setup, setup.options)

    return labelled_sweep(sweep, label, executor=executor, progress=progress)


OFF_BRANCH = 1e-3
"""A start on a branch is off it by this fraction of the tilt, so that a run leaves a motion that is not stable."""


def starts_on_branch(setup: Setup, values: Mapping[str, Any], branch: str) -> dict[str, Floats]:
    """Return the start of each run on the branch of its own motion, a little off it; at rest where there is none.

    Raises
    ------
    ParameterError, UnsupportedError
        If the base motion is not horizontal and harmonic, or the model has no steady rolling in closed form.
    """
    if not isinstance(setup.motion, Harmonic):
        raise ParameterError("motion.kind must be a horizontal harmonic motion for a start on a branch")
    over = setup.options["over"]
    cells = np.stack([axis.ravel() for axis in np.meshgrid(*over.values(), indexing="ij")], axis=1)
    states = np.zeros((len(cells), 5))
    for number, row in enumerate(cells.tolist()):
        model, motion = _case_with(values, dict(zip(over, row, strict=True)))
        try:
            begun = steady_start(model, motion, branch=branch)
        except ParameterError:
            continue
        tilt = np.multiply(begun["tilt"], 1.0 + OFF_BRANCH)
        states[number] = (*tilt, *begun["tilt_rate"], begun.get("spin", 0.0))
    found = dict(zip(("tilt_x", "tilt_y", "tilt_rate_x", "tilt_rate_y", "spin"), states.T, strict=True))
    return found if setup.model.spin_state is not None else {name: found[name] for name in found if name != "spin"}


def _case_with(values: Mapping[str, Any], numbers: Mapping[str, float]) -> tuple[Model, Harmonic]:
    """Return model and motion of the case with other numbers of its description, or of its model."""
    case, rest = {part: dict(values[part]) for part in ("column", "model", "motion") if part in values}, {}
    for name, value in numbers.items():
        part = next((part for part in ("motion", "model", "column") if name in case.get(part, {})), None)
        if part is None:
            rest[name] = value
        else:
            case[part][name] = value
    built = config.SimulationConfig.parse({**case, "duration": 1.0}).build()
    model, _ = with_parameters(built.model, BASE_AT_REST, **rest) if rest else (built.model, None)
    assert isinstance(built.motion, Harmonic)
    return model, built.motion


def _without_height(model: Model) -> Model:
    """Return `model` without the height of its body, which differs between runs."""
    bare: Model = replace(model, column=replace(model.column, height=None))  # type: ignore[type-var]  # a dataclass
    return bare


def _at(values: Mapping[str, Any], over: Mapping[str, Floats]) -> dict[str, Floats]:
    """Return the quantities of sweeps for each cell, with the second axis varying fastest."""
    cells = dict(zip(over, (grid.ravel() for grid in np.meshgrid(*over.values(), indexing="ij")), strict=True))
    found: dict[str, Floats] = {}
    for part, names in case_numbers(values, over).items():
        own = np.stack([cells.pop(name) for name in names], axis=1)
        different, which = np.unique(own, axis=0, return_inverse=True)
        read = [_READ[part](_with(values, part, dict(zip(names, row, strict=True)))) for row in different.tolist()]
        found |= {name: np.array([one[name] for one in read])[which.ravel()] for name in read[0]}
    return found | cells


def _with(values: Mapping[str, Any], part: str, numbers: Mapping[str, float]) -> Setup:
    """Return the setup of the case with other numbers of one part."""
    case = {name: values[name] for name in ("column", "model", "motion") if name in values}
    changed = {**case, part: {**case[part], **numbers}, "duration": 1.0}
    return config.SimulationConfig.parse(changed).build()


def _body(setup: Setup) -> dict[str, float]:
    return {name: float(getattr(setup.model.column, name)) for name in _BODY}


def _moved(setup: Setup) -> dict[str, float]:
    found: dict[str, float] = {}
    for name in _MOVED:
        try:
            found[name] = present_value(setup.model, setup.motion, name)
        except UnsupportedError:
            continue  # a motion without a frequency of its own
    return found


_READ: Mapping[str, Callable[[Setup], dict[str, float]]] = {"column": _body, "motion": _moved}
