"""Passage near the vertical: angle of travel of the contact point round the rim, and required friction."""

import numpy as np

from stylobate.theory.arguments import Real, Values, finite, plain_results, positive
from stylobate.theory.rigid_body import below_one


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
