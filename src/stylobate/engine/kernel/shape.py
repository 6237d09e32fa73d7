"""What sets one kernel apart from another, and the layout of its buffer and table."""

from dataclasses import dataclass
from functools import cache

from stylobate.engine.kernel.columns import (
    LOOKS,
    ORBIT,
    STATE,
    SWITCHING_TRACE_ROOM,
    TRACE_ROOM,
    TRACE_TERMS,
    Change,
    Lane,
    Log,
    Setup,
    Trace,
    Window,
)
from stylobate.engine.kernel.forcing import KernelForcing
from stylobate.engine.kernel.layout import Rows

STAGES = 12
"""Stages of DOP853; one more gives the slope at the end of a step."""

DENSE_TERMS = 7
"""Terms of the polynomial that gives the state within a step of DOP853."""

MARGIN_PLACES = 4
"""Equal parts of a step, at the ends of which guards are looked at."""

SERIES_ORDER = 16
"""Order of Taylor series."""

NODES = 8
"""Places within a step at which it is observed."""


@dataclass(frozen=True, slots=True)
class Shape:
    """What sets one kernel apart from another.

    Parameters
    ----------
    states, parameters
        How many the model has.
    planar
        Whether it integrates motion in a vertical plane, with two states.
    forcing
        How the base moves.
    width
        Lanes.
    series
        Where steps are made by Taylor series: of each state the one whose rate it is, or itself. Empty where they are
        made by DOP853.
    demands
        Whether it follows what the contact must bear.
    guards
        How many guards guard a kind of contact, of a model that changes between kinds; else 0.
    slip, kept
        Which of its states are the velocity of slip, and which do not change within a step.
    orbits
        With how many known orbits each run is compared.
    """

    states: int
    parameters: int
    planar: bool
    forcing: KernelForcing
    width: int
    series: tuple[int, ...] = ()
    demands: bool = False
    guards: int = 0
    slip: tuple[int, ...] = ()
    kept: tuple[int, ...] = ()
    orbits: int = 0

    @property
    def orbits_at(self) -> int:
        """Column of the table at which known orbits begin, behind the state and what is noted of changes."""
        return STATE + max(self.states, 2) + len(self.changes)

    @property
    def parameters_at(self) -> int:
        """Column at which the model's parameters begin."""
        return self.orbits_at + self.orbits * ORBIT

    @property
    def motion_at(self) -> int:
        """Column at which the numbers of the base motion begin."""
        return self.parameters_at + self.parameters

    @property
    def breaks_at(self) -> int:
        """Column at which its breaks begin."""
        return self.motion_at + self.forcing.columns

    @property
    def trace_width(self) -> int:
        """Columns of an entry of a trace, the same for motion in space and in a plane."""
        return len(Trace) + TRACE_TERMS * max(self.states, 2)

    @property
    def trace_room(self) -> int:
        """Entries of a trace that must be free before a lane is dealt with."""
        return SWITCHING_TRACE_ROOM if self.guards else TRACE_ROOM

    @property
    def order(self) -> int:
        """Number of equations."""
        return 2 if self.planar else self.states

    @property
    def changes(self) -> list[str]:
        """Rows behind the state: what is noted of changes between kinds of contact."""
        return [column.name.lower() for column in Change] if self.guards else []

    @property
    def expanded(self) -> list[int]:
        """The states whose Taylor coefficients are kept: all that are not the rate of another."""
        return [j for j, integral in enumerate(self.series) if integral == j]

    @property
    def paired(self) -> set[int]:
        """Those whose rate is a state too."""
        return {integral for j, integral in enumerate(self.series) if integral != j}

    def degree(self, j: int) -> int:
        """Return the degree of the polynomial of an expanded state."""
        return SERIES_ORDER + (j in self.paired)

    def rows(self) -> Rows:
        """Return the layout of the buffer: the tables' columns first, under their names in small letters."""
        return _rows_of(self)


@cache
def _rows_of(shape: Shape) -> Rows:
    rows = Rows()
    rows.add(*(column.name.lower() for column in Setup), *(column.name.lower() for column in Log))
    for window in ("before", "late"):
        rows.add(*(f"{window}_{column.name.lower()}" for column in Window))
    rows.add_many("look", 4 * LOOKS)
    rows.add_many("y", shape.order)
    rows.add(*shape.changes)
    rows.add(*(row.name.lower() for row in Lane))
    rows.add_many("p", shape.parameters)
    shape.forcing.reserve(rows)
    rows.add(*(f"end_{name}" for name in shape.forcing.components))
    for name in ("new", "last"):
        rows.add_many(name, shape.order)
    if shape.orbits:
        rows.add("phase_zero_at", "converged")
        rows.add_many("orbit", shape.orbits * ORBIT)
    if shape.demands:
        rows.add(*(f"{name}_{place}" for place in ("now", 1, 2, 3, 4) for name in DEMANDS))
    (_add_series if shape.series else _add_stages)(shape, rows)
    return rows


def _add_series(shape: Shape, rows: Rows) -> None:
    rows.add("proposed", *(f"node_{name}" for name in OBSERVED))
    rows.add_many("square", SERIES_ORDER + 1)
    for j in shape.expanded:
        rows.add(*(f"c{k}_{j}" for k in range(1, shape.degree(j) + 1)))


def _add_stages(shape: Shape, rows: Rows) -> None:
    for stage in range(STAGES + 1):
        rows.add_many(f"k{stage}_", shape.order)
    rows.add_many("last_slope", shape.order)
    if shape.guards:
        rows.add("last_margin", "margin_now", "broken", "stiff_looks", "stiff_look_at", "stiff_wait")
        for name in ("stage", "rate", "step"):
            rows.add_many(name, shape.order)
    for name in ("extra0_", "extra1_", "extra2_", *(f"dense{power}_" for power in range(DENSE_TERMS))):
        rows.add_many(name, shape.order)


DEMANDS = ("normal", "friction", "pivoting")
"""What the contact must bear: normal force over m g, friction and moment over it."""

OBSERVED = ("mean_tilt", "forward_cos", "forward_sin", "backward_cos", "backward_sin")
"""Rows of the integrals over the last periods."""
