"""Peak contact demands of a run, and warnings about slip and lift-off that the model excludes."""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from stylobate.engine.forcing import Floats, Forcing
from stylobate.engine.standing import loads_while_standing
from stylobate.engine.trajectory import Trajectory
from stylobate.models import Model
from stylobate.models.contact import contact_loads
from stylobate.results.samples import Samples

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
        samples: Samples,
        friction_coefficient: float | None,
    ) -> "Demands":
        """Return the demands of a run, from the dense output near the maximum over `samples` and steps.

        Close to the vertical a load can have a short peak, which steps resolve and samples may miss.
        """
        if model.contact is None or model.switches or "friction_demand" not in samples.variables:
            return cls({}, ())
        loads = _Loads.of(model, forcing, trajectory, samples)
        friction, pivoting, pull = loads.largest().tolist()
        measures = {
            "peak_friction_demand": friction,
            "peak_pivoting_demand": pivoting,
            "minimum_normal_force": -pull,
        }
        warnings = []
        if pull >= 0.0:
            when = _from(loads.first_beyond(Load.PULL, 0.0))
            warnings.append(f"it would lift off{when}: the contact would have to pull, which this model allows")
        if friction_coefficient is not None and friction > friction_coefficient:
            when = _from(loads.first_beyond(Load.FRICTION, friction_coefficient))
            warnings.append(
                f"it would slip{when}: more friction is needed than friction_coefficient {friction_coefficient:.4g} "
                f"provides, {_in_words(friction)}; this model never slips{_before_rocking(model, friction_coefficient)}"
            )
        return cls(measures, tuple(warnings))


def _in_words(demand: float) -> str:
    return (
        f"at most {demand:.4g} times the normal force during the run"
        if np.isfinite(demand)
        else "without bound where nothing presses on the base"
    )


def _before_rocking(model: Model, friction_coefficient: float) -> str:
    capacity = model.rest_capacity
    if friction_coefficient >= capacity:
        return ""
    return (
        f", but with less friction than {capacity:.4g}, at which rocking begins, the column slides before it rocks: "
        "this run does not describe it; use model sliding"
    )


def _from(time: float | None) -> str:
    return " for a moment" if time is None else f" from {time:.5g} s on"


@dataclass(frozen=True, slots=True)
class _Loads:
    """Contact loads of a run at samples and steps, and at any other time.

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
    def of(cls, model: Model, forcing: Forcing, trajectory: Trajectory, samples: Samples) -> "_Loads":
        """Return the loads at the samples, at the ends of the steps, and at more times while the column stands."""
        steps = np.append(trajectory.starts, trajectory.end)
        weight = model.column.mass * model.column.gravity
        sampled = [
            samples.variables[name].values / unit
            for name, unit in (("friction_demand", 1.0), ("pivoting_demand", 1.0), ("normal_force", -weight))
        ]
        stands = [loads_while_standing(forcing, start, end) for start, end in trajectory.standing]
        still = [np.stack([one.friction, np.zeros_like(one.friction), -one.normal]) for one in stands]
        times = [samples.time / model.time_scale, steps, *(one.tau for one in stands)]
        values = [np.stack(sampled), _loads(model, forcing, trajectory, steps), *still]
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
        loads = contact_loads(model, trajectory.states(tau), forcing.along(tau), trajectory.resting(tau))
    return np.stack([loads.friction, loads.pivoting, -loads.normal])
