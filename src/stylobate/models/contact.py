"""What the contact must bear along a run, and where it lies."""

import numpy as np
import numpy.typing as npt

from stylobate.models.model import Floats, Model, Output

LEAST_FORCE = 1e-8
"""The part of the weight below which a force is none.

A normal force is what weight and inertia leave over, each about as large as the weight and known to the usual tolerance
of a run, `rtol`: below it nothing is distinguished from lift-off, and a ratio to it is made of rounding.
"""


def per_normal_force(force: Floats, normal: Floats) -> Floats:
    """Return a force or moment over the normal force: infinite where there is no normal force to bear it.

    Parameters
    ----------
    force, normal
        In units of the weight; where both are none there is no demand.
    """
    presses = normal > LEAST_FORCE
    ratio = force / np.where(presses, normal, 1.0)
    return np.where(presses, ratio, np.where(force > LEAST_FORCE, np.inf, 0.0))


def contact_outputs(
    model: Model, states: Floats, accelerations: Floats, resting: npt.NDArray[np.bool_]
) -> dict[str, Output]:
    """Return the normal force [N], the friction that is needed over it, and the moment about the vertical over N r.

    Where there is no normal force the column lifts off, or would: the demands are infinite there (`per_normal_force`).
    At rest there is no moment.

    Parameters
    ----------
    model
        A model; without `contact` nothing is returned.
    states, accelerations, resting
        As for `Model.outputs`.
    """
    if model.contact is None:
        return {}
    column, moving, parameters = model.column, states[: len(model.state_names)], model.parameters
    found = [
        model.contact(*state, *push, *parameters)
        for state, push in zip(moving.T.tolist(), accelerations.T.tolist(), strict=True)
    ]
    normal, friction, moment = np.array(found).reshape(-1, 3).T
    normal = np.where(resting, 1.0 + accelerations[2], normal)
    friction = np.where(resting, np.hypot(*accelerations[:2]), friction)
    moment = np.where(resting, 0.0, moment)
    demands = [per_normal_force(force, normal) for force in (friction, moment)]
    return {
        "normal_force": Output(column.mass * column.gravity * normal, "N", "normal force at the contact"),
        "friction_demand": Output(demands[0], "1", "friction force over normal force"),
        "pivoting_demand": Output(demands[1], "1", "moment about the vertical over normal force and radius"),
    }


def path_outputs(model: Model, states: Floats, footprint: Floats) -> dict[str, Output]:
    """Return the centre of the footprint circle and the contact point on its rim [m], in the frame of the base.

    There is no contact point, NaN, where the column stands upright.
    """
    tilt = model.tilt(states)
    size = np.hypot(*tilt)
    with np.errstate(invalid="ignore", divide="ignore"):
        rim = model.column.radius * np.where(size > 0.0, tilt / size, np.nan)
    return {
        "footprint": Output(footprint, "m", "centre of the footprint circle"),
        "contact_point": Output(footprint + rim.T, "m", "contact point"),
    }
