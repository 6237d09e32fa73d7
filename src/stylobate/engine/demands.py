"""Find the largest demands on the contact in a run, and warn of what a real contact would not have borne."""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from stylobate.engine.forcing import Floats, Forcing
from stylobate.engine.standing import loads_while_standing
from stylobate.engine.trajectory import Trajectory
from stylobate.models import Model
from stylobate.models.contact import contact_loads
from stylobate.results.samples import Samples

# The largest load is sought in narrower and narrower intervals about it, each divided into so many equal parts.
_NARROWINGS, _PARTS = 3, 128
# When a load first exceeds a limit is sought in the same way: five divisions leave 2⁻⁵⁰ of the first interval.
_DIVISIONS, _DIVIDED = 5, 1024


class Load(IntEnum):
    """A load of the contact; the normal force is counted downwards, so that the largest of each is sought."""

    FRICTION = 0
    PIVOTING = 1
    PULL = 2


@dataclass(frozen=True, slots=True)
class Demands:
    """The largest demands on the contact in a run, while the column moves and while it stands.

    Parameters
    ----------
    measures
        `peak_friction_demand`, `peak_pivoting_demand` and `minimum_normal_force`, the last over m g; empty if the
        model defines no contact forces.
    warnings
        A line for each thing that a real contact would not have borne.
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
        """Return the demands of a run, sought on dense output about the largest at the `samples` and the steps.

        Close to the vertical the contact bears most for a moment that steps resolve and samples may miss.
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
            warnings.append(f"it would lift off{when}: the contact would have to pull, which this model lets it do")
        if friction_coefficient is not None and friction > friction_coefficient:
            when = _from(loads.first_beyond(Load.FRICTION, friction_coefficient))
            warnings.append(
                f"it would slip{when}: more friction is needed than friction_coefficient {friction_coefficient:.4g} "
                f"gives, {_in_words(friction)}; this model never slips{_before_rocking(model, friction_coefficient)}"
            )
        return cls(measures, tuple(warnings))


def _in_words(demand: float) -> str:
    return (
        f"at most {demand:.4g} times the normal force in all of the run"
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
    """What the contact bears in a run: at samples and steps, and at any other time.

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
        """Take the loads at the samples, at the ends of the steps, and closely where the column stands."""
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
        """Return the largest value of each load, shape (3,), each sought about the largest one known."""
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
        """Return when a load first exceeds a limit [s]; None if it does so between two of the times only."""
        beyond = np.flatnonzero(self.values[load] > limit)
        if not beyond.size:
            return None
        first = int(beyond[0])
        low, high = self.tau[max(first - 1, 0)], self.tau[first]
        for _ in range(_DIVISIONS):
            tau = np.linspace(low, high, _DIVIDED + 1)
            exceeds = self.at(tau)[load] > limit
            exceeds[-1] = True  # known, but for rounding
            first = int(np.argmax(exceeds))
            low, high = tau[max(first - 1, 0)], tau[first]
        return float(high) * self.model.time_scale

    def at(self, tau: Floats) -> Floats:
        """Return the loads at any times of the run, shape (3, n)."""
        return _loads(self.model, self.forcing, self.trajectory, tau)


def _loads(model: Model, forcing: Forcing, trajectory: Trajectory, tau: Floats) -> Floats:
    """Return the loads at times of a run, shape (3, n), numbered by `Load`."""
    with np.errstate(invalid="ignore", over="ignore"):  # infinite next to rest, and where the ground would pull
        loads = contact_loads(model, trajectory.states(tau), forcing.along(tau), trajectory.resting(tau))
    return np.stack([loads.friction, loads.pivoting, -loads.normal])
