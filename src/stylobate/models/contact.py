"""What the contact must bear along a run, and where it lies."""

from typing import NamedTuple

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


class ContactLoads(NamedTuple):
    """What the contact bears along a run, each of shape (n,).

    Parameters
    ----------
    normal
        Normal force over the weight.
    friction
        Friction force over the normal force.
    pivoting
        Moment about the vertical over normal force and radius.
    """

    normal: Floats
    friction: Floats
    pivoting: Floats


def contact_loads(model: Model, states: Floats, accelerations: Floats, resting: npt.NDArray[np.bool_]) -> ContactLoads:
    """Compute what the contact bears along a run of a model with `contact`; of a standing column no moment.

    Parameters
    ----------
    model, states, accelerations, resting
        As for `contact_outputs`.
    """
    from stylobate.compiler.over_rows import over_rows  # noqa: PLC0415  building a model needs no compiler

    assert model.contact is not None
    arguments = (*states[: len(model.state_names)], *accelerations, *model.parameters)
    rows = np.column_stack(np.broadcast_arrays(*arguments))
    normal, friction, moment = over_rows(model.contact, rows, name=model.name).reshape(-1, 3).T
    normal = np.where(resting, 1.0 + accelerations[2], normal)
    friction = np.where(resting, np.hypot(*accelerations[:2]), friction)
    moment = np.where(resting, 0.0, moment)
    return ContactLoads(normal, per_normal_force(friction, normal), per_normal_force(moment, normal))


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
    loads = contact_loads(model, states, accelerations, resting)
    weight = model.column.mass * model.column.gravity
    return {
        "normal_force": Output(weight * loads.normal, "N", "normal force at the contact"),
        "friction_demand": Output(loads.friction, "1", "friction force over normal force"),
        "pivoting_demand": Output(loads.pivoting, "1", "moment about the vertical over normal force and radius"),
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
