"""Samples of a trajectory as labelled arrays in SI units."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import BaseMotion
from stylobate.engine.demands import Demands
from stylobate.engine.forcing import Floats, Forcing
from stylobate.engine.trajectory import Trajectory
from stylobate.errors import ParameterError, as_numbers
from stylobate.models import Model
from stylobate.results.samples import Labelled, Samples

if TYPE_CHECKING:
    import xarray as xr

# Default number of samples: per period of the forcing, per unit of time of the column, minimum and maximum.
_PER_PERIOD, _PER_UNIT = 48, 24
_FEWEST, _MOST = 1001, 50_001


@dataclass(frozen=True, slots=True)
class Recorded:
    """Samples of a run, contact demands, warnings, and a function for samples at other times."""

    data: Samples
    measures: dict[str, float]
    warnings: tuple[str, ...]
    sampler: Callable[[npt.ArrayLike], "xr.Dataset"]


def history(
    model: Model,
    motion: BaseMotion,
    trajectory: Trajectory,
    samples: int | None,
    *,
    friction_coefficient: float | None,
) -> Recorded:
    """Return the samples of a run at equal steps, `samples` of them or enough to draw every swing."""
    end = trajectory.end * model.time_scale
    usual = default_count(model, motion, trajectory.end)

    def sampler(time: npt.ArrayLike) -> "xr.Dataset":
        t = np.atleast_1d(np.asarray(as_numbers("time", time, "s"), dtype=float))
        if t.size and not (t.min() >= 0.0 and t.max() <= end * (1.0 + 1e-12)):
            message = f"time must lie within the run, 0 to {end!r} s, got {t.min()!r} to {t.max()!r} s"
            raise ParameterError(message)
        return _samples(model, motion, trajectory, t).as_dataset()

    def spread(count: int) -> Samples:
        return _samples(model, motion, trajectory, np.linspace(0.0, end, count))

    # The measures must not depend on the number of samples in the result.
    seen = spread(usual)
    data = seen if samples in (None, usual) else spread(samples)
    demands = Demands.of(model, Forcing.of(model, motion), trajectory, seen, friction_coefficient)
    return Recorded(data, demands.measures, demands.warnings, sampler)


def _samples(model: Model, motion: BaseMotion, trajectory: Trajectory, time: Floats) -> Samples:
    column = model.column
    tau = np.minimum(time / model.time_scale, trajectory.end)
    acceleration = motion.acceleration(time)
    states, resting = trajectory.states(tau), trajectory.resting(tau)
    tilt, rate = model.tilt(states), model.tilt_rate(states) / model.time_scale
    amplitude = np.hypot(*tilt)
    with np.errstate(divide="ignore", invalid="ignore"):
        rolling = (tilt[0] * rate[1] - tilt[1] * rate[0]) / amplitude**2  # (6): ω = β̇
        radial = (tilt[0] * rate[0] + tilt[1] * rate[1]) / amplitude  # (6): μ = Ȧ
    variables = {
        "tilt": _along_axis(tilt.T, "rad", "tilt vector"),
        "tilt_rate": _along_axis(rate.T, "rad s-1", "rate of the tilt vector"),
        "amplitude": _along_time(amplitude, "rad", "tilt angle"),
        "amplitude_rate": _along_time(radial, "rad s-1", "rate of the tilt angle"),
        "azimuth": _along_time(trajectory.azimuth(tau, tilt), "rad", "azimuth of the lean"),
        "rolling_rate": _along_time(rolling, "rad s-1", "rate of the azimuth"),
        "resting": Labelled(("time",), resting, {"long_name": "stands on its base"}),
        "base_displacement": _of_base(motion.displacement(time), "m", "base displacement"),
        "base_velocity": _of_base(motion.velocity(time), "m s-1", "base velocity"),
        "base_acceleration": _of_base(acceleration, "m s-2", "base acceleration"),
    }
    for name, output in model.outputs(states, acceleration.T / column.gravity, resting).items():
        make = _along_time if output.values.ndim == 1 else _along_axis
        variables[name] = make(output.values, output.units, output.long_name)
    attributes = {
        "slenderness": column.slenderness,
        "base_radius": column.radius,
        "uplift_acceleration": column.slenderness * column.gravity,
    }
    return Samples(time, variables, attributes)


def _along_time(values: Floats, units: str, long_name: str) -> Labelled:
    return Labelled(("time",), values, {"units": units, "long_name": long_name})


def _along_axis(values: Floats, units: str, long_name: str) -> Labelled:
    return Labelled(("time", "axis"), values, {"units": units, "long_name": long_name})


def _of_base(values: Floats, units: str, long_name: str) -> Labelled:
    return Labelled(("time", "direction"), values, {"units": units, "long_name": long_name})


def default_count(model: Model, motion: BaseMotion, end: float) -> int:
    """Return the default number of samples of a run."""
    periods = end * motion.highest_frequency * model.time_scale / (2.0 * math.pi)
    return int(np.clip(math.ceil(_PER_PERIOD * periods + _PER_UNIT * end) + 1, _FEWEST, _MOST))
