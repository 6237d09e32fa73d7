"""Limit states of displacement: slip, residual position, free distance to neighbours and to the edge of a plinth."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import TypeAlias

import numpy as np
import xarray as xr

from stylobate.column import Column
from stylobate.errors import ParameterError, require_positive
from stylobate.text import did_you_mean


class Response(Enum):
    """The displacement that a limit state limits; the value is its name in files."""

    SLIP = "slip"
    """Largest distance of the base from its start."""
    RESIDUAL = "residual"
    """Distance of the base from its start at the end."""
    NEIGHBOURS = "neighbours"
    """Largest horizontal displacement of the body at a height, by slip and tilt."""
    EDGE = "edge"
    """Largest distance of the base from its start, towards the edge of a plinth."""

    @classmethod
    def named(cls, value: "str | Response") -> "Response":
        """Return the response of a name; raise ParameterError for an unknown one."""
        if isinstance(value, cls):
            return value
        names = [one.value for one in cls]
        if value not in names:
            remedy = did_you_mean(str(value), names) or f"use one of {', '.join(names)}."
            raise ParameterError(f"response: unknown (got {value!r}). {remedy[0].upper()}{remedy[1:]}")
        return cls(value)


_MILLIMETRES = 1000.0


@dataclass(frozen=True, slots=True, kw_only=True)
class LimitState:
    """A limit of the displacement of a column relative to its base.

    Parameters
    ----------
    response
        "slip": the largest distance of the base from its start. "residual": its distance at the end. "neighbours": the
        largest horizontal displacement of the body at `height`, against the free distance there. "edge": the largest
        distance of the base from its start, against the distance from the base to the edge of its plinth.
    limit
        The distance that counts as reached [m].
    height
        Height above the base at which neighbours are [m]; for "neighbours" only, by default the height of the column.

    Raises
    ------
    ParameterError
        If the response is unknown, a length is not positive, or a height is stated for another response.

    Notes
    -----
    The direction in which a column slides is seldom known in advance, so each limit is a circle about the start: state
    the smallest free distance. A base that reaches the edge of its plinth still stands, until its centre of pressure
    passes the edge; the limit state is on the safe side.

    Examples
    --------
    >>> LimitState(response="slip", limit=0.05).name, LimitState(response="neighbours", limit=0.08, height=2.5).name
    ('slip 50 mm', 'neighbours 80 mm at 2.5 m')
    """

    response: str | Response
    limit: float
    height: float | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "response", Response.named(self.response))
        object.__setattr__(self, "limit", require_positive("limit", self.limit, "m"))
        if self.height is not None:
            if self.kind is not Response.NEIGHBOURS:
                raise ParameterError(f"height: is of no use for {self.kind.value} (got {self.height!r}). Remove it.")
            object.__setattr__(self, "height", require_positive("height", self.height, "m"))

    @property
    def kind(self) -> Response:
        """The response."""
        return Response.named(self.response)

    @property
    def name(self) -> str:
        """Name of the limit state, such as "slip 50 mm"."""
        where = "" if self.height is None else f" at {self.height:g} m"
        return f"{self.kind.value} {_MILLIMETRES * self.limit:g} mm{where}"

    def of_slip(self, peak: xr.DataArray, residual: xr.DataArray) -> xr.DataArray:
        """Return whether a column that slides on its whole base reaches the limit; its tilt is zero.

        Parameters
        ----------
        peak, residual
            Largest distance from the start, and distance at the end [m].
        """
        return (residual if self.kind is Response.RESIDUAL else peak) >= self.limit

    def of_tilt(self, tilt: xr.DataArray, columns: Sequence[Column], over: str) -> xr.DataArray:
        """Return whether a column that does not slip reaches a limit of "neighbours" by its tilt; see `shift`."""
        return self.shift(tilt, columns, over) >= self.limit

    def shift(self, tilt: xr.DataArray, columns: Sequence[Column], over: str) -> xr.DataArray:
        """Compute the displacement [m] at the height z by a tilt: z sin θ + r (1 − cos θ), contact point at rest.

        Parameters
        ----------
        tilt
            Peak tilts [rad].
        columns
            The column, or several over the dimension `over`.
        over
            Dimension of several columns.

        Raises
        ------
        ParameterError
            If the height is not stated and the column has none.
        """
        heights = xr.DataArray([self.height_on(column) for column in columns], dims=over)
        radii = xr.DataArray([column.radius for column in columns], dims=over)
        if len(columns) == 1:
            heights, radii = heights.isel({over: 0}), radii.isel({over: 0})
        moved: xr.DataArray = heights * np.sin(tilt) + radii * (1.0 - np.cos(tilt))
        return moved

    def height_on(self, column: Column) -> float:
        """Return the height of the limit on a column [m]: as stated, or that of the column.

        Raises
        ------
        ParameterError
            If the height is not stated and the column has none.
        """
        if self.height is not None:
            return self.height
        if column.height is None:
            raise ParameterError(
                f"height: missing in the limit state {self.name!r}, and the column has none. State it, such as 2.0."
            )
        return column.height


LimitStates: TypeAlias = Sequence[LimitState] | Mapping[str, Sequence[LimitState]]
"""Limit states of all columns, or of each by its name."""


def checked_limit_states(given: Iterable[LimitState], where: str = "limit_states") -> tuple[LimitState, ...]:
    """Return limit states of different names as a tuple.

    Raises
    ------
    ParameterError
        If a value is no `LimitState`, or two have one name.
    """
    if isinstance(given, LimitState) or not isinstance(given, Iterable):
        raise ParameterError(f"{where}: must be a sequence of limit states (got {given!r}). Pass [LimitState(…)].")
    found = tuple(given)
    for one in found:
        if not isinstance(one, LimitState):
            raise ParameterError(
                f'{where}: must hold limit states (got {one!r}). Pass LimitState(response="slip", limit=0.05).'
            )
    names = [one.name for one in found]
    for name in names:
        if names.count(name) > 1:
            raise ParameterError(f"{where}: two limit states are equal (got {name!r} twice). Remove one.")
    return found
