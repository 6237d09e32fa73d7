"""What the contact must bear, at small tilt: normal force, friction, and the moment about the vertical."""

import numpy as np
import numpy.typing as npt

from stylobate.models.model import Floats, Model, Output


def contact_outputs(
    model: Model,
    states: Floats,
    accelerations: Floats,
    resting: npt.NDArray[np.bool_],
    spin_moment: Floats | None = None,
) -> dict[str, Output]:
    """Return the normal force [N], the friction that is needed over it, and the moment about the vertical.

    Parameters
    ----------
    model
        A model of small tilts whose rates of states 2 and 3 are the accelerations of the tilt vector.
    states, accelerations, resting
        As for `Model.outputs`.
    spin_moment
        Moment about the vertical over m g r, shape (n,), where a model knows it. None for a column that cannot turn:
        then it is what holds the column against the friction force at the rim.

    Notes
    -----
    To leading order in c: N = m(g + a_z), T = m g (a_h + κ α̈), α̈ in units of ω0²; of a column that cannot turn
    M_z = −r T·n. Negative N means that the column would lift off; the ratios are NaN there.
    """
    column = model.column
    moving = np.array(
        [
            model.rates(*state, *push, *model.parameters)[2:4]
            for state, push in zip(states.T, accelerations.T, strict=True)
        ]
    ).T
    horizontal, weight = accelerations[:2], 1.0 + accelerations[2]
    force = horizontal + np.where(resting, 0.0, column.inertia_ratio * moving)
    with np.errstate(invalid="ignore", divide="ignore"):
        per_weight = np.where(weight > 0.0, 1.0 / weight, np.nan)
        if spin_moment is None:
            x, y = model.tilt(states)
            across = (x * force[1] - y * force[0]) / np.hypot(x, y)
            spin_moment = -across
        moment = np.where(resting, 0.0, spin_moment)
    return {
        "normal_force": Output(column.mass * column.gravity * weight, "N", "normal force at the contact"),
        "friction_demand": Output(np.hypot(*force) * per_weight, "1", "friction force over normal force"),
        "pivoting_demand": Output(
            np.abs(moment) * per_weight, "1", "moment about the vertical over normal force and radius"
        ),
    }
