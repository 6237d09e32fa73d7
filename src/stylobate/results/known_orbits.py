"""Known periodic orbits: runs of an ensemble that have converged to one of these orbits end early."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import numpy.typing as npt

from stylobate.cards import CardSection, Row, card
from stylobate.errors import ParameterError, as_numbers
from stylobate.text import four_digits

if TYPE_CHECKING:
    import xarray as xr

Floats = npt.NDArray[np.float64]
ArrayLike: TypeAlias = "npt.ArrayLike | xr.DataArray"

MOST_ORBITS = 16
"""Maximum number of known orbits of an ensemble."""

# Units in cards, and the most numbers that a card lists: a vector.
_UNITS = {"tilt": "rad", "tilt_rate": "rad/s", "spin": "rad/s", "mean_tilt": "rad"}
_MOST_SHOWN = 2


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class KnownOrbit:
    """Stable periodic orbit of one base period, common to all runs or different for each run.

    Each number has the shapes of `simulate_ensemble`: one for all runs, an array with the dimension `run`, or a
    DataArray. NaN in any number of a run means that this run has no such orbit.

    Parameters
    ----------
    tilt, tilt_rate
        Tilt vector [rad] and its rate [rad/s] at phase zero of the base motion, where stroboscopic samples are taken.
    spin
        Angular velocity about the axis at phase zero [rad/s], for models with a spin.
    multiplier
        Largest modulus of the Floquet multipliers of all states of the model, between 0 and 1. The multipliers of
        planar disturbances alone do not suffice.
    turns
        Turns of the contact point in one period, anticlockwise positive: +1 or −1 for rolling, 0 for rocking.
    mean_tilt
        Mean tilt over a period [rad]. It is the unit of distances from the orbit.

    Raises
    ------
    ParameterError
        If a number is infinite or out of these bounds.
    """

    tilt: ArrayLike
    tilt_rate: ArrayLike
    multiplier: ArrayLike
    turns: ArrayLike
    mean_tilt: ArrayLike
    spin: ArrayLike = 0.0

    def __post_init__(self) -> None:
        for name in self.__slots__:
            values = _numbers(name, getattr(self, name))
            if np.isinf(values).any():
                raise ParameterError(
                    f"known_orbits: {name} must be finite, or NaN for a run without the orbit; got inf"
                )
        _require("multiplier", self.multiplier, "lie between 0 and 1, for an orbit that is stable", _between_0_and_1)
        _require("mean_tilt", self.mean_tilt, "be positive", _positive)
        _require("turns", self.turns, "be -1 or 1 for rolling, 0 for rocking", _whole_turns)

    def numbers(self) -> Mapping[str, ArrayLike]:
        """Return the numbers of the orbit by name."""
        return {name: getattr(self, name) for name in self.__slots__}

    def _repr_html_(self) -> str:
        """Render the card that notebooks show."""
        shapes = {name: np.shape(value) for name, value in self.numbers().items()}
        per_run = {name: f"array of shape {shape}" for name, shape in shapes.items() if np.prod(shape) > _MOST_SHOWN}
        values = {name: ", ".join(map(four_digits, np.ravel(one))) for name, one in self.numbers().items()}
        rows = [
            Row(name.replace("_", " "), f"{(values | per_run)[name]} {_UNITS.get(name, '')}".rstrip())
            for name in self.__slots__
        ]
        return card("Known orbit", [CardSection("", rows)])

    def plain(self) -> dict[str, Any]:
        """Return the numbers of the orbit as plain values, without labels."""
        return {name: np.asarray(value, dtype=float).tolist() for name, value in self.numbers().items()}


KnownOrbits: TypeAlias = KnownOrbit | Sequence[KnownOrbit]


@dataclass(frozen=True, slots=True)
class OrbitsOfRuns:
    """Known orbits of each run, in SI units.

    Parameters
    ----------
    tilt, tilt_rate
        Shape (n, orbits, 2).
    spin, multiplier, turns, mean_tilt
        Shape (n, orbits). The multiplier is NaN if a run has no such orbit.
    """

    tilt: Floats
    tilt_rate: Floats
    spin: Floats
    multiplier: Floats
    turns: Floats
    mean_tilt: Floats

    @classmethod
    def of(cls, flat: Sequence[Mapping[str, Floats]]) -> "OrbitsOfRuns":
        """Return the orbits with these numbers, flat over the runs."""
        numbers = {name: np.stack([one[name] for one in flat], axis=1) for name in cls.__slots__}
        unknown = np.isnan(numbers["tilt"]).any(axis=-1) | np.isnan(numbers["tilt_rate"]).any(axis=-1)
        for name in ("spin", "multiplier", "turns", "mean_tilt"):
            unknown |= np.isnan(numbers[name])
        numbers["multiplier"] = np.where(unknown, np.nan, numbers["multiplier"])
        return cls(**numbers)

    def part(self, chosen: slice | npt.NDArray[np.intp]) -> "OrbitsOfRuns":
        """Return the orbits of some of the runs."""
        return OrbitsOfRuns(*(getattr(self, name)[chosen] for name in self.__slots__))


def as_orbits(given: KnownOrbits | None) -> tuple[KnownOrbit, ...]:
    """Return one or several known orbits as a tuple.

    Raises
    ------
    ParameterError
        If the argument has another type, or there are too many orbits.
    """
    orbits = () if given is None else (given,) if isinstance(given, KnownOrbit) else given
    if not isinstance(orbits, Sequence) or not all(isinstance(one, KnownOrbit) for one in orbits):
        raise ParameterError(f"known_orbits must be a KnownOrbit(...) or a list of them, got {given!r}")
    if len(orbits) > MOST_ORBITS:
        raise ParameterError(f"known_orbits must be {MOST_ORBITS} at most, got {len(orbits)}. Leave out some of them.")
    return tuple(orbits)


def _numbers(name: str, value: Any) -> Floats:
    value = as_numbers(f"known_orbits: {name}", value)
    try:
        return np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        raise ParameterError(f"known_orbits: {name} must be a number or an array of numbers, got {value!r}") from None


def _between_0_and_1(values: Floats) -> npt.NDArray[np.bool_]:
    return (values > 0.0) & (values < 1.0)


def _positive(values: Floats) -> npt.NDArray[np.bool_]:
    return values > 0.0


def _whole_turns(values: Floats) -> npt.NDArray[np.bool_]:
    return np.isin(values, (-1.0, 0.0, 1.0))


def _require(name: str, value: Any, bounds: str, holds: Callable[[Floats], npt.NDArray[np.bool_]]) -> None:
    values = _numbers(name, value)
    known = values[~np.isnan(values)]
    broken = known[~holds(known)]
    if broken.size:
        raise ParameterError(f"known_orbits: {name} must {bounds}, got {float(broken.flat[0])!r}")
