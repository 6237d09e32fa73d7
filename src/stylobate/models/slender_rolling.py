"""The slender column that rolls without slip, with free axial rotation (spin)."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, ClassVar, Literal

import numpy as np
import numpy.typing as npt

from stylobate.column import Column
from stylobate.models import slender
from stylobate.models.contact import contact_outputs, path_outputs
from stylobate.models.declared import Damping, SpinDamping
from stylobate.models.model import Balance, ClosedForm, Floats, Output, Push, RollingLaw, SpinningModel
from stylobate.models.vertical import departure_with_spin, passage_with_spin
from stylobate.quantities import Quantity

# As in the slender model: keeps 1/|α| finite at the vertical.
_TINY = 1e-300

Couples = Annotated[
    Literal["contact", "isotropic"], Quantity(text="whether the damping couples act on the contact force too")
]


def rates(
    x: float,
    y: float,
    vx: float,
    vy: float,
    spin: float,
    ax: float,
    ay: float,
    az: float,
    c: float,
    eta: float,
    zeta: float,
    kappa: float,
    axial: float,
    contact: float,
) -> tuple[float, float, float, float, float]:
    """Return the rates of tilt vector, tilt rate and spin σ = w3/ω0; `contact` is 1 or, for isotropic couples, 0."""
    tilt = math.sqrt(x * x + y * y + _TINY)
    ux, uy = x / tilt, y / tilt
    freedom = 1.0 + axial - kappa  # Λ
    across = ay * ux - ax * uy  # of the base acceleration
    turning = vy * ux - vx * uy  # of the tilt rate: |α| β̇
    # Along n = (−u_y, u_x): the share of the base acceleration that changes the spin; the reaction of the couples
    # through the contact force.
    given = across * (1.0 - kappa) / freedom
    reaction = contact * (eta * (kappa / freedom) * turning + c * kappa * zeta * spin)
    sideways = given - reaction
    # Along u: gravity, and the gyroscopic couple of the spin.
    weight = 1.0 + az
    inward = weight * c + c * kappa * spin * turning / tilt
    spin_rate = across * (1.0 - kappa) / (c * kappa * freedom) - contact * eta * turning / (c * freedom) - zeta * spin
    return (
        vx,
        vy,
        weight * x - inward * ux - eta * vx - ax - sideways * uy,
        weight * y - inward * uy - eta * vy - ay + sideways * ux,
        spin_rate,
    )


def planar_rates(
    tilt: float, rate: float, side: float, horizontal: float, vertical: float, c: float, eta: float, *_: float
) -> tuple[float, float]:
    """Return the right-hand side of planar motion, which has no spin: that of the slender model."""
    return rate, (1.0 + vertical) * (tilt - c * side) - eta * rate - horizontal


def rest_energy(tilt: float, speed: float, vertical: float, c: float, *_: float) -> float:
    """Return ½|α̇|² + c(1 + a_z)|α|, the energy above rest without that of the spin."""
    return 0.5 * speed * speed + c * (1.0 + vertical) * tilt


def contact(
    x: float,
    y: float,
    vx: float,
    vy: float,
    spin: float,
    ax: float,
    ay: float,
    az: float,
    c: float,
    eta: float,
    zeta: float,
    kappa: float,
    axial: float,
    couples: float,
) -> tuple[float, float, float]:
    """Return N = 1 + a_z, |T| and the moment |M_z| of the spin damping, to leading order.

    T = a_h + κ(α̈ + cσβ̇ û − cσ̇ n): the centre of mass moves with the footprint, whose velocity is −cσ n.
    """
    _, _, bx, by, spin_rate = rates(x, y, vx, vy, spin, ax, ay, az, c, eta, zeta, kappa, axial, couples)
    tilt = math.sqrt(x * x + y * y + _TINY)
    ux, uy = x / tilt, y / tilt
    around = spin * (vy * ux - vx * uy) / tilt
    tx = ax + kappa * (bx + c * (around * ux + spin_rate * uy))
    ty = ay + kappa * (by + c * (around * uy - spin_rate * ux))
    moment = zeta * (1.0 + axial - kappa) * kappa * c * spin
    return 1.0 + az, math.sqrt(tx * tx + ty * ty), abs(moment)


def carried_rates(x: float, y: float, _vx: float, _vy: float, spin: float, *_: float) -> tuple[float, float, float]:
    """Return χ̇ = w3 and, in radii, the rate −χ̇ n of the centre of the footprint circle, to leading order."""
    tilt = math.sqrt(x * x + y * y + _TINY)
    return spin, spin * y / tilt, -spin * x / tilt


def departure(
    push: Push, elapsed: float, c: float, eta: float, _zeta: float, kappa: float, axial: float, *_: float
) -> tuple[float, float, float, float, float]:
    """Return the state a short time after uplift."""
    return departure_with_spin(push, elapsed, (eta, 1.0, (push.acceleration - push.excess) / c), c, kappa, axial)


def passage(
    x: float,
    y: float,
    vx: float,
    vy: float,
    spin: float,
    ax: float,
    ay: float,
    az: float,
    c: float,
    eta: float,
    zeta: float,
    kappa: float,
    axial: float,
    *_: float,
) -> tuple[float, tuple[float, float, float, float, float]]:
    """Return the duration and the end state of a passage of the vertical; the spin bends the path."""
    return passage_with_spin((x, y, vx, vy), spin, (ax, ay, az), 1.0, c, eta, zeta, kappa, axial)


@dataclass(frozen=True, slots=True)
class SlenderRolling(SpinningModel):
    """A slender column that rolls without slip, with spin, at small tilt.

    With σ = w3/ω0, κ = m h²/J0, i_a = I_a/(m r²), Λ = 1 + i_a − κ, û = α/|α|, n across it, a_n = a_h·n, and contact
    couples,

    α̈ = (1 + a_z)(α − c û) − a_h + n a_n (1 − κ)/Λ − cκσβ̇ û − η[(α̇·û)û + ((1 + i_a)/Λ)(α̇·n) n] − cκζσ n,
    σ̇ = a_n (1 − κ)/(cκΛ) − (η/(cΛ)) (α̇·n) − ζσ,

    in units of 1/ω0 and g. The base spins the column up. Across its lean, a column with spin responds to a base
    acceleration with i_a/Λ of the response of a column without spin.

    Parameters
    ----------
    column
        The column; its slenderness c must be well below 1 for small errors.
    damping
        Viscous damping η = D1/(ω0 J0), a couple −D1 against the rate of tilt.
    spin_damping
        ζ, by a moment −D0 times the angular velocity about the vertical, D0 = ζ ω0 I_a Λ/i_a: a column that spins
        upright loses its spin at the rate ζ ω0. Without spin damping, but with damping, steady rolling dies out.
    couples
        "contact": both couples act on the rolling body, and so through the force at the contact too; this is the limit
        of the body at finite tilt. "isotropic": −η α̇ and −ζσ alone, as in the equations of a column that cannot turn.

    Raises
    ------
    ParameterError
        If `column` is not a Column, `damping` or `spin_damping` is negative or not finite, or `couples` is unknown.

    Notes
    -----
    A tilt of π/2 counts as overturned: no point of no return is known for a column with spin.
    """

    column: Column
    damping: Damping = 0.0
    spin_damping: SpinDamping = 0.0
    couples: Couples = "contact"

    name: ClassVar[str] = "slender rolling"
    carried_names: ClassVar[tuple[str, ...]] = ("twist", "footprint_x", "footprint_y")

    rates = staticmethod(rates)
    contact = staticmethod(contact)
    carried_rates = staticmethod(carried_rates)
    planar_rates = staticmethod(planar_rates)
    rest_energy = staticmethod(rest_energy)
    departure = staticmethod(departure)
    passage = staticmethod(passage)

    @property
    def parameters(self) -> tuple[float, ...]:
        """c, η, ζ, κ, i_a, and 1 for contact couples, else 0."""
        column = self.column
        numbers = (column.slenderness, self.damping, self.spin_damping, column.inertia_ratio, column.axial_ratio)
        return (*numbers, float(self.couples == "contact"))

    @property
    def comes_to_rest(self) -> bool:
        """Whether there is damping."""
        return self.damping > 0.0

    @property
    def balance(self) -> Balance | None:
        """The balance of the slender model; None with isotropic couples, which can raise the energy from the spin."""
        return slender.Slender(self.column).balance if self.couples == "contact" else None

    @property
    def closed_form(self) -> ClosedForm:
        """Steady rolling with spin, known for contact couples."""
        requires = None if self.couples == "contact" else ("couples", "contact")
        return ClosedForm(RollingLaw.FREE_TWIST, self.damping, self.spin_damping, requires)

    def energy(self, states: Floats) -> Floats:
        """Return ½|α̇|² + cA − ½A² − cκσ Aβ̇ + ½κ(1 + i_a)c²σ² in units of J0 ω0² [J]."""
        column, (x, y, vx, vy, spin) = self.column, states[:5]
        c, kappa = column.slenderness, column.inertia_ratio
        unit = column.base_inertia * column.frequency_scale**2
        tilt = np.hypot(x, y)
        with np.errstate(invalid="ignore", divide="ignore"):
            across = np.where(tilt > 0.0, (x * vy - y * vx) / tilt, 0.0)
        energy: Floats = 0.5 * (vx**2 + vy**2) + c * tilt - 0.5 * tilt**2
        energy += kappa * c * spin * (0.5 * (1.0 + column.axial_ratio) * c * spin - across)
        return energy * unit

    def outputs(self, states: Floats, accelerations: Floats, resting: npt.NDArray[np.bool_]) -> Mapping[str, Output]:
        """Return energy, spin, twist, footprint, path of the contact point and contact loads.

        The energy is ½|α̇|² + cA − ½A² − cκσ Aβ̇ + ½κ(1 + i_a)c²σ² in units of J0 ω0². The centre of pressure is that of
        the slender model; the moment about the vertical is that of the spin damping.
        """
        column, scale = self.column, self.time_scale
        spin, twist = states[4:6]
        plain = slender.Slender(column, damping=self.damping).outputs(states[:4], accelerations, resting)
        return {
            "energy": Output(self.energy(states), "J", "energy above rest"),
            "spin": Output(spin / scale, "rad s-1", "angular velocity about the axis"),
            "twist": Output(twist, "rad", "angle of turn about the axis"),
            "centre_of_pressure": plain["centre_of_pressure"],
            **path_outputs(self, states, column.radius * states[6:8].T),
            **contact_outputs(self, states, accelerations, resting),
        }
