"""The slender column that rolls without slip and may turn about its axis."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Literal, get_args

import numpy as np
import numpy.typing as npt

from stylobate.column import Column
from stylobate.errors import ParameterError, require_not_negative
from stylobate.models import slender
from stylobate.models.contact import contact_outputs
from stylobate.models.model import Floats, Model, Output, Push

# As in the slender model: keeps 1/|α| finite at the upright itself.
_TINY = 1e-300

Couples = Literal["contact", "isotropic"]


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
    freedom = 1.0 + axial - kappa  # D
    across = ay * ux - ax * uy  # of the base acceleration
    turning = vy * ux - vx * uy  # of the tilt rate: |α| β̇
    # Along n = (−u_y, u_x): the part of the base acceleration that the spin takes up; the reaction of the couples
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


def lean(x: Any, y: Any, vx: Any, vy: Any, *_: Any) -> tuple[Any, Any, Any, Any]:
    """Return the tilt vector and its rate."""
    return x, y, vx, vy


def planar_rates(
    tilt: float, rate: float, side: float, horizontal: float, vertical: float, c: float, eta: float, *_: float
) -> tuple[float, float]:
    """Return the right-hand side in a vertical plane, in which nothing spins the column up: that of the slender one."""
    return rate, (1.0 + vertical) * (tilt - c * side) - eta * rate - horizontal


def from_plane(tilt: Any, rate: Any, ux: float, uy: float, *_: float) -> tuple[Any, Any, Any, Any, Any]:
    """Return the state of a motion along the unit vector (ux, uy), without spin."""
    return tilt * ux, tilt * uy, rate * ux, rate * uy, 0.0 * tilt


def rest_energy(tilt: float, speed: float, vertical: float, c: float, *_: float) -> float:
    """Return ½|α̇|² + c(1 + a_z)|α|, what is left above the state of rest but for the spin."""
    return 0.5 * speed * speed + c * (1.0 + vertical) * tilt


def departure(
    push: Push, elapsed: float, c: float, eta: float, _zeta: float, kappa: float, axial: float, *_: float
) -> tuple[float, float, float, float, float]:
    """Return the state a short time δ = `elapsed` after release, by series about α = 0.

    Along the push as in the slender model. Across it the lean is qδ³ with q (6 + 2c/F − 2|a_h|(1 − κ)/(DF)) =
    |a_h| × turning_rate × i_a/D, and the spin −½|a_h|(turning_rate − 2q/F)(1 − κ)δ²/(cκD).
    """
    freedom = 1.0 + axial - kappa
    capacity = push.acceleration - push.excess  # c(1 + a_z)
    jerk = push.excess_rate - eta * push.excess
    mean_excess = push.excess + jerk * elapsed / 3.0
    if mean_excess <= 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0
    along = 0.5 * mean_excess * elapsed**2
    along_rate = push.excess * elapsed + 0.5 * jerk * elapsed**2
    given = (1.0 - kappa) / freedom
    stiffness = 6.0 + 2.0 * (capacity - push.acceleration * given) / mean_excess
    turn = push.acceleration * push.turning_rate * axial / freedom
    across = turn * elapsed**3 / stiffness
    across_rate = across / elapsed * (3.0 + jerk * elapsed / 3.0 / mean_excess)
    behind = push.turning_rate - 2.0 * across / (mean_excess * elapsed**3)
    spin = -0.5 * push.acceleration * behind * elapsed**2 * given / (c * kappa)
    ux, uy = push.direction
    return (
        along * ux - across * uy,
        along * uy + across * ux,
        along_rate * ux - across_rate * uy,
        along_rate * uy + across_rate * ux,
        spin,
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
    zeta: float,
    kappa: float,
    axial: float,
    *_: float,
) -> tuple[float, tuple[float, float, float, float, float]]:
    """Return the duration and the end of a passage with offset b at speed v, past the upright.

    The path is straight but for what happens near the upright, while the azimuth makes its half turn: however small the
    offset, the gyroscopic couple of the spin turns the path there by 2 atan(cκσ/v). To this come the kick
    −(2cb/v) asinh(l/b) of the slender model, and what friction and base do meanwhile, half of it before the turn.
    """
    speed = math.hypot(vx, vy)
    ux, uy = vx / speed, vy / speed
    ahead, offset = -(x * ux + y * uy), y * ux - x * uy
    elapsed = 2.0 * ahead / speed
    across = (ay * ux - ax * uy) * (1.0 - kappa) / (1.0 + axial - kappa)
    jump_x = -0.5 * (eta * vx + ax + across * uy) * elapsed
    jump_y = -0.5 * (eta * vy + ay - across * ux) * elapsed
    # The state on the other side of a straight passage, turned about the upright.
    tangent = c * kappa * spin / speed if offset != 0.0 else 0.0
    cos, sin = (1.0 - tangent * tangent) / (1.0 + tangent * tangent), 2.0 * tangent / (1.0 + tangent * tangent)
    kick = -2.0 * c * (1.0 + az) / speed * (offset * math.asinh(ahead / abs(offset)) if offset != 0.0 else 0.0)
    out_x, out_y = ahead * ux - offset * uy, ahead * uy + offset * ux
    way_x, way_y = vx + jump_x - kick * uy, vy + jump_y + kick * ux
    way_x, way_y = cos * way_x - sin * way_y + jump_x, sin * way_x + cos * way_y + jump_y
    shift = 0.5 * elapsed
    end = (
        cos * out_x - sin * out_y + jump_x * shift,
        sin * out_x + cos * out_y + jump_y * shift,
        way_x,
        way_y,
        spin * math.exp(-zeta * elapsed),
    )
    return elapsed, end


@dataclass(frozen=True, slots=True)
class SlenderRolling(Model):
    """A slender column that rolls without slip: small tilt, the twist free.

    With σ = w3/ω0, κ = m h²/J0, i_a = I_a/(m r²), D = 1 + i_a − κ, û = α/|α|, n across it, a_n = a_h·n, and contact
    couples,

    α̈ = (1 + a_z)(α − c û) − a_h + n a_n (1 − κ)/D − cκσβ̇ û − η[(α̇·û)û + ((1 + i_a)/D)(α̇·n) n] − cκζσ n,
    σ̇ = a_n (1 − κ)/(cκD) − (η/(cD)) (α̇·n) − ζσ,

    in units of 1/ω0 and g. The base spins the column up, and a column that may spin answers a base acceleration across
    its lean with i_a/D of what one answers that cannot turn.

    Parameters
    ----------
    column
        The column; its slenderness c should be well below 1.
    damping
        Viscous friction η = D1/(ω0 J0), a couple −D1 against the rate of tilt.
    spin_friction
        ζ, by a moment −D0 times the angular velocity about the vertical, D0 = ζ ω0 I_a D/i_a: a column that spins
        upright loses its spin at the rate ζ ω0. Without any, and with damping, steady rolling dies out.
    couples
        "contact": both couples act on the rolling body, and so through the force at the contact too; this is the limit
        of the body at finite tilt. "isotropic": −η α̇ and −ζσ alone, as in the equations of a column that cannot turn.

    Raises
    ------
    ParameterError
        If `column` is no Column, `damping` or `spin_friction` is negative or not finite, or `couples` none of the two.

    Notes
    -----
    Overturning is told at a tilt of π/2: spin holds no column up for certain, nor lets it fall.
    """

    column: Column
    damping: float = 0.0
    spin_friction: float = 0.0
    couples: Couples = "contact"

    name: ClassVar[str] = "slender rolling"
    state_names: ClassVar[tuple[str, ...]] = ("tilt_x", "tilt_y", "tilt_rate_x", "tilt_rate_y", "spin")

    def __post_init__(self) -> None:
        if not isinstance(self.column, Column):
            message = f"column must be a Column, such as Column.solid(...), got {self.column!r}"
            raise ParameterError(message)
        for name in ("damping", "spin_friction"):
            object.__setattr__(self, name, require_not_negative(name, getattr(self, name)))
        if self.couples not in get_args(Couples):
            message = f"couples must be 'contact' or 'isotropic', got {self.couples!r}"
            raise ParameterError(message)

    rates = staticmethod(rates)
    lean = staticmethod(lean)
    planar_rates = staticmethod(planar_rates)
    from_plane = staticmethod(from_plane)
    rest_energy = staticmethod(rest_energy)
    departure = staticmethod(departure)
    passage = staticmethod(passage)

    @property
    def parameters(self) -> tuple[float, ...]:
        """c, η, ζ, κ, i_a, and 1 for contact couples, else 0."""
        column = self.column
        numbers = (column.slenderness, self.damping, self.spin_friction, column.inertia_ratio, column.axial_ratio)
        return (*numbers, float(self.couples == "contact"))

    def start(
        self, tilt: tuple[float, float], tilt_rate: tuple[float, float]
    ) -> tuple[float, float, float, float, float]:
        """Return the state with this tilt vector [rad] and its rate [rad/s], without spin."""
        scale = self.time_scale
        return tilt[0], tilt[1], tilt_rate[0] * scale, tilt_rate[1] * scale, 0.0 * tilt[0]

    @property
    def comes_to_rest(self) -> bool:
        """Whether there is friction."""
        return self.damping > 0.0

    def outputs(self, states: Floats, accelerations: Floats, resting: npt.NDArray[np.bool_]) -> Mapping[str, Output]:
        """Return the spin [rad/s], the centre of pressure [m] as of the slender model, and what the contact bears.

        Its moment about the vertical is that of the spin friction.
        """
        column, spin = self.column, states[4]
        plain = slender.Slender(column, damping=self.damping).outputs(states[:4], accelerations, resting)
        ratio, axial = column.inertia_ratio, column.axial_ratio
        moment = self.spin_friction * (1.0 + axial - ratio) * ratio * column.slenderness * spin
        return {
            "spin": Output(spin / self.time_scale, "rad s-1", "angular velocity about the axis"),
            "centre_of_pressure": plain["centre_of_pressure"],
            **contact_outputs(self, states, accelerations, resting, moment),
        }
