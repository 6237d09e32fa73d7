"""Planar rocking of a slender column: free motion, backbones, and periodic motions on a shaking base.

On a shaking base, between two passages of the vertical the equation (1) is linear. A motion that leaves the vertical at
the speed v0, returns after half a forcing period T = π/ν at −v0 and repeats with the opposite sign obeys, with the
rates d = (η + √(η² + 4))/2 of decay and 1/d of growth,

    θ_f = c [tanh(dT/2) − d² tanh(T/2d)] / (1 + d²),                 the forced part of θ at the passage,
    v0 = cd [tanh(dT/2) + tanh(T/2d)] / (1 + d²) ± ν√(θ_a² − θ_f²),  θ_a = a1/√((1 + ν²)² + η²ν²).

The amplitude a1 enters only through θ_a. Without damping θ_f = 0.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from stylobate.theory.arguments import (
    BoolArray,
    ComplexArray,
    FloatArray,
    Real,
    Truths,
    Values,
    finite,
    not_negative,
    plain_results,
    positive,
)


@plain_results
def planar_free_period(amplitude: Real, c: Real) -> Values:
    """Compute the period of free planar rocking: two passages of the vertical.

    Parameters
    ----------
    amplitude
        Peak tilt angle θ0 [rad], positive.
    c
        Slenderness.

    Returns
    -------
    numpy.ndarray
        Period in the time τ, of the broadcast shape; NaN where θ0 ≥ c: the column does not return.

    Raises
    ------
    ParameterError
        If an argument is not positive.

    Notes
    -----
    The inverse of the backbone (3): period = 4 arcosh[c / (c − θ0)] = 8 artanh √[θ0 / (2c − θ0)].

    Examples
    --------
    >>> print(planar_free_period([0.05, 0.1], c=0.1).round(4))
    [5.2678    nan]
    """
    amplitude, c = positive("amplitude", amplitude), positive("c", c)
    ratio = amplitude / c
    inside = ratio < 1.0
    ratio = np.where(inside, ratio, 0.0)
    return np.where(inside, 8.0 * np.arctanh(np.sqrt(ratio / (2.0 - ratio))), np.nan)


@plain_results
def planar_free_motion(tau: Real, amplitude: Real, c: Real) -> tuple[Values, Values]:
    """Compute free planar rocking at any time, from its peak tilt on the positive side at τ = 0.

    Parameters
    ----------
    tau
        Time τ.
    amplitude
        Peak tilt angle θ0 [rad], positive.
    c
        Slenderness.

    Returns
    -------
    tuple of numpy.ndarray
        Signed tilt angle θ [rad] and its rate dθ/dτ, of the broadcast shape; NaN where θ0 ≥ c.

    Raises
    ------
    ParameterError
        If `tau` is not finite or another argument is not positive.

    Notes
    -----
    (2): θ = c − (c − θ0) cosh τ for a quarter period on both sides of the peak tilt. The next half period has the same
    arc with the opposite sign (the printed formula lacks that sign), and so on.

    Examples
    --------
    >>> period = planar_free_period(0.05, c=0.1)
    >>> alpha, rate = planar_free_motion([0.0, 0.5 * period, period], 0.05, c=0.1)
    >>> print(alpha.round(12))
    [ 0.05 -0.05  0.05]
    """
    tau = finite("tau", tau)
    half_period = 0.5 * planar_free_period(amplitude, c)
    amplitude, c = positive("amplitude", amplitude), positive("c", c)
    turn = np.round(tau / half_period)
    side = np.where(np.mod(turn, 2.0) == 0.0, 1.0, -1.0)
    since_turn = tau - turn * half_period
    alpha = side * (c - (c - amplitude) * np.cosh(since_turn))  # (2)
    rate = -side * (c - amplitude) * np.sinh(since_turn)
    return alpha, rate


@plain_results
def planar_backbone(omega: Real, c: Real) -> Values:
    """Compute the amplitude of free planar rocking at the frequency ω.

    Parameters
    ----------
    omega
        Frequency ω = 2π / period of the rocking, positive.
    c
        Slenderness.

    Returns
    -------
    numpy.ndarray
        Peak tilt angle [rad], of the broadcast shape.

    Raises
    ------
    ParameterError
        If an argument is not positive.

    Notes
    -----
    (3): θ0 = c [1 − 1/cosh(π/2ω)], written as c tanh x tanh(x/2) with x = π/2ω, which keeps its relative accuracy at
    every frequency. Valid without damping and for motion confined to one plane; out of the plane this motion is
    unstable.

    Examples
    --------
    >>> print(planar_backbone([0.5, 1.0, 3.0], c=0.1).round(4))
    [0.0914 0.0601 0.0123]
    """
    omega, c = positive("omega", omega), positive("c", c)
    quarter_period = 0.5 * np.pi / omega
    return c * np.tanh(quarter_period) * np.tanh(0.5 * quarter_period)  # (3)


_NODES = 256  # Chebyshev intervals over half a period; dense where the exponentials vary
_BISECTIONS = 60


@dataclass(frozen=True, slots=True, kw_only=True)
class PlanarOrbit:
    """Symmetric rocking orbits of the forcing period, arrays of one shape; NaN (and False) where there is none.

    Parameters
    ----------
    amplitude
        Peak tilt angle [rad].
    phase
        Phase of the base acceleration a1 cos(ντ + phase) when the column passes the vertical towards positive tilt at τ
        = 0 [rad], in (−π, π].
    crossing_velocity
        Tilt rate v0 at that passage.
    exists
        Whether there is such an orbit.
    multipliers
        The two multipliers of the half-period map within the plane, complex, along a last axis of length 2; their
        squares are the multipliers of the period. None exist out of the plane, see `planar_kick_slope`.
    stable_in_plane
        Whether no deviation within the plane grows. Without damping nothing decays either: True then means neutrally
        stable.
    """

    amplitude: Values
    phase: Values
    crossing_velocity: Values
    exists: Truths
    multipliers: ComplexArray
    stable_in_plane: Truths

    @plain_results
    def start(self) -> tuple[Values, Values, Values]:
        """Return tilt angle, tilt rate and phase of the base acceleration as initial conditions of the orbit."""
        return np.zeros_like(self.phase), self.crossing_velocity, self.phase


@dataclass(frozen=True, slots=True, kw_only=True)
class PlanarForcedResponse:
    """Both symmetric rocking orbits of the forcing period.

    Parameters
    ----------
    fast
        The orbit with the higher speed at the vertical, + in the formula for v0: tilt opposite to the base
        acceleration.
    slow
        The orbit with the lower speed at the vertical.
    """

    fast: PlanarOrbit
    slow: PlanarOrbit


@plain_results
def planar_forced_response(nu: Real, a1: Real, *, c: Real, eta: Real) -> PlanarForcedResponse:
    """Compute symmetric planar rocking with the period of a straight-line base motion.

    Parameters
    ----------
    nu
        Frequency ratio ν = Ω/ω0 of the base motion, positive.
    a1
        Acceleration amplitude of the base [g].
    c
        Slenderness.
    eta
        Damping η.

    Returns
    -------
    PlanarForcedResponse
        Both orbits, arrays of the broadcast shape.

    Raises
    ------
    ParameterError
        If `nu` or `c` is not positive, or `a1` or `eta` is negative.

    Notes
    -----
    From (1) with θ_y = 0; derivation in the module's notes. An orbit exists if abs(θ_f) ≤ θ_a, v0 > 0 and the column
    stays on its side for the whole half period. The last condition is checked at the minimum tilt between two maxima,
    searched on 257 Chebyshev nodes and refined. Orbits with other periods or without the symmetry are not found.

    Without damping and as a1 → 0 both orbits become the free rocking (2), (3). At a1 = 0 their phase is arbitrary.

    Examples
    --------
    >>> response = planar_forced_response(3.0, 0.13, c=0.1, eta=0.1)
    >>> print(round(response.fast.amplitude, 5), response.fast.stable_in_plane)
    0.02528 True
    """
    nu, a1, c, eta = np.broadcast_arrays(
        positive("nu", nu), not_negative("a1", a1), positive("c", c), not_negative("eta", eta)
    )
    return PlanarForcedResponse(fast=_orbit(nu, a1, c, eta, 1.0), slow=_orbit(nu, a1, c, eta, -1.0))


def planar_kick_slope(crossing_velocity: Real, c: Real) -> FloatArray:
    """Compute the slope of the kick out of the plane versus the distance from the vertical at a passage.

    Parameters
    ----------
    crossing_velocity
        Speed v of the passage, positive.
    c
        Slenderness.

    Returns
    -------
    numpy.ndarray
        Slope 2c/v of Δẏ/y0 against ln(y0), of the broadcast shape, where y0 is the tilt across the plane at the passage
        and Δẏ the change of its rate.

    Raises
    ------
    ParameterError
        If an argument is not positive.

    Notes
    -----
    From (1): Δẏ = −(2c/v) y0 [ln(1/y0) + O(1)] as y0 → 0. The relative kick grows without bound as the offset
    decreases. So the passage has no linearisation across the plane, the orbit has no finite multiplier there, and
    planar rocking is unstable even with damping and forcing.

    Examples
    --------
    >>> print(planar_kick_slope(0.05, c=0.1))
    4.0
    """
    return 2.0 * positive("c", c) / positive("crossing_velocity", crossing_velocity)


def _orbit(nu: FloatArray, a1: FloatArray, c: FloatArray, eta: FloatArray, branch: float) -> PlanarOrbit:
    arc = _arc(nu, a1, c, eta, branch)
    top, bottom = arc.extremes()
    exists = (arc.speed > 0.0) & (top > 0.0) & (bottom > 0.0)
    multipliers, stable = _in_plane(nu, c, eta, np.where(exists, arc.speed, np.nan))
    return PlanarOrbit(
        amplitude=np.where(exists, top, np.nan),
        phase=np.where(exists, _wrapped(arc.lag - np.arctan2(eta * nu, 1.0 + nu**2)), np.nan),
        crossing_velocity=np.where(exists, arc.speed, np.nan),
        exists=exists,
        multipliers=multipliers,
        stable_in_plane=stable,
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class _Arc:
    """The half period on the positive side: θ = c + C1 e^{(τ−T)/d} + C2 e^{−dτ} + θ_a cos(ντ + lag).

    The growing exponential is scaled to 1 at the end, so that no half period overflows.
    """

    nu: FloatArray
    c: FloatArray
    half_period: FloatArray
    decay: FloatArray
    growing: FloatArray
    decaying: FloatArray
    size: FloatArray
    lag: FloatArray
    speed: FloatArray

    def tilt(self, tau: FloatArray) -> FloatArray:
        """Evaluate the tilt angle at the times τ along a leading axis."""
        growing, decaying = self._exponentials(tau)
        return self.c + growing + decaying + self.size * np.cos(self.nu * tau + self.lag)

    def tilt_rate(self, tau: FloatArray) -> FloatArray:
        """Evaluate the tilt rate at the times τ along a leading axis."""
        growing, decaying = self._exponentials(tau)
        harmonic = -self.nu * self.size * np.sin(self.nu * tau + self.lag)
        return growing / self.decay - self.decay * decaying + harmonic

    def _exponentials(self, tau: FloatArray) -> tuple[FloatArray, FloatArray]:
        growing = self.growing * np.exp((tau - self.half_period) / self.decay)
        return growing, self.decaying * np.exp(-self.decay * tau)

    def extremes(self) -> tuple[FloatArray, FloatArray]:
        """Return the highest maximum and the lowest minimum of the tilt inside the half period (+∞ if no minimum)."""
        fraction = 0.5 * (1.0 - np.cos(np.pi * np.arange(_NODES + 1) / _NODES))
        tau = fraction.reshape(-1, *([1] * self.half_period.ndim)) * self.half_period
        tilt, rate = self.tilt(tau), self.tilt_rate(tau)
        peaks = (rate[:-1] > 0.0) & (rate[1:] <= 0.0)
        dips = (rate[:-1] <= 0.0) & (rate[1:] > 0.0)
        highest = np.argmax(np.where(peaks, np.maximum(tilt[:-1], tilt[1:]), -np.inf), axis=0)
        lowest = np.argmin(np.where(dips, np.minimum(tilt[:-1], tilt[1:]), np.inf), axis=0)
        top = np.where(peaks.any(axis=0), self._refined(tau, highest, 1.0), np.nan)
        bottom = np.where(dips.any(axis=0), self._refined(tau, lowest, -1.0), np.inf)
        return top, bottom

    def _refined(self, tau: FloatArray, index: npt.NDArray[np.intp], direction: float) -> FloatArray:
        """Bisect the tilt rate between two nodes (decreasing through zero if `direction` is +1); return the tilt."""
        low = np.take_along_axis(tau, index[np.newaxis], axis=0)[0]
        high = np.take_along_axis(tau, index[np.newaxis] + 1, axis=0)[0]
        for _ in range(_BISECTIONS):
            middle = 0.5 * (low + high)
            before = direction * self.tilt_rate(middle) > 0.0
            low, high = np.where(before, middle, low), np.where(before, high, middle)
        return self.tilt(0.5 * (low + high))


def _arc(nu: FloatArray, a1: FloatArray, c: FloatArray, eta: FloatArray, branch: float) -> _Arc:
    """Solve θ(0) = θ(T) = 0 and θ̇(T) = −θ̇(0), three linear equations in C1, C2 and θ_f."""
    half_period, decay = np.pi / nu, 0.5 * (eta + np.hypot(eta, 2.0))
    up, down = np.tanh(0.5 * half_period / decay), np.tanh(0.5 * half_period * decay)
    share = c / (1.0 + decay**2)
    size = a1 / np.hypot(1.0 + nu**2, eta * nu)
    forced = share * (down - decay**2 * up)
    square = (size - forced) * (size + forced)
    across = branch * np.sqrt(np.where(square >= 0.0, square, np.nan))
    return _Arc(
        nu=nu,
        c=c,
        half_period=half_period,
        decay=decay,
        growing=-share * decay**2 * (1.0 + up),
        decaying=-share * (1.0 + down),
        size=size,
        lag=np.arctan2(-across, forced),
        speed=share * decay * (up + down) + nu * across,
    )


def _in_plane(nu: FloatArray, c: FloatArray, eta: FloatArray, speed: FloatArray) -> tuple[ComplexArray, BoolArray]:
    """Compute the multipliers of the half-period map: its smooth part, then the jump of the weight at the passage.

    At the passage the acceleration jumps by 2c while the tilt decreases at the rate v0, so the map of (θ, θ̇) is
    −[[1, 0], [−2c/v0, 1]] e^{MH}: determinant e^{−ηH}, trace as below. The sign is the symmetry of the orbit.
    """
    half_period, width = np.pi / nu, np.hypot(eta, 2.0)
    growth = 2.0 / (width + eta)
    shrink = np.exp(-width * half_period)
    kick = 2.0 * c / (speed * width)
    scaled = -((1.0 + shrink) - kick * (1.0 - shrink))  # trace · e^{−H/λ}
    determinant = np.exp(-eta * half_period)
    with np.errstate(over="ignore", invalid="ignore"):  # beyond the largest float at very low ν; NaN without an orbit
        stretch = np.exp(growth * half_period)
        half = (0.5 * scaled).astype(np.complex128)
        root = np.sqrt(half**2 - shrink)
        larger = stretch * (half + np.where(half.real < 0.0, -root, root))
        multipliers = np.stack([larger, determinant / larger], axis=-1)
        return multipliers, np.abs(stretch * scaled) < 1.0 + determinant


def _wrapped(angle: FloatArray) -> FloatArray:
    """Return the angle in (−π, π]."""
    return np.pi - np.mod(np.pi - angle, 2.0 * np.pi)
