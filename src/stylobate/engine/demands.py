"""Find the largest demands on the contact in a run, and warn of what a real contact would not have borne."""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
import xarray as xr

from stylobate.compiler.over_rows import over_rows
from stylobate.engine.forcing import Floats, Forcing
from stylobate.engine.standing import loads_while_standing
from stylobate.engine.trajectory import Trajectory
from stylobate.models import Model
from stylobate.models.contact import contact_outputs, per_normal_force

# About the largest load known, so often so many equal parts are looked at, of the two about the largest before.
_NARROWINGS, _PARTS = 6, 16
_HALVINGS = 50


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
        `largest_friction_demand`, `largest_pivoting_demand` and `least_normal_force`, the last over m g; empty if the
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
        data: xr.Dataset,
        friction_coefficient: float | None,
    ) -> "Demands":
        """Return the demands of a run, sought on dense output about the largest at the samples in `data` and the steps.

        Close to the vertical the contact bears most for a moment that steps resolve and samples may miss.
        """
        if model.contact is None or model.switches or "friction_demand" not in data:
            return cls({}, ())
        loads = _Loads.of(model, forcing, trajectory, data)
        friction, pivoting, pull = (loads.largest(load) for load in Load)
        measures = {
            "largest_friction_demand": friction,
            "largest_pivoting_demand": pivoting,
            "least_normal_force": -pull,
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
    def of(cls, model: Model, forcing: Forcing, trajectory: Trajectory, data: xr.Dataset) -> "_Loads":
        """Take the loads at the samples in `data`, at the ends of the steps, and closely where the column stands."""
        steps = np.append(trajectory.starts, trajectory.end)
        outputs = contact_outputs(model, trajectory.states(steps), forcing.along(steps), trajectory.resting(steps))
        weight = model.column.mass * model.column.gravity
        moving = np.stack(
            [
                np.append(data[name].to_numpy(), outputs[name].values) / unit
                for name, unit in (("friction_demand", 1.0), ("pivoting_demand", 1.0), ("normal_force", -weight))
            ]
        )
        stands = [loads_while_standing(forcing, start, end) for start, end in trajectory.standing]
        still = [np.stack([one.friction, np.zeros_like(one.friction), -one.normal]) for one in stands]
        times = [data["time"].to_numpy() / model.time_scale, steps, *(one.tau for one in stands)]
        tau, order = np.unique(np.concatenate(times), return_index=True)
        return cls(model, forcing, trajectory, tau, np.concatenate([moving, *still], axis=1)[:, order])

    def largest(self, load: Load) -> float:
        """Return the largest value of a load, sought about the largest one known."""
        values = self.values[load]
        top = int(np.argmax(values))
        at_top = float(values[top])
        if not np.isfinite(at_top):
            return at_top
        low, high = float(self.tau[max(top - 1, 0)]), float(self.tau[min(top + 1, self.tau.size - 1)])
        for _ in range(_NARROWINGS):
            tau = np.linspace(low, min(high, self.trajectory.end), _PARTS + 1)
            with np.errstate(invalid="ignore", over="ignore"):  # infinite next to rest, and where the ground would pull
                near = self.at(load, tau)
            top = int(np.argmax(near))
            at_top = max(at_top, float(near[top]))
            low, high = float(tau[max(top - 1, 0)]), float(tau[min(top + 1, _PARTS)])
        return at_top

    def first_beyond(self, load: Load, limit: float) -> float | None:
        """Return when a load first exceeds a limit [s]; None if it does so between two of the times only."""
        beyond = np.flatnonzero(self.values[load] > limit)
        if not beyond.size:
            return None
        first = int(beyond[0])
        high = float(self.tau[first])
        low = float(self.tau[first - 1]) if first else high
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            if self.at(load, np.array([middle]))[0] > limit:
                high = middle
            else:
                low = middle
        return high * self.model.time_scale

    def at(self, load: Load, tau: Floats) -> Floats:
        """Return a load at any times of the run."""
        model, push = self.model, self.forcing.along(tau)
        assert model.contact is not None
        states = self.trajectory.states(tau)[: len(model.state_names)]
        parameters = np.broadcast_to(model.parameters, (tau.size, len(model.parameters)))
        rows = np.hstack([states.T, push.T, parameters])
        normal, friction, moment = over_rows(model.contact, rows, name=model.name).T
        resting = self.trajectory.resting(tau)
        normal = np.where(resting, 1.0 + push[2], normal)
        if load is Load.PULL:
            return np.asarray(-normal)
        force = np.where(resting, np.hypot(*push[:2]), friction) if load is Load.FRICTION else moment
        return per_normal_force(np.where(resting & (load is Load.PIVOTING), 0.0, force), normal)
