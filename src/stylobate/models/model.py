"""The contract between a model of the column and everything that uses models."""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import IntEnum
from typing import Any, ClassVar, NamedTuple

import numpy as np
import numpy.typing as npt

from stylobate.column import Column
from stylobate.errors import ParameterError
from stylobate.models.closed_form import ClosedForm
from stylobate.quantities import Declared

Floats = npt.NDArray[np.float64]

# Room for rounding in the release criterion [ulp]: with an acceleration of exactly the limit, about one sample in ten
# of a circular motion exceeds it by one ulp.
RELEASE_MARGIN = 8.0 * float(np.finfo(float).eps)


class Push(NamedTuple):
    """What pushes a column off its base at the instant of release, dimensionless.

    Parameters
    ----------
    direction
        Unit vector −a_h/|a_h| of the first lean.
    acceleration
        |a_h| [g].
    excess, excess_rate
        |a_h| − c(1 + a_z) [g], and its rate of change.
    turning_rate
        Rate at which the direction turns, anticlockwise.
    """

    direction: tuple[float, float]
    acceleration: float
    excess: float
    excess_rate: float
    turning_rate: float


class Balance(NamedTuple):
    """Where a column stands on its rim in unstable balance, on a base at rest.

    Parameters
    ----------
    tilt
        [rad].
    energy
        Above that of rest [J].
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
    `column.gravity`. It never sees the base motion, only the acceleration of the moment.

    Its physics stands in static functions of plain floats that end with the model's `parameters`. Single runs call
    them, ensembles compile them, so that the equations are written once.

    Notes
    -----
    For developers: a model has a `column` and gives `state_names`, `parameters`, `rates`, `tilt_of` and `start`;
    everything below them in this class has a default. Without `rest_energy` a column never comes to rest, without
    `planar_rates` coplanar motion is integrated in space, without `no_return_tilt` a stated limit decides overturning.

    Ensembles compile these functions: arithmetic, `math`, conditions, loops, tuples and calls of functions that keep
    to the same; what is not compiled is named with its line. `rates` and `planar_rates` run several columns at a time
    where they have no branches and loops: a choice is `a if condition else b`; `math.sqrt`, `abs`, `min` and `max` cost
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
    """Which state is the spin, the angular velocity about the axis in the model's time; None for a model without."""

    planar_only: ClassVar[bool] = False
    """Whether the model knows motion in a vertical plane only, by `planar_rates`."""

    carried_names: ClassVar[tuple[str, ...]] = ()
    """What a single run carries along: it follows from the states and acts on nothing; such as twist and footprint.

    The first is the twist [rad]; then come x and y of the centre of the footprint circle [base radii].
    """

    carried_rates: ClassVar[Callable[..., tuple[float, ...]] | None] = None
    """(state…, parameters…) → the rates of what is carried along."""

    contact: ClassVar[Callable[..., tuple[float, float, float]] | None] = None
    """(state…, ax, ay, az, parameters…) → what the contact bears: N/(m g), |T|/(m g), |M_z|/(m g r).

    The normal force, the friction force, and the moment about the vertical, of a column that moves.
    """

    impact_map: ClassVar[Callable[..., tuple[float, ...]] | None] = None
    """(state…, parameters…) → the state after a passage of the upright below `loss_tilt`, with its loss."""

    guard_names: ClassVar[tuple[str, ...]] = ()
    """What each of the `guards` watches, of a model that switches between kinds of contact; else empty."""

    guards: ClassVar[Callable[..., tuple[float, ...]] | None] = None
    """(state…, ax, ay, az, ε, parameters…) → what is positive as long as a kind of contact lasts.

    One that is below zero ends it; the last does so only where it was above before. The tilt of "fallen" counts as
    overturned; all others lead to `reset_map`. ε is the energy of rest.
    """

    reset_map: ClassVar[Callable[..., tuple[float, tuple[float, ...]]] | None] = None
    """(state…, number of the margin, ax, ay, az, bx, by, bz, ahead, ε, parameters…) → elapsed time, and state.

    How the motion goes on; the base accelerates with (ax, ay, az) now and (bx, by, bz) a short time `ahead`, from which
    a release goes. With the number −1 it gives the state with which a motion begins.
    """

    project: ClassVar[Callable[..., tuple[float, ...]] | None] = None
    """(state…, parameters…) → the state with what it keeps from step to step brought up to date, after each step."""

    slip_states: ClassVar[tuple[int, ...]] = ()
    """Which states are the velocity of slip, integrated more finely while a contact slips: its direction matters."""

    kept_states: ClassVar[tuple[int, ...]] = ()
    """Which states do not change within a step: what `project` brings up to date, and the kind of contact."""

    contact_kinds: ClassVar[type[IntEnum] | None] = None
    """The kinds of contact, of which the last state is one.

    The first two are those of a column that stands on its base, at rest (RESTING) and sliding (SLIDING).
    """

    jacobian: ClassVar[Callable[..., tuple[tuple[float, ...], ...]] | None] = None
    """(state…, ax, ay, az, parameters…) → for each rate its derivatives by state, accelerations and parameters.

    None lets them be derived from `rates`, which can be done unless these choose between cases by a comparison.
    """

    planar_rates: ClassVar[Callable[..., tuple[float, float]] | None] = None
    """(tilt, rate, side, horizontal, vertical, parameters…) → the rates of tilt and rate in a vertical plane.

    `side` (±1) is the side of the upright on which the column leans; accelerations in g. `from_plane` goes with it.
    """

    from_plane: ClassVar[Callable[..., tuple[Any, ...]] | None] = None
    """(tilt, rate, ux, uy, parameters…) → the state of a motion in the plane along the unit vector (ux, uy).

    It is called with floats and with arrays.
    """

    rest_energy: ClassVar[Callable[..., float] | None] = None
    """(|α| [rad], |α̇|, a_z [g], parameters…) → energy above the state of rest without the work of the base.

    In units that make c² its scale.
    """

    no_return_tilt: ClassVar[Callable[..., float] | None] = None
    """(sup |a_h|, inf a_z, parameters…) → tilt [rad] beyond which a growing tilt can never come back, or inf.

    Both bounds are those from now on [g].
    """

    departure: ClassVar[Callable[..., tuple[float, ...]] | None] = None
    """(push, elapsed, parameters…) → the state a short time after the release by a `Push`."""

    passage: ClassVar[Callable[..., tuple[float, tuple[float, ...]]] | None] = None
    """(state…, ax, ay, az, parameters…) → duration and end state of a ballistic passage of the upright.

    It is asked for only where the path leads past the upright so closely that its turn cannot be resolved.
    """

    at_rest: ClassVar[Callable[..., tuple[float, ...]] | None] = None
    """(state…, parameters…) → the state in which a column that comes to rest stands; None for all zeros."""

    def __post_init__(self) -> None:
        """Check the column, then the numbers by their declarations."""
        require_column(self.column)
        Declared.__post_init__(self)

    @property
    @abstractmethod
    def parameters(self) -> tuple[float, ...]:
        """The numbers that the static functions take at their end."""

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
        """The |a_h|/(g + a_z) up to which the column stays on its base, a margin for rounding included."""
        return self.column.slenderness * (1.0 + RELEASE_MARGIN)

    @property
    def comes_to_rest(self) -> bool:
        """Whether friction brings a free column to rest; without friction it never gets there."""
        return False

    @property
    def loss_tilt(self) -> float:
        """Minimum tilt below which a passage near the vertical loses energy by `impact_map` [rad]; 0 without loss."""
        return 0.0

    @property
    def balance(self) -> Balance | None:
        """The unstable balance over which free motion must go to overturn, or None for no such claim.

        With less `energy` than it has there, and a smaller tilt, a column on a base at rest cannot overturn. A subclass
        that replaces `rates` or `parameters` makes this claim only if it states `balance` again.
        """
        return None

    @property
    def closed_form(self) -> ClosedForm | None:
        """The closed form of its steady rolling on a base that moves in a circle, or None where there is none.

        A subclass that replaces the equations makes this claim only if it states `closed_form` again; see
        `closed_form_of`.
        """
        return None

    def energy(self, states: Floats) -> Floats | None:
        """Return the energy above rest [J], shape (n,), which free motion can only lose, or None without a formula.

        Parameters
        ----------
        states
            Shape (number of states, n), perhaps with what is carried along behind them.
        """
        del states
        return None

    @property
    def switches(self) -> bool:
        """Whether it changes between kinds of contact."""
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
        """Return the state of a start of a model that changes between kinds of contact, in SI units."""
        del spin, twist, position, velocity, clearance
        return self.start(tilt, tilt_rate)

    def event_of(self, margin: str, before: int, after: int) -> str:
        """Return the name of an event, by the margin that was broken and the kinds of contact; "" for none."""
        del margin, before, after
        return ""

    @property
    def slope(self) -> tuple[float, float, float]:
        """What an inclined plane adds to the acceleration of the base [g]; `rates` add it themselves."""
        return 0.0, 0.0, 0.0

    def stands(self, state: tuple[float, ...]) -> bool:
        """Return whether the column stands on its base in this state: no tilt, and no rate of it."""
        return not any(self.tilt_of(*state[: len(self.state_names)], *self.parameters))

    def standing(self, state: tuple[float, ...]) -> tuple[float, ...]:
        """Return the state in which a column that comes to rest from `state` stands; what is carried stays."""
        moving, carried = state[: len(self.state_names)], state[len(self.state_names) :]
        still = (0.0,) * len(moving) if self.at_rest is None else self.at_rest(*moving, *self.parameters)
        return *still, *carried

    def least_safe_tilt(self, peak_horizontal: float, minimum_vertical: float) -> float:
        """Return `no_return_tilt` for these bounds [g], infinite where the model has none."""
        if self.no_return_tilt is None:
            return math.inf
        return self.no_return_tilt(peak_horizontal, minimum_vertical, *self.parameters)

    def outputs(self, states: Floats, accelerations: Floats, resting: npt.NDArray[np.bool_]) -> Mapping[str, Output]:
        """Return the outputs of the model besides the tilt, by name.

        Parameters
        ----------
        states
            Shape (number of states, n); behind them what is carried along.
        accelerations
            ax, ay, az [g], shape (3, n).
        resting
            Where the column stands on its base, shape (n,).
        """
        del states, accelerations, resting
        return {}


def require_column(value: object) -> None:
    """Raise ParameterError if `value` is no Column."""
    if not isinstance(value, Column):
        message = f"column must be a Column, such as Column.solid(...), got {value!r}"
        raise ParameterError(message)
