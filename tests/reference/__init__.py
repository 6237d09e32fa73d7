"""An integration that shares neither steps nor event search with the kernels: SciPy's DOP853, Radau and `brentq`.

It is what tests compare single runs and ensembles with.
"""

from collections.abc import Sequence

from stylobate.base_motions import BaseMotion
from stylobate.engine.trajectory import EventRecorder
from stylobate.models import Model

from .course import Course
from .following import method_of
from .forcing import Forcing
from .moving import Mover
from .switching_course import SwitchingCourse
from .thresholds import thresholds_of
from .watch import Watch


def integrated(
    model: Model,
    motion: BaseMotion,
    *,
    tilt: Sequence[float],
    tilt_rate: Sequence[float] = (0.0, 0.0),
    spin: float = 0.0,
    duration: float,
    rtol: float = 1e-8,
    max_steps: int = 200_000,
    tilt_limit: float | None = None,
    rest_energy: float | None = None,
) -> Course:
    """Return a run from a start to its end; arguments as for `simulate`."""
    state = list(model.start(tuple(tilt), tuple(tilt_rate)))
    if model.spin_state is not None:
        state[model.spin_state] = spin * model.time_scale
    forcing = Forcing.of(model, motion)
    end = duration / model.time_scale
    method = method_of(model, motion, rtol, max_steps, end)
    watch = Watch(model, forcing, thresholds_of(model, forcing, tilt_limit, rest_energy))
    course = Course(model, forcing, Mover(model, forcing, watch, method, EventRecorder((), model, forcing, [])), end)
    course.follow((*state, *(0.0 for _ in model.carried_names)))
    return course


def switched(
    model: Model,
    motion: BaseMotion,
    *,
    tilt: Sequence[float],
    tilt_rate: Sequence[float] = (0.0, 0.0),
    spin: float = 0.0,
    twist: float = 0.0,
    position: Sequence[float] = (0.0, 0.0),
    velocity: Sequence[float] = (0.0, 0.0, 0.0),
    clearance: float = 0.0,
    duration: float,
    rtol: float = 1e-8,
    max_steps: int = 200_000,
    tilt_limit: float | None = None,
    rest_energy: float | None = None,
) -> SwitchingCourse:
    """Return a run of a model that changes between kinds of contact; arguments as for `simulate`."""
    forcing, end = Forcing.of(model, motion), duration / model.time_scale
    method = method_of(model, motion, rtol, max_steps, end)
    thresholds = thresholds_of(model, forcing, tilt_limit, rest_energy)
    course = SwitchingCourse(model, forcing, method, thresholds, end)
    state = model.begun(
        tuple(tilt),
        tuple(tilt_rate),
        spin=spin,
        twist=twist,
        position=tuple(position),
        velocity=tuple(velocity),
        clearance=clearance,
    )
    course.follow(state)
    return course
