"""The slender column without rotation about the vertical: equations (1) of the source paper."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from stylobate.column import Column
from stylobate.models.contact import contact_outputs, path_outputs
from stylobate.models.declared import Damping
from stylobate.models.model import Balance, ClosedForm, Floats, Output, Push, RollingLaw, TiltVectorModel
from stylobate.models.vertical import departing_lean, pass_vertical

# Keeps 1/|α| finite at the vertical, far below any resolved tilt.
_TINY = 1e-300


def rates(
    x: float, y: float, vx: float, vy: float, ax: float, ay: float, az: float, c: float, eta: float, _kappa: float
) -> tuple[float, float, float, float]:
    """Return the right-hand side of (1): rates of tilt vector and tilt rate."""
    # (1): α̈ = (1 + a_z)(α − c û) − η α̇ − a_h, û = α/|α|
    weight = 1.0 + az
    lean = weight * (1.0 - c / math.sqrt(x * x + y * y + _TINY))
    return vx, vy, lean * x - eta * vx - ax, lean * y - eta * vy - ay


def planar_rates(
    tilt: float, rate: float, side: float, horizontal: float, vertical: float, c: float, eta: float, *_: float
) -> tuple[float, float]:
    """Return the right-hand side of (1) in a vertical plane, with û = `side` (±1)."""
    return rate, (1.0 + vertical) * (tilt - c * side) - eta * rate - horizontal


def rest_energy(tilt: float, speed: float, vertical: float, c: float, *_: float) -> float:
    """Return ½|α̇|² + c(1 + a_z)|α|, the energy above rest."""
    return 0.5 * speed * speed + c * (1.0 + vertical) * tilt


def no_return_tilt(peak_horizontal: float, minimum_vertical: float, c: float, *_: float) -> float:
    """Return the point of no return, c + sup|a_h|/(1 + inf a_z) [rad]; infinite if 1 + inf a_z ≤ 0.

    From (6), Ä ≥ (1 + a_z)(A − c) − |a_h| − ηȦ: beyond this tilt Ȧ stays positive or zero.
    """
    weight = 1.0 + minimum_vertical
    return c + peak_horizontal / weight if weight > 0.0 else math.inf


def contact(
    x: float, y: float, vx: float, vy: float, ax: float, ay: float, az: float, c: float, eta: float, kappa: float
) -> tuple[float, float, float]:
    """Return N = 1 + a_z, |T| = |a_h + κα̈| and the moment |M_z| = |T_n| that prevents rotation, to leading order."""
    _, _, bx, by = rates(x, y, vx, vy, ax, ay, az, c, eta, kappa)
    tx, ty = ax + kappa * bx, ay + kappa * by
    across = (x * ty - y * tx) / math.sqrt(x * x + y * y + _TINY)
    return 1.0 + az, math.sqrt(tx * tx + ty * ty), abs(across)


def departure(push: Push, elapsed: float, c: float, eta: float, *_: float) -> tuple[float, float, float, float]:
    """Return the state a short time after uplift."""
    return departing_lean(push, elapsed, eta, 1.0, (push.acceleration - push.excess) / c, 1.0)[:4]


def passage(
    x: float, y: float, vx: float, vy: float, ax: float, ay: float, az: float, c: float, eta: float, *_: float
) -> tuple[float, tuple[float, float, float, float]]:
    """Return the duration and the end state of a straight passage of the vertical."""
    return pass_vertical((x, y, vx, vy), (-ax, -ay), c * (1.0 + az), 0.0, eta, 1.0)


@dataclass(frozen=True, slots=True)
class Slender(TiltVectorModel):
    """A slender column: small tilt, no slip, no rotation about the vertical; equations (1).

    α̈ = (1 + a_z)(α − c û) − η α̇ − a_h with û = α/|α|, in units of 1/ω0 and g. At α = 0 the base rests flat and û is
    any vector of length up to 1: the column stays while |a_h| ≤ c(1 + a_z).

    Parameters
    ----------
    column
        The column; its slenderness c must be well below 1 for small errors.
    damping
        Viscous damping η = D1/(ω0 J0), dimensionless; D1 is `damping_coefficient` [N m s].

    Raises
    ------
    ParameterError
        If `column` is not a Column, or `damping` is negative or not finite.

    Notes
    -----
    Source: "Dynamic of a cylindrical column on a vibrating base" (Vibroengineering Procedia), equations (1), with
    the vertical acceleration a_z added. Errors of the model are of the order c².
    """

    column: Column
    damping: Damping = 0.0

    name: ClassVar[str] = "slender"

    rates = staticmethod(rates)
    contact = staticmethod(contact)
    planar_rates = staticmethod(planar_rates)
    rest_energy = staticmethod(rest_energy)
    no_return_tilt = staticmethod(no_return_tilt)
    departure = staticmethod(departure)
    passage = staticmethod(passage)

    @property
    def damping_coefficient(self) -> float:
        """D1 = η ω0 J0, damping couple per angular velocity [N m s]."""
        return self.damping * self.column.frequency_scale * self.column.base_inertia

    @property
    def parameters(self) -> tuple[float, ...]:
        """c, η and κ."""
        return self.column.slenderness, self.damping, self.column.inertia_ratio

    @property
    def comes_to_rest(self) -> bool:
        """Whether there is damping."""
        return self.damping > 0.0

    @property
    def balance(self) -> Balance:
        """At the tilt c, with the energy ½c² J0 ω0²."""
        c, unit = self.column.slenderness, self.column.base_inertia * self.column.frequency_scale**2
        return Balance(tilt=c, energy=0.5 * c * c * unit)

    @property
    def closed_form(self) -> ClosedForm:
        """Equation (8)."""
        return ClosedForm(RollingLaw.SLENDER, self.damping)

    def energy(self, states: Floats) -> Floats:
        """Return ½|α̇|² + cA − ½A² in units of J0 ω0² [J]."""
        x, y, vx, vy = states[:4]
        tilt = np.hypot(x, y)
        unit = self.column.base_inertia * self.column.frequency_scale
        energy: Floats = 0.5 * (vx**2 + vy**2) + self.column.slenderness * tilt - 0.5 * tilt**2
        return energy * unit * self.column.frequency_scale

    def outputs(self, states: Floats, accelerations: Floats, resting: npt.NDArray[np.bool_]) -> Mapping[str, Output]:
        """Return energy [J], angular momentum about the vertical [kg m²/s] and contact loads.

        Energy is ½|α̇|² + cA − ½A² in units of J0 ω0², 0 at rest; angular momentum A²β̇ in units of J0 ω0: the two
        integrals of free motion (page "free motion"). The centre of pressure [m] lies at −h a_h/(1 + a_z)
        from the axis while the column stands, at the contact point of the rim while it leans. Normal force [N],
        friction over it, and moment about the vertical over normal force and radius: see `contact_outputs`.
        """
        x, y, vx, vy = states
        column = self.column
        unit = column.base_inertia * column.frequency_scale
        tilt = np.hypot(x, y)
        momentum = x * vy - y * vx
        ax, ay, az = accelerations
        with np.errstate(invalid="ignore", divide="ignore"):
            standing = -column.mass_height * np.stack([ax, ay]) / (1.0 + az)
            leaning = column.radius * np.stack([x, y]) / tilt
        pressure = np.where(resting, standing, leaning)
        return {
            "energy": Output(self.energy(states), "J", "energy above rest"),
            "angular_momentum": Output(momentum * unit, "kg m2 s-1", "angular momentum about the vertical"),
            "centre_of_pressure": Output(pressure.T, "m", "centre of pressure from the axis"),
            **path_outputs(self, states, np.zeros((states.shape[1], 2))),
            **contact_outputs(self, states, accelerations, resting),
        }
