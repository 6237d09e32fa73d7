"""Modulated rolling below ν*: rolling at the mean rate of the base motion with an oscillating tilt.

The cycles of (7) are computed with the tilt angle in units of c, and a0 for a0/c there.
"""

from dataclasses import dataclass

import numpy as np

from stylobate.errors import ParameterError, require_not_negative, require_positive
from stylobate.theory.arguments import ComplexArray, FloatArray, plain_results
from stylobate.theory.averaging import STATE_LENGTH, rotating_frame_jacobian, rotating_frame_rates
from stylobate.theory.rolling import critical_frequency, crossing_frequency, steady_rolling


def differentiation_matrix(points: int) -> FloatArray:
    """Return the matrix that differentiates the trigonometric interpolant of a function of period 1 given at j/points.

    Parameters
    ----------
    points
        Number of points, odd.

    Returns
    -------
    numpy.ndarray
        Matrix D of shape (points, points), antisymmetric; the derivative is D @ values.

    References
    ----------
    L. N. Trefethen, Spectral Methods in MATLAB, SIAM 2000, chapter 3.
    """
    index = np.arange(points)
    apart = index[:, np.newaxis] - index
    sine = np.sin(np.pi * apart / points)
    np.fill_diagonal(sine, np.inf)
    return np.pi * np.where(apart % 2 == 0, 1.0, -1.0) / sine


def interpolated(values: FloatArray, fraction: FloatArray) -> FloatArray:
    """Evaluate the trigonometric interpolant at any fraction of the period.

    Parameters
    ----------
    values
        Values at j/points along the last axis, an odd number of them, shape (m, points).
    fraction
        Fractions of the period, shape (n,).

    Returns
    -------
    numpy.ndarray
        Values of shape (m, n).
    """
    coefficients = 2.0 * np.fft.rfft(values, axis=-1) / values.shape[-1]
    coefficients[..., 0] *= 0.5
    waves = np.exp(2.0j * np.pi * np.outer(np.arange(coefficients.shape[-1]), fraction))
    return np.real(coefficients @ waves)


_NEWTON_STEPS = 10
_NEWTON_TOLERANCE = 1e-10  # of the last correction, whose square is the error left
_EASY, _HARD = 3, 6  # below and above these Newton steps the next step along the branch grows and shrinks
_FIRST_STEP, _SHORTEST_STEP, _LONGEST_STEP = 0.02, 1e-6, 0.1
_MOST_STEPS = 500


@dataclass(frozen=True, slots=True, kw_only=True)
class _Cycle:
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


class _NoCycleError(Exception):
    """The branch of cycles does not reach the requested frequency; the message gives the reason."""


@dataclass(frozen=True, slots=True, kw_only=True)
class _CycleProblem:
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

    def cycle(self, unknowns: FloatArray) -> _Cycle:
        """Convert a vector of unknowns to a cycle."""
        state = unknowns[:-2].reshape(STATE_LENGTH, self.points)
        return _Cycle(state=state, period=float(unknowns[-2]), nu=float(unknowns[-1]))

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


def _cycle_at(nu: float, a0: float, eta: float, points: int) -> _Cycle:
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
    _Cycle
        The first cycle along the branch at ν.

    Raises
    ------
    _NoCycleError
        If there is no branch or it does not reach ν.
    """
    problem = _CycleProblem(a0=a0, eta=eta, derivative=differentiation_matrix(points))
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
            raise _NoCycleError(f"the branch of modulated rolling turns back at ν = {point[-1]:.4f}")
        if following[-1] <= nu:
            return _landed(problem, point, following, nu, born=born)
        point, born = following, False
        step = min(step * 1.4, _LONGEST_STEP) if effort <= _EASY else step
        step = step / 1.4 if effort >= _HARD else step
    raise _NoCycleError(f"the branch of modulated rolling could not be followed below ν = {point[-1]:.4f}")


def _birth(problem: _CycleProblem, nu: float) -> tuple[FloatArray, FloatArray]:
    """Return steady rolling at ν* as a cycle of zero amplitude, and the direction of the bifurcating cycles."""
    critical = float(critical_frequency(problem.a0, c=1.0, eta=problem.eta))
    if not (problem.eta > 0.0 and nu < critical):
        raise _NoCycleError(f"modulated rolling is sought below the critical frequency only, which is {critical:.4f}")
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


def _landed(problem: _CycleProblem, point: FloatArray, following: FloatArray, nu: float, *, born: bool) -> _Cycle:
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
        raise _NoCycleError(f"the modulated rolling next to ν = {nu:.4f} did not converge")
    return problem.cycle(found[0])


_STEPS_PER_POINT = 4

# Gauss–Legendre with three stages, order 6: E. Hairer, S. P. Nørsett, G. Wanner, Solving ODEs I, table II.7.4
_ROOT = np.sqrt(15.0)
_NODES = np.array([0.5 - _ROOT / 10.0, 0.5, 0.5 + _ROOT / 10.0])
_WEIGHTS = np.array([5.0, 8.0, 5.0]) / 18.0
_STAGES = np.array(
    [
        [5.0 / 36.0, 2.0 / 9.0 - _ROOT / 15.0, 5.0 / 36.0 - _ROOT / 30.0],
        [5.0 / 36.0 + _ROOT / 24.0, 2.0 / 9.0, 5.0 / 36.0 - _ROOT / 24.0],
        [5.0 / 36.0 + _ROOT / 30.0, 2.0 / 9.0 + _ROOT / 15.0, 5.0 / 36.0],
    ]
)


def floquet_multipliers(state: FloatArray, period: float, a0: float, eta: float) -> ComplexArray:
    """Compute the Floquet multipliers of a periodic solution of (7), the largest first.

    Parameters
    ----------
    state
        (θ̇, β̇, θ, ψ) on equally spaced points of one period, shape (4, points).
    period
        Period of the solution.
    a0
        Acceleration amplitude of the base [g].
    eta
        Damping η.

    Returns
    -------
    numpy.ndarray
        Four complex multipliers; one is 1, the shift along the solution.

    Notes
    -----
    The variational equation is integrated with the Gauss–Legendre method of order 6 along the trigonometric
    interpolant. The product of the multipliers is e^{−2ηT} (Liouville): base motion and weight do not contract the
    state space.
    """
    steps = _STEPS_PER_POINT * state.shape[-1]
    fraction = ((np.arange(steps)[:, np.newaxis] + _NODES) / steps).ravel()
    jacobian = rotating_frame_jacobian(interpolated(state, fraction), a0, eta=eta)
    monodromy = np.eye(STATE_LENGTH)
    for factor in _step_matrices(jacobian.reshape(steps, -1, STATE_LENGTH, STATE_LENGTH), period / steps):
        monodromy = factor @ monodromy
    multipliers = np.linalg.eigvals(monodromy).astype(np.complex128)
    return multipliers[np.argsort(-np.abs(multipliers), kind="stable")]


def _step_matrices(jacobian: FloatArray, step: float) -> FloatArray:
    """Return the propagation matrix of each step, from the Jacobian at its stages (steps, 3, 4, 4)."""
    stages = _WEIGHTS.size
    size = stages * STATE_LENGTH
    coupling = np.einsum("ij,nipq->nipjq", _STAGES, jacobian).reshape(-1, size, size)
    slopes = np.linalg.solve(np.eye(size) - step * coupling, jacobian.reshape(-1, size, STATE_LENGTH))
    slopes = slopes.reshape(-1, stages, STATE_LENGTH, STATE_LENGTH)
    increments: FloatArray = np.einsum("i,nipq->npq", _WEIGHTS, slopes)
    return np.eye(STATE_LENGTH) + step * increments


_RESOLUTION = 1e-6  # highest harmonics against the largest
_FEWEST_POINTS = 15


@dataclass(frozen=True, slots=True, kw_only=True)
class ModulatedRolling:
    """A modulated rolling, or the reason why none was found (all numbers are then NaN).

    Parameters
    ----------
    found
        Whether a modulated rolling was found.
    reason
        Reason of the failure; empty if found.
    tau
        Times of one period of the modulation, equally spaced, shape (points,).
    amplitude, phase
        Tilt angle θ [rad] and phase ψ = β − ντ [rad] at these times.
    tilt_rate, rolling_rate
        θ̇ and β̇ at these times.
    period
        Period of the modulation, in the frame that turns with the base motion.
    multipliers
        The four Floquet multipliers, complex, the largest first; one of them is 1.
    stable
        Whether the other three multipliers lie within the unit circle.
    amplitude_range
        Minimum and peak tilt angle at these times, over the tilt θ+ of the unstable steady rolling.
    """

    found: bool
    reason: str
    tau: FloatArray
    amplitude: FloatArray
    phase: FloatArray
    tilt_rate: FloatArray
    rolling_rate: FloatArray
    period: float
    multipliers: ComplexArray
    stable: bool
    amplitude_range: tuple[float, float]


@plain_results
def modulated_rolling(nu: float, a0: float, *, c: float, eta: float, points: int = 101) -> ModulatedRolling:
    """Find modulated rolling on a circling base below the critical frequency.

    Parameters
    ----------
    nu
        Frequency ratio ν = Ω/ω0 of the base motion, a number.
    a0
        Acceleration amplitude of the base [g].
    c
        Slenderness.
    eta
        Damping η, above zero for a modulated rolling to exist.
    points
        Number of points over one period of the modulation, odd. More are needed far below the critical frequency, where
        the column comes near the vertical.

    Returns
    -------
    ModulatedRolling
        The motion and its stability, or the reason why there is none: ν is not below ν*, the branch turns back before
        it reaches ν, or the points do not resolve it.

    Raises
    ------
    ParameterError
        If `nu` or `c` is not positive, `a0` or `eta` is negative, or `points` is even or below 15.

    Notes
    -----
    The motion is a limit cycle of (7) that bifurcates from steady rolling at ν* (Hopf), computed by Fourier collocation
    and continuation. At c = η = 0.1 and a0 = 0.065 it is stable from ν* = 1.3971 down to 1.3224, where a multiplier
    passes −1: the modulation doubles its period. Integration then shows a cascade of period doublings, which ends near
    1.313 with overturning. The unstable cycle continues to lower frequencies.

    Examples
    --------
    >>> motion = modulated_rolling(1.36, 0.065, c=0.1, eta=0.1, points=41)
    >>> print(motion.found, motion.stable, round(motion.period, 3))
    True True 4.763
    """
    nu, a0 = require_positive("nu", nu), require_not_negative("a0", a0)
    c, eta = require_positive("c", c), require_not_negative("eta", eta)
    if points < _FEWEST_POINTS or points % 2 == 0:
        raise ParameterError(f"points must be odd and at least {_FEWEST_POINTS}, got {points!r}")
    try:
        cycle = _cycle_at(nu, a0 / c, eta, points)
    except _NoCycleError as none:
        return _missing(str(none), points)
    harmonics = np.abs(np.fft.rfft(cycle.state, axis=-1)).max(axis=0)
    left = float(harmonics[-3:].max() / harmonics.max())  # an estimate of the truncation error
    if left > _RESOLUTION:
        return _missing(f"{points} points do not resolve the motion: {left:.1e} is left in its harmonics", points)
    return _described(cycle, a0, c, eta)


def _described(cycle: _Cycle, a0: float, c: float, eta: float) -> ModulatedRolling:
    tilt_rate, rolling_rate, ratio, phase = cycle.state
    steady = float(steady_rolling(cycle.nu, a0 / c, c=1.0, eta=eta).upper.amplitude)
    multipliers = floquet_multipliers(cycle.state, cycle.period, a0 / c, eta)
    shift = np.argmin(np.abs(multipliers - 1.0))
    return ModulatedRolling(
        found=True,
        reason="",
        tau=cycle.period * np.arange(ratio.size) / ratio.size,
        amplitude=c * ratio,
        phase=phase,
        tilt_rate=c * tilt_rate,
        rolling_rate=rolling_rate,
        period=cycle.period,
        multipliers=multipliers,
        stable=bool(np.all(np.abs(np.delete(multipliers, shift)) < 1.0)),
        amplitude_range=(float(ratio.min()) / steady, float(ratio.max()) / steady),
    )


def _missing(reason: str, points: int) -> ModulatedRolling:
    none = np.full(points, np.nan)
    return ModulatedRolling(
        found=False,
        reason=reason,
        tau=none,
        amplitude=none,
        phase=none,
        tilt_rate=none,
        rolling_rate=none,
        period=np.nan,
        multipliers=np.full(4, np.nan, dtype=np.complex128),
        stable=False,
        amplitude_range=(np.nan, np.nan),
    )
