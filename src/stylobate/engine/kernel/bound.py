"""What the modules of the driver leave open: each kernel binds it to a model and a kind of base motion.

See `kernels` for how; before that, a name here stands for nothing.
"""

from collections.abc import Callable
from typing import Any

from stylobate.compiler.programs import Unbound

WIDTH: int
GRAIN: int
"""A step takes a multiple of so many lanes."""
ORDER: int
"""Number of equations."""
KEPT: int
"""Number of columns of the state, with what is noted of changes between kinds of contact."""
KEPT_STATES: tuple[int, ...]
"""States that a step keeps, among them the kind of contact."""
PARAMETERS: int
PLANAR: bool
COMPONENTS: int
"""Of the acceleration that are followed: one along the line of a plane or two, and the vertical one if there is any."""
SERIES: int
"""Order of the series by which steps are made; 0 where they are made by stages."""
INTEGRALS: tuple[int, ...]
"""Of each state the one whose rate it is, or itself, where steps are made by series."""
RATES_OF: tuple[int, ...]
"""Of each state the one that is its rate, or −1."""
DEGREES: tuple[int, ...]
COEFFICIENTS: tuple[int, ...]
"""Of each expanded state the degree of its polynomial, and the row of its first coefficient."""
VERTICAL: bool
TERMS: int
WINDOWED: int
FIRST_FORCING: int
FORCING_ROWS: int
DEGREE: int
"""Of the polynomials that tabulate the base motion; −1 for harmonic motion."""
PARAMETERS_AT: int
MOTION_AT: int
BREAKS_AT: int
"""Columns of the table at which the parameters, the numbers of the base motion and its breaks begin."""
TRACE_ROOM: int
"""Entries of a trace that must be free before a lane is dealt with."""
TRACE_STATES: int
TRACE_WIDTH: int
"""Most states of an entry of a trace, and its columns."""
CAN_REST: bool
CAN_DEPART: bool
CAN_PASS: bool
CAN_PROVE_NO_RETURN: bool
CAN_GO_TO_PLANE: bool
CAN_LOSE: bool
KEEPS_AT_REST: bool
"""Whether the model has a function `at_rest` that says in which state it rests."""
SWITCHING: bool
"""Whether the model changes between kinds of contact."""
DEMANDS: bool
ORBITS: int
ORBITS_AT: int
"""With how many known orbits a run is compared, and the column of the table at which they begin."""
SPIN: int
"""Number of the state that is the spin, or −1."""

GUARDS: int
LAST: int
LIMIT: int
"""Numbers of the last margin, and of that of the tilt limit behind it."""
FALLEN: int
"""Number of the margin of a column that has overturned."""
FRICTION: int
JAM: int
"""Numbers of the margins of friction, and of friction that jams."""
SLIP_X: int
SLIP_Y: int
"""Places of the velocity of slip in the state."""
WINDOW_ENDS: tuple[int, int, int]
"""Places of footprint and twist in the state."""
CHANGES: int
"""Numbers that make up an implicit step: as many states as it has stages."""
RESTING: int
SLIDING: int
ROLLING: int
SLIPPING: int
FLYING: int
JAMMED: int
"""Kinds of contact."""

R: Any
"""Numbers of the rows of the buffer."""

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
"""Taylor coefficients of a step; written for the model, see `expansion`."""

begin: Callable[..., int]
"""Sets the run of a lane going; returns WAITING when it moves, else the status with which it ends at once."""
handle: Callable[..., int]
"""Deals with a lane that needs it; returns the status of a run that ends, or WAITING."""


def __getattr__(name: str) -> Any:
    if name in __annotations__:
        return Unbound(name)
    message = f"no kernel binds {name}"
    raise AttributeError(message)
