"""The rocking body in a vertical plane: Housner's block, at finite angles, with restitution at its impacts."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np
import numpy.typing as npt

from stylobate.column import Column
from stylobate.column.numbers import STANDARD_GRAVITY
from stylobate.errors import require_positive
from stylobate.models import finite_tilt
from stylobate.models.contact import contact_outputs, path_outputs
from stylobate.models.declared import Damping, Restitution, RollingResistance
from stylobate.models.finite_tilt import TINY, FiniteTiltModel, planar_acceleration
from stylobate.models.model import Balance, Floats, Output


def rates(
    x: float,
    y: float,
    vx: float,
    vy: float,
    ax: float,
    ay: float,
    az: float,
    c: float,
    eta: float,
    kappa: float,
    resistance: float,
    _restitution: float,
) -> tuple[float, float, float, float]:
    """Return the rates of tilt vector and tilt rate of a motion in the plane in which the body leans."""
    tilt = math.sqrt(x * x + y * y + TINY)
    ux, uy = x / tilt, y / tilt
    rate, horizontal = vx * ux + vy * uy, ax * ux + ay * uy
    acceleration, _, _ = planar_acceleration(tilt, rate, 1.0, horizontal, az, c, eta, kappa, resistance)
    return vx, vy, acceleration * ux, acceleration * uy


def contact(
    x: float,
    y: float,
    vx: float,
    vy: float,
    ax: float,
    ay: float,
    az: float,
    c: float,
    eta: float,
    kappa: float,
    resistance: float,
    _restitution: float,
) -> tuple[float, float, float]:
    """Return N and |T| over m g, and the moment about the vertical, which is zero."""
    tilt = math.sqrt(x * x + y * y + TINY)
    ux, uy = x / tilt, y / tilt
    rate, horizontal = vx * ux + vy * uy, ax * ux + ay * uy
    _, normal, swept = planar_acceleration(tilt, rate, 1.0, horizontal, az, c, eta, kappa, resistance)
    return normal, abs(swept), 0.0


@dataclass(frozen=True, slots=True)
class PlanarRocking(FiniteTiltModel):
    """A body that rocks in a vertical plane from one edge to the other: Housner's model, at finite angles.

    Initial tilt and base motion must lie in one vertical plane. The model uses the half width r, the height h of the
    centre of mass and the transverse inertia; `PlanarRocking.block` makes the rectangular block of the literature.

    Parameters
    ----------
    column
        The body.
    damping
        Viscous damping η = D1/(ω0 J0).
    rolling_resistance
        Lever arm μ_r of the normal force, in units of the radius, against the angular velocity.
    restitution
        e, fraction of the angular velocity that remains after an impact; None for Housner's value 1 − 2 m r²/K, by
        which the body keeps its angular momentum about the edge on which it lands. Measured values lie on either side.

    Raises
    ------
    ParameterError
        If `column` is not a Column, a damping parameter is negative or not finite, or `restitution` is outside 0 to 1.

    Notes
    -----
    K = J0 + m r². Sources: G. W. Housner, "The behavior of inverted pendulum structures during earthquakes", Bulletin
    of the Seismological Society of America 53 (1963).
    """

    column: Column
    damping: Damping = 0.0
    rolling_resistance: RollingResistance = 0.0
    restitution: Restitution | None = None

    name: ClassVar[str] = "planar rocking"
    planar_only: ClassVar[bool] = True

    @classmethod
    def block(
        cls,
        *,
        width: float,
        height: float,
        density: float,
        damping: float = 0.0,
        restitution: float | None = None,
        gravity: float = STANDARD_GRAVITY,
    ) -> Self:
        """Describe a uniform rectangular block in its plane, 1 m thick across it.

        Parameters
        ----------
        width, height
            Width and height of the block [m].
        density
            Density [kg/m³].
        damping, restitution
            As in the model; Housner's restitution is 1 − 1.5 sin²α_c here, with tan α_c = width/height.
        gravity
            Acceleration of gravity [m/s²].

        Raises
        ------
        ParameterError
            If a number is not positive.
        """
        width, height = require_positive("width", width, "m"), require_positive("height", height, "m")
        mass = require_positive("density", density, "kg/m³") * width * height
        transverse = mass * (width**2 + height**2) / 12.0
        # Planar motion does not use the axial inertia; this is its value for a square base.
        column = Column(
            radius=0.5 * width,
            mass_height=0.5 * height,
            mass=mass,
            transverse_inertia=transverse,
            axial_inertia=mass * width**2 / 6.0,
            height=height,
            gravity=gravity,
        )
        return cls(column, damping=damping, restitution=restitution)

    rates = staticmethod(rates)
    contact = staticmethod(contact)
    no_return_tilt = staticmethod(finite_tilt.no_return_tilt)

    @property
    def impact_restitution(self) -> float:
        """e; Housner's value if `restitution` is None."""
        return self.column.housner_restitution if self.restitution is None else self.restitution

    @property
    def parameters(self) -> tuple[float, ...]:
        """c, η, κ, δ/r and e."""
        column = self.column
        numbers = (column.slenderness, self.damping, column.inertia_ratio)
        return (*numbers, self.rolling_resistance, self.impact_restitution)

    @property
    def loss_tilt(self) -> float:
        """Positive if impacts lose energy [rad]; every planar passage of the vertical is an impact."""
        return finite_tilt.loss_tilt(self.column, self.impact_restitution, None)

    @property
    def balance(self) -> Balance:
        """At the tilt atan c, with the energy m g (R − h)."""
        return finite_tilt.balance(self.column)

    def energy(self, states: Floats) -> Floats:
        """Return ½Kθ̇² + c sin θ − (1 − cos θ) in units of m g h [J]."""
        column, (x, y, vx, vy) = self.column, states[:4]
        c = column.slenderness
        kinetic = 0.5 * (1.0 + column.inertia_ratio * c * c) * (vx**2 + vy**2)
        energy: Floats = kinetic + finite_tilt.potential(np.hypot(x, y), c)
        return energy * (column.mass * column.gravity * column.mass_height)

    def outputs(self, states: Floats, accelerations: Floats, resting: npt.NDArray[np.bool_]) -> Mapping[str, Output]:
        """Return energy, contact point and contact loads."""
        outputs = {
            "energy": Output(self.energy(states), "J", "energy above rest"),
            **path_outputs(self, states, np.zeros((states.shape[1], 2))),
            **contact_outputs(self, states, accelerations, resting),
        }
        del outputs["footprint"]
        return outputs
