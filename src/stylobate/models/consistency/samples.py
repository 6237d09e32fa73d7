"""Random states of a model, with their rates and accelerations."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from stylobate.models.inheritance import owner_of
from stylobate.models.model import Model

Floats = npt.NDArray[np.float64]

# Half the step of central differences, in the time of the model; the error is of second order.
_STEP = 1e-4

# Peak tilt of a random state [rad], and peak tilt and rate in units of c.
_TOP, _TIMES_C = 1.2, 3.0


@dataclass(frozen=True, slots=True)
class Subject:
    """A model under examination, with its numbers.

    Parameters
    ----------
    model
        The model.
    thorough
        Whether to take many samples, and to report functions that raise.
    """

    model: Model
    numbers: tuple[float, ...]
    thorough: bool

    @property
    def slenderness(self) -> float:
        """c = r/h of the column, the scale of tilts."""
        return self.model.column.slenderness

    @property
    def halfway(self) -> float:
        """Half of the tipping angle [rad]: the weight returns the column from this tilt."""
        return 0.5 * self.model.column.tipping_angle

    def generator(self) -> "np.random.Generator":
        """Return a random generator with a fixed seed."""
        return np.random.default_rng(20)

    def state(self, tilt: tuple[float, float], rate: tuple[float, float], spin: float = 0.0) -> tuple[float, ...]:
        """Return the state with a tilt vector [rad], its rate and a spin in the time of the model."""
        scale, index = self.model.time_scale, self.model.spin_state
        begun = self.model.start(tilt, (rate[0] / scale, rate[1] / scale))
        return tuple(float(spin if i == index and spin else value) for i, value in enumerate(begun))

    def random_states(self, count: int) -> list[tuple[float, ...]]:
        """Return states of random tilts and rates of the order of c, with spin if the model has it."""
        random, c = self.generator(), self.slenderness
        found = []
        for _ in range(count):
            size = min(_TOP, c * random.uniform(0.05, _TIMES_C))
            lean, heading, speed = *random.uniform(0.0, 2.0 * np.pi, 2), c * random.uniform(0.0, _TIMES_C)
            if self.model.planar_only:
                heading = lean
            tilt = (size * np.cos(lean), size * np.sin(lean))
            found.append(
                self.state(tilt, (speed * np.cos(heading), speed * np.sin(heading)), random.uniform(-1.0, 1.0))
            )
        return found

    def rates(self, state: tuple[float, ...], push: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> np.ndarray:
        """Return the rates of a state under an acceleration of the base [g]."""
        return np.array(self.model.rates(*state, *push, *self.numbers), dtype=float)

    def beside(self, state: tuple[float, ...], rates: np.ndarray) -> tuple[tuple[float, ...], tuple[float, ...], float]:
        """Return the states a short time before and after `state`, and the time between them."""
        here = np.array(state)
        return tuple((here - _STEP * rates).tolist()), tuple((here + _STEP * rates).tolist()), 2.0 * _STEP

    def tilt_change(self, state: tuple[float, ...], push: tuple[float, float, float]) -> Floats:
        """Return the derivatives of the four results of `tilt_of` along `rates`."""
        before, after, lapse = self.beside(state, self.rates(state, push))
        found: Floats = (self.lean(after) - self.lean(before)) / lapse
        return found

    def tilt_acceleration(self, state: tuple[float, ...], push: tuple[float, float, float]) -> Floats:
        """Return the second derivative of the tilt vector."""
        return self.tilt_change(state, push)[2:]

    def lean(self, state: tuple[float, ...]) -> Floats:
        """Return the tilt vector and its rate, as `tilt_of` gives them."""
        return np.array(self.model.tilt_of(*state, *self.numbers), dtype=float)

    def described(self, state: tuple[float, ...], push: tuple[float, float, float] | None = None) -> str:
        """Return a state, and the acceleration of the base, for a message."""
        named = ", ".join(f"{name} = {value:.4g}" for name, value in zip(self.model.state_names, state, strict=True))
        return named if push is None else f"{named}, base acceleration {', '.join(f'{a:.4g}' for a in push)} g"

    def origin(self, name: str) -> str:
        """Return ", inherited from Slender," for a member that the class of the model does not state itself."""
        owner = owner_of(type(self.model), name)
        return "" if owner is type(self.model) else f", inherited from {owner.__name__},"
