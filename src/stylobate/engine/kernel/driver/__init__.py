"""Driver of a kernel: fills the lanes with runs, handles events of single lanes, and removes runs at their end.

The functions take the buffer and a lane, and if necessary the table of the batch and the polynomials of the base
motion. They are ordinary functions. Equations, row indices (`R.TIME`) and options come from `bound`, which each kernel
binds to a model and a kind of base motion.
"""

from types import ModuleType

from stylobate.engine.kernel.driver import (
    base_motion,
    batch,
    contact_changes,
    contact_ends,
    contact_events,
    contact_implicit,
    contact_steps,
    contact_stiffness,
    convergence,
    demands,
    equations,
    events,
    guards,
    implicit_step,
    lift_off,
    looks,
    moving,
    observation,
    passages,
    peaks,
    push,
    release,
    release_search,
    resting,
    series,
    stages,
    standing_loads,
    starting,
    step,
    step_control,
    stops,
    tracing,
    within,
)

_COMMON = (
    *(push, equations, stages, series, guards, step_control, demands, observation, step),
    *(base_motion, moving, within, tracing, looks, stops, release, release_search, standing_loads, peaks, convergence),
    batch,
)
_SMOOTH = (resting, lift_off, passages, events, starting)
_SWITCHING = (
    *(contact_ends, contact_changes, contact_stiffness, contact_steps),
    *(implicit_step, contact_implicit, contact_events),
)


def modules(*, switching: bool) -> tuple[ModuleType, ...]:
    """Return the modules of the driver for models with (`switching`) or without changes between kinds of contact."""
    return _COMMON + (_SWITCHING if switching else _SMOOTH)
