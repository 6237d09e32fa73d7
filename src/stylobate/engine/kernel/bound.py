"""The buffer of a kernel, and the names that the driver leaves open: each kernel binds them.

The buffer is one contiguous array, row r of lane i at buf[r * WIDTH + i]. `columns` defines the meaning of the rows
(`Setup`, `Log`, `Lane`); the `Shape` of a kernel determines which it has. The open names stand for a model and a kind
of base motion; `kernels` binds them, and until then they have no value.
"""

from collections.abc import Callable, Iterator
from enum import IntEnum
from typing import Any

import numpy as np
import numpy.typing as npt

from stylobate.compiler.programs import placeholders

Table = npt.NDArray[np.float64]
Row = npt.NDArray[np.float64]


class FromZero(IntEnum):
    """Columns or rows, numbered from zero in the order of their definition."""

    @staticmethod
    def _generate_next_value_(name: str, start: int, count: int, last_values: list[int]) -> int:
        del name, start, last_values
        return count


class Rows:
    """Named rows, numbered in the order of addition."""

    def __init__(self) -> None:
        self._numbers: dict[str, int] = {}

    def add(self, *names: str) -> None:
        """Add rows."""
        for name in names:
            assert name not in self._numbers, name
            self._numbers[name] = len(self._numbers)

    def add_many(self, name: str, count: int) -> None:
        """Add the rows name0, name1 and so on."""
        self.add(*(f"{name}{index}" for index in range(count)))

    def __getitem__(self, name: str) -> int:
        return self._numbers[name]

    def get(self, name: str) -> int:
        """Return the index of a row, or 0 if there is no row of this name."""
        return self._numbers.get(name, 0)

    def __iter__(self) -> Iterator[str]:
        return iter(self._numbers)

    def __len__(self) -> int:
        return len(self._numbers)


WIDTH: int
GRAIN: int
"""The number of lanes of a step is a multiple of this number."""
ORDER: int
"""Number of equations."""
KEPT: int
"""Number of columns of the state and of the record of contact changes."""
GROUPS: tuple[int, ...]
"""The numbers of the groups of lanes."""
GROUP_KINDS: tuple[int, ...]
GROUP_MOVING: tuple[int, ...]
"""For each group of lanes: the kind of contact of its runs, and the number of leading states that change in a step."""
ROWS: int
"""Number of rows of a group."""
KEPT_STATES: tuple[int, ...]
"""States that are constant within a step, among them the kind of contact."""
PARAMETERS: int
PLANAR: bool
COMPONENTS: int
"""Number of acceleration components: one (planar) or two horizontal ones, and the vertical one if the base has it."""
SERIES: int
"""Order of the Taylor series; 0 if the steps are those of DOP853."""
INTEGRALS: tuple[int, ...]
"""For each state: the state whose rate it is, or itself. Only for steps by Taylor series."""
RATES_OF: tuple[int, ...]
"""For each state: the state that is its rate, or −1."""
DEGREES: tuple[int, ...]
COEFFICIENTS: tuple[int, ...]
"""Degree of the polynomial of each expanded state, and the row of its first coefficient."""
VERTICAL: bool
TERMS: int
WINDOWED: int
FIRST_FORCING: int
FORCING_ROWS: int
DEGREE: int
"""Degree of the polynomials that tabulate the base motion; −1 for harmonic motion."""
PARAMETERS_AT: int
MOTION_AT: int
BREAKS_AT: int
"""First columns of the parameters, of the numbers of the base motion and of its breaks in the table."""
TRACE_ROOM: int
"""Number of free trace entries that the driver requires before it handles an event of a lane."""
TRACE_STATES: int
TRACE_WIDTH: int
"""Maximum number of states in a trace entry, and number of its columns."""
CAN_REST: bool
CAN_DEPART: bool
CAN_PASS: bool
CAN_PROVE_NO_RETURN: bool
CAN_GO_TO_PLANE: bool
CAN_LOSE: bool
KEEPS_AT_REST: bool
"""Whether the model has a function `at_rest`, which gives the state at rest."""
SWITCHING: bool
"""Whether the model changes between kinds of contact."""
DEMANDS: bool
ORBITS: int
ORBITS_AT: int
"""Number of known orbits with which a run is compared, and their first column in the table."""
SPIN: int
"""Index of the spin in the state, or −1."""

GUARDS: int
LAST: int
LIMIT: int
"""Indices of the last guard of the model, and of the guard of the tilt limit, which follows it."""
FALLEN: int
"""Index of the guard of overturning."""
FRICTION: int
JAM: int
"""Indices of the guards of Coulomb friction and of dynamic jamming."""
SLIP_X: int
SLIP_Y: int
"""Indices of the slip velocity in the state."""
WINDOW_ENDS: tuple[int, int, int]
"""Indices of footprint and twist in the state."""
CHANGES: int
"""Number of unknowns of an implicit step: states times stages."""
RESTING: int
SLIDING: int
ROLLING: int
SLIPPING: int
FLYING: int
JAMMED: int
"""Kinds of contact."""

R: Any
"""Indices of the rows of the buffer."""

rates: Callable[..., tuple[float, ...]]
tilt_of: Callable[..., tuple[float, float, float, float]]
contact: Callable[..., tuple[float, float, float]]
impact_map: Callable[..., tuple[float, ...]]
from_plane: Callable[..., tuple[float, ...]]
rest_energy: Callable[..., float]
no_return_tilt: Callable[..., float]
departure: Callable[..., tuple[float, ...]]
passage: Callable[..., tuple[float, tuple[float, ...]]]
at_rest: Callable[..., tuple[float, ...]]
guards: Callable[..., tuple[float, ...]]
reset_map: Callable[..., tuple[float, tuple[float, ...]]]
project: Callable[..., tuple[float, ...]]
"""The model's functions: see `Model`."""

expand: Callable[..., tuple[tuple[tuple[float, ...], ...], tuple[tuple[float, ...], ...], tuple[float, ...]]]
"""Taylor coefficients of a step; `expansion` writes this function for the model."""

begin: Callable[..., int]
"""Starts the run of a lane; returns WAITING if the column moves, else the status with which the run ends at once."""
handle: Callable[..., int]
"""Handles the event of a lane; returns the final status if the run ends, else WAITING."""

__getattr__ = placeholders(__name__, __annotations__)
