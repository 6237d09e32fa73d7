"""Straight-line and elliptic base motion as two circular motions, each with its rolling by averaging (9), (10).

Compared with the exact motion, the error of averaging depends on a1/c alone and does not shrink with frequency.
"""

from dataclasses import dataclass

import numpy as np

from stylobate.theory.arguments import ComplexArray, Real, finite, not_negative, plain_results, positive
from stylobate.theory.rolling import SteadyRolling, steady_rolling


@dataclass(frozen=True, slots=True, kw_only=True)
class AveragedRolling:
    """Steady rolling in both senses, by averaging.

    Parameters
    ----------
    forward
        Anticlockwise rolling, driven by the circular part p e^{iντ}.
    backward
        Clockwise rolling, driven by the circular part q e^{−iντ}.
    """

    forward: SteadyRolling
    backward: SteadyRolling


def circular_components(a1: Real, a2: Real, phi2: Real) -> tuple[ComplexArray, ComplexArray]:
    """Split harmonic base motion into two circular motions of opposite sense.

    Parameters
    ----------
    a1, a2
        Acceleration amplitudes along the two horizontal axes [g].
    phi2
        Phase φ2 of axis 2 against axis 1 [rad].

    Returns
    -------
    tuple of numpy.ndarray
        p and q, complex, of the broadcast shape, such that
        a1 cos ντ + i a2 cos(ντ + φ2) = p e^{iντ} + q e^{−iντ}. The peak acceleration is abs(p) + abs(q).

    Raises
    ------
    ParameterError
        If an argument is not finite.

    Examples
    --------
    A circle has one component, a straight line two of half its amplitude.

    >>> p, q = circular_components(0.065, 0.065, -np.pi / 2)
    >>> print(abs(p).round(12), abs(q).round(12))
    0.065 0.0
    >>> p, q = circular_components(0.13, 0.0, 0.0)
    >>> print(abs(p), abs(q))
    0.065 0.065
    """
    a1, a2, phi2 = np.broadcast_arrays(finite("a1", a1), finite("a2", a2), finite("phi2", phi2))
    turn = np.exp(1.0j * phi2)
    return 0.5 * (a1 + 1.0j * a2 * turn), 0.5 * (a1 + 1.0j * a2 * turn.conj())


@plain_results
def averaged_rolling(nu: Real, a1: Real, a2: Real = 0.0, phi2: Real = 0.0, *, c: Real, eta: Real) -> AveragedRolling:
    """Compute steady rolling under straight-line or elliptic base motion by averaging.

    Parameters
    ----------
    nu
        Frequency ratio ν = Ω/ω0 of the base motion, positive.
    a1, a2
        Acceleration amplitudes along the two horizontal axes [g]. By default the base moves along axis 1.
    phi2
        Phase φ2 of axis 2 against axis 1 [rad].
    c
        Slenderness.
    eta
        Damping η.

    Returns
    -------
    AveragedRolling
        Rolling in both senses, arrays of the broadcast shape. The mean azimuth of the contact point is
        β = sense · (ντ + ψ) + azimuth_offset.

    Raises
    ------
    ParameterError
        If `nu` or `c` is not positive, `eta` is negative, or an amplitude or phase is not finite.

    Notes
    -----
    (10): (8) with a0 = abs(p) forward and a0 = abs(q) backward; both are a1/2 for straight-line motion. Exact for
    circular motion. The small parameter is a1/c at every frequency. For a1 ≪ c the undamped exact motion from these
    initial conditions deviates from the averaged tilt by about 2.3 a1/c of the tilt. At a1 = 0.4c and 1.3c the exact
    critical frequency lies 11 and 16 per cent above the averaged critical frequency (c = η = 0.1).

    Examples
    --------
    >>> rolling = averaged_rolling(3.0, 0.13, c=0.1, eta=0.1)
    >>> print(round(rolling.forward.upper.amplitude, 4), round(rolling.backward.upper.amplitude, 4))
    0.0165 0.0165
    """
    nu, c, eta = positive("nu", nu), positive("c", c), not_negative("eta", eta)
    p, q = circular_components(a1, a2, phi2)
    return AveragedRolling(
        forward=_rolling(nu, p, c, eta, sense=1),
        backward=_rolling(nu, q, c, eta, sense=-1),
    )


def _rolling(nu: Real, component: ComplexArray, c: Real, eta: Real, *, sense: int) -> SteadyRolling:
    rolling = steady_rolling(nu, np.abs(component), c=c, eta=eta)
    offset = np.broadcast_to(np.angle(component), np.shape(rolling.azimuth_offset)).copy()
    return SteadyRolling(upper=rolling.upper, lower=rolling.lower, sense=sense, azimuth_offset=offset)
