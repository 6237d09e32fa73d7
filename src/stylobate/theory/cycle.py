"""Limit cycles of (7) by Fourier collocation and continuation from the Hopf bifurcation of steady rolling.

The tilt angle is in units of c here, and a0 stands for a0/c.
"""

from dataclasses import dataclass

import numpy as np

from stylobate.theory.arguments import FloatArray
from stylobate.theory.critical import critical_frequency, crossing_frequency
from stylobate.theory.rolling import steady_rolling
from stylobate.theory.rotating_frame import STATE_LENGTH, rotating_frame_jacobian, rotating_frame_rates
from stylobate.theory.spectral import differentiation_matrix

_NEWTON_STEPS = 10
_NEWTON_TOLERANCE = 1e-10  # of the last correction, whose square is the error left
_EASY, _HARD = 3, 6  # below and above these Newton steps the next step along the branch grows and shrinks
_FIRST_STEP, _SHORTEST_STEP, _LONGEST_STEP = 0.02, 1e-6, 0.1
_MOST_STEPS = 500


@dataclass(frozen=True, slots=True, kw_only=True)
class Cycle:
    """A closed solution of (7).

    Parameters
    ----------
    state
        (θ̇/c, β̇, θ/c, ψ) on equally spaced points of one period, shape (4, points).
    period
        Its period.
    nu
        Frequency ratio ν = Ω/ω0 of the base motion.
    """

    state: FloatArray
    period: float
    nu: float


class NoCycleError(Exception):
    """The branch of cycles does not reach the requested frequency; the message gives the reason."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CycleProblem:
    """Collocation equations; the unknowns are the state at all points, the period and ν, as one vector.

    Parameters
    ----------
    a0
        Acceleration amplitude of the base in units of c.
    eta
        Damping η.
    derivative
        Spectral differentiation matrix.
    """

    a0: float
    eta: float
    derivative: FloatArray

    @property
    def points(self) -> int:
        """Number of collocation points."""
        return len(self.derivative)

    @property
    def weight(self) -> FloatArray:
        """Weights of the norm of the unknowns: mean square of the state, and ν; the period has no weight."""
        return np.concatenate([np.full(STATE_LENGTH * self.points, 1.0 / self.points), [0.01, 1.0]])

    def cycle(self, unknowns: FloatArray) -> Cycle:
        """Convert a vector of unknowns to a cycle."""
        state = unknowns[:-2].reshape(STATE_LENGTH, self.points)
        return Cycle(state=state, period=float(unknowns[-2]), nu=float(unknowns[-1]))

    def unit(self, direction: FloatArray) -> FloatArray:
        """Return the direction scaled to length one."""
        length = float(np.sqrt(np.sum(self.weight * direction**2)))
        return direction / length

    def corrected(self, guess: FloatArray, closing: FloatArray) -> tuple[FloatArray, FloatArray, int] | None:
        """Solve by Newton's method within the plane through the guess to which `closing` is normal.

        Returns the solution, the tangent of the branch there and the number of steps; None without convergence.
        """
        unknowns = guess
        reference = self.cycle(guess).state
        for count in range(_NEWTON_STEPS):
            if self.cycle(unknowns).state[2].min() <= 0.0:  # (7) is not defined for negative tilt
                return None
            residual, matrix = self._equations(unknowns, reference)
            matrix[-1] = closing
            residual[-1] = closing @ (unknowns - guess)
            correction = np.linalg.solve(matrix, -residual)
            unknowns = unknowns + correction
            if np.sqrt(np.sum(self.weight * correction**2)) < _NEWTON_TOLERANCE:
                along = np.zeros_like(unknowns)
                along[-1] = 1.0
                tangent = np.linalg.solve(matrix, along).astype(np.float64)
                return unknowns, self.unit(tangent), count
        return None

    def _equations(self, unknowns: FloatArray, reference: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Compute residual and matrix of (7) at the points and of the phase condition against the reference."""
        cycle, points = self.cycle(unknowns), self.points
        rates = rotating_frame_rates(cycle.state, cycle.nu, self.a0, c=1.0, eta=self.eta)
        jacobian = rotating_frame_jacobian(cycle.state, self.a0, eta=self.eta)
        shift = (reference @ self.derivative.T / points).ravel()
        matrix = np.zeros((unknowns.size, unknowns.size))
        blocks = matrix[:-2, :-2].reshape(STATE_LENGTH, points, STATE_LENGTH, points)
        each = np.arange(points)
        for row in range(STATE_LENGTH):
            blocks[row, :, row, :] = self.derivative
            for column in range(STATE_LENGTH):
                blocks[row, each, column, each] -= cycle.period * jacobian[:, row, column]
        matrix[:-2, -2] = -rates.ravel()
        matrix[-2 - points : -2, -1] = cycle.period  # ψ̇ = β̇ − ν
        matrix[-2, :-2] = shift
        residual = np.zeros_like(unknowns)
        residual[:-2] = (cycle.state @ self.derivative.T - cycle.period * rates).ravel()
        residual[-2] = shift @ (cycle.state - reference).ravel()
        return residual, matrix


def cycle_at(nu: float, a0: float, eta: float, points: int) -> Cycle:
    """Continue the cycles from the Hopf bifurcation down to the frequency ratio ν.

    Parameters
    ----------
    nu
        Requested frequency ratio.
    a0
        Acceleration amplitude of the base in units of c.
    eta
        Damping η.
    points
        Number of collocation points, odd.

    Returns
    -------
    Cycle
        The first cycle along the branch at ν.

    Raises
    ------
    NoCycleError
        If there is no branch or it does not reach ν.
    """
    problem = CycleProblem(a0=a0, eta=eta, derivative=differentiation_matrix(points))
    point, tangent = _birth(problem, nu)
    step, born = _FIRST_STEP, True
    for _ in range(_MOST_STEPS):
        found = problem.corrected(point + step * tangent, problem.weight * tangent)
        if found is None:
            step *= 0.5
            if step < _SHORTEST_STEP:
                break
            continue
        following, tangent, effort = found
        if following[-1] >= point[-1]:
            message = f"the branch of modulated rolling turns back at ν = {point[-1]:.4f}"
            raise NoCycleError(message)
        if following[-1] <= nu:
            return _landed(problem, point, following, nu, born=born)
        point, born = following, False
        step = min(step * 1.4, _LONGEST_STEP) if effort <= _EASY else step
        step = step / 1.4 if effort >= _HARD else step
    message = f"the branch of modulated rolling could not be followed below ν = {point[-1]:.4f}"
    raise NoCycleError(message)


def _birth(problem: CycleProblem, nu: float) -> tuple[FloatArray, FloatArray]:
    """Return steady rolling at ν* as a cycle of zero amplitude, and the direction of the bifurcating cycles."""
    critical = float(critical_frequency(problem.a0, c=1.0, eta=problem.eta))
    if not (problem.eta > 0.0 and nu < critical):
        message = f"modulated rolling is sought below the critical frequency only, which is {critical:.4f}"
        raise NoCycleError(message)
    crossing = float(crossing_frequency(problem.a0, c=1.0, eta=problem.eta))
    rolling = steady_rolling(critical, problem.a0, c=1.0, eta=problem.eta).upper
    state = np.array([0.0, critical, float(rolling.amplitude), float(rolling.phase)])
    jacobian = rotating_frame_jacobian(state, problem.a0, eta=problem.eta)
    values, vectors = np.linalg.eig(jacobian)
    critical_vector = vectors[:, np.argmin(np.abs(values - 1.0j * crossing))]
    turn = np.exp(2.0j * np.pi * np.arange(problem.points) / problem.points)
    direction = np.outer(critical_vector, turn).real
    unknowns = np.concatenate([np.repeat(state, problem.points), [2.0 * np.pi / crossing, critical]])
    return unknowns, problem.unit(np.concatenate([direction.ravel(), [0.0, 0.0]]))


def _landed(problem: CycleProblem, point: FloatArray, following: FloatArray, nu: float, *, born: bool) -> Cycle:
    """Solve at ν itself, between two points of the branch on both sides of ν."""
    fraction = (point[-1] - nu) / (point[-1] - following[-1])
    if born:  # near the bifurcation the amplitude grows with the square root of the distance
        fraction = np.sqrt(fraction)
    guess = point + fraction * (following - point)
    guess[-1] = nu
    closing = np.zeros_like(guess)
    closing[-1] = 1.0
    found = problem.corrected(guess, closing)
    if found is None:
        message = f"the modulated rolling next to ν = {nu:.4f} did not converge"
        raise NoCycleError(message)
    return problem.cycle(found[0])
