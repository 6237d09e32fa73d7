"""What the modules of the driver leave open: each kernel binds it to a model and a kind of base motion.

See `kernels` for how; before that, a name here stands for nothing.
"""

from collections.abc import Callable
from typing import Any

from stylobate.compiler.programs import Unbound

WIDTH: int
ORDER: int
"""Number of equations."""
KEPT: int
"""Number of columns of the state, with what is noted of changes between kinds of contact."""
KEPT_STATES: tuple[int, ...]
"""States that a step keeps, among them the kind of contact."""
PARAMETERS: int
PLANAR: bool
SERIES: int
"""Order of the series by which steps are made; 0 where they are made by stages."""
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
DEMANDS: bool


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
"""Rows of the buffer."""

step: Callable[..., None]
observe: Callable[..., None]
accelerations: Callable[..., tuple[float, float, float]]
rates_at: Callable[..., tuple[float, ...]]
series_within: Callable[..., tuple[float, ...]]
row_state: Callable[..., tuple[float, ...]]
model_lean: Callable[..., tuple[float, float, float, float]]
lean_of_new: Callable[..., tuple[float, float, float, float]]
model_struck: Callable[..., tuple[float, ...]]
model_contact: Callable[..., tuple[float, float, float]]
model_at_rest: Callable[..., tuple[float, ...]]
model_departure: Callable[..., tuple[float, ...]]
model_no_return: Callable[..., float]
model_passage: Callable[..., tuple[float, tuple[float, ...]]]
model_rest_energy: Callable[..., float]
margins_at: Callable[..., tuple[float, ...]]
model_react: Callable[..., tuple[float, tuple[float, ...]]]
model_project: Callable[..., tuple[float, ...]]
note_window: Callable[..., None]
"""Notes where and how the column is as the last periods begin, of a model that changes between kinds of contact."""
stability: Callable[..., float]
"""hλ of the step just made, by a method of Runge and Kutta."""
set_dense: Callable[..., None]
dense_state: Callable[..., tuple[float, ...]]


def __getattr__(name: str) -> Any:
    if name in __annotations__:
        return Unbound(name)
    message = f"no kernel binds {name}"
    raise AttributeError(message)
