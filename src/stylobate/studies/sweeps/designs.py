"""What a sweep varies: quantities and their checked values, on a grid, at random or at given points."""

import hashlib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol, TypeAlias

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import BaseMotion
from stylobate.engine.cost import require_memory
from stylobate.engine.parameters import check_names
from stylobate.errors import MOST_RUNS, ParameterError, as_numbers, require_finite, require_size, require_whole
from stylobate.models import Model
from stylobate.parameter_quantities import quantity_of
from stylobate.quantities import Parameter
from stylobate.results.random_numbers import Rng, seed_of

Floats = npt.NDArray[np.float64]
Own: TypeAlias = Mapping[str, Parameter] | None

STARTS = ("tilt_x", "tilt_y", "tilt_rate_x", "tilt_rate_y")
"""Components of the initial conditions."""

OF_A_RUN = (*STARTS, "spin", "duration")
"""Quantities that can vary besides the parameters of `simulate_ensemble`."""


def check_quantities(where: str, model: Model, names: Iterable[str], motion: BaseMotion | None = None) -> None:
    """Raise ParameterError if one of the `names` in the argument `where` cannot vary, or two are contradictory."""
    check_names(model, motion, names, where=where, others=OF_A_RUN)


def checked_values(where: str, name: str, values: npt.ArrayLike, own: Own = None, *, scalar: bool = False) -> Floats:
    """Return `values` of the quantity `name` as an array, shape (n,).

    Parameters
    ----------
    where
        The argument with names and values; or, such as scales, with the values alone.
    name, values
        The quantity and its values, which may be quantities of pint or astropy.
    own
        Declared numbers of the model and base motion at hand.
    scalar
        Whether the argument is the values alone, and a single number a list of one.

    Raises
    ------
    ParameterError
        If the values are not a list of numbers, or the quantity does not accept one of them.

    Warns
    -----
    UnlikelyInputWarning
        If the largest value was more likely meant in another unit.
    """
    argument = where if scalar or where in (name, f"{name}s") else f"{where}[{name!r}]"
    quantity = quantity_of(name, own)
    values = as_numbers(argument, values, quantity.unit)
    try:
        array = np.array(values, dtype=np.float64, ndmin=int(scalar))  # a copy: a sweep is immutable
    except (TypeError, ValueError):
        raise ParameterError(f"{argument} must be a list of numbers, got {values!r}") from None
    if array.ndim != 1:
        raise ParameterError(f"{argument} must be a list of numbers, got an array of shape {array.shape}")
    refused = ~quantity.accepts(array)
    if refused.any():
        number = require_finite(argument, float(array[refused][0]), quantity.unit)
        require_size(argument, number, quantity.unit)
        raise ParameterError(quantity.refusal(argument, number))
    for value in (array.min(initial=1.0), array.max(initial=1.0)):
        require_size(argument, float(value), quantity.unit, zero=quantity.gt is None or quantity.gt < 0.0)
    if array.size:
        quantity.question(argument, float(array[np.argmax(np.abs(array))]))
    array.setflags(write=False)
    return array


# Size of groups of random points, each with its own stream, so that the points do not depend on the blocks.
_GROUP = 4096
# Minimum memory for drawing a random run and storing its result [bytes].
_BYTES_OF_A_START = 64


class Design(Protocol):
    """The values of the runs of a sweep, an array of `shape` over `dims`."""

    @property
    def argument(self) -> str:
        """The argument with the names of the quantities that vary."""

    @property
    def names(self) -> tuple[str, ...]:
        """The quantities that vary."""

    @property
    def dims(self) -> tuple[str, ...]:
        """The names of the dimensions."""

    @property
    def shape(self) -> tuple[int, ...]:
        """Lengths of the dimensions."""

    def values(self, slices: tuple[slice, ...]) -> dict[str, Floats]:
        """Return the values of the runs in a piece of the array, flat, in C order."""

    @property
    def coordinate_dims(self) -> dict[str, str]:
        """The dimension along which each quantity varies."""

    def coordinates(self, slices: tuple[slice, ...]) -> dict[str, Floats]:
        """Return the coordinates of a piece of the array, each along its dimension."""

    def describe(self) -> dict[str, Any]:
        """Return the identity of this design as plain values."""


@dataclass(frozen=True, slots=True, eq=False)
class Grid:
    """Every combination of the values of each of `axes`."""

    axes: Mapping[str, Floats]
    argument: str = field(default="over", init=False)

    @classmethod
    def of(cls, over: Mapping[str, npt.ArrayLike], own: Own = None) -> "Grid":
        """Return the grid `over` these values."""
        _require_names("over", over)
        return cls({name: checked_values("over", name, values, own) for name, values in over.items()})

    @property
    def names(self) -> tuple[str, ...]:
        """The quantities that vary."""
        return tuple(self.axes)

    @property
    def dims(self) -> tuple[str, ...]:
        """One dimension per quantity."""
        return self.names

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of values of each quantity."""
        return tuple(axis.size for axis in self.axes.values())

    def values(self, slices: tuple[slice, ...]) -> dict[str, Floats]:
        """Return every combination within the piece, flat, in C order."""
        parts = [axis[part] for axis, part in zip(self.axes.values(), slices, strict=True)]
        return {name: mesh.ravel() for name, mesh in zip(self.axes, np.meshgrid(*parts, indexing="ij"), strict=True)}

    @property
    def coordinate_dims(self) -> dict[str, str]:
        """Each quantity along its own dimension."""
        return {name: name for name in self.names}

    def coordinates(self, slices: tuple[slice, ...]) -> dict[str, Floats]:
        """Return the values along each dimension."""
        return {name: axis[part] for (name, axis), part in zip(self.axes.items(), slices, strict=True)}

    def describe(self) -> dict[str, Any]:
        """Return the dimensions in order, and the identity of their values."""
        return {"kind": "grid", "dims": list(self.dims), "values": {name: digest(a) for name, a in self.axes.items()}}


@dataclass(frozen=True, slots=True, eq=False)
class Box:
    """`count` points drawn uniformly between `bounds`; the first ones are the same for every `count`."""

    bounds: Mapping[str, tuple[float, float]]
    count: int
    seed: int
    argument: str = field(default="over", init=False)

    @classmethod
    def of(cls, over: Mapping[str, Sequence[float]], count: int, rng: Rng, own: Own = None) -> "Box":
        """Return random points in the box `over` these bounds; a generator provides one number as the seed."""
        _require_names("over", over)
        bounds = {name: _bounds(name, pair, own) for name, pair in over.items()}
        number = require_whole("count", count, least=0, most=MOST_RUNS)
        require_memory(_BYTES_OF_A_START * number, number, "Draw fewer")
        return cls(bounds, number, seed_of(rng))

    @property
    def names(self) -> tuple[str, ...]:
        """The quantities that vary."""
        return tuple(self.bounds)

    @property
    def dims(self) -> tuple[str, ...]:
        """The dimension of the runs."""
        return ("run",)

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of runs."""
        return (self.count,)

    def values(self, slices: tuple[slice, ...]) -> dict[str, Floats]:
        """Return the values of these runs."""
        (part,) = slices
        low, high = np.array(list(self.bounds.values())).T
        first, last = part.start // _GROUP, -(-part.stop // _GROUP)
        groups = [self._shares(group) for group in range(first, last)]
        shares = np.concatenate(groups) if groups else np.empty((0, low.size))
        chosen = shares[part.start - first * _GROUP : part.stop - first * _GROUP]
        # Weighted so that the bounds can be reached exactly but never exceeded.
        columns = np.clip((1.0 - chosen) * low + chosen * high, low, high).T
        return {name: np.ascontiguousarray(column) for name, column in zip(self.names, columns, strict=True)}

    def _shares(self, group: int) -> Floats:
        stream = np.random.SeedSequence(self.seed, spawn_key=(group,))
        return np.random.Generator(np.random.PCG64(stream)).random((_GROUP, len(self.bounds)))

    @property
    def coordinate_dims(self) -> dict[str, str]:
        """All quantities along the runs."""
        return dict.fromkeys(self.names, "run")

    def coordinates(self, slices: tuple[slice, ...]) -> dict[str, Floats]:
        """Return the values of these runs."""
        return self.values(slices)

    def describe(self) -> dict[str, Any]:
        """Return bounds, number and seed."""
        bounds = {name: list(pair) for name, pair in self.bounds.items()}
        return {"kind": "random", "order": list(self.names), "values": bounds, "count": self.count, "seed": self.seed}


@dataclass(frozen=True, slots=True, eq=False)
class Points:
    """Runs at given values: the i-th of each of `columns`."""

    columns: Mapping[str, Floats]
    argument: str = field(default="at", init=False)

    @classmethod
    def of(cls, at: Mapping[str, npt.ArrayLike], own: Own = None) -> "Points":
        """Return the points `at` these values.

        Raises
        ------
        ParameterError
            If the arrays have different lengths.
        """
        _require_names("at", at)
        columns = {name: checked_values("at", name, values, own) for name, values in at.items()}
        (first, length), *others = [(name, values.size) for name, values in columns.items()]
        for name, size in others:
            if size != length:
                raise ParameterError(f"at[{name!r}] must have as many values as at[{first!r}], {length}, got {size}")
        return cls(columns)

    @property
    def names(self) -> tuple[str, ...]:
        """The quantities that vary."""
        return tuple(self.columns)

    @property
    def dims(self) -> tuple[str, ...]:
        """The dimension of the runs."""
        return ("run",)

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of runs."""
        return (next(iter(self.columns.values())).size,)

    def values(self, slices: tuple[slice, ...]) -> dict[str, Floats]:
        """Return the values of these runs."""
        (part,) = slices
        return {name: column[part] for name, column in self.columns.items()}

    @property
    def coordinate_dims(self) -> dict[str, str]:
        """All quantities along the runs."""
        return dict.fromkeys(self.names, "run")

    def coordinates(self, slices: tuple[slice, ...]) -> dict[str, Floats]:
        """Return the values of these runs."""
        return self.values(slices)

    def describe(self) -> dict[str, Any]:
        """Return the identity of the values."""
        return {"kind": "points", "values": {name: digest(column) for name, column in self.columns.items()}}


def whole(design: Design) -> tuple[slice, ...]:
    """Return the slices of all runs of `design`."""
    return tuple(slice(0, length) for length in design.shape)


def digest(values: Floats) -> dict[str, Any]:
    """Return number, ends and SHA-256 of `values`, which represent the values in a description."""
    ends = {"first": float(values[0]), "last": float(values[-1])} if values.size else {}
    bits = np.ascontiguousarray(values, dtype="<f8").tobytes()
    return {"count": int(values.size), **ends, "sha256": hashlib.sha256(bits).hexdigest()}


def _require_names(where: str, given: object) -> None:
    if not isinstance(given, Mapping) or not given:
        raise ParameterError(
            f'{where} must name what varies, such as {where}={{"angular_frequency": …}}, got {given!r}'
        )


def _bounds(name: str, pair: Sequence[float], own: Own) -> tuple[float, float]:
    values = checked_values("over", name, pair, own)
    if values.size != 2 or not values[0] <= values[1]:  # noqa: PLR2004
        raise ParameterError(f"over[{name!r}] must be a lower and an upper bound, got {pair!r}")
    low, high = (float(value) for value in values)
    return low, high
