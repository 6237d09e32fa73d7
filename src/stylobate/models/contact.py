"""Contact demand along a run, and the path of the contact point."""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from stylobate.models.model import Floats, Model, Output

LEAST_FORCE = 1e-8
"""Fraction of the weight below which a force counts as zero.

A normal force is the difference of weight and inertia, both of the order of the weight and accurate to `rtol`.
A smaller force cannot be distinguished from lift-off, and a ratio to it contains only rounding errors.
"""


def per_normal_force(force: Floats, normal: Floats) -> Floats:
    """Divide a force or moment by the normal force; a load without normal force gives infinity.

    Parameters
    ----------
    force, normal
        In units of the weight; the ratio is 0 where both are zero.
    """
    presses = normal > LEAST_FORCE
    ratio = force / np.where(presses, normal, 1.0)
    return np.where(presses, ratio, np.where(force > LEAST_FORCE, np.inf, 0.0))


class ContactLoads(NamedTuple):
    """Contact loads along a run, each of shape (n,).

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
    """Compute the contact loads along a run of a model with `contact`; a standing column has no moment.

    Parameters
    ----------
    model, states, accelerations, resting
        As for `contact_outputs`.
    """
    from stylobate.compiler.compiled import over_rows

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
    """Return the normal force N [N], the friction force over N, and the moment about the vertical over N r.

    Without normal force the column lifts off, or would: the demands are infinite there (`per_normal_force`). At rest
    the moment is zero.

    Parameters
    ----------
    model
        A model; the result is empty without `contact`.
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

    The contact point is NaN where the column stands upright.
    """
    tilt = model.tilt(states)
    size = np.hypot(*tilt)
    with np.errstate(invalid="ignore", divide="ignore"):
        rim = model.column.radius * np.where(size > 0.0, tilt / size, np.nan)
    return {
        "footprint": Output(footprint, "m", "centre of the footprint circle"),
        "contact_point": Output(footprint + rim.T, "m", "contact point"),
    }
