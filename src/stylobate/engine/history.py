"""History of a run: sampled states, contact demand and measures of the contact."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import IntEnum
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import BaseMotion
from stylobate.compiler.compiled import over_rows
from stylobate.engine.ensembles.runs import CONTACT_KINDS
from stylobate.engine.forcing import Floats, Forcing
from stylobate.engine.tolerances import SAMPLES_PER_PERIOD
from stylobate.engine.trajectory import Trajectory
from stylobate.errors import ParameterError, as_numbers
from stylobate.models import Model, Sliding
from stylobate.models.contact import contact_loads, per_normal_force
from stylobate.models.sliding import Contact
from stylobate.models.sliding.equations import JAM

if TYPE_CHECKING:
    import xarray as xr

# Default number of samples: per period of the forcing, per unit of time of the column, minimum and maximum.
_PER_PERIOD, _PER_UNIT = 48, 24
_FEWEST, _MOST = 1001, 5_001


@dataclass(frozen=True, slots=True)
class Recorded:
    """Contact demands and warnings of a run, and functions for its samples and for samples at other times."""

    data: Callable[[], "xr.Dataset"]
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
    """Return the history of a run; its samples are at equal steps, `samples` of them or enough to draw every swing."""
    end = trajectory.end * model.time_scale
    usual = default_count(model, motion, trajectory.end)

    def sampler(time: npt.ArrayLike) -> "xr.Dataset":
        t = np.atleast_1d(np.asarray(as_numbers("time", time, "s"), dtype=float))
        if t.size and not (t.min() >= 0.0 and t.max() <= end * (1.0 + 1e-12)):
            raise ParameterError(f"time must lie within the run, 0 to {end!r} s, got {t.min()!r} to {t.max()!r} s")
        return _samples(model, motion, trajectory, t)

    def data() -> "xr.Dataset":
        return _samples(model, motion, trajectory, np.linspace(0.0, end, samples or usual))

    # The measures must not depend on the number of samples in the result.
    demands = Demands.of(model, Forcing.of(model, motion), trajectory, usual, friction_coefficient)
    return Recorded(data, demands.measures, demands.warnings, sampler)


def _samples(model: Model, motion: BaseMotion, trajectory: Trajectory, time: Floats) -> "xr.Dataset":
    import xarray as xr

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
        "resting": (("time",), resting, {"long_name": "stands on its base"}),
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
    coordinates = {"time": _along_time(time, "s", "time"), "axis": ["x", "y"], "direction": ["x", "y", "z"]}
    return xr.Dataset(variables, coords=coordinates, attrs=attributes)


def _along_time(values: Floats, units: str, long_name: str) -> tuple[Any, ...]:
    return ("time",), values, {"units": units, "long_name": long_name}


def _along_axis(values: Floats, units: str, long_name: str) -> tuple[Any, ...]:
    return ("time", "axis"), values, {"units": units, "long_name": long_name}


def _of_base(values: Floats, units: str, long_name: str) -> tuple[Any, ...]:
    return ("time", "direction"), values, {"units": units, "long_name": long_name}


def default_count(model: Model, motion: BaseMotion, end: float) -> int:
    """Return the default number of samples of a run."""
    periods = end * motion.highest_frequency * model.time_scale / (2.0 * math.pi)
    return int(np.clip(math.ceil(_PER_PERIOD * periods + _PER_UNIT * end) + 1, _FEWEST, _MOST))


# Search for a peak load: number of successively narrower intervals, and equal parts of each.
_NARROWINGS, _PARTS = 3, 128
# The same for the first time beyond a limit: five divisions leave 2⁻⁵⁰ of the first interval.
_DIVISIONS, _DIVIDED = 5, 1024


class Load(IntEnum):
    """Load of the contact; the sign of the normal force is reversed, so that each peak is a maximum."""

    FRICTION = 0
    PIVOTING = 1
    PULL = 2


@dataclass(frozen=True, slots=True)
class Demands:
    """Peak contact demands of a run, while the column moves and while it stands.

    Parameters
    ----------
    measures
        `peak_friction_demand`, `peak_pivoting_demand` and `minimum_normal_force`, the last over m g; empty if the
        model defines no contact forces.
    warnings
        A line for each limit of a real contact that the run exceeds.
    """

    measures: dict[str, float]
    warnings: tuple[str, ...]

    @classmethod
    def of(
        cls,
        model: Model,
        forcing: Forcing,
        trajectory: Trajectory,
        count: int,
        friction_coefficient: float | None,
    ) -> "Demands":
        """Return the demands of a run, from the dense output near the maximum over `count` equal steps and its own.

        Close to the vertical a load can have a short peak, which steps resolve and equal steps may miss.
        """
        if model.contact is None or model.switches:
            return cls({}, ())
        loads = _Loads.of(model, forcing, trajectory, count)
        friction, pivoting, pull = loads.largest().tolist()
        measures = {
            "peak_friction_demand": friction,
            "peak_pivoting_demand": pivoting,
            "minimum_normal_force": -pull,
        }
        warnings = []
        if pull >= 0.0:
            when = _from(loads.first_beyond(Load.PULL, 0.0))
            warnings.append(LIFTS_OFF.format(when=when))
        if friction_coefficient is not None and friction > friction_coefficient:
            when = _from(loads.first_beyond(Load.FRICTION, friction_coefficient))
            before = _before_rocking(model, friction_coefficient)
            warnings.append(
                SLIPS.format(when=when, limit=friction_coefficient, needed=_in_words(friction), before=before)
            )
        return cls(measures, tuple(warnings))


def _in_words(demand: float) -> str:
    return AT_MOST.format(demand=demand) if np.isfinite(demand) else WITHOUT_BOUND


def _before_rocking(model: Model, friction_coefficient: float) -> str:
    capacity = model.rest_capacity
    if friction_coefficient >= capacity:
        return ""
    return BEFORE_ROCKING.format(capacity=capacity)


def _from(time: float | None) -> str:
    return FOR_A_MOMENT if time is None else FROM.format(time=time)


LIFTS_OFF = "it would lift off{when}: the contact would have to pull, which this model allows"
SLIPS = (
    "it would slip{when}: more friction is needed than friction_coefficient {limit:.4g} provides, {needed}; this model "
    "never slips{before}"
)
AT_MOST = "at most {demand:.4g} times the normal force during the run"
WITHOUT_BOUND = "without bound where nothing presses on the base"
BEFORE_ROCKING = (
    ", but with less friction than {capacity:.4g}, at which rocking begins, the column slides before it rocks: "
    "this run does not describe it; use model sliding"
)
FROM, FOR_A_MOMENT = " from {time:.5g} s on", " for a moment"
"""Warnings about the contact and their parts, with gaps."""


def demand_texts() -> dict[str, str]:
    """Return the warnings about the contact with gaps for numbers, for a page that states them without Python."""
    return {
        "lifts_off": LIFTS_OFF,
        "slips": SLIPS,
        "at_most": AT_MOST,
        "without_bound": WITHOUT_BOUND,
        "before_rocking": BEFORE_ROCKING,
        "from_time": FROM,
        "for_a_moment": FOR_A_MOMENT,
    }


@dataclass(frozen=True, slots=True)
class _Loads:
    """Contact loads of a run at some times, and at any other time.

    Parameters
    ----------
    tau, values
        Times, and the loads there, shape (3, n), numbered by `Load`.
    """

    model: Model
    forcing: Forcing
    trajectory: Trajectory
    tau: Floats
    values: Floats

    @classmethod
    def of(cls, model: Model, forcing: Forcing, trajectory: Trajectory, count: int) -> "_Loads":
        """Return the loads at `count` equal steps, at the run's own, and at more times while the column stands."""
        known = np.concatenate([np.linspace(0.0, trajectory.end, count), trajectory.starts, [trajectory.end]])
        stands = [loads_while_standing(forcing, start, end) for start, end in trajectory.standing]
        still = [np.stack([one.friction, np.zeros_like(one.friction), -one.normal]) for one in stands]
        times = [known, *(one.tau for one in stands)]
        values = [_loads(model, forcing, trajectory, known), *still]
        tau, order = np.unique(np.concatenate(times), return_index=True)
        return cls(model, forcing, trajectory, tau, np.concatenate(values, axis=1)[:, order])

    def largest(self) -> Floats:
        """Return the maximum of each load, shape (3,), from a search near the maximum of the known values."""
        loads, last = np.arange(len(Load)), self.tau.size - 1
        top = np.argmax(self.values, axis=1)
        largest: Floats = self.values[loads, top]
        bounded = np.isfinite(largest)
        low = self.tau[np.maximum(top - 1, 0)]
        high = np.minimum(self.tau[np.minimum(top + 1, last)], self.trajectory.end)
        for _ in range(_NARROWINGS if bounded.any() else 0):
            tau = np.linspace(low, high, _PARTS + 1, axis=1)
            near = self.at(tau.ravel()).reshape(len(Load), *tau.shape)[loads, loads]
            top = np.argmax(near, axis=1)
            largest = np.where(bounded, np.fmax(largest, near[loads, top]), largest)
            low, high = tau[loads, np.maximum(top - 1, 0)], tau[loads, np.minimum(top + 1, _PARTS)]
        return largest

    def first_beyond(self, load: Load, limit: float) -> float | None:
        """Return the first time [s] of a load above a limit; None if it is above only between two known times."""
        beyond = np.flatnonzero(self.values[load] > limit)
        if not beyond.size:
            return None
        first = int(beyond[0])
        low, high = self.tau[max(first - 1, 0)], self.tau[first]
        for _ in range(_DIVISIONS):
            tau = np.linspace(low, high, _DIVIDED + 1)
            exceeds = self.at(tau)[load] > limit
            exceeds[-1] = True  # known; rounding could hide it
            first = int(np.argmax(exceeds))
            low, high = tau[max(first - 1, 0)], tau[first]
        return float(high) * self.model.time_scale

    def at(self, tau: Floats) -> Floats:
        """Return the loads at any times of the run, shape (3, n)."""
        return _loads(self.model, self.forcing, self.trajectory, tau)


def _loads(model: Model, forcing: Forcing, trajectory: Trajectory, tau: Floats) -> Floats:
    """Return the loads at times of a run, shape (3, n), numbered by `Load`."""
    with np.errstate(invalid="ignore", over="ignore"):  # infinite next to rest, and if the base would pull
        loads = contact_loads(model, trajectory.own_states(tau), forcing.along(tau), trajectory.resting(tau))
    return np.stack([loads.friction, loads.pivoting, -loads.normal])


# Maximum number of samples, to limit memory.
_MOST_SAMPLES = 500_000


@dataclass(frozen=True, slots=True)
class StandingLoads:
    """Loads of the contact of a standing column over time.

    Parameters
    ----------
    tau
        Dimensionless times, shape (n,).
    friction
        Friction demand |a_h|/(g + a_z), shape (n,): infinite if the normal force is zero.
    normal
        Normal force over the weight, 1 + a_z/g, shape (n,).
    """

    tau: Floats
    friction: Floats
    normal: Floats


def loads_while_standing(forcing: Forcing, start: float, end: float) -> StandingLoads:
    """Return the loads from `start` to `end`, at times close enough to locate the extremes.

    The times are the breaks of the base motion (the extremes of a piecewise linear motion are there) and 64 samples per
    shortest period. One period is enough if the motion is periodic after its last break. The number of samples is at
    most 500 000; only a motion without a period can need more.
    """
    breaks = np.array(forcing.stops(end))
    within = breaks[(breaks > start) & (breaks < end)]
    until = end
    if forcing.motion.period is not None:
        last = float(within[-1]) if within.size else start
        until = min(end, last + forcing.motion.period / forcing.time_scale)
    linear = forcing.motion.degree is not None and forcing.motion.degree <= 1
    frequency = 0.0 if linear else forcing.highest_frequency
    parts = max(1, math.ceil(min((until - start) * frequency * SAMPLES_PER_PERIOD / (2.0 * math.pi), _MOST_SAMPLES)))
    tau = np.unique(np.concatenate([np.linspace(start, until, parts + 1), within, [end]]))
    ax, ay, az = forcing.along(tau)
    normal = 1.0 + az
    return StandingLoads(tau, per_normal_force(np.hypot(ax, ay), normal), normal)


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
        Results of the run as those of an ensemble.
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
