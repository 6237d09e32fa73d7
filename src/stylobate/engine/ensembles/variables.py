"""Variables of the results of ensembles: type, dimensions and attributes of each, and empty arrays for them."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from stylobate.engine.kernel.columns import Change
from stylobate.engine.memory import require_memory
from stylobate.models import Model
from stylobate.results.outcomes import NOT_COMPUTED, NUMERICALLY_UNCERTAIN, outcome_attributes
from stylobate.run_arguments import Options

TIMES_OF_CONTACTS = tuple(column for column in Change if column.name.startswith("TIME_"))
CONTACT_KINDS = tuple(column.name.removeprefix("TIME_").lower() for column in TIMES_OF_CONTACTS)
"""Kinds of contact, in the order of their numbers."""

Arrays = dict[str, npt.NDArray[Any]]


@dataclass(frozen=True, slots=True)
class Variable:
    """Variable of the results: type, dimensions besides those of the runs, attributes, value if not computed."""

    dtype: type
    dims: tuple[str, ...]
    attributes: Mapping[str, Any]
    none: float = 0


def _numbers(long_name: str, units: str, *dims: str) -> Variable:
    return Variable(np.float64, dims, {"long_name": long_name, "units": units}, np.nan)


_CONTACTS = (
    *(
        "strobe_footprint",
        "strobe_twist",
        "end_footprint",
        "end_twist",
        "end_contact",
        "mean_velocity",
        "mean_twist_rate",
        "impacts",
        "slips",
    ),
    *(f"time_{kind}" for kind in CONTACT_KINDS),
)


QUANTITIES: Mapping[str, Variable] = {
    "outcome": Variable(np.int8, (), outcome_attributes(), NOT_COMPUTED),
    "decided_at": _numbers("time at which the outcome was decided", "s"),
    "end_time": _numbers("end of the run", "s"),
    "uncertain": Variable(np.bool_, (), {"long_name": NUMERICALLY_UNCERTAIN}),
    "in_doubt": Variable(np.bool_, (), {"long_name": "finer thresholds or another tolerance could change the outcome"}),
    "planar": Variable(np.bool_, (), {"long_name": "moved in one vertical plane"}),
    "end_tilt": _numbers("tilt vector at the end", "rad", "axis"),
    "end_tilt_rate": _numbers("rate of the tilt vector at the end", "rad s-1", "axis"),
    "direction": _numbers("azimuth in which it overturned", "rad"),
    "peak_tilt": _numbers("peak tilt", "rad"),
    "time_of_peak_tilt": _numbers("time of the peak tilt", "s"),
    "minimum_tilt": _numbers("minimum tilt while it moves", "rad"),
    "turns": _numbers("turns of the contact point", "1"),
    "mean_tilt": _numbers("mean tilt over the last periods", "rad"),
    "phase": _numbers("phase of the tilt vector relative to the base acceleration, over the last periods", "rad"),
    "mean_rolling_rate": _numbers("mean rolling rate over the last periods", "rad s-1"),
    "repetition": _numbers("change from period to period, over the last periods", "1"),
    "repeats_after": Variable(
        np.int8, (), {"long_name": "periods of the base motion after which the motion repeats; 0 if it does not"}
    ),
    "end_spin": _numbers("angular velocity about the axis at the end", "rad s-1"),
    "peak_friction_demand": _numbers("peak friction force over normal force", "1"),
    "peak_pivoting_demand": _numbers("peak moment about the vertical over normal force and radius", "1"),
    "minimum_normal_force": _numbers("minimum normal force over weight", "1"),
    "end_footprint": _numbers("centre of the footprint circle at the end", "m", "axis"),
    "end_twist": _numbers("angle of turn about the axis at the end", "rad"),
    "end_contact": Variable(
        np.int8,
        (),
        {
            "long_name": "kind of contact at the end: "
            + ", ".join(f"{k} {kind}" for k, kind in enumerate(CONTACT_KINDS))
            + ", 5 jammed"
        },
    ),
    **{f"time_{kind}": _numbers(f"time spent {kind}", "s") for kind in CONTACT_KINDS},
    "mean_velocity": _numbers("mean velocity of the footprint over the last periods", "m s-1", "axis"),
    "mean_twist_rate": _numbers("mean rate of the twist over the last periods", "rad s-1"),
    "impacts": Variable(np.int32, (), {"long_name": "landings and face impacts"}),
    "slips": Variable(np.int32, (), {"long_name": "times that a sticking contact began to slip"}),
    "uplifts": Variable(np.int32, (), {"long_name": "uplifts from rest"}),
    "steps": Variable(np.int32, (), {"long_name": "integration steps"}),
    "strobe_tilt": _numbers("tilt vector at phase zero of the base motion", "rad", "strobe", "axis"),
    "strobe_tilt_rate": _numbers("its rate at phase zero of the base motion", "rad s-1", "strobe", "axis"),
    "strobe_footprint": _numbers("footprint at phase zero of the base motion", "m", "strobe", "axis"),
    "strobe_twist": _numbers("angle of turn about the axis at phase zero of the base motion", "rad", "strobe"),
    "sample_time": _numbers("time", "s", "sample"),
    "sampled_tilt": _numbers("tilt vector", "rad", "sample", "axis"),
    "sampled_tilt_rate": _numbers("rate of the tilt vector", "rad s-1", "sample", "axis"),
}


DEMANDS = ("peak_friction_demand", "peak_pivoting_demand", "minimum_normal_force")


def empty(model: Model, options: Options, count: int) -> Arrays:
    """Return arrays for the results of `count` runs, filled with the values for runs that are not computed."""
    sizes = {"axis": 2, "strobe": options["strobes"], "sample": options["samples"] or 0}
    left_out = {*(() if options["demands"] else DEMANDS), *(("end_spin",) if model.spin_state is None else ())}
    left_out |= {*(() if model.switches else _CONTACTS)}
    shapes = {
        name: tuple(sizes[dim] for dim in quantity.dims)
        for name, quantity in QUANTITIES.items()
        if name not in left_out
    }
    shapes = {name: shape for name, shape in shapes.items() if 0 not in shape}
    bytes_of_a_run = sum(np.dtype(QUANTITIES[name].dtype).itemsize * math.prod(shape) for name, shape in shapes.items())
    require_memory(bytes_of_a_run * count, count, "Take fewer runs, samples or strobes")
    return {
        name: np.full((count, *shape), QUANTITIES[name].none, QUANTITIES[name].dtype) for name, shape in shapes.items()
    }
