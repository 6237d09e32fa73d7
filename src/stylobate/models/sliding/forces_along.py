"""The forces on the column at many states of a run."""

import numpy as np

from stylobate.models.model import Floats
from stylobate.models.sliding.balance import balance
from stylobate.models.sliding.phases import Numbers, State

# Number of results of `balance` for a state.
_RESULTS = 16


def forces_along(states: Floats, accelerations: Floats, n: Numbers) -> Floats:
    """Compute the `balance` of each state, shape (16, number of states).

    Parameters
    ----------
    states
        Shape (16, number of states).
    accelerations
        Accelerations of the base [g], shape (3, number of states).
    n
        The parameters.
    """
    from stylobate.compiler.over_rows import over_rows

    state = State(*states)
    rows = np.column_stack(np.broadcast_arrays(
        state.tilt_x, state.tilt_y, state.tilt_rate_x, state.tilt_rate_y, state.spin, state.velocity_x,
        state.velocity_y, state.heading_x, state.heading_y, state.heading_z, state.contact, *accelerations,
        n.c, n.eta, n.zeta, n.kappa, n.axial, n.resistance, n.kinetic, n.static, n.patch, n.slope_x, n.slope_y,
        n.relief,
    ))  # fmt: skip
    return np.ascontiguousarray(over_rows(balance, rows, name="sliding").reshape(-1, _RESULTS).T)
