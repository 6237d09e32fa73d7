"""Maps and basins, shown progressively during their computation: every eighth run along each axis first."""

import os
import time
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate import config, conveying, studies
from stylobate.errors import Outcome, ParameterError
from stylobate.lab.answers import (
    Attractor,
    BasinResult,
    ContactMapResult,
    MapResult,
    PlaneAxes,
    PlaneAxis,
    PlaneBegun,
    PlaneCells,
)
from stylobate.lab.case_axes import case_map, case_numbers, units_of
from stylobate.lab.pool import Emit, Found, Progress
from stylobate.parameter_quantities import attributes_of
from stylobate.progress import Report
from stylobate.studies.sweeps.computing import Arrays, Computed, Task
from stylobate.studies.sweeps.executors import Work

Cells = npt.NDArray[np.int64]


def overturning_plane(values: Mapping[str, Any], emit: Emit) -> MapResult | ContactMapResult:
    """Compute the map of outcomes over two quantities; for a sliding model, the map of kinds of contact."""
    setup = config.MapConfig.parse(values).build()
    study = conveying.contact_map if setup.model.switches else studies.overturning_map
    if case_numbers(values, setup.options["over"]):
        found = _watched(partial(case_map, setup, values), setup, emit, keywords={}, flat=True)
    else:
        found = _watched(partial(study, setup.model, setup.motion), setup, emit, keywords=setup.options)
    if "contact_class" in found:
        return ContactMapResult(**_classes(found, "contact_class", found["class_name"].to_numpy(), setup))
    shares = zip(Outcome, found["share"].to_numpy().tolist(), strict=True)
    return MapResult(**_size(found), shares={outcome.label: share for outcome, share in shares})


def basin_plane(values: Mapping[str, Any], emit: Emit) -> BasinResult:
    """Compute the attractor of each initial condition of a grid."""
    setup = config.BasinConfig.parse(values).build()
    if "count" in setup.options:
        raise ParameterError(
            "basin.random: the laboratory computes grids only. Give basin.x and basin.y, or use the command line."
        )
    found = _watched(partial(studies.basins, setup.model, setup.motion), setup, emit, keywords=setup.options)
    classes = _classes(found, "attractor", found["attractor_name"].to_numpy(), setup)
    members = [found.isel(attractor_index=i) for i in range(found.sizes["attractor_index"])]
    return BasinResult(**classes, attractors=[_attractor(one) for one in members])


def _attractor(one: xr.Dataset) -> Attractor:
    return Attractor(
        name=str(one["attractor_name"].item()),
        kind=str(one["attractor_kind"].item()),
        period=int(one["attractor_period"]),
        **{name: float(one[name]) for name in ("fraction", "fraction_low", "fraction_high")},
    )


def _watched(
    study: Callable[..., xr.Dataset],
    setup: config.Setup,
    emit: Emit,
    *,
    keywords: Mapping[str, Any],
    flat: bool = False,
) -> xr.Dataset:
    """Run `study` and emit the outcomes as soon as they are known; `flat` if the runs of the study form one row."""
    over = setup.options["over"]
    axes = {
        place: PlaneAxis(name=name, values=values, **(attributes_of(name) or {"units": units_of(name)}))
        for place, (name, values) in zip("xy", over.items(), strict=True)
    }
    names = [(int(outcome), outcome.label) for outcome in Outcome]
    emit(Found(PlaneBegun(axes=PlaneAxes(**axes), names=names)))

    def show(stride: int, places: Cells, outcomes: Cells) -> None:
        emit(Found(PlaneCells(stride=stride, cells=np.column_stack([places, outcomes]).tolist())))

    shape = tuple(len(values) for values in over.values()) if flat else None
    executor = Refining(show, threads=max(1, (os.cpu_count() or 2) // 2), shape=shape)
    return study(
        **keywords,
        executor=executor,
        progress=lambda done, total: emit(Progress(done, total)),
    )


def _classes(found: xr.Dataset, variable: str, names: Any, setup: config.Setup) -> dict[str, Any]:
    """Return the cells with their final classes."""
    codes = found[variable].transpose(*found["outcome"].dims).to_numpy()
    codes = codes.reshape([len(values) for values in setup.options["over"].values()])
    return {**_size(found), "codes": codes.tolist(), "names": [(index, str(name)) for index, name in enumerate(names)]}


def _size(found: xr.Dataset) -> dict[str, int]:
    return {"uncertain": int(found["uncertain"].sum()), "runs": int(found["outcome"].size)}


# The executor

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
