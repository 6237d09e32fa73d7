"""The models of the hierarchy, and one case that all of them run."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypedDict

from stylobate.base_motions import BaseMotion
from stylobate.column import Column
from stylobate.engine import simulate
from stylobate.engine.forcing import common_line
from stylobate.models import Model, PlanarRocking, Rolling, Slender, SlenderRolling, Wobbling
from stylobate.results import OutcomeRules, Response


class RunArguments(TypedDict, total=False):
    """What all levels are run with: the arguments of `simulate` of these names."""

    rtol: float
    atol: float | None
    tilt_limit: float | None
    rest_energy: float | None
    max_steps: int
    rules: OutcomeRules | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """A column with its frictions, a base motion and a start.

    Parameters
    ----------
    column, motion
        The column, and how its base moves.
    damping, spin_damping, restitution
        η; ζ of levels that may turn; e of levels at finite tilt on passing the upright, None for Housner's value in
        planar rocking and no loss elsewhere.
    tilt, tilt_rate, spin
        Start [rad], [rad/s], [rad/s].
    """

    column: Column
    motion: BaseMotion
    damping: float
    spin_damping: float
    restitution: float | None
    tilt: tuple[float, float]
    tilt_rate: tuple[float, float]
    spin: float

    def scaled_to(self, slenderness: float) -> "Case":
        """Return the case that is the same to small tilts: tilt, its rate and the base motion in proportion to c.

        Height and transverse inertia stay, and with them ω0 and κ; so does the spin.
        """
        factor = slenderness / self.column.slenderness
        return Case(
            column=self.column.with_slenderness(slenderness),
            motion=self.motion.scaled(factor),
            damping=self.damping,
            spin_damping=self.spin_damping,
            restitution=self.restitution,
            tilt=(factor * self.tilt[0], factor * self.tilt[1]),
            tilt_rate=(factor * self.tilt_rate[0], factor * self.tilt_rate[1]),
            spin=self.spin,
        )

    @property
    def in_a_plane(self) -> bool:
        """Whether start and base motion lie in one vertical plane, and no spin leads out of it."""
        directions = (self.tilt, self.tilt_rate, *self.motion.directions())
        moving = any(any(direction) for direction in directions)
        return self.spin == 0.0 and (not moving or common_line(*directions) is not None)

    def models(self) -> tuple[Model, ...]:
        """Return the levels from the simplest on; planar rocking is the last, where the motion lies in a plane."""
        column, damping, loss = self.column, self.damping, 1.0 if self.restitution is None else self.restitution
        levels: tuple[Model, ...] = (
            Slender(column, damping=damping),
            SlenderRolling(column, damping=damping, spin_damping=self.spin_damping),
            Wobbling(column, damping=damping, restitution=loss),
            Rolling(column, damping=damping, spin_damping=self.spin_damping, restitution=loss),
        )
        if self.in_a_plane:
            levels += (PlanarRocking(column, damping=damping, restitution=self.restitution),)
        return levels

    def run(
        self, model: Model, duration: float, friction_coefficient: float | None, arguments: Mapping[str, Any]
    ) -> Response:
        """Return the run of one level; one that cannot turn starts without spin."""
        return simulate(
            model,
            self.motion,
            tilt=self.tilt,
            tilt_rate=self.tilt_rate,
            spin=0.0 if model.spin_state is None else self.spin,
            duration=duration,
            friction_coefficient=friction_coefficient,
            **arguments,
        )
