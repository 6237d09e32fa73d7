"""The column with six degrees of freedom, on a plane that it can leave and on which it can slip."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import IntEnum
from types import MappingProxyType
from typing import Annotated, Any, ClassVar

import numpy as np
import numpy.typing as npt

from stylobate.column import Column
from stylobate.elementwise import cos, larger, sin, smaller
from stylobate.errors import ParameterError
from stylobate.models import finite_tilt
from stylobate.models.contact import path_outputs, per_normal_force
from stylobate.models.declared import (
    Damping,
    FrictionCoefficient,
    NormalRestitution,
    PassageTilt,
    RollingResistance,
    SpinDamping,
    StaticFrictionCoefficient,
)
from stylobate.models.model import RELEASE_MARGIN, ClosedForm, Floats, Model, Output, RollingLaw, tilt_of, zero
from stylobate.models.sliding.balance import Contact, SlidingNumbers, SlidingState, forces_along
from stylobate.models.sliding.equations import GUARDS, STRAIGHT, contact_loads, guards, rates
from stylobate.models.sliding.rim_and_base import lifted
from stylobate.models.sliding.transitions import project, reset_map
from stylobate.quantities import Quantity


@dataclass(frozen=True, slots=True)
class Sliding(Model):
    """A rigid column in unilateral contact with Coulomb friction: it can slip, pivot, lift off and land.

    The column stands on its base, at rest or sliding; rolls or slips on its rim; or flies. Changes between these states
    are located events, and impacts are instantaneous. No parameter regularises friction.

    Parameters
    ----------
    column
        The column.
    friction_coefficient
        Kinetic coefficient μ of slipping contacts and of impacts; 0 for a plane without friction.
    static_friction_coefficient
        Coefficient up to which a contact does not slip; by default the kinetic one, and not below it.
    patch
        Radius r_p of the contact of the rim, in units of the base radius. A patch resists rotation about the vertical
        by a moment up to (3π/16) μN r_p; slip reduces the moment, and rotation the force. While it does neither, the
        column rolls as on rubber. 0 is a point.
    normal_restitution
        e_n, normal speed of the struck point after an impact over that before it.
    damping, spin_damping, rolling_resistance
        As for `Rolling`, while the rim touches.
    passage_tilt
        The base strikes the plane where the column passes the vertical closer than this [rad]. By default, and at
        least, this is 1e-9 c: only a column that moves in a vertical plane strikes, all others roll past.
    incline, incline_direction
        Angle of the plane to the horizontal [rad], and azimuth of its downward direction [rad]. Base motions refer to
        the plane and its normal.

    Raises
    ------
    ParameterError
        If `column` is not a Column, a number is out of range, or the static coefficient is below the kinetic one.

    Notes
    -----
    Limits: for large μ, as long as N > 0 and the base face does not strike, the model equals `Rolling`. With a large
    patch it rolls as on rubber. A column with c above μ slides as a block.

    Thresholds: a rebound slower than 1e-5 √(κgh) is plastic. Slip slower than 1e-10 √(κgh) sticks. A path that passes
    the vertical within 1e-9 c is straight. Where Painlevé's denominator falls to 1e-3, slip ends by an impulse. A
    column on its rim with less than the rest energy of the run is set down on its base if the plane holds it. Impacts
    follow A. Chatterjee and A. Ruina (1998), and never add energy. An impact of the base face is an impact of the
    opposite rim point, in the plane of the motion; without slip and rebound it is Housner's. The pressure under a
    standing base is even.
    """

    column: Column
    friction_coefficient: FrictionCoefficient = 0.5
    static_friction_coefficient: StaticFrictionCoefficient | None = None
    patch: Annotated[float, Quantity(text="radius of the contact, in base radii", ge=0.0, slider=(0.0, 0.2))] = 0.0
    normal_restitution: NormalRestitution = 0.0
    damping: Damping = 0.0
    spin_damping: SpinDamping = 0.0
    rolling_resistance: RollingResistance = 0.0
    passage_tilt: PassageTilt | None = None
    incline: Annotated[
        float,
        Quantity(
            unit="rad",
            text="slope of the base",
            ge=0.0,
            le=1.57,
            note="with incline_direction for the way down",
            slider=(0.0, 0.4),
        ),
    ] = 0.0
    incline_direction: Annotated[
        float, Quantity(unit="rad", text="direction in which the base slopes down", slider=(-3.142, 3.142))
    ] = 0.0

    name: ClassVar[str] = "sliding"
    state_names: ClassVar[tuple[str, ...]] = SlidingState._fields
    spin_state: ClassVar[int | None] = SlidingState._fields.index("spin")
    slip_states: ClassVar[tuple[int, ...]] = tuple(map(SlidingState._fields.index, ("velocity_x", "velocity_y")))
    kept_states: ClassVar[tuple[int, ...]] = tuple(
        map(SlidingState._fields.index, ("heading_x", "heading_y", "heading_z", "contact"))
    )
    moving_states: ClassVar[Mapping[IntEnum, int]] = MappingProxyType(
        {
            Contact.ROLLING: SlidingState._fields.index("velocity_x"),
            Contact.SLIPPING: SlidingState._fields.index("rise"),
        }
    )
    guard_names: ClassVar[tuple[str, ...]] = GUARDS
    contact_kinds: ClassVar[type[IntEnum] | None] = Contact

    def validate(self) -> None:
        """Raise ParameterError if the static coefficient of friction is below the kinetic one."""
        if not self.consistent:
            raise ParameterError(
                f"static_friction_coefficient must not be below the kinetic {self.friction_coefficient!r}, "
                f"got {self.static_friction_coefficient!r}"
            )

    @property
    def consistent(self) -> Any:
        """Whether the static coefficient of friction is at least the kinetic one; of arrays, for each model."""
        static = self.static_friction_coefficient
        return static is None or static >= self.friction_coefficient

    rates = staticmethod(rates)
    tilt_of = staticmethod(tilt_of)
    contact = staticmethod(contact_loads)
    guards = staticmethod(guards)
    reset_map = staticmethod(reset_map)
    project = staticmethod(project)

    @property
    def numbers(self) -> SlidingNumbers:
        """The parameters by name."""
        column, kinetic = self.column, self.friction_coefficient
        down, half = sin(self.incline), sin(0.5 * self.incline)
        return SlidingNumbers(
            c=column.slenderness,
            eta=self.damping,
            zeta=self.spin_damping,
            kappa=column.inertia_ratio,
            axial=column.axial_ratio,
            resistance=self.rolling_resistance,
            kinetic=kinetic,
            static=kinetic if self.static_friction_coefficient is None else self.static_friction_coefficient,
            patch=self.patch,
            normal_restitution=self.normal_restitution,
            slope_x=-down * cos(self.incline_direction),
            slope_y=-down * sin(self.incline_direction),
            relief=2.0 * (half * half),
        )

    @property
    def parameters(self) -> tuple[float, ...]:
        """`numbers` as a plain tuple."""
        return tuple(self.numbers)

    @property
    def slope(self) -> tuple[float, float, float]:
        """Term that the inclined plane adds to the acceleration of the base [g]."""
        numbers = self.numbers
        return numbers.slope_x, numbers.slope_y, -numbers.relief

    @property
    def rest_capacity(self) -> float:
        """Maximum |a_h|/(g + a_z) at which the column neither slides nor tips: the smaller of c and the static μ."""
        numbers = self.numbers
        return smaller(numbers.c, numbers.static) * (1.0 + RELEASE_MARGIN)

    @property
    def comes_to_rest(self) -> bool:
        """True: impacts of the base face dissipate energy."""
        return True

    @property
    def loss_tilt(self) -> float:
        """Distance from the vertical below which a passage is an impact of the base face [rad]."""
        least = STRAIGHT * self.column.slenderness
        return least if self.passage_tilt is None else larger(self.passage_tilt, least)

    @property
    def closed_form(self) -> ClosedForm:
        """Steady rolling with slip at a point, on a horizontal plane."""
        requires = zero(self, "patch", "incline", "rolling_resistance")
        return ClosedForm(RollingLaw.SLIPPING, self.damping, self.spin_damping, requires)

    def start(self, tilt: tuple[float, float], tilt_rate: tuple[float, float]) -> tuple[float, ...]:
        """Return the state with this tilt vector [rad] and its rate [rad/s], without slip on its rim."""
        scale, nothing = self.time_scale, 0.0 * tilt[0]
        lean = (tilt[0], tilt[1], tilt_rate[0] * scale, tilt_rate[1] * scale)
        return *lean, *(nothing,) * 11, nothing + Contact.ROLLING

    def begun(
        self,
        tilt: tuple[float, float],
        tilt_rate: tuple[float, float],
        *,
        spin: float,
        twist: float,
        position: tuple[float, float],
        velocity: tuple[float, float, float],
        clearance: float,
    ) -> tuple[float, ...]:
        """Return the initial state, from which `reset_map` determines the contact.

        Parameters
        ----------
        tilt, tilt_rate
            Tilt vector [rad] and its rate [rad/s].
        spin, twist
            Spin [rad/s] and twist [rad].
        position
            Centre of the footprint circle [m].
        velocity
            Velocity of the lowest point of the rim, or of the base, relative to the plane [m/s].
        clearance
            Height of this point [m].
        """
        length, scale = self.column.mass_height, self.time_scale
        vx, vy, vz = (part * scale / length for part in velocity)
        lean = (*tilt, tilt_rate[0] * scale, tilt_rate[1] * scale)
        touching = SlidingState(
            *lean, spin * scale, twist, position[0] / length, position[1] / length, vx, vy, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        )
        if clearance > 0.0 or vz != 0.0:
            flying = lifted(touching, self.numbers)
            return tuple(flying._replace(rise=flying.rise + clearance / length, rise_rate=flying.rise_rate + vz))
        kind = Contact.SLIPPING if any(lean) else Contact.SLIDING
        return tuple(touching._replace(contact=float(kind)))

    def event_of(self, margin: str, before: int, after: int) -> str:
        """Return the name of an event from its guard and the kinds of contact before and after."""
        if margin in ("jam", "face_impact") or after == Contact.JAMMED:
            return "face_impact" if margin == "face_impact" and after != Contact.JAMMED else "jam"
        return _EVENTS.get((Contact(before), Contact(after)), "")

    def outputs(self, states: Floats, accelerations: Floats, resting: npt.NDArray[np.bool_]) -> Mapping[str, Output]:
        """Return spin, twist, footprint, kind of contact, slip, the height of the lowest point, forces and energy.

        Friction and pivoting demand are NaN in flight.
        """
        del resting
        column, scale, numbers = self.column, self.time_scale, self.numbers
        length, named = column.mass_height, SlidingState(*states)
        forces = forces_along(states, accelerations, numbers)
        pressing, friction, turning = forces[5], forces[6:8], forces[8]
        kind, weight = states[15].astype(np.int8), column.mass * column.gravity
        touches = kind != Contact.FLYING
        slip = np.where(touches, states[8:10], 0.0).T * length / scale
        demand, pivoting = (
            np.where(touches, per_normal_force(load, pressing), np.nan)
            for load in (np.hypot(*friction), np.abs(turning) / numbers.c)
        )
        return {
            "contact": Output(
                kind, "1", "kind of contact: " + ", ".join(f"{k.value} {k.name.lower()}" for k in Contact)
            ),
            "spin": Output(states[4] / scale, "rad s-1", "angular velocity about the axis"),
            "twist": Output(states[5], "rad", "angle of turn about the axis"),
            **path_outputs(self, states, length * states[6:8].T),
            "clearance": Output(length * self._gap(named), "m", "height of the lowest point above the plane"),
            "slip_velocity": Output(slip, "m s-1", "velocity of the contact along the plane"),
            "energy": Output(self._energy(named), "J", "energy above rest, relative to the plane"),
            "normal_force": Output(weight * pressing, "N", "normal force at the contact"),
            "friction_force": Output(weight * friction.T, "N", "friction force at the contact"),
            "friction_demand": Output(demand, "1", "friction force over normal force"),
            "pivoting_demand": Output(pivoting, "1", "moment about the vertical over normal force and radius"),
            "painleve_denominator": Output(forces[11], "1", "Painlevé's denominator, 1 without slip on the rim"),
        }

    def _gap(self, state: SlidingState) -> Floats:
        """Return the height of the lowest point above the plane [h]."""
        tilt = np.hypot(state.tilt_x, state.tilt_y)
        flying = np.asarray(state.contact) == Contact.FLYING
        gap: Floats = np.where(flying, state.rise - finite_tilt.potential(tilt, self.column.slenderness), 0.0)
        return gap

    def _energy(self, state: SlidingState) -> Floats:
        """Return ½κ|V|² + ½(1 − κ)(w1² + w2²) + ½I_a w3² plus the potential energy, in units of m g h [J]."""
        column = self.column
        c, kappa = column.slenderness, column.inertia_ratio
        x, y, vx, vy = (np.asarray(part) for part in state[:4])
        tilt = np.hypot(x, y)
        with np.errstate(invalid="ignore", divide="ignore"):
            ux, uy = (np.where(tilt > 0.0, part / tilt, 0.0) for part in (x, y))
        w2 = ux * vx + uy * vy
        w1 = -np.sinc(tilt / np.pi) * (ux * vy - uy * vx)
        flies = np.asarray(state.contact) == Contact.FLYING
        height, slope = np.cos(tilt) + c * np.sin(tilt), c * np.cos(tilt) - np.sin(tilt)
        # V = v + ρ'w2 d − w n if the column touches
        ahead, swing = np.where(flies, 0.0, height * w2), np.where(flies | (tilt == 0.0), 0.0, c * state.spin + w1)
        speed_x = state.velocity_x + ahead * ux + swing * uy
        speed_y = state.velocity_y + ahead * uy - swing * ux
        climb = np.where(flies, state.rise_rate, slope * w2)
        kinetic = kappa * (speed_x**2 + speed_y**2 + climb**2) + (1.0 - kappa) * (
            w1**2 + np.where(tilt > 0.0, w2, np.hypot(vx, vy)) ** 2
        )
        kinetic += kappa * column.axial_ratio * c * c * np.square(state.spin)
        weight = 1.0 - self.numbers.relief
        lift = np.where(flies, state.rise, finite_tilt.potential(tilt, c))
        energy: Floats = column.mass * column.gravity * column.mass_height * (0.5 * kinetic + weight * lift)
        return energy


_EVENTS: Mapping[tuple[Contact, Contact], str] = {
    (Contact.RESTING, Contact.SLIDING): "slide",
    (Contact.RESTING, Contact.ROLLING): "uplift",
    (Contact.RESTING, Contact.SLIPPING): "uplift",
    (Contact.RESTING, Contact.FLYING): "lift",
    (Contact.SLIDING, Contact.RESTING): "stop",
    (Contact.SLIDING, Contact.SLIDING): "reverse",
    (Contact.SLIDING, Contact.ROLLING): "uplift",
    (Contact.SLIDING, Contact.SLIPPING): "uplift",
    (Contact.SLIDING, Contact.FLYING): "lift",
    (Contact.ROLLING, Contact.RESTING): "rest",
    (Contact.ROLLING, Contact.SLIDING): "rest",
    (Contact.ROLLING, Contact.SLIPPING): "slip",
    (Contact.ROLLING, Contact.FLYING): "lift",
    (Contact.SLIPPING, Contact.RESTING): "rest",
    (Contact.SLIPPING, Contact.SLIDING): "rest",
    (Contact.SLIPPING, Contact.ROLLING): "stick",
    (Contact.SLIPPING, Contact.SLIPPING): "reverse",
    (Contact.SLIPPING, Contact.FLYING): "lift",
    **{(Contact.FLYING, kind): "land" for kind in Contact},
}
