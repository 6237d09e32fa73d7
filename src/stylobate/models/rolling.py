"""The column that rolls without slip at finite tilt, with free axial rotation (spin)."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from stylobate.column import Column
from stylobate.models import finite_tilt
from stylobate.models.contact import contact_outputs, path_outputs
from stylobate.models.declared import Damping, PassageTilt, Restitution, RollingResistance, SpinDamping
from stylobate.models.finite_tilt import TINY, FiniteTiltModel, cosine, sine_over_angle, tilt_acceleration
from stylobate.models.model import Balance, ClosedForm, Floats, Output, Push, RollingLaw, SpinningModel, zero
from stylobate.models.vertical import departure_with_spin, passage_with_spin


def balance(
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
    resistance: float,
) -> tuple[float, float, float, float, float, float, float]:
    """Return the rates of the tilt rate and of the spin; N, T_d, T_n over m g and M_z over m g h."""
    square = x * x + y * y + TINY
    tilt = math.sqrt(square)
    ux, uy = x / tilt, y / tilt
    per_angle, cos = sine_over_angle(square), cosine(square)
    sine = per_angle * tilt
    turning = vy * ux - vx * uy  # θ β̇
    around = turning / tilt  # β̇
    w1, w2, w3 = -per_angle * turning, vx * ux + vy * uy, spin
    outward, across = ax * ux + ay * uy, ay * ux - ax * uy
    transverse, inertia = 1.0 - kappa, kappa * axial * c * c  # I_t, I_a
    height, slope = cos + c * sine, c * cos - sine  # ρ', z'
    # K θ̈ = −(1 + a_z) z' − ρ' a_d − κρ'β̇ w + (1 − κ)β̇² sin θ cos θ − I_a β̇ sin θ w3 + M2,  w = c w3 − β̇ sin θ
    whirl = -around * (w1 * (cos + kappa * c * sine) + kappa * c * (height + axial * c * sine) * w3)
    moment = whirl - (1.0 + az) * slope - height * outward - eta * w2
    rolling = w1 * cos + w3 * sine  # the angular rate about d
    falling, normal, drag = tilt_acceleration(moment, w2, rolling, sine, cos, 1.0 + az, c, kappa, resistance)
    # The couples: −ηw1; −ζP ω_z about the vertical, P = I_a Λ/i_a; rolling resistance about d.
    spin_inertia = kappa * c * c * (1.0 + axial - kappa)  # P
    pivoting = zeta * spin_inertia * (w3 * cos - w1 * sine)
    dragged = drag * rolling
    m1 = pivoting * sine - eta * w1 - dragged * cos
    m3 = -pivoting * cos - dragged * sine
    # I_t (ẇ1 − w2 β̇ cos θ) = T_n + M1 − I_a w2 w3 and I_a ẇ3 = c T_n + M3, with rolling without slip,
    # T_n = a_n − κ(c ẇ3 + ẇ1 − ρ'θ̇β̇), solved for the rates: with F = M1 − I_a w2 w3 and A = a_n − κc w1 w2,
    # P (ẇ1 − w2 β̇ cos θ) = κc (c (F + i_a (F + A)) − M3),  P ẇ3 = c (I_t A − κF) + M3.
    turned, carried = m1 - inertia * w2 * w3, across - kappa * c * w1 * w2
    per_inertia = 1.0 / spin_inertia
    driven = kappa * c * (per_inertia * (c * (turned + axial * (turned + carried)) - m3))
    spin_rate = per_inertia * (c * (transverse * carried - kappa * turned) + m3)
    friction = (inertia * spin_rate - m3) / c  # T_n
    # α̈ along u and across, from θ̈ and from ẇ1 = −d(β̇ sin θ)/dτ.
    inward = falling - turning * around
    sideways = (2.0 * w2 * around * (per_angle - cos) - driven) / per_angle
    # T_d = a_d + κ(ρ'θ̈ + z'θ̇² + β̇ w)
    swept = outward + kappa * (height * falling + slope * w2 * w2 + around * (c * w3 + w1))
    return (
        inward * ux - sideways * uy,
        inward * uy + sideways * ux,
        spin_rate,
        normal,
        swept,
        friction,
        -pivoting,
    )


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
    kappa: float,
    resistance: float,
    _restitution: float,
    zeta: float,
    axial: float,
) -> tuple[float, float, float, float, float]:
    """Return the rates of tilt vector, tilt rate and spin w3/ω0."""
    bx, by, spin_rate, _, _, _, _ = balance(x, y, vx, vy, spin, ax, ay, az, c, eta, zeta, kappa, axial, resistance)
    return vx, vy, bx, by, spin_rate


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
    kappa: float,
    resistance: float,
    _restitution: float,
    zeta: float,
    axial: float,
) -> tuple[float, float, float]:
    """Return N and |T| over m g, and the moment |M_z| of the spin damping over m g r."""
    _, _, _, normal, along, across, moment = balance(
        x, y, vx, vy, spin, ax, ay, az, c, eta, zeta, kappa, axial, resistance
    )
    return normal, math.sqrt(along * along + across * across), abs(moment) / c


def carried_rates(x: float, y: float, vx: float, vy: float, spin: float, *_: float) -> tuple[float, float, float]:
    """Return χ̇ = w3 − w1 tan(θ/2) and, in radii, the rate −χ̇ n of the centre of the footprint circle."""
    square = x * x + y * y + TINY
    # w1 tan(θ/2) = −β̇ sin²θ/(1 + cos θ)
    twisting = spin + (1.0 - cosine(square)) * (x * vy - y * vx) / square
    tilt = math.sqrt(square)
    return twisting, twisting * y / tilt, -twisting * x / tilt


def departure(
    push: Push,
    elapsed: float,
    c: float,
    eta: float,
    kappa: float,
    resistance: float,
    _restitution: float,
    _zeta: float,
    axial: float,
) -> tuple[float, float, float, float, float]:
    """Return the state a short time after uplift."""
    return departure_with_spin(
        push, elapsed, finite_tilt.uplift_terms(push, c, eta, kappa, resistance), c, kappa, axial
    )


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
    kappa: float,
    _resistance: float,
    _restitution: float,
    zeta: float,
    axial: float,
) -> tuple[float, tuple[float, float, float, float, float]]:
    """Return the duration and the end state of a passage of the vertical; the spin bends the path."""
    return passage_with_spin((x, y, vx, vy), spin, (ax, ay, az), 1.0 + kappa * c * c, c, eta, zeta, kappa, axial)


def impact_map(
    x: float,
    y: float,
    vx: float,
    vy: float,
    spin: float,
    _c: float,
    _eta: float,
    _kappa: float,
    _resistance: float,
    restitution: float,
    *_: float,
) -> tuple[float, float, float, float, float]:
    """Return the state after a passage of the vertical with loss: the tilt rate times the restitution."""
    return x, y, restitution * vx, restitution * vy, spin


@dataclass(frozen=True, slots=True)
class Rolling(SpinningModel, FiniteTiltModel):
    """A rigid column that rolls without slip on the rim of its base, with spin, at any tilt below π/2.

    Its state is the tilt vector α = θ(cos β, sin β), its rate and the spin w3, the angular velocity about its axis;
    twist and footprint follow from them. The equations are regular at the vertical except for a physical singularity:
    the contact point races round the rim, by the angle π√(K/J0) if the column has no spin.

    Parameters
    ----------
    column
        The column.
    damping
        Viscous damping η = D1/(ω0 J0), a couple −D1 times the angular velocity across the axis: −D1(w1 u + w2 n), n
        horizontal and u across axis and n.
    spin_damping
        ζ, by a moment −D0 times the angular velocity about the vertical, D0 = ζ ω0 I_a Λ/i_a: a column that spins
        upright loses its spin at the rate ζ ω0.
    rolling_resistance
        Lever arm μ_r of the normal force, in units of the radius: a couple μ_r r N against the horizontal component of
        the angular velocity, which fades out below the rate 1e-3 ω0. This loss falls while a flat body settles; that of
        measured disks grows.
    restitution
        e, fraction of the tilt rate that remains after a passage of the vertical; 1 for no loss, the limit of grazing
        rolling. `theory.housner_restitution` computes Housner's value for planar impacts.
    passage_tilt
        Minimum tilt below which a swing counts as a passage of the vertical [rad]; by default 0.01 c.

    Raises
    ------
    ParameterError
        If `column` is not a Column, a damping parameter is negative or not finite, or `restitution` is outside 0 to 1.

    Notes
    -----
    A tilt of π/2 counts as overturned: no point of no return is known for a column with spin. With κ = m h²/J0,
    i_a = I_a/(m r²), Λ = 1 + i_a − κ, in units of 1/ω0, h and g, w = c w3 + w1, d and n horizontal along the lean and
    across it, the equations are those of Newton and Euler with the force N, T_d, T_n at the contact, and

    K θ̈ = −(1 + a_z) z' − ρ' a_d − κρ'β̇w + (1 − κ)β̇² sin θ cos θ − I_a β̇ w3 sin θ + M2,
    (1 − κ) ẇ1 = (1 − κ) β̇θ̇ cos θ − I_a θ̇ w3 + T_n + M1,   I_a ẇ3 = c T_n + M3.
    """

    column: Column
    damping: Damping = 0.0
    spin_damping: SpinDamping = 0.0
    rolling_resistance: RollingResistance = 0.0
    restitution: Restitution = 1.0
    passage_tilt: PassageTilt | None = None

    name: ClassVar[str] = "rolling"
    carried_names: ClassVar[tuple[str, ...]] = ("twist", "footprint_x", "footprint_y")

    rates = staticmethod(rates)
    contact = staticmethod(contact)
    carried_rates = staticmethod(carried_rates)
    departure = staticmethod(departure)
    passage = staticmethod(passage)
    impact_map = staticmethod(impact_map)

    @property
    def parameters(self) -> tuple[float, ...]:
        """c, η, κ, δ/r, e, ζ and i_a."""
        column = self.column
        losses = (self.rolling_resistance, self.restitution)
        return (column.slenderness, self.damping, column.inertia_ratio, *losses, self.spin_damping, column.axial_ratio)

    @property
    def loss_tilt(self) -> float:
        """Tilt below which a passage of the vertical loses energy [rad]; 0 without loss."""
        return finite_tilt.loss_tilt(self.column, self.restitution, self.passage_tilt)

    def outputs(self, states: Floats, accelerations: Floats, resting: npt.NDArray[np.bool_]) -> Mapping[str, Output]:
        """Return spin, twist, footprint, path of the contact point, energy and contact loads."""
        column, scale = self.column, self.time_scale
        spin, twist = states[4:6]
        return {
            "spin": Output(spin / scale, "rad s-1", "angular velocity about the axis"),
            "twist": Output(twist, "rad", "angle of turn about the axis"),
            **path_outputs(self, states, column.radius * states[6:8].T),
            "energy": Output(self.energy(states), "J", "energy above rest"),
            **contact_outputs(self, states, accelerations, resting),
        }

    @property
    def balance(self) -> Balance:
        """At the tilt atan c, with the energy m g (R − h)."""
        return finite_tilt.balance(self.column)

    @property
    def closed_form(self) -> ClosedForm:
        """Steady rolling without rolling resistance."""
        requires = zero(self, "rolling_resistance")
        return ClosedForm(RollingLaw.FULL, self.damping, self.spin_damping, requires)

    def energy(self, states: Floats) -> Floats:
        """Return ½Kθ̇² + ½κw² + ½(1 − κ)w1² + ½I_a w3² + c sin θ − (1 − cos θ) in units of m g h [J]."""
        column = self.column
        c, kappa = column.slenderness, column.inertia_ratio
        x, y, vx, vy, w3 = states[:5]
        tilt = np.hypot(x, y)
        with np.errstate(invalid="ignore", divide="ignore"):
            w2 = np.where(tilt > 0.0, (x * vx + y * vy) / tilt, np.hypot(vx, vy))
            w1 = np.where(tilt > 0.0, -np.sin(tilt) * (x * vy - y * vx) / tilt**2, 0.0)
        kinetic = (1.0 + kappa * c * c) * w2**2 + kappa * (c * w3 + w1) ** 2 + (1.0 - kappa) * w1**2
        kinetic += kappa * column.axial_ratio * c * c * w3**2
        energy: Floats = 0.5 * kinetic + finite_tilt.potential(tilt, c)
        return column.mass * column.gravity * column.mass_height * energy
