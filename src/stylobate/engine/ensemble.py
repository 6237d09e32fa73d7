"""Integration of many runs: simulate_ensemble."""

import json
import os
from collections.abc import Callable, Mapping
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import asdict, replace
from functools import cache
from typing import Any, Unpack

import numpy as np
import numpy.typing as npt
import pandas as pd
import xarray as xr

from stylobate.base_motions import BASE_AT_REST, BaseMotion
from stylobate.base_motions.combined import members_of
from stylobate.column import Column
from stylobate.engine.cost import LOG, announce, expected_steps
from stylobate.engine.ensembles.batch import Batch, Plan
from stylobate.engine.ensembles.results import fallen, write_results
from stylobate.engine.ensembles.run_columns import MotionPlan, terms_of
from stylobate.engine.ensembles.runs import (
    AXIS,
    COMPONENT,
    QUANTITIES,
    ArrayLike,
    Arrays,
    EnsembleRuns,
    broadcast,
    empty,
)
from stylobate.engine.forcing import check_motion
from stylobate.engine.parameters import changed_model, check_names, in_declared_units, own_numbers, split
from stylobate.engine.starts import Turning, refuse_friction, require_nouns
from stylobate.engine.verdict import duration_of_runs
from stylobate.errors import (
    MOST_THREADS,
    Interrupted,
    Outcome,
    ParameterError,
    UnsupportedError,
    as_numbers,
    require_whole,
)
from stylobate.models import Model
from stylobate.models.consistency.check import check_once
from stylobate.models.finite_tilt import FiniteTiltModel
from stylobate.processes import end_all
from stylobate.progress import Progress, Report, beat, report_of, shows_progress, silent
from stylobate.provenance import provenance_of_run
from stylobate.quantities import Parameter, parameters_of
from stylobate.results import OutcomeRules
from stylobate.results.known_orbits import as_orbits
from stylobate.results.outcomes import NOT_COMPUTED
from stylobate.run_arguments import (
    EnsembleOptions,
    FreeStart,
    InitialConditions,
    OfEnsemble,
    SingleRun,
    arguments_of,
    checked_options,
    defaults_of,
    numbers_of,
    takes,
)


@shows_progress("runs")
@takes(OfEnsemble)
def simulate_ensemble(
    model: Model,
    motion: BaseMotion | None = None,
    *,
    tilt: ArrayLike = (0.0, 0.0),
    tilt_rate: ArrayLike = (0.0, 0.0),
    spin: ArrayLike = 0.0,
    twist: ArrayLike = 0.0,
    position: ArrayLike = (0.0, 0.0),
    velocity: ArrayLike = (0.0, 0.0, 0.0),
    clearance: ArrayLike = 0.0,
    duration: "ArrayLike | None" = None,
    friction_coefficient: "ArrayLike | None" = None,
    parameters: Mapping[str, ArrayLike] | None = None,
    threads: int | None = None,
    progress: Progress = None,
    **run: Unpack[OfEnsemble],
) -> xr.Dataset:
    """Integrate many columns, each from its initial state until its outcome is decided.

    The runs have the events, outcomes and tolerances of `simulate`; many runs advance together in compiled code. A
    kernel is compiled at the first use of a model with a kind of base motion, and kept in the user's cache folder
    ($STYLOBATE_CACHE names another one). The result of a run does not depend on the other runs.

    Parameters
    ----------
    model
        Model of the column.
    motion
        Base motion; None for a base at rest.
    tilt, tilt_rate
        Initial tilt vectors [rad] and their rates [rad/s]: shape (2,) for all runs, (n, 2) with the dimension `run`, or
        a DataArray with a dimension "axis" and any others.
    spin
        Initial angular velocity about the axis [rad/s], for models that have it; shapes as for `duration`.
    twist, position, velocity, clearance
        The other initial conditions of `simulate`: angle of rotation about the axis [rad], centre of the footprint [m],
        velocity of the lowest point [m/s] and its height above the plane [m]. Shapes as for `spin`; those of `position`
        as for `tilt`; (3,) or (n, 3) for `velocity`, or a DataArray with a dimension "component". Of models whose
        contact neither slips nor opens, twist and position change no result of an ensemble.
    duration
        Duration of the runs [s]: a number, shape (n,), or a DataArray. If all base motions end, such as records or
        pulses, the default is that of the longest one and a free-vibration tail of 20/p, where p is
        `model.column.frequency_parameter`.
    friction_coefficient
        Friction coefficient of the contact, shapes as for `duration`: the result says which runs need more friction.
        Models that can slip have a number of their own.
    parameters
        Numbers of column, model and motion that differ between the runs, by name; shapes as for `duration`. The names
        are those of `with_parameters`. All arrays are broadcast together by the names of their dimensions.
    **run
    threads
        Number of threads; all cores by default.
    progress
        A function that is called from time to time as `progress(finished runs, all runs)`, or False. By default a bar
        appears after two seconds if stderr is a terminal, or in a notebook.

    Returns
    -------
    xarray.Dataset
        Over the dimensions of the arguments: `outcome` (codes, see its `flag_meanings`), the time of its decision, the
        end state, peak and minimum tilt, turns of the contact point; over the last periods mean tilt, phase of the tilt
        vector relative to the base acceleration, mean rolling rate and repetition. Values that a run does not have are
        NaN.

        * With `strobes`: `strobe_tilt` and `strobe_tilt_rate`, in the order of time.
        * With `samples`: `sample_time`, `sampled_tilt` and `sampled_tilt_rate`. They and the stroboscopic samples are
          NaN before the start and after the end of a run.
        * Models with a spin: `end_spin`.
        * With `friction_coefficient`: `would_slip`, and the results of `demands`.
        * With `demands`: `peak_friction_demand`, `peak_pivoting_demand` and `minimum_normal_force` (over the
          weight), interpolated within each step by parabolas through its quarter points. While the column stands, the
          friction demand is |a_h|/(g + a_z).
        * Models that change between kinds of contact: `end_contact`, `end_footprint`, `end_twist`, the duration of each
          kind (`time_slipping` and so on), and the numbers of `impacts` and `slips`.

    Raises
    ------
    ParameterError
        If an argument is out of range, two arguments have different lengths along a dimension, or two parameters
        contradict each other: slenderness changes the radius, size the lengths. If `duration` is missing and the base
        is at rest or its motion does not end.
    UnsupportedError
        If the model cannot be compiled, or the motion lacks a number that is varied.
    Interrupted
        After Ctrl-C; its `partial` is the Dataset of the finished runs.

    Examples
    --------
    >>> import stylobate as sb
    >>> model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    >>> motion = sb.Harmonic.circular(acceleration=0.15, angular_frequency=0.5)
    >>> runs = sb.simulate_ensemble(model, motion, duration=50.0, parameters={"acceleration": [0.05, 0.15]})
    >>> [sb.Outcome(code).name for code in runs["outcome"].values]
    ['AT_REST', 'OVERTURNED']
    """
    require_nouns(model, motion)
    moved = BASE_AT_REST if motion is None else motion
    changes = _named(parameters)
    check_names(model, moved, changes)
    own = own_numbers(model, moved)
    changes = in_declared_units(changes, own)
    tilt, tilt_rate = as_numbers("tilt", tilt, "rad"), as_numbers("tilt_rate", tilt_rate, "rad/s")
    spin = as_numbers("spin", spin, "rad/s")
    if duration is None:
        duration = duration_of_runs(model, moved, _ends(changes))
    duration = as_numbers("duration", duration, "s")
    refuse_friction(model, friction_coefficient)
    orbits = as_orbits(run["known_orbits"])
    options = _options(model, run, with_orbits=bool(orbits), with_friction=friction_coefficient is not None)
    free = _given(
        twist=twist,
        position=position,
        velocity=velocity,
        clearance=clearance,
        friction_coefficient=friction_coefficient,
    )
    threads = usual_threads() if threads is None else require_whole("threads", threads, least=1, most=MOST_THREADS)
    runs = broadcast(tilt, tilt_rate, spin, duration, changes, orbits, free)
    friction = runs.free.get("friction_coefficient")
    if friction is not None and len(runs):
        arguments_of(SingleRun)["friction_coefficient"].checked(float(friction.min()))
    runs = replace(runs, turning=_turnings(model, runs))
    if len(runs):
        frequency = moved.highest_frequency * model.time_scale
        longest = float(runs.duration.max()) / model.time_scale
        announce(expected_steps(model, frequency, longest), options["max_steps"])
    _check_own_model(model, runs)
    arrays = empty(model, options, len(runs), slips=friction is not None)
    # The coordinates hold the arguments that differ between the runs.
    arguments = {"tilt": tilt, "tilt_rate": tilt_rate, "spin": spin, **free, "duration": duration, **changes}
    same = {name: np.asarray(value).tolist() for name, value in arguments.items() if name not in runs.coordinates}
    if terms_of(moved) is None and len(runs):
        for member in members_of(moved):
            check_motion(member, float(runs.duration.max()))
    plan = Plan(model, MotionPlan.of(moved, split(model, runs.values)[1], runs.duration), options, orbits=len(orbits))

    def result() -> xr.Dataset:
        if friction is not None:
            arrays["would_slip"][:] = arrays["peak_friction_demand"] > friction
        return _dataset(runs, arrays, _provenance(model, moved, options, same), {**parameters_of(Column), **own})

    if _followed(plan, runs, arrays, threads, report_of(progress)) and _rechecked(plan, runs, arrays, threads):
        return result()
    raise Interrupted("interrupted; `partial` has the finished runs", result())


def _named(parameters: Mapping[str, ArrayLike] | None) -> dict[str, ArrayLike]:
    if parameters is not None and not isinstance(parameters, Mapping):
        raise ParameterError(f'parameters must name what differs, such as {{"acceleration": […]}}, got {parameters!r}')
    return dict(parameters or {})


def _ends(parameters: Mapping[str, ArrayLike]) -> dict[str, tuple[float, float]]:
    """Return the smallest and largest value of each parameter; those without numbers are refused later."""
    arrays = {name: np.asarray(values, dtype=float) for name, values in parameters.items()}
    return {name: (float(array.min()), float(array.max())) for name, array in arrays.items() if array.size}


def _options(model: Model, run: Mapping[str, Any], *, with_orbits: bool, with_friction: bool) -> EnsembleOptions:
    """Check the options that the runs share; runs with a friction coefficient need the contact demand.

    Raises
    ------
    UnsupportedError
        If the model does not support an option.
    """
    options = checked_options(run)
    if with_friction:
        options = {**options, "demands": True}
    if options["demands"] and model.contact is None:
        asked = "friction_coefficient" if with_friction else "demands"
        raise UnsupportedError(
            f"model {model.name} has no forces of its contact. Give it `contact`, or leave out {asked}."
        )
    if model.switches and (options["demands"] or with_orbits or options["method"] != "dop853"):
        other = "known_orbits" if with_orbits else f"method {options['method']!r}"
        asked = "demands" if options["demands"] else other
        raise UnsupportedError(f"model {model.name} changes between kinds of contact: leave out {asked}")
    if options["method"] == "taylor" and isinstance(model, FiniteTiltModel):
        LOG.warning(
            "method 'taylor' takes two to eight times the time of 'dop853' for the equations of model %s: omit it",
            model.name,
        )
    return options


def _given(**free: "ArrayLike | None") -> dict[str, Any]:
    """Return the arguments that are not None or zero, in their declared units."""
    declared = numbers_of(SingleRun)
    return {
        name: as_numbers(name, value, declared[name].quantity.unit)
        for name, value in free.items()
        if value is not None and (declared[name].optional or np.any(value))
    }


def _turnings(model: Model, runs: EnsembleRuns) -> tuple[Turning, ...] | None:
    """Return the other initial conditions of each run, checked as those of a single run; None if all are zero."""
    usual = {**defaults_of(FreeStart), "spin": 0.0}
    if not runs.free.keys() & usual.keys():
        return None
    given = {**usual, **runs.free, "spin": runs.spin}
    flat = {name: np.broadcast_to(given[name], (len(runs), *np.shape(one))) for name, one in usual.items()}
    return tuple(
        Turning.checked(model, {name: values[k].tolist() for name, values in flat.items()}, standing=False)
        for k in range(len(runs))
    )


def _check_own_model(model: Model, runs: EnsembleRuns) -> None:
    """Raise ModelError if the members of a user's own model contradict each other at the parameters of some runs."""
    own, _ = split(model, runs.values)
    for index in {round(share * (len(runs) - 1)) for share in (0.0, 0.25, 0.5, 0.75, 1.0)} if own and len(runs) else ():
        check_once(changed_model(model, {name: float(values[index]) for name, values in own.items()}))


def _followed(plan: Plan, runs: EnsembleRuns, arrays: Arrays, threads: int, progress: Report) -> bool:
    """Fill `arrays`; return False after Ctrl-C."""
    done = 0

    def compute(part: slice, halt: Halt) -> None:
        batch = Batch.of(plan, runs.part(part))
        batch.advance(halt)
        write_results({name: values[part] for name, values in arrays.items()}, batch)

    def count(part: slice) -> None:
        nonlocal done
        done += part.stop - part.start
        progress(done, len(runs))

    return run_parts(parts_of(len(runs), threads), compute, threads, count)


def _rechecked(plan: Plan, runs: EnsembleRuns, arrays: Arrays, threads: int) -> bool:
    """Repeat the runs in doubt and mark those whose outcome changes; return False after Ctrl-C."""
    if not plan.options["recheck"]:
        return True
    places = np.flatnonzero(arrays["in_doubt"])
    if not places.size:
        return True
    again = plan.repeated()
    other = empty(plan.model, again.options, places.size)
    finished = _followed(again, runs.part(places), other, threads, silent)
    changed = fallen(other["outcome"]) != fallen(arrays["outcome"][places])
    changed |= other["outcome"] == Outcome.FAILED
    arrays["uncertain"][places] |= changed & (other["outcome"] != NOT_COMPUTED)
    return finished


Halt = npt.NDArray[np.uint8]


def run_parts(
    parts: list[slice],
    compute: Callable[[slice, Halt], None],
    threads: int,
    done: Callable[[slice], None],
) -> bool:
    """Call `compute` for each part, and `done` in this thread as each is finished; return False after Ctrl-C.

    The second argument of `compute` is a flag that is set when it should stop. An exception of `compute` is raised here
    after all parts have stopped.
    """
    halt = np.zeros(1, dtype=np.uint8)
    waiting = iter(parts)
    with ThreadPoolExecutor(max_workers=threads, thread_name_prefix="stylobate") as pool:
        running: dict[Future[None], slice] = {}

        def start() -> None:
            part = next(waiting, None)
            if part is not None:
                running[pool.submit(compute, part, halt)] = part

        try:
            for _ in range(threads):
                start()
            while running:
                # The timeout lets Python react to Ctrl-C, which it can only do between its own steps.
                finished, _ = wait(running, timeout=0.1, return_when=FIRST_COMPLETED)
                beat()
                for future in finished:
                    part = running.pop(future)
                    future.result()
                    start()
                    done(part)
        except KeyboardInterrupt:
            halt[0] = 1
            while running and wait(running, timeout=0.1).not_done:
                end_all()  # a thread may wait for a compiler, and the next one may start another
            return False
        except BaseException:
            halt[0] = 1
            raise
    return True


# Size of parts: small enough that every thread has one, all threads end together and progress is visible; large enough
# to fill the lanes and to keep the overhead of Python small.
_FEWEST, _ENOUGH, _MOST, _PARTS_PER_THREAD = 32, 512, 4096, 4


def parts_of(count: int, threads: int) -> list[slice]:
    """Return the slices of the parts of `count` runs."""
    share = -(-count // threads)
    size = min(max(_FEWEST, min(share, _ENOUGH), -(-share // _PARTS_PER_THREAD)), _MOST)
    return [slice(start, min(start + size, count)) for start in range(0, count, size)]


def usual_threads() -> int:
    """Return the number of threads that this process may run at a time."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _provenance(model: Model, motion: BaseMotion, options: EnsembleOptions, same: Mapping[str, Any]) -> dict[str, Any]:
    names = (*InitialConditions.__annotations__, *FreeStart.__annotations__, "duration", "friction_coefficient")
    starts = {name: same[name] for name in names if name in same}
    parameters = {name: value for name, value in same.items() if name not in starts}
    kept = {**options, "rules": asdict(options["rules"] or OutcomeRules()), **starts, "parameters": parameters}
    return provenance_of_run(model, motion, **kept)


@cache
def _index(dim: str, *labels: str) -> xr.DataArray:
    index = xr.indexes.PandasIndex(pd.Index(np.array(labels)), dim, coord_dtype=np.dtype("<U1"))
    return xr.Coordinates.from_xindex(index)[dim]


def _dataset(
    runs: EnsembleRuns,
    arrays: Mapping[str, npt.NDArray[Any]],
    provenance: Mapping[str, Any],
    declared: Mapping[str, Parameter],
) -> xr.Dataset:
    variables = {
        name: xr.Variable(
            (*runs.dims, *QUANTITIES[name].dims),
            values.reshape(*runs.shape, *values.shape[1:]),
            dict(QUANTITIES[name].attributes),
            fastpath=True,
        )
        for name, values in arrays.items()
    }
    coordinates: dict[str, Any] = {AXIS: _index(AXIS, "x", "y")}
    if any(COMPONENT in array.dims for array in runs.coordinates.values()):
        coordinates[COMPONENT] = _index(COMPONENT, "x", "y", "z")
    for name, array in runs.coordinates.items():
        for label, index in array.coords.items():
            coordinates.setdefault(label, index)
        # An array along a dimension of its own name is the index, which exists already.
        if name not in coordinates:
            coordinates[name] = array.variable
    data = xr.Dataset(
        variables, coords=coordinates, attrs={"kind": "ensemble", "provenance": json.dumps(dict(provenance))}
    )
    for name in runs.coordinates:
        known = declared.get(name.removeprefix("motion."))
        if known is not None and not data.variables[name].attrs:
            data.variables[name].attrs = {"long_name": known.quantity.text, "units": known.quantity.cf_units}
    return data
