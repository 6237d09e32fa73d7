"""Initial conditions of runs: spin, twist, position, velocity and clearance, and their checks."""

import reprlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import BaseMotion
from stylobate.engine.forcing import check_kinds, common_line
from stylobate.errors import ParameterError, UnsupportedError
from stylobate.models import Model
from stylobate.models.consistency.check import check_once
from stylobate.quantities import QUARTER_TURN, degrees_meant
from stylobate.run_arguments import SingleRun, arguments_of

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Turning:
    """Spin [rad/s], twist [rad], position [m], velocity [m/s] and clearance [m] at the start of a run."""

    spin: float = 0.0
    twist: float = 0.0
    position: tuple[float, float] = (0.0, 0.0)
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    clearance: float = 0.0

    @classmethod
    def checked(cls, model: Model, run: Mapping[str, Any], *, standing: bool) -> "Turning":
        """Check and return the initial conditions; `standing` means zero tilt and zero tilt rate.

        Raises
        ------
        ParameterError
            If a value is not finite, or `model` does not support it.
        """
        declared = arguments_of(SingleRun)
        spin, twist, position, velocity, clearance = (declared[one.name].checked(run[one.name]) for one in fields(cls))
        (x, y), (vx, vy, vz) = position, velocity
        refuse_spin(model, spin, standing=standing)
        if not model.carried_names and not model.switches and (twist or x or y):
            name, value = ("twist", twist) if twist else ("position", (x, y))
            raise ParameterError(f"{name} must be left out: model {model.name} does not compute it, got {value!r}")
        if not model.switches and (vx or vy or vz or clearance):
            name, found = ("clearance", clearance) if clearance else ("velocity", (vx, vy, vz))
            raise ParameterError(
                f"{name} must be left out: in model {model.name} the contact neither slips nor opens, got {found!r}"
            )
        if vz < 0.0 and clearance == 0.0:
            raise ParameterError(
                f"velocity must not lead into the plane if the clearance is 0, got {vz!r} m/s along its normal"
            )
        return cls(spin, twist, (x, y), (vx, vy, vz), clearance)

    def carried(self, model: Model) -> tuple[float, ...]:
        """Return the initial passive states of a run of `model`."""
        if not model.carried_names:
            return ()
        return self.twist, self.position[0] / model.column.radius, self.position[1] / model.column.radius

    def begun(self, model: Model, state: Floats) -> Floats:
        """Add twist, position, velocity and clearance to an initial state without them.

        The state is that of a model that changes between kinds of contact.
        """
        if not (self.twist or any(self.position) or any(self.velocity) or self.clearance):
            return state
        x, y, vx, vy = map(float, model.tilt_of(*state, *model.parameters))
        return np.array(
            model.begun(
                (x, y),
                (vx / model.time_scale, vy / model.time_scale),
                spin=self.spin,
                twist=self.twist,
                position=self.position,
                velocity=self.velocity,
                clearance=self.clearance,
            )
        )

    def values(self) -> dict[str, Any]:
        """Return the values that are not zero, by name."""
        given: dict[str, Any] = {"spin": self.spin, "twist": self.twist, "position": self.position}
        given |= {"velocity": self.velocity, "clearance": self.clearance}
        return {name: value for name, value in given.items() if np.any(value)}


@dataclass(frozen=True, slots=True)
class RunStart:
    """Initial conditions of a single run (tilt [rad], tilt rate [rad/s], others), and its duration [s]."""

    tilt: tuple[float, float]
    tilt_rate: tuple[float, float]
    duration: float
    turning: Turning = Turning()


def refuse_friction(model: Model, friction_coefficient: object) -> None:
    """Raise ParameterError if a friction coefficient is given besides a `model` that has its own."""
    if friction_coefficient is not None and model.switches:
        raise ParameterError(
            f"friction_coefficient must be given to model {model.name} itself, got {friction_coefficient!r} here"
        )


def require_below_level(tilt: Floats) -> None:
    """Raise ParameterError if an initial tilt vector, shape (…, 2) [rad], is as long as π/2."""
    largest = float(np.hypot(tilt[..., 0], tilt[..., 1]).max(initial=0.0))
    if largest >= QUARTER_TURN:
        message = f"tilt must be below π/2 in length, got {largest!r} rad. {degrees_meant(largest)}"
        raise ParameterError(message.rstrip())


def refuse_spin(model: Model, spin: float, *, standing: bool) -> None:
    """Raise ParameterError if there is a spin and `model` does not support it, or the column stands."""
    if spin == 0.0:
        return
    if model.spin_state is None:
        raise ParameterError(NO_SPIN.format(model=model.name, spin=spin))
    if standing and not model.switches:
        raise ParameterError(SPIN_UPRIGHT.format(spin=spin))


def require_plane(model: Model, motion: BaseMotion, tilt: tuple[float, float], tilt_rate: tuple[float, float]) -> None:
    """Raise ParameterError if `model` is planar, but start and base motion are not in one vertical plane."""
    if not model.planar_only:
        return
    directions = (tilt, tilt_rate, *motion.directions())
    if any(any(direction) for direction in directions) and common_line(*directions) is None:
        raise out_of_plane(model, tilt, tilt_rate)


def out_of_plane(model: Model, tilt: Sequence[float], tilt_rate: Sequence[float]) -> ParameterError:
    """Return the error of a start and a base motion that are not in one vertical plane."""
    given = ", ".join(f"{name} ({x:.5g}, {y:.5g})" for name, (x, y) in (("tilt", tilt), ("tilt_rate", tilt_rate)))
    return ParameterError(OUT_OF_PLANE.format(model=model.name, given=given))


NO_SPIN = "spin must be left out: the column of model {model} cannot turn, got {spin} rad/s"
SPIN_UPRIGHT = "spin must be 0 for a column that stands flat on its base, got {spin} rad/s; give it a tilt"
OUT_OF_PLANE = (
    "tilt, tilt_rate and motion must lie in one vertical plane for model {model}; with {given} they do not: "
    "give all of them the same direction"
)
"""Refusals of initial conditions, with gaps."""


def require_nouns(model: Model, motion: BaseMotion | None) -> None:
    """Raise ParameterError if an argument has the wrong type."""
    if not isinstance(model, Model):
        raise ParameterError(f"model must be a model such as Slender(column), got {reprlib.repr(model)}")
    check_once(model)
    if motion is not None and not isinstance(motion, BaseMotion):
        raise ParameterError(
            f"motion must be a base motion such as Harmonic.circular(...) or None, got {reprlib.repr(motion)}"
        )
    if motion is not None:
        check_kinds(motion)


def cannot_depart(model: Model) -> UnsupportedError:
    """Return the error of a model without the function `departure`."""
    message = f"model {model.name} does not say how a column departs from rest: give it `departure`, or start it moving"
    return UnsupportedError(message)
