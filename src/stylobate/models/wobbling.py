"""The column at finite tilt without axial rotation: the slender model's constraint without its small angles."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, ClassVar, Literal

import numpy as np
import numpy.typing as npt

from stylobate.column import Column
from stylobate.models import finite_tilt
from stylobate.models.contact import contact_outputs, path_outputs
from stylobate.models.declared import Damping, PassageTilt, Restitution, RollingResistance
from stylobate.models.finite_tilt import TINY, FiniteTiltModel, cosine, sine_over_angle, tilt_acceleration
from stylobate.models.model import Balance, ClosedForm, Floats, Output, RollingLaw, zero
from stylobate.models.vertical import pass_vertical
from stylobate.quantities import Quantity

Constraint = Annotated[Literal["pure_tilt", "rubber"], Quantity(text="constraint on the axial rotation")]

# Keeps tan θ and its powers finite at θ = π/2.
_LEVEL = 1e-100


def balance(
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
    axial: float,
    resistance: float,
    rubber: float,
) -> tuple[float, float, float, float, float, float]:
    """Return the rates of the tilt rate; N, T_d, T_n over m g and M_z over m g h."""
    square = x * x + y * y + TINY
    tilt = math.sqrt(square)
    ux, uy = x / tilt, y / tilt
    per_angle, cos = sine_over_angle(square), cosine(square)
    sine = per_angle * tilt
    turning = vy * ux - vx * uy  # θ β̇
    around = turning / tilt  # β̇
    w1, w2 = -per_angle * turning, vx * ux + vy * uy
    outward, across = ax * ux + ay * uy, ay * ux - ax * uy
    height, slope = cos + c * sine, c * cos - sine  # ρ', z'
    # w3 = q w1: q = tan(θ/2) where ω·(e3 + Z) = 0, q = tan θ where ω·Z = 0.
    per_up = 1.0 / (cos + _LEVEL)
    bound, bisected = rubber * per_up, (1.0 - rubber) / (1.0 + cos)
    q = (bound + bisected) * sine
    w3 = q * w1
    whirl = -around * (w1 * (cos + kappa * c * sine) + kappa * c * (height + axial * c * sine) * w3)
    moment = whirl - (1.0 + az) * slope - height * outward - eta * w2
    rolling = w1 * cos + w3 * sine
    falling, normal, drag = tilt_acceleration(moment, w2, rolling, sine, cos, 1.0 + az, c, kappa, resistance)
    dragged = drag * rolling
    m1, m3 = -eta * w1 - dragged * cos, -dragged * sine
    # D (ẇ1 − β̇θ̇ cos θ) = (1 + qc) a_n + M1 + qM3 − B (1 + q' − q cos θ/sin θ) w1w2, B = κc(1 + qc) + q I_a,
    # D = I_t + q²I_a + κ(1 + qc)² = 1 + q(κc + B), as I_t + κ = 1
    inertia = kappa * axial * c * c  # I_a
    reach = 1.0 + q * c
    coupling = kappa * c * reach + q * inertia
    growth = 1.0 + bound * (per_up - cos) + bisected * (1.0 - cos)
    driven = (reach * across + m1 + q * m3 - coupling * growth * w1 * w2) / (1.0 + q * (kappa * c + coupling))
    w1_rate = around * cos * w2 + driven
    w3_rate = q * w1_rate + (bound * per_up + bisected) * w2 * w1
    # T_n = a_n − κ(ẇ − ρ'θ̇β̇); the couple that prevents rotation acts along e3 + Z, or along Z.
    friction = across - kappa * (c * w3_rate + w1_rate - height * w2 * around)
    couple = (inertia * w3_rate - c * friction - m3) * (bound + 1.0 - rubber)
    inward = falling - turning * around
    sideways = (2.0 * w2 * around * (per_angle - cos) - driven) / per_angle
    swept = outward + kappa * (height * falling + slope * w2 * w2 + around * (c * w3 + w1))
    return inward * ux - sideways * uy, inward * uy + sideways * ux, normal, swept, friction, couple


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
    axial: float,
    rubber: float,
) -> tuple[float, float, float, float]:
    """Return the rates of tilt vector and tilt rate."""
    bx, by, _, _, _, _ = balance(x, y, vx, vy, ax, ay, az, c, eta, kappa, axial, resistance, rubber)
    return vx, vy, bx, by


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
    axial: float,
    rubber: float,
) -> tuple[float, float, float]:
    """Return N and |T| over m g, and the moment |M_z| of the couple that prevents rotation, over m g r."""
    _, _, normal, along, across, couple = balance(x, y, vx, vy, ax, ay, az, c, eta, kappa, axial, resistance, rubber)
    return normal, math.sqrt(along * along + across * across), abs(couple) / c


def carried_rates(
    x: float,
    y: float,
    vx: float,
    vy: float,
    _c: float,
    _eta: float,
    _kappa: float,
    _resistance: float,
    _restitution: float,
    _axial: float,
    rubber: float,
) -> tuple[float, float, float]:
    """Return χ̇ = w3 − w1 tan(θ/2), 0 where ω·(e3 + Z) = 0, and the rate −χ̇ n of the footprint circle in radii."""
    square = x * x + y * y + TINY
    tilt, cos = math.sqrt(square), cosine(square)
    # w1 (tan θ − tan(θ/2)) = −β̇ (1 − cos θ)/cos θ
    twisting = -rubber * (x * vy - y * vx) / square * (1.0 - cos) / (cos + _LEVEL)
    return twisting, twisting * y / tilt, -twisting * x / tilt


def passage(
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
    *_: float,
) -> tuple[float, tuple[float, float, float, float]]:
    """Return the duration and the end state of a passage of the vertical; the azimuth turns by π√K."""
    inertia = 1.0 + kappa * c * c
    speed = math.hypot(vx, vy)
    ux, uy = vx / speed, vy / speed
    along, across = (ax * ux + ay * uy) / inertia, ay * ux - ax * uy
    push = (across * uy - along * ux, -across * ux - along * uy)
    return pass_vertical((x, y, vx, vy), push, c * (1.0 + az), 0.0, eta, inertia)


@dataclass(frozen=True, slots=True)
class Wobbling(FiniteTiltModel):
    """A rigid column that rolls on the rim of its base without axial rotation, at any tilt below π/2.

    Its angular velocity has no component along e3 + Z, the bisector of axis and vertical: it tilts without twist, and
    the footprint of its base stays in place. This is the holonomic form of the source paper's assumption.

    Parameters
    ----------
    column
        The column.
    damping
        Viscous damping η = D1/(ω0 J0), a couple −D1(w1 u + w2 n).
    rolling_resistance
        Lever arm μ_r of the normal force, in units of the radius: a couple μ_r r N against the horizontal component of
        the angular velocity, which fades out below the rate 1e-3 ω0.
    restitution
        e, fraction of the tilt rate that remains after a passage of the vertical; 1 for no loss.
    passage_tilt
        Minimum tilt below which a swing counts as a passage of the vertical [rad]; by default 0.01 c.
    constraint
        "pure_tilt": ω·(e3 + Z) = 0. "rubber": ω·Z = 0, no rotation about the vertical at all, as for a contact that
        cannot pivot; it is not holonomic, differs by O(c²), and the footprint wanders.

    Raises
    ------
    ParameterError
        If `column` is not a Column, a damping parameter is negative or not finite, `restitution` is outside 0 to 1,
        or `constraint` is unknown.

    Notes
    -----
    Under pure tilt, with M(θ) = κρ² + (1 − κ) sin²θ + I_a(1 − cos θ)², ρ = sin θ + c(1 − cos θ) and K = 1 + κc², in
    units of 1/ω0, h and g,

    K θ̈ = ½M'β̇² − (1 + a_z) z' − ρ' a_d − ηθ̇,   (Mβ̇)˙ = −ρ a_n − η sin²θ β̇.
    """

    column: Column
    damping: Damping = 0.0
    rolling_resistance: RollingResistance = 0.0
    restitution: Restitution = 1.0
    passage_tilt: PassageTilt | None = None
    constraint: Constraint = "pure_tilt"

    name: ClassVar[str] = "wobbling"
    carried_names: ClassVar[tuple[str, ...]] = ("twist", "footprint_x", "footprint_y")

    rates = staticmethod(rates)
    contact = staticmethod(contact)
    carried_rates = staticmethod(carried_rates)
    no_return_tilt = staticmethod(finite_tilt.no_return_tilt)
    passage = staticmethod(passage)

    @property
    def parameters(self) -> tuple[float, ...]:
        """c, η, κ, δ/r, e, i_a, and 1 for rubber, else 0."""
        column = self.column
        losses = (self.rolling_resistance, self.restitution)
        own = (column.axial_ratio, float(self.constraint == "rubber"))
        return (column.slenderness, self.damping, column.inertia_ratio, *losses, *own)

    @property
    def loss_tilt(self) -> float:
        """Tilt below which a passage of the vertical loses energy [rad]; 0 without loss."""
        return finite_tilt.loss_tilt(self.column, self.restitution, self.passage_tilt)

    @property
    def balance(self) -> Balance:
        """At the tilt atan c, with the energy m g (R − h)."""
        return finite_tilt.balance(self.column)

    @property
    def closed_form(self) -> ClosedForm:
        """Steady rolling without rolling resistance; on rubber it is that of `Rolling` with infinite spin damping."""
        requires = zero(self, "rolling_resistance")
        if self.constraint == "rubber":
            return ClosedForm(RollingLaw.FULL, self.damping, math.inf, requires)
        return ClosedForm(RollingLaw.WOBBLING, self.damping, requires=requires)

    def energy(self, states: Floats) -> Floats:
        """Return ½Kθ̇² + ½Mβ̇² + c sin θ − (1 − cos θ) in units of m g h [J]."""
        return self._energy(states, *self._motion(states))

    def _energy(self, states: Floats, falling: Floats, around: Floats, moment: Floats) -> Floats:
        kappa, c = self.column.inertia_ratio, self.column.slenderness
        kinetic = (1.0 + kappa * c * c) * falling**2 + moment * around**2
        energy: Floats = 0.5 * kinetic + finite_tilt.potential(np.hypot(*states[:2]), c)
        return energy * self.column.base_inertia * self.column.frequency_scale * self.column.frequency_scale

    def _motion(self, states: Floats) -> tuple[Floats, Floats, Floats]:
        """Return θ̇, β̇ and M."""
        column = self.column
        c, kappa = column.slenderness, column.inertia_ratio
        x, y, vx, vy = states[:4]
        tilt = np.hypot(x, y)
        with np.errstate(invalid="ignore", divide="ignore"):
            falling = np.where(tilt > 0.0, (x * vx + y * vy) / tilt, np.hypot(vx, vy))
            around = np.where(tilt > 0.0, (x * vy - y * vx) / tilt**2, 0.0)
        sine, half = np.sin(tilt), 2.0 * np.sin(0.5 * tilt) ** 2
        sway = sine + c * half
        q_sine = half if self.constraint == "pure_tilt" else sine * np.tan(tilt)
        if self.constraint == "rubber":
            sway = sine + c * q_sine
        moment = kappa * sway**2 + (1.0 - kappa) * sine**2 + kappa * column.axial_ratio * c * c * q_sine**2
        return falling, around, moment

    def outputs(self, states: Floats, accelerations: Floats, resting: npt.NDArray[np.bool_]) -> Mapping[str, Output]:
        """Return energy, angular momentum, twist, footprint, path of the contact point and contact loads.

        Under pure tilt the angular momentum Mβ̇ [kg m²/s] belongs to the azimuth of the lean; on a base at rest it and
        the energy are constant without dissipation.
        """
        column, (falling, around, moment) = self.column, self._motion(states)
        unit = column.base_inertia * column.frequency_scale
        outputs = {
            "energy": Output(self._energy(states, falling, around, moment), "J", "energy above rest"),
            "angular_momentum": Output(moment * around * unit, "kg m2 s-1", "angular momentum of the azimuth"),
            "twist": Output(states[4], "rad", "angle of turn about the axis"),
            **path_outputs(self, states, column.radius * states[5:7].T),
            **contact_outputs(self, states, accelerations, resting),
        }
        if self.constraint == "rubber":
            del outputs["angular_momentum"]
        return outputs
