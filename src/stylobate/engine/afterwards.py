"""Choose the duration of a run, and decide whether a column that moves at its end could overturn later."""

import math

import numpy as np

from stylobate.base_motions import BaseMotion
from stylobate.config.simulation import duration_with_tail
from stylobate.engine.forcing import Floats
from stylobate.engine.trajectory import Trajectory
from stylobate.errors import ParameterError, require_positive
from stylobate.models import Model
from stylobate.models.inheritance import belongs_to_equations


def duration_of(duration: float | None, model: Model, motion: BaseMotion) -> float:
    """Return how long a run lasts [s]: for the `duration`, or to a free tail of 20/p after a motion that ends.

    Raises
    ------
    ParameterError
        If it is not positive; or if there is none, and the base stays at rest or never does.
    """
    if duration is not None:
        return require_positive("duration", duration, "s")
    if not 0.0 < motion.duration < math.inf:
        what = "a base at rest" if motion.duration == 0.0 else "a base motion that never ends"
        message = f"duration must be given, in s, with {what}, such as duration=60.0; got None"
        raise ParameterError(message)
    return duration_with_tail(model, motion)


def survivor_reason(model: Model, motion: BaseMotion, trajectory: Trajectory) -> str:
    """Return the reason of a column that moves at the end of its run: whether it could overturn later.

    After a base motion the energy of a column can only fall. With less energy than at its balance, on this side of it,
    it cannot overturn any more. A model without a `balance` of its own makes no such claim.
    """
    end = trajectory.end * model.time_scale
    if end < motion.duration:
        return f"{_MOVED}, {motion.duration - end:.4g} s before the base motion stops; {_OPEN}"
    after = end - motion.duration
    followed = motion.duration > 0.0 and after > 0.0
    moved = f"{_MOVED}, {after:.4g} s after the base motion stopped" if followed else _MOVED
    share = _share_of_the_balance(model, trajectory.states(np.array([trajectory.end])))
    if share < 1.0:
        return f"{moved}, but cannot overturn any more: it has {100.0 * share:.2g} % of the energy that takes"
    return f"{moved}; {_OPEN}"


_MOVED = "it moved to the end of the run"
_OPEN = "it may yet overturn: follow it longer"


def _share_of_the_balance(model: Model, state: Floats) -> float:
    """Return the energy over that at the balance; infinite beyond the balance, and without a claim of the model."""
    balance, energy = model.balance, model.energy(state)
    if balance is None or energy is None or not belongs_to_equations(type(model), "balance", "energy"):
        return math.inf
    tilt = float(np.hypot(*model.tilt(state)[:, 0]))
    return float(energy[0]) / balance.energy if tilt < balance.tilt else math.inf
