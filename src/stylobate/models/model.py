"""The contract between a model of the column and everything that uses models."""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import Enum, IntEnum
from types import MappingProxyType
from typing import Any, ClassVar, NamedTuple

import numpy as np
import numpy.typing as npt

from stylobate.column import Column
from stylobate.errors import ParameterError
from stylobate.quantities import Declared


class RollingLaw(Enum):
    """The closed forms of steady rolling, by the function of `theory` that computes each."""

    SLENDER = "steady_rolling"
    FREE_TWIST = "free_twist_rolling"
    WOBBLING = "wobbling_rolling"
    FULL = "full_rolling"
    SLIPPING = "slipping_rolling"


@dataclass(frozen=True, slots=True)
class ClosedForm:
    """The closed form of steady rolling of a model on a base that moves in a circle.

    Parameters
    ----------
    law
        The function that computes it.
    eta, zeta
        Damping η and spin damping ζ that it takes; ζ is infinite for a column that cannot turn about the vertical.
    requires
        Name of a number of the model that differs from the value that the closed form requires, and that value.
    """

    law: RollingLaw
    eta: float
    zeta: float = 0.0
    requires: tuple[str, float | str] | None = None


def zero(model: object, *names: str) -> tuple[str, float] | None:
    """Return the name of the first of these numbers of `model` that is not zero, and 0; None if all are zero."""
    return next(((name, 0) for name in names if getattr(model, name) != 0.0), None)


Floats = npt.NDArray[np.float64]

# Allowance for rounding in the uplift criterion: with an acceleration of exactly the limit, about one sample in ten of
# a circular motion exceeds it by one ulp.
RELEASE_MARGIN = 8.0 * float(np.finfo(float).eps)


class Push(NamedTuple):
    """Push of the base on a column at the instant of uplift, dimensionless.

    Parameters
    ----------
    direction
        Unit vector −a_h/|a_h| of the first lean.
    acceleration
        |a_h| [g].
    excess, excess_rate
        |a_h| − c(1 + a_z) [g], and its mean rate of change over the first two thirds of the departure.
    turning_rate
        Mean rate over this time at which the direction turns, anticlockwise.
    """

    direction: tuple[float, float]
    acceleration: float
    excess: float
    excess_rate: float
    turning_rate: float


class Balance(NamedTuple):
    """Unstable balance of a column on its rim, on a base at rest.

    Parameters
    ----------
    tilt
        Tilt [rad].
    energy
        Energy above rest [J].
    """

    tilt: float
    energy: float


@dataclass(frozen=True, slots=True)
class Output:
    """A quantity along a run: `values` of shape (n,) or (n, 2), its `units` and a `long_name` for axes."""

    values: Floats
    units: str
    long_name: str


class Model(Declared, ABC):
    """A column with its equations of motion.

    A model integrates in its own units: time in units of `time_scale`, accelerations of the base in units of
    `column.gravity`. It receives the current acceleration of the base, not the base motion.

    Its physics consists of static functions of plain floats, whose last arguments are the model's `parameters`. Single
    runs call these functions, ensembles compile them.

    Notes
    -----
    For developers: a model has a `column` and defines `state_names`, `parameters`, `rates`, `tilt_of` and `start`; all
    other members have a default. Without `rest_energy` a column never comes to rest. Without `planar_rates` planar
    motion is integrated in three dimensions. Without `no_return_tilt` a stated limit decides overturning.

    Ensembles compile these functions. They may use arithmetic, `math`, conditions, loops, tuples and calls of such
    functions; an error names the line of anything else. `rates` and `planar_rates` compute several columns at a time if
    they have no branches and loops: write a choice as `a if condition else b`. `math.sqrt`, `abs`, `min` and `max` cost
    little there, transcendental functions more.
    """

    __slots__ = ()

    name: ClassVar[str]
    state_names: ClassVar[tuple[str, ...]]
    column: Column

    rates: ClassVar[Callable[..., tuple[float, ...]]]
    """(state…, ax, ay, az, parameters…) → rates of the state; accelerations in g."""

    tilt_of: ClassVar[Callable[..., tuple[Any, Any, Any, Any]]]
    """(state…, parameters…) → the tilt vector [rad] and its rate in the model's time: x, y, vx, vy.

    It is called with floats and with arrays.
    """

    spin_state: ClassVar[int | None] = None
    """Index of the spin, the angular velocity about the axis in the model's time; None for a model without spin."""

    planar_only: ClassVar[bool] = False
    """Whether the model describes planar motion only, by `planar_rates`."""

    carried_names: ClassVar[tuple[str, ...]] = ()
    """Names of the passive states, which follow from the states and do not act on them, such as twist and footprint.

    The first is the twist [rad]; then come x and y of the centre of the footprint circle [base radii].
    """

    carried_rates: ClassVar[Callable[..., tuple[float, ...]] | None] = None
    """(state…, parameters…) → the rates of the passive states."""

    contact: ClassVar[Callable[..., tuple[float, float, float]] | None] = None
    """(state…, ax, ay, az, parameters…) → the contact loads N/(m g), |T|/(m g), |M_z|/(m g r).

    These are the normal force, the friction force and the moment about the vertical of a moving column.
    """

    impact_map: ClassVar[Callable[..., tuple[float, ...]] | None] = None
    """(state…, parameters…) → the state after a passage of the vertical below `loss_tilt`, with the energy loss."""

    guard_names: ClassVar[tuple[str, ...]] = ()
    """Names of the `guards` of a model that switches between kinds of contact; empty for other models."""

    guards: ClassVar[Callable[..., tuple[float, ...]] | None] = None
    """(state…, ax, ay, az, ε, passage, parameters…) → guards, which are positive as long as a kind of contact lasts.

    A guard below zero ends the contact; the last guard does so only if it was positive before. At "fallen" the column
    counts as overturned; all others lead to `reset_map`. ε is the rest energy, and `passage` the `loss_tilt`.
    """

    reset_map: ClassVar[Callable[..., tuple[float, tuple[float, ...]]] | None] = None
    """(state…, number of the guard, ax, ay, az, bx, by, bz, ahead, ε, parameters…) → elapsed time, and new state.

    The base accelerates with (ax, ay, az) now and (bx, by, bz) after the short time `ahead`, in which uplift develops.
    With the number −1 the result is the state with which a motion begins.
    """

    project: ClassVar[Callable[..., tuple[float, ...]] | None] = None
    """(state…, parameters…) → the state after a step, with its `kept_states` updated."""

    slip_states: ClassVar[tuple[int, ...]] = ()
    """Indices of the slip velocity, which needs finer integration while a contact slips: its direction matters."""

    kept_states: ClassVar[tuple[int, ...]] = ()
    """Indices of the states that are constant within a step: those that `project` updates, and the kind of contact.

    They are the last states.
    """

    moving_states: ClassVar[Mapping[IntEnum, int]] = MappingProxyType({})
    """Number of leading states that change in some kinds of contact; while one lasts, the others are constant.

    Runs with such a contact are computed together, by the operations that it needs.
    """

    contact_kinds: ClassVar[type[IntEnum] | None] = None
    """The kinds of contact; the last state has one of them as its value.

    The first two are those of a column that stands on its base, at rest (RESTING) and sliding (SLIDING).
    """

    jacobian: ClassVar[Callable[..., tuple[tuple[float, ...], ...]] | None] = None
    """(state…, ax, ay, az, parameters…) → for each rate its derivatives by state, accelerations and parameters.

    If None, they are derived from `rates`, which must not choose between cases by a comparison then.
    """

    planar_rates: ClassVar[Callable[..., tuple[float, float]] | None] = None
    """(tilt, rate, side, horizontal, vertical, parameters…) → the rates of tilt and rate in a vertical plane.

    `side` (±1) is the side of the vertical on which the column leans; accelerations in g. Define `from_plane` too.
    """

    from_plane: ClassVar[Callable[..., tuple[Any, ...]] | None] = None
    """(tilt, rate, ux, uy, parameters…) → the state of a motion in the plane along the unit vector (ux, uy).

    It is called with floats and with arrays.
    """

    rest_energy: ClassVar[Callable[..., float] | None] = None
    """(|α| [rad], |α̇|, a_z [g], parameters…) → energy above the state of rest without the work of the base.

    Its unit is such that c² is its scale.
    """

    no_return_tilt: ClassVar[Callable[..., float] | None] = None
    """(sup |a_h|, inf a_z, parameters…) → point of no return of a growing tilt [rad], or inf.

    Both bounds hold from now on [g].
    """

    departure: ClassVar[Callable[..., tuple[float, ...]] | None] = None
    """(push, elapsed, parameters…) → the state a short time after uplift by a `Push`."""

    passage: ClassVar[Callable[..., tuple[float, tuple[float, ...]]] | None] = None
    """(state…, ax, ay, az, parameters…) → duration and end state of a ballistic passage of the vertical.

    It is used only if the path passes the vertical so closely that its turn cannot be resolved.
    """

    at_rest: ClassVar[Callable[..., tuple[float, ...]] | None] = None
    """(state…, parameters…) → the state of a column that has come to rest; None for all zeros."""

    def __post_init__(self) -> None:
        """Check the column, then the numbers by their declarations."""
        require_column(self.column)
        Declared.__post_init__(self)

    @property
    @abstractmethod
    def parameters(self) -> tuple[float, ...]:
        """The last arguments of the static functions."""

    @abstractmethod
    def start(self, tilt: tuple[float, float], tilt_rate: tuple[float, float]) -> tuple[float, ...]:
        """Return the state with this tilt vector [rad] and its rate [rad/s]; called with floats and with arrays."""

    def tilt(self, states: Floats) -> Floats:
        """Return the tilt vectors [rad], shape (2, n), of `states`, shape (number of states, n)."""
        return np.stack(self.tilt_of(*states[: len(self.state_names)], *self.parameters)[:2])

    def tilt_rate(self, states: Floats) -> Floats:
        """Return the rates of the tilt vectors in the model's own time, shape (2, n)."""
        return np.stack(self.tilt_of(*states[: len(self.state_names)], *self.parameters)[2:])

    @property
    def time_scale(self) -> float:
        """The model's unit of time, 1/ω0 [s]."""
        return 1.0 / self.column.frequency_scale

    @property
    def rest_capacity(self) -> float:
        """Maximum |a_h|/(g + a_z) at which the column stays on its base, with an allowance for rounding."""
        return self.column.slenderness * (1.0 + RELEASE_MARGIN)

    @property
    def comes_to_rest(self) -> bool:
        """Whether dissipation brings a free column to rest."""
        return False

    @property
    def loss_tilt(self) -> float:
        """Minimum tilt below which a passage near the vertical loses energy by an impact [rad]; 0 without loss."""
        return 0.0

    @property
    def balance(self) -> Balance | None:
        """The unstable balance that free motion must pass to overturn, or None for no such claim.

        With less energy and a smaller tilt than the balance, a column on a base at rest cannot overturn. A subclass
        that replaces `rates` or `parameters` makes this claim only if it states `balance` again.
        """
        return None

    @property
    def closed_form(self) -> ClosedForm | None:
        """The closed form of steady rolling on a base that moves in a circle, or None.

        A subclass that replaces the equations makes this claim only if it states `closed_form` again; see
        `closed_form_of`.
        """
        return None

    def energy(self, states: Floats) -> Floats | None:
        """Return the energy above rest [J], shape (n,), which free motion can only lose, or None without a formula.

        Parameters
        ----------
        states
            Shape (number of states, n), optionally followed by the passive states.
        """
        del states
        return None

    @property
    def switches(self) -> bool:
        """Whether the model switches between kinds of contact."""
        return self.guards is not None

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
        """Return the initial state of a model that switches between kinds of contact; arguments in SI units."""
        del spin, twist, position, velocity, clearance
        return self.start(tilt, tilt_rate)

    def event_of(self, margin: str, before: int, after: int) -> str:
        """Return the name of an event from its guard and the kinds of contact before and after; "" for none."""
        del margin, before, after
        return ""

    @property
    def slope(self) -> tuple[float, float, float]:
        """Term that an inclined plane adds to the acceleration of the base [g]; `rates` contains it."""
        return 0.0, 0.0, 0.0

    def stands(self, state: tuple[float, ...]) -> bool:
        """Return whether the column stands on its base in this state: zero tilt and zero tilt rate."""
        return not any(self.tilt_of(*state[: len(self.state_names)], *self.parameters))

    def standing(self, state: tuple[float, ...]) -> tuple[float, ...]:
        """Return the state after coming to rest from `state`; the passive states keep their values."""
        moving, carried = state[: len(self.state_names)], state[len(self.state_names) :]
        still = (0.0,) * len(moving) if self.at_rest is None else self.at_rest(*moving, *self.parameters)
        return *still, *carried

    def least_safe_tilt(self, peak_horizontal: float, minimum_vertical: float) -> float:
        """Return `no_return_tilt` for these bounds [g]; infinite for a model without it."""
        if self.no_return_tilt is None:
            return math.inf
        return self.no_return_tilt(peak_horizontal, minimum_vertical, *self.parameters)

    def outputs(self, states: Floats, accelerations: Floats, resting: npt.NDArray[np.bool_]) -> Mapping[str, Output]:
        """Return the outputs of the model besides the tilt, by name.

        Parameters
        ----------
        states
            Shape (number of states, n), followed by the passive states.
        accelerations
            ax, ay, az [g], shape (3, n).
        resting
            Whether the column stands on its base, shape (n,).
        """
        del states, accelerations, resting
        return {}


def require_column(value: object) -> None:
    """Raise ParameterError if `value` is not a Column."""
    if not isinstance(value, Column):
        raise ParameterError(f"column must be a Column, such as Column.solid(...), got {value!r}")


_EQUATIONS = ("rates", "parameters")


def owner_of(kind: type[Model], name: str) -> type:
    """Return the class from which `kind` has its member `name`."""
    return next(cls for cls in kind.__mro__ if name in vars(cls))


def belongs_to_equations(kind: type[Model], name: str, *also: str) -> bool:
    """Return whether the class that states `rates` and `parameters`, or a subclass of it, states `name`.

    A subclass that replaces `rates` or `parameters` replaces the equations. An inherited claim about the equations,
    such as the energy of the balance, is then void unless the subclass states it again.

    Parameters
    ----------
    kind
        The class of a model.
    name
        The member that makes the claim.
    *also
        Further members on which the claim depends, such as `energy`.
    """
    place = kind.__mro__.index(owner_of(kind, name))
    return all(place <= kind.__mro__.index(owner_of(kind, other)) for other in (*_EQUATIONS, *also))


def closed_form_of(model: object) -> ClosedForm | None:
    """Return the closed form of steady rolling that a model states for its own equations; None without one."""
    if not isinstance(model, Model) or not belongs_to_equations(type(model), "closed_form", "tilt_of", "start"):
        return None
    return model.closed_form


LEAN = ("tilt_x", "tilt_y", "tilt_rate_x", "tilt_rate_y")
"""Names of these states."""


def tilt_of(x: Any, y: Any, vx: Any, vy: Any, *_: Any) -> tuple[Any, Any, Any, Any]:
    """Return the tilt vector and its rate: the state itself."""
    return x, y, vx, vy


def from_plane(tilt: Any, rate: Any, ux: float, uy: float, *_: float) -> tuple[Any, ...]:
    """Return the state of a motion along the unit vector (ux, uy)."""
    return tilt * ux, tilt * uy, rate * ux, rate * uy


def from_plane_without_spin(tilt: Any, rate: Any, ux: float, uy: float, *_: float) -> tuple[Any, ...]:
    """Return the state of a motion along the unit vector (ux, uy), with zero spin."""
    return tilt * ux, tilt * uy, rate * ux, rate * uy, 0.0 * tilt


class TiltVectorModel(Model):
    """A model whose state is the tilt vector and its rate."""

    __slots__ = ()

    state_names: ClassVar[tuple[str, ...]] = LEAN

    tilt_of = staticmethod(tilt_of)
    from_plane = staticmethod(from_plane)

    def start(self, tilt: tuple[float, float], tilt_rate: tuple[float, float]) -> tuple[float, ...]:
        """Return the state with this tilt vector [rad] and its rate [rad/s]."""
        scale = self.time_scale
        return tilt[0], tilt[1], tilt_rate[0] * scale, tilt_rate[1] * scale


class SpinningModel(TiltVectorModel):
    """A model with the spin as its fifth state."""

    __slots__ = ()

    state_names: ClassVar[tuple[str, ...]] = (*LEAN, "spin")
    spin_state: ClassVar[int | None] = len(LEAN)

    from_plane = staticmethod(from_plane_without_spin)

    def start(self, tilt: tuple[float, float], tilt_rate: tuple[float, float]) -> tuple[float, ...]:
        """Return the state with this tilt vector [rad] and its rate [rad/s], without spin."""
        return *TiltVectorModel.start(self, tilt, tilt_rate), 0.0 * tilt[0]
