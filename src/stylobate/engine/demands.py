"""What the contact had to bear in a run: the largest demands, and what a real contact would not have borne."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import xarray as xr
from scipy.optimize import minimize_scalar

from stylobate.engine.forcing import Floats, Forcing
from stylobate.engine.trajectory import Trajectory
from stylobate.models import Model
from stylobate.models.contact import contact_outputs

Bools = npt.NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Demands:
    """The largest demands on the contact of a run while the column moves.

    Parameters
    ----------
    measures
        `largest_friction_demand`, `largest_pivoting_demand` and `least_normal_force`, the last over m g; empty where
        the model does not tell, or the column never moved.
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

        Close to the upright the contact bears most for a moment that steps resolve and samples may miss.
        """
        if model.contact is None or model.switches or "friction_demand" not in data or bool(data["resting"].all()):
            return cls({}, ())
        tau, moving, series = _seen(model, forcing, trajectory, data)
        extremes = _Extremes(model, forcing, trajectory)
        measures = {
            name: extremes.largest(kind, tau, np.where(moving, values, -np.inf))
            for kind, (name, values) in enumerate(series.items())
        }
        measures["least_normal_force"] *= -1.0
        time, warnings = tau * model.time_scale, []
        if measures["least_normal_force"] <= 0.0:
            when = _first(time, moving & (series["least_normal_force"] >= 0.0))
            warnings.append(f"it would lift off{when}: the contact would have to pull, which this model lets it do")
        demand = measures["largest_friction_demand"]
        if friction_coefficient is not None and demand > friction_coefficient:
            when = _first(time, moving & (series["largest_friction_demand"] > friction_coefficient))
            warnings.append(
                f"it would slip{when}: more friction is needed than friction_coefficient {friction_coefficient:.4g} "
                f"gives, {_told(demand)}; this model never slips"
            )
        return cls(measures, tuple(warnings))


def _seen(
    model: Model, forcing: Forcing, trajectory: Trajectory, data: xr.Dataset
) -> tuple[Floats, Bools, dict[str, Floats]]:
    """Return the times of the samples and the steps, where the column moves, and what the contact bears there.

    The least normal force is counted downwards.
    """
    steps = np.concatenate([piece.nodes for piece in trajectory.pieces])
    resting = trajectory.resting(steps)
    loads = contact_outputs(model, trajectory.states(steps), forcing.along(steps), resting)
    tau, order = np.unique(np.append(data["time"].to_numpy() / model.time_scale, steps), return_index=True)
    friction, pivoting, normal = (
        np.append(data[name].to_numpy(), loads[name].values)[order]
        for name in ("friction_demand", "pivoting_demand", "normal_force")
    )
    moving = ~np.append(data["resting"].to_numpy(), resting)[order]
    downwards = -normal / (model.column.mass * model.column.gravity)
    return (
        tau,
        moving,
        {
            "largest_friction_demand": friction,
            "largest_pivoting_demand": pivoting,
            "least_normal_force": downwards,
        },
    )


def _told(demand: float) -> str:
    return (
        f"at most {demand:.4g} times the normal force in all of the run"
        if np.isfinite(demand)
        else "without bound where nothing presses on the base"
    )


def _first(time: Floats, where: Bools) -> str:
    return f" from {time[np.argmax(where)]:.4g} s on" if where.any() else " for a moment"


@dataclass(frozen=True, slots=True)
class _Extremes:
    """Finds extremes of what the contact bears, between samples."""

    model: Model
    forcing: Forcing
    trajectory: Trajectory

    def largest(self, kind: int, tau: Floats, values: Floats) -> float:
        """Return the largest value of one kind: friction over normal force, moment over it, normal force downwards."""
        top = int(np.argmax(values))
        at_top = float(values[top])
        if not np.isfinite(at_top):
            return at_top
        low, high = float(tau[max(top - 1, 0)]), float(tau[min(top + 1, tau.size - 1)])
        bounds = (low, min(high, self.trajectory.end))
        with np.errstate(invalid="ignore", over="ignore"):  # infinite next to rest, and where the ground would pull
            found = minimize_scalar(self._below(kind), bounds=bounds, method="bounded", options={"xatol": 1e-9})
        return max(at_top, -float(found.fun))

    def _below(self, kind: int) -> Callable[[float], float]:
        model, trajectory = self.model, self.trajectory
        assert model.contact is not None
        contact, parameters = model.contact, model.parameters

        def below(tau: float) -> float:
            if bool(trajectory.resting(np.array([tau]))[0]):
                return 0.0 if kind < _NORMAL else np.inf
            state = trajectory.states(np.array([tau]))[: len(model.state_names), 0].tolist()
            normal, friction, moment = contact(*state, *self.forcing.at(tau), *parameters)
            if kind == _NORMAL:
                return normal
            return -(friction, moment)[kind] / normal if normal > 0.0 else -np.inf

        return below


_NORMAL = 2
