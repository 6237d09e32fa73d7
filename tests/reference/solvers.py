"""The integrator of a stretch between two events: DOP853, or Radau where slip is stiff.

Slip that has hardly begun follows the load almost at once, and so does the creep of a patch that turns: the rates of
its direction are as large as friction over slip. There the steps of an explicit method are cut by stability alone.
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.integrate import DOP853, Radau

from stylobate.engine.forcing import Floats
from stylobate.engine.tolerances import SLIP_SHARE, SLIP_TURNS

from .following import Method
from .steps import attempted, with_finite_step

# E. Hairer, G. Wanner, "Solving Ordinary Differential Equations II", section IV.2: the boundary of stability of DOP853
# along the negative axis is at hλ = 6.1; so many steps near it in turn count as stiff.
_NEAR_BOUNDARY, _STIFF_STEPS = 3.0, 20

# Radau's steps are over where those of DOP853, some times as long, would be stable.
_EASY = 1.0


# Part of its size by which a state is changed to see how the rates change.
_DIFFERENCE = 1e-7


class Stepper:
    """Steps from a state towards a stop, by the method that suits them.

    Parameters
    ----------
    derivative
        Rates at a time, of a state.
    start, state, stop
        Where it begins, and how far it may go.
    method
        Tolerances.
    slip
        Which states are the velocity of a contact that slips: this may be stiff, and a slip that fades is told more
        finely. Empty where nothing slips.
    """

    def __init__(
        self,
        derivative: Callable[[float, Any], Any],
        start: float,
        state: Floats,
        stop: float,
        method: Method,
        slip: tuple[int, ...],
    ) -> None:
        self._derivative, self._stop, self._method = derivative, stop, method
        self._slip, self._near = list(slip), 0
        self._atol: Any = np.full(state.size, method.atol)
        self._atol[self._slip] *= SLIP_SHARE
        self.solver: Any = self._explicit(start, state)

    @property
    def running(self) -> bool:
        """Whether the stop lies ahead."""
        return bool(self.solver.status == "running")

    def step(self) -> str | None:
        """Make a step; return why that failed, or None."""
        if self._near >= _STIFF_STEPS and isinstance(self.solver, DOP853):
            self.solver = self._implicit(self.solver.t, self.solver.y)
        elif self._near == 0 and isinstance(self.solver, Radau):
            self.solver = self._explicit(self.solver.t, self.solver.y)
        failure = attempted(self.solver)  # trial steps across the end of a slip may overflow
        if self._slip and failure is None:
            self._look(self.solver)
        return failure

    def turned(self, state: Floats) -> bool:
        """Return whether a slip that ends along its heading in `state`, within the last step, goes on across it."""
        if not self._slip:
            return False
        before, after = (float(np.linalg.norm(y[self._slip])) for y in (self.solver.y_old, state))
        return after > SLIP_TURNS * (float(self._atol[self._slip[0]]) + self._method.rtol * before)

    def again(self, length: float) -> None:
        """Go back to where the last step began, and step on from there by this length at most."""
        solver = self.solver
        renewed = self._explicit if isinstance(solver, DOP853) else self._implicit
        self.solver = renewed(solver.t_old, solver.y_old, length)

    def _look(self, solver: Any) -> None:
        """Count the steps in turn that were cut by stability; of an implicit method, down those that would not be."""
        if isinstance(solver, DOP853):
            self._near = self._near + 1 if _boundary(solver) > _NEAR_BOUNDARY else 0
        else:
            easy = _largest_rate(solver.J) * solver.step_size < _EASY
            self._near = self._near - 1 if easy else _STIFF_STEPS

    def _explicit(self, time: float, state: Floats, first_step: float | None = None) -> DOP853:
        method = self._method
        return with_finite_step(
            DOP853(
                self._derivative,
                time,
                state,
                self._stop,
                max_step=method.max_step,
                first_step=first_step,
                rtol=method.rtol,
                atol=self._atol,
            )
        )

    def _implicit(self, time: float, state: Floats, first_step: float | None = None) -> Radau:
        method = self._method
        return with_finite_step(
            Radau(
                self._derivative,
                time,
                state,
                self._stop,
                max_step=method.max_step,
                first_step=first_step,
                rtol=method.rtol,
                atol=self._atol,
                jac=self._jacobian,
            )
        )

    def _jacobian(self, time: float, state: Floats) -> Floats:
        """Return the derivatives of the rates by differences, which are small against a slip."""
        steps = np.full(state.size, _DIFFERENCE)
        steps[self._slip] = _DIFFERENCE * max(float(np.hypot(*state[self._slip])), self._atol[self._slip[0]])
        rates, jacobian = self._derivative(time, state), np.empty((state.size, state.size))
        for column, step in enumerate(steps):
            moved = state.copy()
            moved[column] += step
            jacobian[:, column] = (self._derivative(time, moved) - rates) / (moved[column] - state[column])
        return jacobian


def _boundary(solver: Any) -> float:
    """Return hλ of the last step, from its two last stages."""
    h, slopes = solver.step_size, solver.K
    last = solver.n_stages - 1
    place = solver.y_old + h * (solver.A[last, :last] @ slopes[:last])
    apart = float(np.linalg.norm(solver.y - place))
    return h * float(np.linalg.norm(solver.f - slopes[last])) / apart if apart > 0.0 else 0.0


def _largest_rate(jacobian: Floats) -> float:
    return float(np.abs(np.linalg.eigvals(jacobian)).max()) if np.isfinite(jacobian).all() else math.inf
