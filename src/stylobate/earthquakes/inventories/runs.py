"""Runs of an inventory: blocks of objects of one site, computed by an executor and stored object by object."""

import logging
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from importlib.metadata import version
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from stylobate.base_motions import BaseMotion, OneOf
from stylobate.earthquakes.assessment.inputs import identities
from stylobate.earthquakes.inventories.objects import OF_RUNS, Draws, PreparedObject, name_of_constructor, unquestioned
from stylobate.earthquakes.study_inputs import tail_of
from stylobate.engine import simulate_ensemble
from stylobate.models import Model
from stylobate.progress import Report
from stylobate.results.keyed_store import KeyedStore
from stylobate.run_arguments import FREE_TAIL, Accuracy
from stylobate.studies.sweeps import Executor, Threads
from stylobate.studies.sweeps.chunks import Arrays, Computed, GridBlock, Task

_log = logging.getLogger("stylobate")

# Version of the layout of stored parts; a store of another layout is not read.
_LAYOUT = 1
# Maximum number of runs in a block of several objects; an object with more runs is a block by itself.
_BLOCK = 16_384
# The same for executors whose workers compute a block on one thread each.
_BLOCK_OF_WORKER = 4096
KEPT = ("outcome", "peak_tilt", "peak_friction_demand")
"""Results of a run that are kept."""
_RUN_DIMS = ("record", "property_sample", "scale")


@dataclass(frozen=True, slots=True, kw_only=True)
class SiteRuns:
    """The runs of one site: each object under each record, with its own samples of the uncertain numbers.

    Each record has samples of its own. So the shares of two records are independent, and an interval over records
    covers the sampling of the properties too.

    Parameters
    ----------
    records
        Base motions by name, sorted.
    scales
        Factors of the records.
    samples
        Number of samples of the uncertain numbers for each record.
    seed
        Seed of the samples.
    tail
        Free-vibration time after a record [s], by default 20/p of each sample.
    options
        Options of all runs.
    """

    records: Mapping[str, BaseMotion]
    scales: tuple[float, ...]
    samples: int
    seed: int
    tail: float | None
    options: Accuracy

    def samples_of(self, one: PreparedObject) -> int:
        """Return the number of samples of an object: 1 if all its numbers are certain."""
        return self.samples if one.spreads else 1

    def runs_of(self, one: PreparedObject) -> int:
        """Return the number of runs of an object."""
        return len(self.records) * self.samples_of(one) * len(self.scales)

    def identity(self, one: PreparedObject, motions: Mapping[str, Any]) -> dict[str, Any]:
        """Return everything on which the runs of an object depend; `motions` are the identities of the records."""
        return {
            "version": version("stylobate"),
            "layout": _LAYOUT,
            "model": {"kind": one.model.name, **{name: getattr(one.model, name) for name in one.of_model}},
            "column": {name: getattr(one.model.column, name) for name in OF_RUNS},
            "numbers": dict(one.numbers),
            "make": name_of_constructor(one.make),
            "spreads": {name: repr(spread) for name, spread in one.spreads.items()},
            "records": motions,
            "scales": self.scales,
            "samples": self.samples_of(one),
            "seed": self.seed,
            "tail": self.tail,
            "options": repr(dict(self.options)),
        }

    def parts(
        self, objects: Sequence[PreparedObject], store: Path | None, executor: Executor | None, progress: Report
    ) -> Iterator[tuple[PreparedObject, xr.Dataset]]:
        """Yield each object with its runs: those in the store first, then the others as blocks are computed.

        Parameters
        ----------
        objects
            Objects of the site.
        store, executor
            Folder of the runs, and executor of the blocks; None for none, and for `Threads()`.
        progress
            Called with the number of runs done of a block, and all its runs.

        Yields
        ------
        tuple
            The object, and its runs over `record`, `property_sample` and `scale`: `outcome`, `peak_tilt` [rad] and
            `peak_friction_demand`; and the `slenderness` over the first two.

        Raises
        ------
        FileError
            If the store cannot be written.
        """
        kept = None if store is None else KeyedStore(store)
        motions = identities(self.records)
        missing: list[PreparedObject] = []
        for one in objects:
            stored = None if kept is None else kept.read(one.name, self.identity(one, motions))
            if stored is None:
                missing.append(one)
            else:
                yield one, stored.to_dataset()
        if kept is not None and len(missing) < len(objects):
            _log.info("%d of %d objects were read from %s", len(objects) - len(missing), len(objects), store)
        # Blocks of objects that state the same numbers of the model.
        missing.sort(key=lambda one: (one.of_model, one.name))
        for _, alike in groupby(missing, key=lambda one: one.of_model):
            for one, part in self._computed(list(alike), executor or Threads(), progress):
                if kept is not None:
                    kept.write(one.name, self.identity(one, motions), part)
                yield one, part

    def _computed(
        self, objects: Sequence[PreparedObject], executor: Executor, progress: Report
    ) -> Iterator[tuple[PreparedObject, xr.Dataset]]:
        most = _BLOCK if isinstance(executor, Threads) else min(_BLOCK, _BLOCK_OF_WORKER)
        blocks = list(self._blocks(objects, most))
        work = _Work(objects[0].base, OneOf(motions=tuple(self.records.values())), self.scales, self.options)
        with closing(executor.results(work, self._tasks(blocks), progress)) as results:
            for task, computed in results:
                begin, arrays = 0, dict(task.values)
                for one in blocks[task.block.index]:
                    series = slice(begin, begin + len(self.records) * self.samples_of(one))
                    begin = series.stop
                    yield one, self._part(one, arrays["slenderness"][series], computed.arrays, series)

    def _blocks(self, objects: Sequence[PreparedObject], most: int) -> Iterator[list[PreparedObject]]:
        block: list[PreparedObject] = []
        for one in objects:
            if block and sum(map(self.runs_of, block)) + self.runs_of(one) > most:
                yield block
                block = []
            block.append(one)
        if block:
            yield block

    def _tasks(self, blocks: Sequence[Sequence[PreparedObject]]) -> Iterator[Task]:
        for index, block in enumerate(blocks):
            drawn = [self._series(one) for one in block]
            values = {name: np.concatenate([one[name] for one in drawn]) for name in drawn[0]}
            yield Task(GridBlock(index, (slice(0, values["motion"].size),)), values)

    def _series(self, one: PreparedObject) -> Draws:
        """Return the numbers of each record and sample of an object, with the record `motion` and the `duration`."""
        samples = self.samples_of(one)
        drawn = one.draws(len(self.records) * samples, self.seed)
        ends = np.repeat([motion.duration for motion in self.records.values()], samples)
        tails = FREE_TAIL / drawn.pop("frequency_parameter")
        if self.tail is not None:
            tails = np.full(tails.size, tail_of(one.model.column, self.tail))
        return {**drawn, "motion": np.repeat(np.arange(len(self.records)), samples), "duration": ends + tails}

    def _part(self, one: PreparedObject, slenderness: Any, arrays: Arrays, series: slice) -> xr.Dataset:
        shape = (len(self.records), self.samples_of(one), len(self.scales))
        runs = slice(series.start * len(self.scales), series.stop * len(self.scales))
        return xr.Dataset(
            {
                **{name: (_RUN_DIMS, arrays[name][runs].reshape(shape)) for name in KEPT},
                "slenderness": (_RUN_DIMS[:2], np.reshape(slenderness, shape[:2])),
            }
        )


@dataclass(frozen=True, slots=True)
class _Work:
    """Function that computes a block; it can be pickled."""

    model: Model
    motion: BaseMotion
    scales: tuple[float, ...]
    options: Accuracy

    def __call__(self, task: Task, *, threads: int | None, progress: Report | None) -> Computed:
        """Return the kept results of the runs, flat: the scale varies fastest.

        Raises
        ------
        Interrupted
            On Ctrl-C; nothing of the block is kept.
        """
        count = len(self.scales)
        values = {name: np.repeat(array, count) for name, array in task.values.items() if name != "slenderness"}
        duration = values.pop("duration")
        values["scale"] = np.tile(self.scales, task.values["motion"].size)
        every: Callable[[int, int], None] | bool = False if progress is None else progress
        with unquestioned():
            found = simulate_ensemble(
                self.model,
                self.motion,
                duration=duration,
                parameters=values,
                threads=threads,
                progress=every,
                demands=True,
                **self.options,
            )
        return Computed({name: found[name].to_numpy() for name in KEPT})
