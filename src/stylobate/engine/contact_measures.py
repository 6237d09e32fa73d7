"""Measures of a run whose contact changes: displacement, paths, and duration of each kind of contact."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from stylobate.base_motions import BaseMotion
from stylobate.compiler.over_rows import over_rows
from stylobate.engine.ensembles.variables import CONTACT_KINDS
from stylobate.engine.forcing import Floats, Forcing
from stylobate.engine.trajectory import Trajectory
from stylobate.models import Model, Sliding
from stylobate.models.sliding import Contact
from stylobate.models.sliding.equations import JAM

# Nodes and weights of Gauss's rule on [0, 1] for the lengths of paths in each step.
_NODES, _WEIGHTS = (part / 2.0 for part in np.polynomial.legendre.leggauss(4))
_NODES = _NODES + 0.5

EQUAL = 1e-9
"""Relative difference of friction coefficient and slenderness below which they count as equal."""


def contact_measures(arrays: Mapping[str, Any], motion: BaseMotion, trajectory: Trajectory) -> dict[str, float]:
    """Return the measures of a run.

    Parameters
    ----------
    arrays
        Results of the run from the summary of an ensemble.
    motion, trajectory
        Motion of the base, and of the column.

    Returns
    -------
    dict
        `time_resting` … [s]; `residual_displacement` of the centre of the footprint, with its components along x and y,
        and `walking_distance`, the length of its path [m]; `slip_distance`, the length of the path of the contact on
        the plane [m]; `residual_twist` [rad]; the numbers of `impacts` and `slips`; `least_painleve_denominator`.
    """
    model = trajectory.model
    names, length = model.state_names, model.column.mass_height
    begun, ended = trajectory.states(np.array([0.0, trajectory.end])).T
    place = [names.index("footprint_x"), names.index("footprint_y")]
    dx, dy = (length * (ended[place] - begun[place])).tolist()
    twist = names.index("twist")
    walked, slipped, least = _paths(motion, trajectory)
    return {
        **{f"time_{kind}": float(arrays[f"time_{kind}"]) for kind in CONTACT_KINDS},
        "residual_displacement": math.hypot(dx, dy),
        "residual_displacement_x": dx,
        "residual_displacement_y": dy,
        "residual_twist": float(ended[twist] - begun[twist]),
        "walking_distance": length * walked,
        "slip_distance": length * slipped,
        "impacts": float(arrays["impacts"]),
        "slips": float(arrays["slips"]),
        "least_painleve_denominator": least,
    }


def contact_warnings(model: Model, measures: Mapping[str, float]) -> tuple[str, ...]:
    """Return a line for each knife edge of a run: landings at a tilt of exactly 0, and a friction coefficient of c.

    Parameters
    ----------
    model
        Model of the run.
    measures
        Measures of the run.
    """
    warnings = []
    if measures["time_flying"] > 0.0 and measures.get("mean_tilt_late", measures["peak_tilt"]) == 0.0:
        warnings.append(
            "it lands at a tilt of exactly 0, which no real part does: a small initial tilt can make it rock or "
            "overturn; count runs by conveying.upright (stylobate upright)"
        )
    c = model.column.slenderness
    if isinstance(model, Sliding) and abs(model.numbers.static - c) <= EQUAL * c:
        warnings.append(
            f"the friction coefficient equals the slenderness c = {c:.6g}: sliding and rocking begin together, and "
            "rounding decides; compare values below and above c"
        )
    return tuple(warnings)


def _paths(motion: BaseMotion, trajectory: Trajectory) -> tuple[float, float, float]:
    """Return the lengths of the paths of footprint and slip [h], and the minimum Painlevé denominator."""
    model, lengths = trajectory.model, trajectory.ends - trajectory.starts
    moving = np.flatnonzero((trajectory.contacts != Contact.RESTING) & (lengths > 0.0))
    if not moving.size:
        return 0.0, 0.0, 1.0
    tau = (trajectory.starts[moving, np.newaxis] + lengths[moving, np.newaxis] * _NODES).ravel()
    weights = (lengths[moving, np.newaxis] * _WEIGHTS).ravel()
    kinds = np.repeat(trajectory.contacts[moving], len(_NODES))
    states = trajectory.states(tau).T
    pushes = Forcing.of(model, motion).along(tau).T
    parameters = np.broadcast_to(model.parameters, (len(tau), len(model.parameters)))
    rates = over_rows(model.rates, np.hstack([states, pushes, parameters]), name=model.name)
    places = [model.state_names.index(name) for name in ("footprint_x", "footprint_y")]
    walked = float(weights @ np.hypot(*rates[:, places].T))
    slides = np.isin(kinds, (Contact.SLIDING, Contact.SLIPPING))
    slipped = float(weights[slides] @ np.hypot(*states[slides][:, list(model.slip_states)].T))
    return walked, slipped, _least_denominator(trajectory, np.hstack([states, pushes])[kinds == Contact.SLIPPING])


def _least_denominator(trajectory: Trajectory, slipping: Floats) -> float:
    """Return the minimum Painlevé denominator at states of a slipping rim, with accelerations appended; 1 if none."""
    model = trajectory.model
    if not len(slipping):
        return 1.0
    assert model.guards is not None
    jam = model.guard_names.index("jam")
    numbers = np.broadcast_to((0.0, model.loss_tilt, *model.parameters), (len(slipping), 2 + len(model.parameters)))
    guards: Floats = over_rows(model.guards, np.hstack([slipping, numbers]), name=model.name)
    return min(1.0, float(guards[:, jam].min()) + JAM)
