"""Free motion without damping (11) between its turning points, and its passage near the vertical."""

from dataclasses import dataclass

import numpy as np

from stylobate.theory.arguments import FloatArray, Real, Values, finite, plain_results, positive
from stylobate.theory.rigid_body import below_one

_NEWTON_STEPS = 64  # each step halves the distance to a double root: enough to go from 1 to rounding


@dataclass(frozen=True, slots=True, kw_only=True)
class FreeMotion:
    """Free motions of the column without damping, arrays of one shape; NaN where the column overturns.

    Parameters
    ----------
    smallest_tilt, peak_tilt
        Turning points θ1 ≤ θ2 of the tilt angle [rad].
    energy
        E = ½(θ̇² + θ²β̇²) + cθ − ½θ², also where the column overturns.
    angular_momentum
        ℓ = θ²β̇, with the sign of the rolling rate, also where the column overturns.
    period
        Time τ from one peak tilt to the next.
    azimuth_advance
        Angle of travel of the contact point round the rim in one period [rad], with the sign of the rolling rate.
    """

    smallest_tilt: Values
    peak_tilt: Values
    energy: Values
    angular_momentum: Values
    period: Values
    azimuth_advance: Values


@plain_results
def free_motion(tilt: Real, rolling_rate: Real, c: Real) -> FreeMotion:
    """Compute free motion without damping, started at a turning point of the tilt.

    Parameters
    ----------
    tilt
        Tilt angle θ at the start [rad], positive; its rate θ̇ is zero there.
    rolling_rate
        Rolling rate β̇ at the start, either sense.
    c
        Slenderness.

    Returns
    -------
    FreeMotion
        Turning points, integrals, period and advance of the azimuth, each of the broadcast shape.

    Raises
    ------
    ParameterError
        If `rolling_rate` is not finite or another argument is not positive.

    Notes
    -----
    From (11), θ̈ = ℓ²/θ³ + θ − c and β̇ = ℓ/θ². In units of c the turning points are roots of the quartic
    θ⁴ − 2θ³ + 2Eθ² − ℓ² = (θ − θ1)(θ − θ2)(θ − θ3)(θ − θ4) with θ4 < 0 < θ1 ≤ θ2 < θ3, and
    ℓ² = θ1²θ2²(2 − θ1 − θ2)/(θ1 + θ2). The motion is bounded if the initial tilt lies below θ3. An initial condition on
    the separatrix θ2 = θ3, which includes steady rolling at ω² ≤ 1/3, counts as overturning.

    One period contains one passage near the vertical. As ℓ → 0 the azimuth turns by π in the passage, so the limit of
    the advance is the jump from one side of the vertical to the other, and `planar_free_period` is two of these
    periods. At a rolling rate of zero the advance is reported as +π.

    Examples
    --------
    >>> motion = free_motion(0.05, [0.0, 0.5, 1.0], c=0.1)
    >>> print(motion.smallest_tilt.round(4))
    [0.     0.0179 0.05  ]
    >>> print(motion.azimuth_advance.round(4))
    [3.1416 3.869  4.4429]
    """
    tilt, rate, c = np.broadcast_arrays(positive("tilt", tilt), finite("rolling_rate", rolling_rate), positive("c", c))
    start = tilt / c
    partner = _partner_turning_point(start, np.abs(rate))
    period, advance = _period_and_advance(np.minimum(start, partner), np.maximum(start, partner))
    return FreeMotion(
        smallest_tilt=c * np.minimum(start, partner),
        peak_tilt=c * np.maximum(start, partner),
        energy=0.5 * (tilt * rate) ** 2 + c * tilt - 0.5 * tilt**2,
        angular_momentum=tilt**2 * rate,
        period=period,
        azimuth_advance=np.where(rate < 0.0, -advance, advance),
    )


def _partner_turning_point(start: FloatArray, rate: FloatArray) -> FloatArray:
    """Compute the other turning point in units of c, NaN where the motion is unbounded.

    θ' is a turning point if θ'²(2 − θ0 − θ') = θ0²w²(θ0 + θ'). With θ' = θ0 w/Z that is the convex cubic
    F(Z) = Z³ + wZ² − gZ + w = 0, g = 2/θ0 − 1, for Z > 0: the other turning point belongs to the larger root, θ3 to the
    smaller, and the initial tilt is Z = w. Newton's method from above the larger root always converges to it.
    """
    slope = 2.0 / start - 1.0

    def cubic(z: FloatArray) -> FloatArray:
        return ((z + rate) * z - slope) * z + rate

    at_start = rate * (2.0 * rate**2 - slope + 1.0)
    lowest = (np.sqrt(rate**2 + 3.0 * np.maximum(slope, 0.0)) - rate) / 3.0
    start_is_largest = (slope > 0.0) & (2.0 * rate**2 - slope + 1.0 < 0.0)
    start_is_smallest = (slope > 0.0) & (at_start >= 0.0) & (lowest < rate) & (cubic(lowest) < 0.0)
    bounded = start_is_largest | start_is_smallest
    z = np.where(start_is_smallest, rate, np.sqrt(np.maximum(slope, 1.0)))
    z = np.where(bounded, z, 1.0)
    for _ in range(_NEWTON_STEPS):
        steepness = (3.0 * z + 2.0 * rate) * z - slope
        falls = bounded & (steepness > 0.0) & (cubic(z) > 0.0)
        z = z - np.where(falls, cubic(z), 0.0) / np.where(falls, steepness, 1.0)
    return np.where(bounded, start * rate / z, np.nan)


def _period_and_advance(a1: FloatArray, a2: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Compute the period and the advance of the azimuth between the turning points a1 ≤ a2 in units of c.

    With θ² = θ1²cos²φ + θ2²sin²φ the half period is the integral over a quarter turn of
    √[(θ + θ1)(θ + θ2) / ((θ3 − θ)(θ − θ4))]; with 1/θ² = cos²χ/θ1² + sin²χ/θ2², which removes the peak of β̇ = ℓ/θ² at
    the passage near the vertical, half the advance is ℓ/(θ1 θ2) times the integral of the same root over χ.
    """
    others = 2.0 - a1 - a2  # θ3 + θ4
    product = a1 * a2 * others / (a1 + a2)  # −θ3 θ4
    a3 = 0.5 * (others + np.sqrt(others**2 + 4.0 * product))
    a4 = -product / a3
    spread = (a2 - a1) * (a1 + a2)

    def root(a: FloatArray, rise: FloatArray, fall: FloatArray) -> FloatArray:
        """Evaluate the root where θ² − θ1² = rise and θ2² − θ² = fall, both given free of cancellation."""
        below_a3 = (a3 - a2) + fall / (a2 + a)
        above_a4 = (a1 - a4) + rise / (a + a1)
        return np.sqrt((a + a1) * (a + a2) / (below_a3 * above_a4))

    upright = a1 == 0.0
    half_period, half_advance = np.zeros_like(a1), np.zeros_like(a1)
    for sine, cosine, weight in quarter_turn():  # one node at a time, to limit memory
        a = np.hypot(a1 * cosine, a2 * sine)
        half_period = half_period + weight * root(a, spread * sine**2, spread * cosine**2)
        squeeze = np.hypot(a2 * cosine, a1 * sine)  # θ1 θ2 / θ
        a = np.where(upright, a2, a2 * (a1 / squeeze))
        rise, fall = spread * (sine * a1 / squeeze) ** 2, spread * (cosine * a2 / squeeze) ** 2
        with np.errstate(divide="ignore", invalid="ignore"):  # the limit for θ1 = 0 is inserted below
            half_advance = half_advance + weight * root(a, rise, fall)
    advance = np.where(upright, np.pi, 2.0 * np.sqrt(others / (a1 + a2)) * half_advance)
    return 2.0 * half_period, advance


def quarter_turn(*, step: float = 1.0 / 24.0, reach: float = 3.6) -> list[tuple[float, float, float]]:
    """Return nodes and weights of tanh–sinh quadrature over (0, π/2).

    Parameters
    ----------
    step
        Step in the double-exponential variable; halving it squares the error. The default leaves 1e-12.
    reach
        Largest double-exponential variable: at 3.6 the nearest node is 1e-25 from the end.

    Returns
    -------
    list of tuple
        sin φ, cos φ and the weight for each node φ, such that the integral of f is the sum of weight · f.

    Notes
    -----
    The nodes approach both ends double-exponentially, so a layer of width 1e-10 needs no more points than a smooth
    integrand. For double precision, sine and cosine are formed from the distance to the end at which they vanish.

    References
    ----------
    H. Takahasi and M. Mori, Double exponential formulas for numerical integration, Publ. RIMS 9 (1974) 721-741.

    Examples
    --------
    >>> print(round(sum(weight * sine for sine, cosine, weight in quarter_turn()), 12))
    1.0
    """
    count = round(reach / step)
    t = step * np.arange(-count, count + 1)
    stretch = np.pi * np.sinh(t)
    sine = np.sin(0.5 * np.pi / (1.0 + np.exp(-stretch)))
    cosine = np.sin(0.5 * np.pi / (1.0 + np.exp(stretch)))
    weight = step * 0.125 * np.pi**2 * np.cosh(t) / np.cosh(0.5 * stretch) ** 2
    return list(zip(sine.tolist(), cosine.tolist(), weight.tolist(), strict=True))


@plain_results
def angle_of_turn(c: Real, *, inertia_ratio: Real = 0.75, spin_ratio: Real = 0.0) -> Values:
    """Compute the angle of travel of the contact point round the rim in a passage near the vertical.

    Parameters
    ----------
    c
        Slenderness.
    inertia_ratio
        κ = m h²/J0; ¾ for a slender solid cylinder, as by default, and 1/(4/3 + c²/4) for one of slenderness c.
    spin_ratio
        Axial angular velocity w3 over the tilt rate |θ̇| on approach; positive if the contact point turns in the sense
        of w3.

    Returns
    -------
    numpy.ndarray
        Angle |Δβ| [rad], of the broadcast shape, in the limit of zero distance from the vertical.

    Raises
    ------
    ParameterError
        If `c` is not positive, `inertia_ratio` not between 0 and 1, or `spin_ratio` not finite.

    See Also
    --------
    required_friction : friction below which the contact slips in such a passage.

    Notes
    -----
    Near the vertical ℓ = θ²β̇ and w3 are constant, and

        K θ̈ = J0 ℓ²/θ³ − m h r w3 ℓ/θ²,

    which is, for 1/θ as a function of β, a harmonic oscillator under a constant force. The solution gives

        |Δβ| = [π + 2 atan(m h r w3 / (√(K J0) |θ̇|))] √(K/J0),   K/J0 = 1 + κc².

    Without spin the angle is π for a slender column, which falls to the opposite side as in planar rocking. The angle
    of a solid cylinder grows with its flatness, up to √5 π for a disk (Srinivasan and Ruina 2008). A disk has h = 0 and
    no finite c: its K/J0 is the limit of large c and small κ.

    Examples
    --------
    >>> c = np.array([0.1, 0.2, 1e6])
    >>> print(np.degrees(angle_of_turn(c, inertia_ratio=1.0 / (4.0 / 3.0 + c**2 / 4.0))).round(3))
    [180.672 182.66  402.492]
    """
    c, kappa, spin = np.broadcast_arrays(
        positive("c", c), below_one("inertia_ratio", inertia_ratio), finite("spin_ratio", spin_ratio)
    )
    rim = np.sqrt(1.0 + kappa * c**2)  # √(K/J0)
    return np.asarray((np.pi + 2.0 * np.arctan(kappa * c * spin / rim)) * rim)


@plain_results
def required_friction(c: Real, *, inertia_ratio: Real = 0.75) -> Values:
    """Compute the friction coefficient that prevents slip of the rim near the vertical.

    Parameters
    ----------
    c
        Slenderness.
    inertia_ratio
        κ = m h²/J0; ¾ for a slender solid cylinder, as by default.

    Returns
    -------
    numpy.ndarray
        κc, of the broadcast shape.

    Raises
    ------
    ParameterError
        If `c` is not positive or `inertia_ratio` not between 0 and 1.

    Notes
    -----
    m h r/J0 = κc is the ratio of the horizontal to the vertical force, or impulse, of the contact in three events on a
    base at rest: release at a small tilt, when the column accelerates about the tangent of the rim; a passage close to
    the vertical without spin, when the force turns with the contact point; and the planar impact on the other side of
    the base. Uplift from rest by the base needs more: the base acceleration is then c g, so the friction coefficient
    must be at least c.

    Examples
    --------
    >>> print(required_friction([0.1, 0.2]).round(3))
    [0.075 0.15 ]
    """
    return np.asarray(below_one("inertia_ratio", inertia_ratio) * positive("c", c))
