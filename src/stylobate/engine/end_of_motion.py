"""Duration of a run, and survival of a column that still moves after the base motion."""

import math

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import BaseMotion
from stylobate.engine.forcing import Floats
from stylobate.engine.kernel.columns import SLACK
from stylobate.engine.trajectory import Trajectory
from stylobate.errors import Outcome, ParameterError, require_positive
from stylobate.models import Model
from stylobate.models.inheritance import belongs_to_equations
from stylobate.run_arguments import duration_with_tail


def duration_of(duration: float | None, model: Model, motion: BaseMotion) -> float:
    """Return the duration of a run [s]: `duration`, or the base motion and a free-vibration tail of 20/p.

    Raises
    ------
    ParameterError
        If the duration is not positive; or if there is none, and the base is always at rest or never comes to rest.
    """
    if duration is not None:
        return require_positive("duration", duration, "s")
    if not 0.0 < motion.duration < math.inf:
        what = "a base at rest" if motion.duration == 0.0 else "a base motion that never ends"
        message = f"duration must be given, in s, with {what}, such as duration=60.0; got None"
        raise ParameterError(message)
    return duration_with_tail(motion.duration, model.column.frequency_parameter)


def survival(model: Model, motion: BaseMotion, trajectory: Trajectory) -> tuple[Outcome, str]:
    """Return outcome and reason of a column that moves at the end of a run, after its base motion or without any.

    After the base motion the energy of a column can only fall, see `energy_over_balance`. A column that can no longer
    overturn has the outcome SURVIVED, or STILL_MOVING if there was no base motion.
    """
    end = trajectory.end * model.time_scale
    if not has_ended(end, motion.duration):
        left = motion.duration - end
        return Outcome.STILL_MOVING, f"still moving, {left:.4g} s before the base motion ends; {_OPEN}"
    after = max(0.0, end - motion.duration)
    moving = f"still moving {after:.4g} s after the base motion ended" if motion.duration > 0.0 else "still moving"
    push = remaining_acceleration(motion) / model.column.gravity
    share = float(energy_over_balance(model, trajectory.states(np.array([trajectory.end])), push)[0])
    if share >= 1.0:
        return Outcome.STILL_MOVING, f"{moving}; {_OPEN}"
    outcome = Outcome.SURVIVED if motion.duration > 0.0 else Outcome.STILL_MOVING
    return outcome, f"{moving}, but it cannot overturn any more: it has {100.0 * share:.2g} % of the energy required"


_OPEN = "it may overturn later: simulate longer"


def has_ended(time: npt.ArrayLike, duration: npt.ArrayLike) -> npt.NDArray[np.bool_]:
    """Return whether base motions of these durations have ended at these times [s]."""
    return np.asarray(np.asarray(time) * (1.0 + SLACK) >= np.asarray(duration))


def remaining_acceleration(motion: BaseMotion) -> float:
    """Return sup |a_h| after the end of a base motion [m/s²]: 0 on a level base."""
    return motion.peak_horizontal(math.nextafter(motion.duration, math.inf)) if motion.duration < math.inf else 0.0


def energy_over_balance(model: Model, states: Floats, push: npt.ArrayLike = 0.0) -> Floats:
    """Return the energy over that required to overturn, shape (n,), for `states` of shape (number of states, n).

    A column with a smaller tilt and less energy than at its balance, at the tilt α, cannot overturn on a base at rest.
    A constant horizontal acceleration, `push` in g, lowers the energy at the balance by at most push²/2 m g R, and does
    at most the work 2 push sin α m g R between the balances of both sides; the energy of the balance is 1 − cos α. The
    result is infinite beyond the balance, and for a model without its own `balance`.
    """
    balance, energy = model.balance, model.energy(states)
    if balance is None or energy is None or not belongs_to_equations(type(model), "balance", "energy"):
        return np.full(states.shape[1], math.inf)
    required = np.full(states.shape[1], balance.energy)
    if balance.tilt < math.inf:
        a, rise = np.asarray(push), 1.0 - math.cos(balance.tilt)
        required = required * (1.0 - (2.0 * a * math.sin(balance.tilt) + 0.5 * a * a) / rise)
    share = np.divide(energy, required, out=np.full(states.shape[1], math.inf), where=required > 0.0)
    return np.where(np.hypot(*model.tilt(states)) < balance.tilt, share, math.inf)
