"""What the processes of the laboratory can compute, by name. Each takes plain values and returns plain values."""

import json
import math
from collections.abc import Callable, Mapping
from typing import Any

from stylobate import config, engine
from stylobate.lab.messages import Emit, Progress
from stylobate.lab.remarks import remarks
from stylobate.lab.request_parsing import Described
from stylobate.lab.responses import plain_record, plain_run, snippets

_USUAL_LENGTH = 12.0
"""How long a moving picture lasts [s], unless its base swings so fast that it must be slower."""
_PICTURES_PER_SECOND, _PICTURES_PER_PERIOD, _MOST_PICTURES = 25.0, 12.0, 1400

_SAMPLES_PER_PERIOD, _FEWEST_SAMPLES, _MOST_SAMPLES = 48, 601, 2000

# Imports inside tasks are heavy, and few of the processes do such tasks.


def run(given: Described, emit: Emit) -> bytes:
    """Return one run with all that is drawn of it, as JSON: so much is written where nobody else waits for it."""
    del emit
    with remarks(given.values) as remarked:
        setup = config.SimulationConfig.parse(given.values).build()
    samples = setup.options["samples"] or _enough(setup)
    found = engine.simulate(setup.model, setup.motion, **{**setup.options, "samples": samples})
    answer = {**plain_run(found, setup.model), **snippets(given)}
    answer["warnings"] = [*remarked, *answer["warnings"]]
    return json.dumps(answer, separators=(",", ":")).encode()


def _enough(setup: config.Setup) -> int:
    """Return how many samples draw a run smoothly: a page shows no more, and waits for each."""
    frequency = max(setup.motion.highest_frequency, setup.model.column.frequency_scale)
    swings = setup.options["duration"] * frequency / (2.0 * math.pi)
    return int(min(max(_SAMPLES_PER_PERIOD * swings, _FEWEST_SAMPLES), _MOST_SAMPLES))


def record(values: Mapping[str, Any], emit: Emit) -> dict[str, Any]:
    """Return what a record holds, and the warnings that were issued while its files were read."""
    del emit
    with remarks(values) as remarked:
        found = plain_record(config.RecordMotion.parse(values).build())
    return {**found, "warnings": remarked}


def start(values: Mapping[str, Any], emit: Emit) -> dict[str, Any]:
    """Compute the start on a branch of steady rolling."""
    from stylobate.lab.starts import start as start_on_branch  # noqa: PLC0415

    del emit
    return start_on_branch(values)


def exact(values: Mapping[str, Any], emit: Emit) -> dict[str, Any]:
    """Return exact periodic orbits over a range of frequencies, with their bifurcations."""
    from stylobate.lab.curves import exact_curves  # noqa: PLC0415

    return exact_curves(values, emit)


def overturning(values: Mapping[str, Any], emit: Emit) -> dict[str, Any]:
    """Compute the map over two quantities."""
    from stylobate.lab.grids import overturning_plane  # noqa: PLC0415

    return overturning_plane(values, emit)


def basin(values: Mapping[str, Any], emit: Emit) -> dict[str, Any]:
    """Return where starts lead."""
    from stylobate.lab.grids import basin_plane  # noqa: PLC0415

    return basin_plane(values, emit)


def animation(values: Mapping[str, Any], emit: Emit) -> bytes:
    """Return a run as a moving picture (GIF), long ones faster than they are."""
    from stylobate.plots.animation import animate  # noqa: PLC0415

    setup = config.SimulationConfig.parse(values).build()
    run = engine.simulate(setup.model, setup.motion, **setup.options)
    return animate(run, speed=speed_of_pictures(setup, float(run.data["time"][-1]))).gif(
        lambda done, total: emit(Progress(done, total))
    )


def speed_of_pictures(setup: config.Setup, end: float) -> float:
    """Return how fast a run is shown: in about twelve seconds, but so slowly that each swing of the base is seen."""
    frequency = setup.motion.highest_frequency / (2.0 * math.pi)
    swings = setup.motion.period is not None and frequency > 0.0
    seen = _PICTURES_PER_SECOND / (_PICTURES_PER_PERIOD * frequency) if swings else math.inf
    return max(min(max(1.0, end / _USUAL_LENGTH), seen), _PICTURES_PER_SECOND * end / _MOST_PICTURES)


def warm_up() -> None:
    """Import and compile what every run needs."""
    values = {"column": {"shape": "dimensionless", "slenderness": 0.1}, "tilt": [0.02, 0.0], "duration": 1.0}
    run(Described(values, values), lambda _: None)


TASKS: Mapping[str, Callable[[Any, Emit], Any]] = {
    "run": run,
    "record": record,
    "start": start,
    "exact": exact,
    "map": overturning,
    "basin": basin,
    "animation": animation,
}
