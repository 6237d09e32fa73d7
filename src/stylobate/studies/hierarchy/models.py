"""Models of the hierarchy, and a case for all of them."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from stylobate.base_motions import BaseMotion
from stylobate.column import Column
from stylobate.engine import simulate
from stylobate.engine.forcing import common_line
from stylobate.models import Model, PlanarRocking, Rolling, Slender, SlenderRolling, Wobbling
from stylobate.models.declared import dissipation_of
from stylobate.results import Response
from stylobate.run_arguments import Accuracy


class HierarchyArguments(Accuracy, total=False):
    """Arguments that all models of a comparison share; each model uses the dissipation parameters that it declares.

    They are `damping`, `spin_damping`, `rolling_resistance`, `restitution`, and `rtol`, `atol`, `tilt_limit`,
    `rest_energy`, `max_steps` and `rules` as in `simulate`.
    """

    damping: float
    spin_damping: float
    rolling_resistance: float
    restitution: float | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """A column with its dissipation, a base motion and an initial state.

    Parameters
    ----------
    column, motion
        The column and its base motion.
    dissipation
        Dissipation parameters by name; each model uses the parameters that it declares. None selects the default.
    tilt, tilt_rate, spin
        Initial conditions [rad], [rad/s], [rad/s].
    """

    column: Column
    motion: BaseMotion
    dissipation: Mapping[str, float | None]
    tilt: tuple[float, float]
    tilt_rate: tuple[float, float]
    spin: float

    def scaled_to(self, slenderness: float) -> "Case":
        """Return the case that is equivalent for small tilts: tilt, tilt rate and base motion are proportional to c.

        Height, transverse inertia and spin stay constant, and with them ω0 and κ.
        """
        factor = slenderness / self.column.slenderness
        return Case(
            column=self.column.with_slenderness(slenderness),
            motion=self.motion.scaled(factor),
            dissipation=self.dissipation,
            tilt=(factor * self.tilt[0], factor * self.tilt[1]),
            tilt_rate=(factor * self.tilt_rate[0], factor * self.tilt_rate[1]),
            spin=self.spin,
        )

    @property
    def in_a_plane(self) -> bool:
        """Whether initial conditions and base motion are planar, without spin."""
        directions = (self.tilt, self.tilt_rate, *self.motion.directions())
        moving = any(any(direction) for direction in directions)
        return self.spin == 0.0 and (not moving or common_line(*directions) is not None)

    def models(self) -> tuple[Model, ...]:
        """Return the models, the simplest first; planar rocking is last, if the motion is planar."""
        models = (Slender, SlenderRolling, Wobbling, Rolling, *((PlanarRocking,) if self.in_a_plane else ()))
        return tuple(self._model(model) for model in models)

    def _model(self, model: Callable[..., Model]) -> Model:
        declared = dissipation_of(model)
        stated = {name: value for name, value in self.dissipation.items() if name in declared and value is not None}
        return model(self.column, **stated)

    def run(
        self, model: Model, duration: float, friction_coefficient: float | None, arguments: Mapping[str, Any]
    ) -> Response:
        """Run one model; a model without spin starts without spin."""
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
