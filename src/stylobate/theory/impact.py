"""Planar impact of a rocking column: restitution, and the viscous damping with the same energy loss."""

import numpy as np

from stylobate.errors import ParameterError
from stylobate.theory.arguments import FloatArray, Real, Values, not_negative, plain_results, positive
from stylobate.theory.rigid_body import below_one


@plain_results
def housner_restitution(c: Real, *, inertia_ratio: Real = 0.75) -> Values:
    """Compute the restitution of an impact that neither bounces nor slips (Housner).

    Parameters
    ----------
    c
        Slenderness.
    inertia_ratio
        κ = m h²/J0; ¾ for a slender solid cylinder, as by default, and 1/(4/3 + c²/4) for one of slenderness c.

    Returns
    -------
    numpy.ndarray
        e, of the broadcast shape, between 0 and 1: the energy of the motion falls by the factor e².

    Raises
    ------
    ParameterError
        If `c` is not positive or `inertia_ratio` not between 0 and 1.

    See Also
    --------
    block_restitution : the same for a rectangular block.
    required_friction : friction below which the contact slips in the impact.

    Notes
    -----
    The moment of momentum about the new contact point is conserved (Housner 1963): with J0 − m r² before and K = J0 + m
    r² after the impact,

        e = 1 − 2 m r²/K = (1 − κc²)/(1 + κc²).

    A body with κc² ≥ 1 is so flat that it does not rebound: e = 0. Measured losses of columns were larger or smaller.

    Examples
    --------
    >>> c = np.array([0.1, 0.2])
    >>> print(housner_restitution(c, inertia_ratio=1.0 / (4.0 / 3.0 + c**2 / 4.0)).round(6))
    [0.985139 0.942169]
    """
    flatness = below_one("inertia_ratio", inertia_ratio) * positive("c", c) ** 2  # m r²/J0
    return np.asarray(np.maximum((1.0 - flatness) / (1.0 + flatness), 0.0))


@plain_results
def block_restitution(c: Real) -> Values:
    """Compute the restitution of an impact of a uniform rectangular block.

    Parameters
    ----------
    c
        Slenderness, width over height.

    Returns
    -------
    numpy.ndarray
        e = 1 − (3/2) sin²α_c with tan α_c = c; 0 for c ≥ √2, blocks so flat that they do not rebound.

    Raises
    ------
    ParameterError
        If `c` is not positive.

    See Also
    --------
    housner_restitution : the same for a body of revolution.

    Notes
    -----
    Housner (1963): the moment of momentum about the new edge is conserved, and J0 = m h² (4 + c²)/3.

    Examples
    --------
    >>> print(block_restitution([0.1, 0.2]).round(6))
    [0.985149 0.942308]
    """
    square = positive("c", c) ** 2
    return np.asarray(np.maximum(1.0 - 1.5 * square / (1.0 + square), 0.0))


@plain_results
def equivalent_viscous_damping(amplitude: Real, *, c: Real, restitution: Real) -> Values:
    """Compute the damping that dissipates as much energy per cycle of planar rocking as impacts do.

    Parameters
    ----------
    amplitude
        Peak tilt angle θ [rad].
    c
        Slenderness.
    restitution
        Ratio e of the rocking rates after and before an impact, at most 1.

    Returns
    -------
    numpy.ndarray
        Damping η, of the broadcast shape; NaN where θ ≥ c: the column does not return.

    Raises
    ------
    ParameterError
        If `amplitude` or `c` is not positive, or `restitution` not between 0 and 1.

    Notes
    -----
    For the slender column. Its free motion (2), φ = θ/c, hits the base at the rate cv with v² = 2φ − φ² and loses (1 −
    e²) of its energy; damping dissipates 2ηc²S in the same half cycle, S = ∫₀^φ √(v² − 2x + x²) dx:

        η = (1 − e²) v²/(4S),   S = ½[v − (1 − v²) artanh v].

    η decreases with the amplitude, from ¾(1 − e²)/v at small amplitudes to ½(1 − e²) at θ = c: no single η fits a
    decay.

    Examples
    --------
    >>> print(equivalent_viscous_damping([0.01, 0.05, 0.09, 0.1], c=0.1, restitution=0.985).round(5))
    [0.04919 0.0208  0.01527     nan]
    """
    amplitude, c, e = np.broadcast_arrays(
        positive("amplitude", amplitude), positive("c", c), not_negative("restitution", restitution)
    )
    if np.any(e > 1.0):
        message = f"restitution must be at most 1, got {float(np.max(e))!r}: an impact adds no energy"
        raise ParameterError(message)
    ratio = amplitude / c
    inside = ratio < 1.0
    ratio = np.where(inside, ratio, 0.5)
    speed = np.sqrt(ratio * (2.0 - ratio))  # v
    return np.where(inside, (1.0 - e) * (1.0 + e) * speed**2 / (4.0 * _action(speed, 1.0 - ratio)), np.nan)


# Below this limit the terms of S nearly cancel; its series has the relative error v^(2 · terms) = 1e-16.
_SMALL_SPEED = 0.1
_TERMS = 8


def _action(speed: FloatArray, left: FloatArray) -> FloatArray:
    """Return S = ½[v − (1 − v²) artanh v] = Σ v^(2k + 1)/(4k² − 1), with √(1 − v²) = 1 − φ."""
    series = np.zeros_like(speed)
    for k in range(_TERMS, 0, -1):
        series = (series + 1.0 / (4.0 * k**2 - 1.0)) * speed**2
    closed = 0.5 * (speed - left**2 * np.log((1.0 + speed) / left))
    return np.where(speed < _SMALL_SPEED, series * speed, closed)
