"""Shape of a kernel: its distinguishing properties, kinds of base motion, and the layout of its buffer and table."""

from dataclasses import dataclass
from functools import cache
from typing import Protocol

from stylobate.engine.kernel.bound import Rows
from stylobate.engine.kernel.columns import (
    ORBIT,
    STATE,
    SWITCHING_TRACE_ROOM,
    TRACE_ROOM,
    TRACE_TERMS,
    BySeries,
    Change,
    Lane,
    Log,
    Setup,
    Switching,
    Tabulated,
    Trace,
    Watching,
    Wave,
)
from stylobate.engine.kernel.driver.events import EventSetup


class KernelForcing(Protocol):
    """A kind of base motion that kernels can evaluate."""

    @property
    def components(self) -> tuple[str, ...]:
        """Names of the accelerations: "ax" and "ay", or "ah" if planar, and "az" if the base moves vertically."""

    @property
    def tag(self) -> str:
        """Short name for file names."""

    def reserve(self, rows: Rows) -> None:
        """Add the rows of the coefficients."""

    def constants(self, rows: Rows) -> dict[str, int]:
        """Return the constants that the driver needs to fill the rows."""

    @property
    def columns(self) -> int:
        """Number of columns that describe the motion in the table of a batch."""


@dataclass(frozen=True, slots=True)
class Harmonics(KernelForcing):
    """Sum of harmonic terms, each with one frequency, and an amplitude and phase for each component.

    Parameters
    ----------
    terms
        Number of terms.
    windowed
        Whether the terms may begin later or rise over a time: each is multiplied by α − β cos(window phase).
    components
        ("ax", "ay"), or ("ah",) if planar; with "az" if the base moves vertically.
    """

    terms: int
    windowed: bool
    components: tuple[str, ...]

    @property
    def tag(self) -> str:
        """Short name such as `h1`, `h2w`; `z` marks a vertical component."""
        return f"h{self.terms}{'w' * self.windowed}{'z' * ('az' in self.components)}"

    @property
    def columns(self) -> int:
        """Number of columns, those of `Wave` for each term."""
        return self.terms * (len(Wave) if self.windowed else Wave.ONSET)

    def reserve(self, rows: Rows) -> None:
        """Add the rows of all terms, term by term."""
        for term in range(self.terms):
            rows.add(f"turns{term}")
            for component in self.components:
                rows.add(f"{component}_amplitude{term}")
                rows.add(f"{component}_phase{term}")
            if self.windowed:
                for name in ("full", "depth", "window_turns", "window_phase"):
                    rows.add(f"{name}{term}")

    def constants(self, rows: Rows) -> dict[str, int]:
        """Return the number of terms and the layout of their rows."""
        return {
            "TERMS": self.terms,
            "WINDOWED": int(self.windowed),
            "FIRST_FORCING": rows["turns0"] if self.terms else 0,
            "FORCING_ROWS": 1 + 2 * len(self.components) + 4 * self.windowed,
            "DEGREE": -1,
        }


@dataclass(frozen=True, slots=True)
class Polynomials(KernelForcing):
    """Motion tabulated as successive polynomials of the same `degree`; steps end where the pieces end."""

    degree: int
    components: tuple[str, ...]

    @property
    def tag(self) -> str:
        """Short name such as `p1`, `p15`; `z` marks a vertical component."""
        return f"p{self.degree}{'z' * ('az' in self.components)}"

    @property
    def columns(self) -> int:
        """Number of columns, those of `Tabulated`."""
        return len(Tabulated)

    def reserve(self, rows: Rows) -> None:
        """Add the rows of the present piece."""
        rows.add("middle")
        rows.add("per_half")
        for component in self.components:
            for power in range(self.degree + 1):
                rows.add(f"{component}{power}")

    def constants(self, rows: Rows) -> dict[str, int]:
        """Return the degree and the first row."""
        return {
            "TERMS": 0,
            "WINDOWED": 0,
            "FIRST_FORCING": rows["middle"],
            "FORCING_ROWS": self.degree + 1,
            "DEGREE": self.degree,
        }


STAGES = 12
"""Stages of DOP853; one more gives the slope at the end of a step."""

DENSE_TERMS = 7
"""Terms of the polynomial that gives the state within a step of DOP853."""

ANY_KIND = -2
"""Not a kind of contact: that of a group of lanes for all kinds without a group of their own."""

SERIES_ORDER = 16
"""Order of Taylor series."""

NODES = 8
"""Number of nodes within a step at which it is observed."""


@dataclass(frozen=True, slots=True)
class Shape:
    """Properties that distinguish one kernel from another.

    Parameters
    ----------
    states, parameters
        Numbers of states and parameters of the model.
    planar
        Whether it integrates planar motion, with two states.
    forcing
        Kind of base motion.
    width
        Number of lanes.
    series
        For steps by Taylor series: for each state the state whose rate it is, or itself. Empty for DOP853.
    demands
        Whether it computes the contact demands.
    guards
        Number of guards of a model that changes between kinds of contact; else 0.
    slip, kept
        Indices of the slip velocity, and of the states that are constant within a step, the last ones.
    groups
        Groups of lanes: kind of contact, and number of leading states that change within a step.
    orbits
        Number of known orbits with which each run is compared.
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
    groups: tuple[tuple[int, int], ...] = ()
    orbits: int = 0

    @property
    def orbits_at(self) -> int:
        """First column of the known orbits in the table, behind the state and the record of contact changes."""
        return STATE + max(self.states, 2) + len(self.changes)

    @property
    def parameters_at(self) -> int:
        """First column of the parameters of the model."""
        return self.orbits_at + self.orbits * ORBIT

    @property
    def motion_at(self) -> int:
        """First column of the numbers of the base motion."""
        return self.parameters_at + self.parameters

    @property
    def breaks_at(self) -> int:
        """First column of the breaks of the base motion."""
        return self.motion_at + self.forcing.columns

    @property
    def trace_width(self) -> int:
        """Number of columns of a trace entry, the same for three-dimensional and planar motion."""
        return len(Trace) + TRACE_TERMS * max(self.states, 2)

    @property
    def trace_room(self) -> int:
        """Number of free trace entries that the driver requires before it handles an event of a lane."""
        return SWITCHING_TRACE_ROOM if self.guards else TRACE_ROOM

    @property
    def order(self) -> int:
        """Number of equations."""
        return 2 if self.planar else self.states

    @property
    def changes(self) -> list[str]:
        """Rows behind the state: the record of contact changes."""
        return [column.name.lower() for column in Change] if self.guards else []

    @property
    def expanded(self) -> list[int]:
        """States whose Taylor coefficients are stored: all that are not the rate of another state."""
        return [j for j, integral in enumerate(self.series) if integral == j]

    @property
    def paired(self) -> set[int]:
        """States whose rate is also a state."""
        return {integral for j, integral in enumerate(self.series) if integral != j}

    def degree(self, j: int) -> int:
        """Return the degree of the polynomial of an expanded state."""
        return SERIES_ORDER + (j in self.paired)

    def rows(self) -> Rows:
        """Return the layout of the buffer: first the columns of the table, under their names in lower case."""
        return _rows_of(self)


@cache
def _rows_of(shape: Shape) -> Rows:
    rows = Rows()
    rows.add(*(column.name.lower() for group in (Setup, EventSetup, Log) for column in group))
    rows.add_many("y", shape.order)
    rows.add(*shape.changes)
    rows.add(*(row.name.lower() for row in Lane))
    rows.add_many("p", shape.parameters)
    shape.forcing.reserve(rows)
    rows.add(*(f"end_{name}" for name in shape.forcing.components))
    for name in ("new", "last"):
        rows.add_many(name, shape.order)
    if shape.orbits:
        rows.add(*(row.name.lower() for row in Watching))
        rows.add_many("orbit", shape.orbits * ORBIT)
    if shape.demands:
        rows.add(*(f"{name}_{place}" for place in ("now", 1, 2, 3, 4) for name in DEMANDS))
    (_add_series if shape.series else _add_stages)(shape, rows)
    return rows


def _add_series(shape: Shape, rows: Rows) -> None:
    rows.add(*(row.name.lower() for row in BySeries))
    rows.add_many("square", SERIES_ORDER + 1)
    for j in shape.expanded:
        rows.add(*(f"c{k}_{j}" for k in range(1, shape.degree(j) + 1)))


def _add_stages(shape: Shape, rows: Rows) -> None:
    for stage in range(STAGES + 1):
        rows.add_many(f"k{stage}_", shape.order)
    rows.add_many("last_slope", shape.order)
    if shape.guards:
        rows.add(*(row.name.lower() for row in Switching))
        for name in ("stage", "rate", "step"):
            rows.add_many(name, shape.order)
    for name in ("extra0_", "extra1_", "extra2_", *(f"dense{power}_" for power in range(DENSE_TERMS))):
        rows.add_many(name, shape.order)


DEMANDS = ("normal", "friction", "pivoting")
"""Contact demands: normal force over m g, and friction force and moment over the normal force."""
