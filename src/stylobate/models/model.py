"""The contract between a model of the column and everything that uses models."""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from stylobate.column import Column
from stylobate.errors import UnsupportedError

Floats = npt.NDArray[np.float64]

# Room for rounding in the release criterion [ulp]: with an acceleration of exactly the limit, about one sample in ten
# of a circular motion exceeds it by one ulp.
RELEASE_MARGIN = 8.0 * float(np.finfo(float).eps)


@dataclass(frozen=True, slots=True, kw_only=True)
class Push:
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


@dataclass(frozen=True, slots=True)
class Output:
    """A quantity along a run: `values` of shape (n,) or (n, 2), its `units` and a `long_name` for axes."""

    values: Floats
    units: str
    long_name: str


class Model(ABC):
    """A column with its equations of motion.

    A model integrates in its own units: time in units of `time_scale`, accelerations of the base in units of
    `column.gravity`. It never sees the base motion, only the acceleration of the moment.

    Notes
    -----
    For developers: a model has a `column` and gives `state_names`, `parameters`, `rates`, `start`, `tilt` and
    `tilt_rate`; everything below them in this class has a default. Without `rest_energy` a column never comes to
    rest, without `planar_rates` coplanar motion is integrated in space, without `no_return_tilt` a stated limit
    tells overturning.
    """

    __slots__ = ()

    name: ClassVar[str]
    state_names: ClassVar[tuple[str, ...]]
    rates: ClassVar[Callable[..., tuple[float, ...]]]
    """The right-hand side, a static function (state…, ax, ay, az, parameters…) → rates; accelerations in g."""
    column: Column

    @property
    @abstractmethod
    def parameters(self) -> tuple[float, ...]:
        """The numbers that `rates` takes after the accelerations."""

    @abstractmethod
    def start(self, tilt: tuple[float, float], tilt_rate: tuple[float, float]) -> tuple[float, ...]:
        """Return the state with this tilt vector [rad] and its rate [rad/s]."""

    @abstractmethod
    def tilt(self, states: Floats) -> Floats:
        """Return the tilt vectors [rad], shape (2, n), of `states`, shape (number of states, n)."""

    @abstractmethod
    def tilt_rate(self, states: Floats) -> Floats:
        """Return the rates of the tilt vectors in the model's own time, shape (2, n)."""

    @property
    def time_scale(self) -> float:
        """The model's unit of time, 1/ω0 [s]."""
        return 1.0 / self.column.frequency_scale

    @property
    def rest_capacity(self) -> float:
        """The |a_h|/(g + a_z) up to which the column stays on its base, a margin for rounding included."""
        return self.column.slenderness * (1.0 + RELEASE_MARGIN)

    def stands(self, state: tuple[float, ...]) -> bool:
        """Return whether the column stands on its base in this state: no tilt, and no rate of it."""
        column = np.array(state)[:, np.newaxis]
        return not (np.any(self.tilt(column)) or np.any(self.tilt_rate(column)))

    def at_rest(self, state: tuple[float, ...]) -> tuple[float, ...]:
        """Return the state in which a column that comes to rest from `state` stands; all zeros unless overridden."""
        return (0.0,) * len(state)

    @property
    def comes_to_rest(self) -> bool:
        """Whether friction brings a free column to rest; without friction it never gets there."""
        return False

    def rest_energy(self, tilt: float, speed: float, vertical: float) -> float:
        """Return the energy above the state of rest, without the work of the base; infinite if unknown.

        Parameters
        ----------
        tilt, speed
            |α| [rad] and |α̇| in the model's own time.
        vertical
            a_z [g].

        Returns
        -------
        float
            Energy in units that make c² its scale.
        """
        del tilt, speed, vertical
        return math.inf

    def no_return_tilt(self, largest_horizontal: float, least_vertical: float) -> float:
        """Return the tilt [rad] beyond which a tilt that grows can never come back; infinite if none is known.

        Parameters
        ----------
        largest_horizontal
            sup |a_h| from now on [g].
        least_vertical
            inf a_z from now on [g].
        """
        del largest_horizontal, least_vertical
        return math.inf

    def depart(self, push: Push, elapsed: float) -> tuple[float, ...] | None:
        """Return the state a short time `elapsed` after release, or None where release is not modelled."""
        del push, elapsed
        return None

    def pass_upright(
        self, state: tuple[float, ...], accelerations: tuple[float, float, float]
    ) -> tuple[float, tuple[float, ...]] | None:
        """Return the duration and the end of a ballistic passage of the upright from `state`, or None if unknown.

        It is asked for only where the path leads past the upright so closely that its turn cannot be resolved.
        """
        del state, accelerations
        return None

    def planar_rates(
        self, tilt: float, rate: float, side: float, horizontal: float, vertical: float
    ) -> tuple[float, float] | None:
        """Return the rates of (`tilt`, `rate`) in a vertical plane on one `side` (±1) of the upright, or None."""
        del tilt, rate, side, horizontal, vertical
        return None

    def from_plane(self, planar: Floats, line: tuple[float, float]) -> Floats:
        """Return the states, shape (number of states, n), of planar states (tilt, rate) along the unit vector.

        Raises
        ------
        UnsupportedError
            If the model gives `planar_rates` without it.
        """
        del planar, line
        message = f"model {self.name} gives planar_rates and must give from_plane with it"
        raise UnsupportedError(message)

    def outputs(self, states: Floats, accelerations: Floats, resting: npt.NDArray[np.bool_]) -> Mapping[str, Output]:
        """Return what the model tells besides the tilt, by name.

        Parameters
        ----------
        states
            Shape (number of states, n).
        accelerations
            ax, ay, az [g], shape (3, n).
        resting
            Where the column stands on its base, shape (n,).
        """
        del states, accelerations, resting
        return {}
