"""Names that the modules of the driver leave open: each kernel binds them to a model and a kind of base motion.

`kernels` binds the names; until then they have no value.
"""

from collections.abc import Callable
from typing import Any

from stylobate.compiler.programs import placeholders

WIDTH: int
GRAIN: int
"""The number of lanes of a step is a multiple of this number."""
ORDER: int
"""Number of equations."""
KEPT: int
"""Number of columns of the state and of the record of contact changes."""
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
