"""Tasks of worker processes by name."""

import math
from collections import Counter
from collections.abc import Callable, Mapping
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Any, NamedTuple

from stylobate import config, engine
from stylobate.config.simulation import Setup
from stylobate.lab.messages import Emit, Progress
from stylobate.lab.requests import GRIDS, Archive, Description
from stylobate.lab.runs import answered_run, record_contents, remarks
from stylobate.records.events import find_events
from stylobate.records.reading import FileReading, read_parts

_USUAL_LENGTH = 12.0
"""Usual duration of an animation [s]; longer if the base oscillates too fast to be visible."""
_PICTURES_PER_SECOND, _PICTURES_PER_PERIOD, _MOST_PICTURES = 25.0, 12.0, 1400


class SampleNumbers(NamedTuple):
    """Numbers of samples of a run: in each period of the base motion, at least, and at most."""

    per_period: int
    fewest: int
    most: int


SAMPLES = SampleNumbers(48, 601, 2000)


def run(given: Description, emit: Emit) -> bytes:
    """Compute one run with its histories and motion, as JSON, so that the server need not encode it."""
    del emit
    with remarks(given.values) as remarked:
        setup = config.SimulationConfig.parse(given.values).build()
    found = engine.simulate(setup.model, setup.motion, **{**setup.options, "samples": _enough(setup)})
    return answered_run(found, setup.model, given, remarked, frequency=_frequency(setup)).as_json()


def _frequency(setup: Setup) -> float:
    """Return the highest angular frequency of base and column [rad/s]."""
    return max(setup.motion.highest_frequency, setup.model.column.frequency_scale)


def _enough(setup: Setup) -> int:
    """Return the number of samples for a smooth plot of a run; the page cannot show more."""
    stated: int | None = setup.options["samples"]
    if stated is not None:
        return stated
    if setup.options["duration"] is None:
        return SAMPLES.most
    swings = setup.options["duration"] * _frequency(setup) / (2.0 * math.pi)
    return int(min(max(SAMPLES.per_period * swings, SAMPLES.fewest), SAMPLES.most))


def record(values: Mapping[str, Any], emit: Emit) -> dict[str, Any]:
    """Read a record; return its contents, and the warnings about its files."""
    del emit
    with remarks(values) as remarked:
        found = record_contents(config.RecordMotion.parse(values).build())
    return {**found, "warnings": remarked}


def archive(values: Mapping[str, Any], emit: Emit) -> Archive:
    """List the records in an archive; those of equal names have the path of their first file."""
    del emit
    path, how = Path(values["path"]), FileReading.of(values.get("step"), None, None, None)
    with remarks(values) as remarked:
        events = find_events(path, lambda one: read_parts(one, how))
    count = Counter(event.name for event in events)
    names = (event.name if count[event.name] == 1 else event.paths[0].relative_to(path).as_posix() for event in events)
    return Archive({name: event.paths for name, event in zip(names, events, strict=True)}, tuple(remarked))


def animation(values: Mapping[str, Any], emit: Emit) -> bytes:
    """Animate a run as a GIF; long runs are shown faster."""
    from stylobate.plots.animation.animation import animate

    setup = config.SimulationConfig.parse(values).build()
    run = engine.simulate(setup.model, setup.motion, **setup.options)
    return animate(run, speed=speed_of_pictures(setup, float(run.data["time"][-1]))).gif(
        progress=lambda done, total: emit(Progress(done, total))
    )


def speed_of_pictures(setup: Setup, end: float) -> float:
    """Return the speed of the animation of a run: about twelve seconds, but with each period of the base visible."""
    frequency = setup.motion.highest_frequency / (2.0 * math.pi)
    swings = setup.motion.period is not None and frequency > 0.0
    seen = _PICTURES_PER_SECOND / (_PICTURES_PER_PERIOD * frequency) if swings else math.inf
    return max(min(max(1.0, end / _USUAL_LENGTH), seen), _PICTURES_PER_SECOND * end / _MOST_PICTURES)


def warm_up() -> None:
    """Import and compile the code that every run needs."""
    values = {"column": {"shape": "dimensionless", "slenderness": 0.1}, "tilt": [0.02, 0.0], "duration": 1.0}
    run(Description(values, values), lambda _: None)


_TASKS = {
    "run": "tasks:run",
    "record": "tasks:record",
    "archive": "tasks:archive",
    "start": "curves:start",
    "exact": "curves:exact_curves",
    "animation": "tasks:animation",
    "variations": "variations:variations",
}
"""Module and function of each task besides grids, imported by the processes that need it."""


def task(kind: str) -> Callable[[Any, Emit], Any]:
    """Return the task of this `kind`, which takes plain values and sends messages during the computation."""
    if kind in GRIDS:
        from stylobate.lab.grids import grid

        return partial(grid, GRIDS[kind])
    module, _, name = _TASKS[kind].partition(":")
    found: Callable[[Any, Emit], Any] = getattr(import_module(f"stylobate.lab.{module}"), name)
    return found
