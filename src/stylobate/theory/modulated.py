"""Modulated rolling below ν*: rolling at the mean rate of the base motion with an oscillating tilt."""

from dataclasses import dataclass

import numpy as np

from stylobate.errors import ParameterError, require_not_negative, require_positive
from stylobate.theory.arguments import ComplexArray, FloatArray, plain_results
from stylobate.theory.cycle import Cycle, NoCycleError, cycle_at
from stylobate.theory.floquet import floquet_multipliers
from stylobate.theory.rolling import steady_rolling
from stylobate.theory.spectral import unresolved

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
        message = f"points must be odd and at least {_FEWEST_POINTS}, got {points!r}"
        raise ParameterError(message)
    try:
        cycle = cycle_at(nu, a0 / c, eta, points)
    except NoCycleError as none:
        return _missing(str(none), points)
    left = unresolved(cycle.state)
    if left > _RESOLUTION:
        return _missing(f"{points} points do not resolve the motion: {left:.1e} is left in its harmonics", points)
    return _described(cycle, a0, c, eta)


def _described(cycle: Cycle, a0: float, c: float, eta: float) -> ModulatedRolling:
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
