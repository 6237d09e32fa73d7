"""Runs that lanes give up because they are stiff: each is followed by itself, as `simulate` follows it.

A patch that creeps follows its load almost at once. Lanes step by an explicit method, whose steps stability then cuts
to as little; single runs change to an implicit method there.
"""

import math

import numpy as np
import numpy.typing as npt

from stylobate.engine.ensembles.batch import Batch
from stylobate.engine.ensembles.broadcasting import Runs
from stylobate.engine.ensembles.noting import note
from stylobate.engine.ensembles.pool import Halt
from stylobate.engine.forcing import Forcing
from stylobate.engine.parameters import changed_model, changed_motion, split
from stylobate.engine.single import method_of
from stylobate.engine.starts import Turning
from stylobate.engine.switching.course import SwitchingCourse
from stylobate.engine.thresholds import Thresholds, is_rest
from stylobate.engine.watch import Reason


def follow_alone(batch: Batch, runs: Runs, halt: Halt) -> None:
    """Follow all `runs` of a fresh `batch`, and put into its table what a kernel would have; stop where `halt` is set.

    A run in which it was stopped is left waiting.
    """
    for number in range(len(runs)):
        if halt[0]:
            return
        course = _course(batch, runs.part(np.array([number])), float(batch.rest_energy[number]), halt)
        if course.ended is not Reason.HALTED:
            note(batch, number, course)


def _course(batch: Batch, run: Runs, rest_energy: float, halt: Halt) -> SwitchingCourse:
    """Return the course of a single run, from the start to the end."""
    options = batch.plan.options
    values = {name: float(value[0]) for name, value in run.values.items()}
    own, shaken = split(batch.plan.model, values)
    model = changed_model(batch.plan.model, own)
    motion = changed_motion(batch.plan.motion.motion, shaken)
    limit = math.inf if options.tilt_limit is None else options.tilt_limit
    course = SwitchingCourse(
        model,
        Forcing.of(model, motion),
        method_of(model, motion, options.rtol, options.atol, options.max_steps),
        Thresholds(rest_energy=rest_energy, tilt_limit=limit),
        float(run.duration[0]) / model.time_scale,
        halted=lambda: bool(halt[0]),
    )
    tilt, rate = _start(run.tilt[0], run.tilt_rate[0], model.column.slenderness, model.time_scale)
    course.follow(Turning(float(run.spin[0]), 0.0, (0.0, 0.0)).begun(model, tilt, rate))
    return course


Pair = tuple[float, float]


def _start(
    tilt: npt.NDArray[np.float64], rate: npt.NDArray[np.float64], slenderness: float, time_scale: float
) -> tuple[Pair, Pair]:
    """Return tilt and rate of a start, without the rounding of one at rest."""
    if is_rest(tilt, rate, slenderness, time_scale):
        return (0.0, 0.0), (0.0, 0.0)
    return (float(tilt[0]), float(tilt[1])), (float(rate[0]), float(rate[1]))
