"""A family of periodic orbits over one parameter: points, tangents and Newton's method for the next point."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from stylobate.engine.flow.integration import Status
from stylobate.engine.flow.periodic import PeriodicSystem
from stylobate.equality import ByContent
from stylobate.errors import StylobateError
from stylobate.orbits.shooting import Shots, shots

Floats = npt.NDArray[np.float64]
Complexes = npt.NDArray[np.complex128]

_CLOSE, _MOST_STEPS = 1e-11, 12


@dataclass(frozen=True, slots=True, eq=False)
class Family(ByContent):
    """Periodic orbits of one system and one length over the parameter `name`.

    The vector u of a point has the states in units of c, and the parameter in units of `span`, the width of its range.
    """

    system: PeriodicSystem
    periods: int
    name: str
    span: float
    sense: float = 1.0

    @property
    def covered(self) -> float:
        """Periods over which shooting integrates: half of them with `sense` −1, for orbits with the inversion only."""
        return 0.5 * self.periods if self.sense < 0.0 else float(self.periods)

    def at(self, value: float) -> PeriodicSystem:
        """Return the system with this value of the parameter."""
        return self.system.changed(**{self.name: value})

    def units(self, count: int) -> Floats:
        """Return the units of u for `count` states."""
        return np.append(np.full(count, self.system.scale * np.sqrt(count)), self.span)


@dataclass(frozen=True, eq=False)
class Point(ByContent):
    """A periodic orbit of a family."""

    family: Family
    value: float
    chain: Shots

    @property
    def u(self) -> Floats:
        """Vector u of the point, in the units of the family."""
        states = self.chain.states.ravel()
        return np.asarray(np.append(states, self.value) / self.family.units(states.size))

    @cached_property
    def jacobian(self) -> Floats:
        """Derivative of the residual by u, one row fewer than columns."""
        units = self.family.units(self.chain.states.size)
        return np.column_stack([self.chain.matrix, self.chain.by_parameter]) * units

    @cached_property
    def tangent(self) -> Floats:
        """Unit vector along the family; `along` chooses its sense."""
        return np.asarray(np.linalg.svd(self.jacobian)[2][-1])

    def along(self, direction: Floats) -> Floats:
        """Return the tangent that points the same way as `direction`."""
        return self.tangent if self.tangent @ direction >= 0.0 else -self.tangent

    @cached_property
    def map_derivative(self) -> Floats:
        """Derivative of the map that has the first state as a fixed point."""
        return self.chain.map_derivative

    @cached_property
    def map_multipliers(self) -> Complexes:
        """Eigenvalues of the map's derivative, the largest first; for a half orbit the squares are multipliers."""
        found = np.linalg.eigvals(self.map_derivative).astype(complex)
        return found[np.argsort(-np.abs(found), kind="stable")]

    @property
    def multipliers(self) -> Complexes:
        """Floquet multipliers, the largest first."""
        return self.map_multipliers**2 if self.family.sense < 0.0 else self.map_multipliers


def corrected(family: Family, u: Floats, normal: Floats) -> tuple[Point, int] | Status:
    """Return the point of the family in the plane through `u` across `normal`, and the number of Newton steps.

    Returns
    -------
    tuple or Status
        LOST if the orbit reaches the vertical, GONE if it leaves for good, FAILED if no point was reached.
    """
    order = family.system.order
    arcs = (u.size - 1) // order
    units = family.units(u.size - 1)
    here = u
    for steps in range(1, _MOST_STEPS + 1):
        try:
            value = float(here[-1] * units[-1])
            system, change = family.at(value), family.system.derivative(family.name, value)
        except StylobateError:  # the parameter has left its range
            return Status.FAILED
        states = (here[:-1] * units[:-1]).reshape(arcs, order)
        chain = shots(system, states, family.covered, sense=family.sense, change=change)
        if chain.status is not Status.DONE:
            return chain.status
        point = Point(family, value, chain)
        # The distance from the plane is zero after the first steps.
        matrix = np.vstack([point.jacobian, normal])
        residual = np.append(chain.residual.ravel(), normal @ (here - u))
        try:
            step = np.linalg.solve(matrix, -residual)
        except np.linalg.LinAlgError:
            return Status.FAILED
        if not np.all(np.isfinite(step)) or np.abs(step).max() > 1.0:
            return Status.FAILED
        if np.abs(step).max() < _CLOSE * max(float(np.abs(here).max()), 1e-3):
            return point, steps
        here = here + step
    return Status.FAILED


def on_family(family: Family, states: Floats, value: float) -> Point | Status:
    """Return the point at this value of the parameter, from states near it."""
    u = np.append(states.ravel(), value) / family.units(states.size)
    normal = np.zeros(u.size)
    normal[-1] = 1.0
    found = corrected(family, u, normal)
    return found if isinstance(found, Status) else found[0]
