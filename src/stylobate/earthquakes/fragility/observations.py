"""Data of a fragility fit: intensity, limit states, record and property sample of each run."""

from dataclasses import dataclass, replace
from enum import Enum
from typing import Any, Self, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.errors import ParameterError

Floats: TypeAlias = npt.NDArray[np.float64]
Integers: TypeAlias = npt.NDArray[np.int64]
Data: TypeAlias = npt.ArrayLike | xr.DataArray

NOT_KNOWN = -1
"""Code of an undecided run."""

LIMIT_STATE = "limit_state"


class Counting(Enum):
    """How runs above the first that reached the limit state count, if the column survives there."""

    AS_COMPUTED = "as computed"
    """Each run as computed."""
    FIRST = "first"
    """Every run above the first that reached it counts as reached."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Observations:
    """Runs as flat arrays.

    Parameters
    ----------
    intensity
        Intensity of each run, shape (runs,), positive.
    reached
        Shape (limit states, runs): 1 reached, 0 not, NOT_KNOWN.
    record
        Number of the record of each run, from 0, shape (runs,); None if records are not named.
    series
        Number of the combination of record and property sample of each run.
    records
        Names of the records, by number.
    names
        Names of the limit states.
    attributes
        Unit and long name of the intensity.
    """

    intensity: Floats
    reached: Integers
    record: Integers | None
    series: Integers | None
    records: tuple[str, ...]
    names: tuple[str, ...]
    attributes: dict[str, Any]

    @classmethod
    def of(cls, intensity: Data, reached: Data, record: Data | None, property_sample: Data | None = None) -> Self:
        """Flatten arrays that broadcast by the names of their dimensions, or have equal shapes.

        Raises
        ------
        ParameterError
            If shapes differ, an intensity is not positive, or `reached` has values other than booleans, 0, 1 and −1.
        """
        states = _labelled("reached", reached, ())
        if LIMIT_STATE not in states.dims:
            name = str(states[LIMIT_STATE].item()) if LIMIT_STATE in states.coords else "reached"
            states = states.drop_vars(LIMIT_STATE, errors="ignore").expand_dims({LIMIT_STATE: [name]})
        dims = tuple(str(dim) for dim in states.dims if dim != LIMIT_STATE)
        shaped = states.isel({LIMIT_STATE: 0}, drop=True)
        levels = _labelled("intensity", intensity, dims, shaped.shape)
        given = [_named(states, "record", record), _named(states, "property_sample", property_sample)]
        named = [None if one is None else _labelled(*one, dims, shaped.shape) for one in given]
        try:
            parts = xr.broadcast(shaped, levels, *(one for one in named if one is not None))
            states = states.broadcast_like(parts[0]).transpose(LIMIT_STATE, *parts[0].dims)
        except ValueError as error:
            raise ParameterError(
                f"intensity, reached and record must have one shape or share named dimensions: {error}"
            ) from None
        values = parts[1].to_numpy().ravel()
        known, number = (None, None) if named[0] is None else _numbered(parts[2])
        series = number
        if number is not None and named[1] is not None:
            samples, sample = _numbered(parts[3])
            series = number * samples.size + sample
        return cls(
            intensity=_positive(values),
            reached=_codes(states.to_numpy().reshape(states.sizes[LIMIT_STATE], -1)),
            record=number,
            series=None if series is None else np.unique(series, return_inverse=True)[1],
            records=() if known is None else tuple(str(one) for one in known),
            names=tuple(str(name) for name in states[LIMIT_STATE].to_numpy()),
            attributes={"long_name": "intensity", "units": "1", **levels.attrs},
        )

    def counted(self, counting: Counting) -> Self:
        """Count the runs above the first reached one of each series by the rule `counting`.

        Raises
        ------
        ParameterError
            If records are required but not named.
        """
        if counting is Counting.AS_COMPUTED:
            return self
        if self.series is None:
            raise ParameterError(
                "counting must be Counting.AS_COMPUTED if no record is named, got Counting.FIRST; give record"
            )
        reached = self.reached.copy()
        for state in reached:
            for one in range(self.series.max() + 1):
                runs = self.series == one
                first = np.min(self.intensity, where=runs & (state == 1), initial=np.inf)
                state[runs & (self.intensity >= first)] = 1
        return replace(self, reached=reached)

    def non_monotone(self) -> Integers:
        """Count the records that survive above an intensity that reached each limit state."""
        if self.record is None or self.series is None:
            return np.full(len(self.names), NOT_KNOWN, dtype=np.int64)
        found = []
        for state in self.reached:
            all_series = [self.series == one for one in range(self.series.max() + 1)]
            back = [int(self.record[runs][0]) for runs in all_series if self._falls_back(state, runs)]
            found.append(len(set(back)))
        return np.array(found, dtype=np.int64)

    def _falls_back(self, state: Integers, runs: npt.NDArray[np.bool_]) -> bool:
        first = np.min(self.intensity, where=runs & (state == 1), initial=np.inf)
        return bool(np.any(runs & (state == 0) & (self.intensity > first)))


def _labelled(name: str, values: Data, dims: tuple[str, ...], shape: tuple[int, ...] = ()) -> xr.DataArray:
    if isinstance(values, xr.DataArray):
        return values
    array = np.asarray(values)
    if not dims:
        return xr.DataArray(array, dims=[f"run_{place}" if place else "run" for place in range(array.ndim)])
    if array.shape != shape:
        raise ParameterError(
            f"{name} must have the shape of reached, {shape}, or named dimensions; got shape {array.shape}"
        )
    return xr.DataArray(array, dims=dims)


def _named(reached: xr.DataArray, name: str, values: Data | None) -> tuple[str, Data] | None:
    """Return the given names, or those of the dimension or coordinate of `reached`; None without either."""
    if values is not None:
        return name, values
    if name in reached.coords:
        return name, reached[name]
    return (name, xr.DataArray(np.arange(reached.sizes[name]), dims=name)) if name in reached.dims else None


def _numbered(values: xr.DataArray) -> tuple[npt.NDArray[Any], Integers]:
    """Return the unique values, and the index of each run's value among them."""
    known, number = np.unique(values.to_numpy().ravel(), return_inverse=True)
    return known, number.astype(np.int64)


def _positive(given: npt.NDArray[Any]) -> Floats:
    if given.size and given.dtype.kind not in "iuf":
        raise ParameterError(f"intensity must hold real numbers, got {given[0]!r}")
    values = given.astype(np.float64)
    if not values.size:
        raise ParameterError("intensity must hold at least one run, got none")
    bad = values[~(np.isfinite(values) & (values > 0.0))]
    if bad.size:
        raise ParameterError(
            f"intensity must be positive and finite, got {float(bad[0])!r}; leave out runs without base motion"
        )
    return values


def _codes(values: npt.NDArray[Any]) -> Integers:
    bad = values[~np.isin(values, (NOT_KNOWN, 0, 1))]
    if bad.size:
        raise ParameterError(f"reached must hold True or False (or 1, 0, and -1 for not known), got {bad.flat[0]!r}")
    return np.asarray(values, dtype=np.int64)
