"""Newton's method for periodic orbits, single or multiple shooting, and the Floquet multipliers within rounding."""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from stylobate.engine.flow.integration import FlowStatus
from stylobate.engine.flow.periodic import Flow, FlowNumbers, PeriodicSystem
from stylobate.equality import ByContent
from stylobate.errors import NoOrbitError

Floats = npt.NDArray[np.float64]

# A state counts as exact if Newton's step is below this fraction of it; rounding of the flow leaves about 1e-13.
_CLOSE = 1e-10
_MOST_STEPS, _MOST_HALVINGS = 25, 8
# A step may increase the residual by this factor: far from an orbit Newton's method is not monotonic.
_GROWTH = 2.0

WHY_LOST = {
    FlowStatus.LOST: "it comes within 1e-6 c of the vertical, or so close that it loses energy",
    FlowStatus.GONE: "it leaves for tilts from which no motion returns",
    FlowStatus.FAILED: "the integration does not reach the tolerance",
}


@dataclass(frozen=True, slots=True, eq=False)
class Shots(ByContent):
    """A closed chain of arcs: states at the beginning of arcs, shape (arcs, order), and the flow along each arc.

    With a `factor` other than ones the chain covers half an orbit with x(t + nT/2) = −x(t), where x is the lean: the
    last arc ends at the opposite state of the first one, `factor` times the first state.
    """

    states: Floats
    flows: tuple[Flow, ...]
    factor: Floats

    @property
    def status(self) -> FlowStatus:
        """DONE, or the status of the first arc that does not reach its end."""
        return next((flow.status for flow in self.flows if flow.status is not FlowStatus.DONE), FlowStatus.DONE)

    @property
    def residual(self) -> Floats:
        """End of each arc minus the beginning of the next arc, shape (arcs, order)."""
        ends = np.stack([flow.end for flow in self.flows])
        ends[-1] *= self.factor
        return ends - np.roll(self.states, -1, axis=0)

    @property
    def matrix(self) -> Floats:
        """Derivative of the residual by the states, shape (arcs × order, arcs × order)."""
        arcs, order = self.states.shape
        matrix = np.zeros((arcs * order, arcs * order))
        for arc, flow in enumerate(self.flows):
            rows = slice(arc * order, (arc + 1) * order)
            matrix[rows, rows] += self._factor(arc)[:, np.newaxis] * flow.by_start
            after = (arc + 1) % arcs * order
            matrix[rows, after : after + order] -= np.eye(order)
        return matrix

    @property
    def by_parameter(self) -> Floats:
        """Derivative of the residual by the parameter, shape (arcs × order,)."""
        return np.concatenate([self._factor(arc) * flow.by_parameter for arc, flow in enumerate(self.flows)])

    @property
    def map_derivative(self) -> Floats:
        """Derivative of the closed map, which has the first state as a fixed point."""
        product = np.eye(self.states.shape[1])
        for flow in self.flows:
            product = flow.by_start @ product
        return self.factor[:, np.newaxis] * product

    @property
    def map_sensitivity(self) -> Floats:
        """Derivative of the closed map by the parameter."""
        total = np.zeros(self.states.shape[1])
        for flow in self.flows:
            total = flow.by_start @ total + flow.by_parameter
        return self.factor * total

    @property
    def monodromy(self) -> Floats:
        """Derivative of the state after the whole orbit by the state at its start."""
        once = self.map_derivative
        return once @ once if np.any(self.factor < 0.0) else once

    def _factor(self, arc: int) -> Floats:
        return self.factor if arc == len(self.flows) - 1 else np.ones_like(self.factor)

    @property
    def turns(self) -> float:
        """Turns of the lean about the vertical over all arcs."""
        return sum(flow.turns for flow in self.flows)

    @property
    def minimum_tilt(self) -> float:
        """Minimum tilt of all arcs."""
        return min(flow.minimum_tilt for flow in self.flows)

    @property
    def peak_tilt(self) -> float:
        """Peak tilt of all arcs."""
        return max(flow.peak_tilt for flow in self.flows)


def shots(
    system: PeriodicSystem, states: Floats, periods: float, *, sense: float = 1.0, change: FlowNumbers | None = None
) -> Shots:
    """Integrate each of `states`, shape (arcs, order), over its arc; the arcs cover `periods` base periods.

    With `sense` −1 the chain closes at the opposite of the first state.
    """
    arcs = len(states)
    ends = [periods * arc / arcs for arc in range(arcs + 1)]
    side, flows = 0.0, []
    for arc, state in enumerate(states):
        flow = system.carry(state, ends[arc], ends[arc + 1], change=change, side=side)
        flows.append(flow)
        if flow.status is not FlowStatus.DONE:
            # The other arcs are not integrated; this flow stands in for them.
            flows.extend([flow] * (arcs - arc - 1))
            break
    return Shots(states, tuple(flows), system.image(sense))


def closed(system: PeriodicSystem, guess: Floats, periods: int) -> Shots:
    """Find a periodic orbit by Newton's method from `guess`, shape (arcs, order).

    Raises
    ------
    NoOrbitError
        If Newton's method finds no orbit.
    """
    chain = shots(system, guess, periods)
    if chain.status is not FlowStatus.DONE:
        raise NoOrbitError(_lost("the guess", chain.status))
    for _ in range(_MOST_STEPS):
        step = newton_step(chain)
        if step is None:
            break
        following = damped(system, chain, step, periods)
        if following is None:
            raise NoOrbitError(_lost("Newton's method", chain_status(system, chain, step, periods)))
        close = np.abs(step).max() <= _CLOSE * np.abs(chain.states).max()
        chain = following
        if close:
            return chain
    raise NoOrbitError(
        f"no periodic orbit was reached from this guess in {_MOST_STEPS} steps; follow a run until it repeats"
    )


def newton_step(chain: Shots) -> Floats | None:
    """Return Newton's step, shape (arcs, order), or None if its equations are singular."""
    try:
        step = np.linalg.solve(chain.matrix, -chain.residual.ravel()).reshape(chain.states.shape)
    except np.linalg.LinAlgError:
        return None
    return np.asarray(step) if np.all(np.isfinite(step)) else None


def damped(system: PeriodicSystem, chain: Shots, step: Floats, periods: int) -> Shots | None:
    """Return the chain after the longest admissible fraction of `step`, or None."""
    before = float(np.linalg.norm(chain.residual))
    part = 1.0
    for _ in range(_MOST_HALVINGS):
        following = shots(system, chain.states + part * step, periods)
        after = float(np.linalg.norm(following.residual))
        if following.status is FlowStatus.DONE and (after <= _GROWTH * before or after <= _CLOSE * system.scale):
            return following
        part *= 0.5
    return None


def chain_status(system: PeriodicSystem, chain: Shots, step: Floats, periods: int) -> FlowStatus:
    """Return the status of the chain after the whole `step`; FAILED if it is DONE."""
    status = shots(system, chain.states + step, periods).status
    return status if status is not FlowStatus.DONE else FlowStatus.FAILED


def _lost(what: str, status: FlowStatus) -> str:
    return f"no periodic orbit was reached: {what} fails because {WHY_LOST[status]}; try another guess"


def arcs_of(system: PeriodicSystem, state: Floats, periods: float, arcs: int) -> Floats:
    """Return the states at the beginning of arcs, on the run that begins in `state`.

    Raises
    ------
    NoOrbitError
        If the run ends before.
    """
    states = [np.asarray(state, dtype=float)]
    for arc in range(arcs - 1):
        flow = system.carry(states[-1], periods * arc / arcs, periods * (arc + 1) / arcs)
        if flow.status is not FlowStatus.DONE or not math.isfinite(float(flow.end.sum())):
            raise NoOrbitError(_lost("the guess", flow.status))
        states.append(flow.end)
    return np.stack(states)


Complexes = npt.NDArray[np.complex128]

# A multiplier within this distance of the unit circle cannot be distinguished from a multiplier on the circle.
_NEUTRAL = 1e-9
# Rounding error of the product of all multipliers, as measured without damping, over the square of the largest; and the
# error above which the product is unknown.
_ROUNDING, _UNKNOWN = 1e-14, 0.1


def without_damping(multipliers: Complexes) -> bool:
    """Return whether the flow preserves volumes of states: the product of all multipliers is 1.

    Multipliers are accurate to 1e-9, and the smallest contains the rounding error of a large one.
    """
    allowed = len(multipliers) * _NEUTRAL + min(_rounding_of_product(multipliers), _UNKNOWN)
    return bool(abs(np.prod(multipliers) - 1.0) <= allowed)


def least_are_rounding(multipliers: Complexes) -> bool:
    """Return whether rounding of the largest multiplier dominates the smallest one and the product of all."""
    return _rounding_of_product(multipliers) > _UNKNOWN


def _rounding_of_product(multipliers: Complexes) -> float:
    return _ROUNDING * float(np.abs(multipliers).max()) ** 2


def is_stable(multipliers: Complexes) -> bool:
    """Return whether all multipliers lie inside the unit circle; without damping, whether none lies outside it."""
    margin = _NEUTRAL if without_damping(multipliers) else -_NEUTRAL
    return bool(np.abs(multipliers).max() < 1.0 + margin)
