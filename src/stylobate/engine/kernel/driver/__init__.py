"""The driver of a kernel: fills lanes with runs, meets the events of single lanes, takes the runs out at their end.

Functions take the buffer and a lane, and where they need them the table of the batch and the polynomials of the base
motion. They are ordinary functions; what differs between kernels they take from `bound`, which each kernel binds to a
model and a kind of base motion: equations, numbers of rows (`R.TIME`), what there is.
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
    sums,
    tracing,
    within,
)

_COMMON = (
    *(sums, push, equations, stages, series, guards, step_control, demands, observation, step),
    *(base_motion, moving, within, tracing, stops, release, release_search, standing_loads, peaks, convergence, batch),
)
_SMOOTH = (resting, lift_off, passages, events, starting)
_SWITCHING = (
    *(contact_ends, contact_changes, contact_stiffness, contact_steps),
    *(implicit_step, contact_implicit, contact_events),
)


def modules(*, switching: bool) -> tuple[ModuleType, ...]:
    """Return the modules of the driver, for models that change between kinds of contact or for others."""
    return _COMMON + (_SWITCHING if switching else _SMOOTH)
