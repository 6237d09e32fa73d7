"""A family of periodic orbits over one parameter: points, tangents, and the way from one point to the next."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from stylobate.engine.flow.periodic import PeriodicSystem
from stylobate.engine.flow.tableau import Status
from stylobate.errors import StylobateError
from stylobate.orbits.shooting import Shots, shots

Floats = npt.NDArray[np.float64]
Complexes = npt.NDArray[np.complex128]

_CLOSE, _MOST_STEPS = 1e-11, 12


@dataclass(frozen=True, slots=True)
class Family:
    """Periodic orbits of one system, of one length, against the parameter `name`.

    Along it a point is measured by u: states in units of c, and the parameter in units of `span`, the width of what is
    looked at.
    """

    system: PeriodicSystem
    periods: int
    name: str
    span: float
    sense: float = 1.0

    @property
    def covered(self) -> float:
        """Periods that are shot over: half of them with `sense` −1, which keeps to orbits with the inversion."""
        return 0.5 * self.periods if self.sense < 0.0 else float(self.periods)

    def at(self, value: float) -> PeriodicSystem:
        """Return the system with this value of the parameter."""
        return self.system.changed(**{self.name: value})

    def units(self, count: int) -> Floats:
        """Return the units of u for `count` states."""
        return np.append(np.full(count, self.system.scale * np.sqrt(count)), self.span)


@dataclass(frozen=True)
class Point:
    """A periodic orbit of a family."""

    family: Family
    value: float
    chain: Shots

    @property
    def u(self) -> Floats:
        """Where it lies, in the units of the family."""
        states = self.chain.states.ravel()
        return np.asarray(np.append(states, self.value) / self.family.units(states.size))

    @cached_property
    def jacobian(self) -> Floats:
        """Derivative of the residual by u, one row fewer than columns."""
        units = self.family.units(self.chain.states.size)
        return np.column_stack([self.chain.matrix, self.chain.by_parameter]) * units

    @cached_property
    def tangent(self) -> Floats:
        """Unit vector along the family; `along` gives its sense."""
        return np.asarray(np.linalg.svd(self.jacobian)[2][-1])

    def along(self, direction: Floats) -> Floats:
        """Return the tangent that points the same way as `direction`."""
        return self.tangent if self.tangent @ direction >= 0.0 else -self.tangent

    @cached_property
    def map_derivative(self) -> Floats:
        """Derivative of the map of which the first state is a fixed point."""
        return self.chain.map_derivative

    @cached_property
    def map_multipliers(self) -> Complexes:
        """Eigenvalues of the map's derivative, the largest first; of a half orbit their squares are multipliers."""
        found = np.linalg.eigvals(self.map_derivative).astype(complex)
        return found[np.argsort(-np.abs(found), kind="stable")]

    @property
    def multipliers(self) -> Complexes:
        """Floquet multipliers, the largest first."""
        return self.map_multipliers**2 if self.family.sense < 0.0 else self.map_multipliers


def corrected(family: Family, u: Floats, normal: Floats) -> tuple[Point, int] | Status:
    """Return the point of the family in the plane through `u` across `normal`, and how many steps led there.

    Returns
    -------
    tuple or Status
        LOST or GONE where the orbit comes to the upright or leaves for good, FAILED where no point was reached.
    """
    order = family.system.order
    arcs = (u.size - 1) // order
    units = family.units(u.size - 1)
    here = u
    for steps in range(1, _MOST_STEPS + 1):
        try:
            value = float(here[-1] * units[-1])
            system, change = family.at(value), family.system.derivative(family.name, value)
        except StylobateError:  # the parameter has left what can be
            return Status.FAILED
        states = (here[:-1] * units[:-1]).reshape(arcs, order)
        chain = shots(system, states, family.covered, sense=family.sense, change=change)
        if chain.status is not Status.DONE:
            return chain.status
        point = Point(family, value, chain)
        # What is left to the plane is zero but for the first steps.
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
