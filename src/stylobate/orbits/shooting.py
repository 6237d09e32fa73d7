"""Newton's method for periodic orbits: single or multiple shooting with exact derivatives."""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from stylobate.engine.flow.periodic import Flow, Numbers, PeriodicSystem
from stylobate.engine.flow.tableau import Status
from stylobate.errors import NoOrbitError

Floats = npt.NDArray[np.float64]

# A state found counts as exact when Newton's step is below this part of it; rounding of the flow leaves about 1e-13.
_CLOSE = 1e-10
_MOST_STEPS, _MOST_HALVINGS = 25, 8
# A step may make the residual grow by this much: far from an orbit Newton's way is not monotonic.
_GROWTH = 2.0

WHY_LOST = {
    Status.LOST: "it comes within 1e-6 c of the upright, where its direction is lost, or so near that it loses energy",
    Status.GONE: "it leaves for tilts from which no motion returns",
    Status.FAILED: "it cannot be followed with the wanted tolerance",
}


@dataclass(frozen=True, slots=True)
class Shots:
    """A closed chain of arcs: states where arcs begin, shape (arcs, order), and how each arc was carried.

    With a `factor` other than ones it covers half an orbit that is its own image under x(t + nT/2) = −x(t), x being the
    lean: the last arc ends at the opposite of the first state, which the factor makes of it.
    """

    states: Floats
    flows: tuple[Flow, ...]
    factor: Floats

    @property
    def status(self) -> Status:
        """DONE, or how the first arc that was not carried to its end went."""
        return next((flow.status for flow in self.flows if flow.status is not Status.DONE), Status.DONE)

    @property
    def residual(self) -> Floats:
        """Where each arc ends less where the next begins, shape (arcs, order)."""
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
        """Derivative of the closed map, of which the first state is a fixed point."""
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
        """Derivative of the state after the whole orbit by the one at its start."""
        once = self.map_derivative
        return once @ once if np.any(self.factor < 0.0) else once

    def _factor(self, arc: int) -> Floats:
        return self.factor if arc == len(self.flows) - 1 else np.ones_like(self.factor)

    @property
    def turns(self) -> float:
        """Turns of the lean about the upright over what is shot."""
        return sum(flow.turns for flow in self.flows)

    @property
    def minimum_tilt(self) -> float:
        """Minimum tilt met."""
        return min(flow.minimum_tilt for flow in self.flows)

    @property
    def peak_tilt(self) -> float:
        """Peak tilt met."""
        return max(flow.peak_tilt for flow in self.flows)


def shots(
    system: PeriodicSystem, states: Floats, periods: float, *, sense: float = 1.0, change: Numbers | None = None
) -> Shots:
    """Carry each of `states`, shape (arcs, order), over its arc of `periods` periods of the base motion.

    With `sense` −1 they close at the opposite of the first state.
    """
    arcs = len(states)
    ends = [periods * arc / arcs for arc in range(arcs + 1)]
    side, flows = 0.0, []
    for arc, state in enumerate(states):
        flow = system.carry(state, ends[arc], ends[arc + 1], change=change, side=side)
        flows.append(flow)
        if flow.status is not Status.DONE:
            # The others are not looked at; their numbers stand in so that the chain is whole.
            flows.extend([flow] * (arcs - arc - 1))
            break
    return Shots(states, tuple(flows), system.image(sense))


def closed(system: PeriodicSystem, guess: Floats, periods: int) -> Shots:
    """Return the periodic orbit to which Newton's method leads from `guess`, shape (arcs, order).

    Raises
    ------
    NoOrbitError
        If it leads to none.
    """
    chain = shots(system, guess, periods)
    if chain.status is not Status.DONE:
        raise NoOrbitError(_lost("the guess", chain.status))
    for _ in range(_MOST_STEPS):
        step = newton_step(chain)
        if step is None:
            break
        following = damped(system, chain, step, periods)
        if following is None:
            raise NoOrbitError(_lost("on its way Newton's method", chain_status(system, chain, step, periods)))
        close = np.abs(step).max() <= _CLOSE * np.abs(chain.states).max()
        chain = following
        if close:
            return chain
    message = f"no periodic orbit was reached from this guess in {_MOST_STEPS} steps; follow a run until it repeats"
    raise NoOrbitError(message)


def newton_step(chain: Shots) -> Floats | None:
    """Return Newton's step, shape (arcs, order), or None where its equations are singular."""
    try:
        step = np.linalg.solve(chain.matrix, -chain.residual.ravel()).reshape(chain.states.shape)
    except np.linalg.LinAlgError:
        return None
    return np.asarray(step) if np.all(np.isfinite(step)) else None


def damped(system: PeriodicSystem, chain: Shots, step: Floats, periods: int) -> Shots | None:
    """Return the chain after as much of `step` as can be made, or None."""
    before = float(np.linalg.norm(chain.residual))
    part = 1.0
    for _ in range(_MOST_HALVINGS):
        following = shots(system, chain.states + part * step, periods)
        after = float(np.linalg.norm(following.residual))
        if following.status is Status.DONE and (after <= _GROWTH * before or after <= _CLOSE * system.scale):
            return following
        part *= 0.5
    return None


def chain_status(system: PeriodicSystem, chain: Shots, step: Floats, periods: int) -> Status:
    """Return how the chain after the whole `step` goes wrong."""
    status = shots(system, chain.states + step, periods).status
    return status if status is not Status.DONE else Status.FAILED


def _lost(what: str, status: Status) -> str:
    return f"no periodic orbit was reached: {what} fails because {WHY_LOST[status]}; try another guess"


def arcs_of(system: PeriodicSystem, state: Floats, periods: float, arcs: int) -> Floats:
    """Return states where arcs begin, on the run that begins in `state`.

    Raises
    ------
    NoOrbitError
        If the run does not last so long.
    """
    states = [np.asarray(state, dtype=float)]
    for arc in range(arcs - 1):
        flow = system.carry(states[-1], periods * arc / arcs, periods * (arc + 1) / arcs)
        if flow.status is not Status.DONE or not math.isfinite(float(flow.end.sum())):
            raise NoOrbitError(_lost("the guess", flow.status))
        states.append(flow.end)
    return np.stack(states)
