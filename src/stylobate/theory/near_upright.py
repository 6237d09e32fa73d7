"""A column that passes near the vertical: how far the contact point runs round the rim, and what friction it needs."""

import numpy as np

from stylobate.theory.arguments import FloatArray, Real, finite, positive
from stylobate.theory.rigid_body import below_one


def angle_of_turn(c: Real, *, inertia_ratio: Real = 0.75, spin_ratio: Real = 0.0) -> FloatArray:
    """Compute the angle by which the contact point runs round the rim in a passage near the vertical.

    Parameters
    ----------
    c
        Slenderness.
    inertia_ratio
        κ = m h²/J0; ¾ for a slender solid cylinder, as by default, and 1/(4/3 + c²/4) for one of slenderness c.
    spin_ratio
        Axial angular velocity w3 over the rate |θ̇| at which the tilt falls on approach; positive where the contact
        point turns in the sense of w3.

    Returns
    -------
    numpy.ndarray
        Angle |Δβ| [rad], of the broadcast shape, in the limit of a passage that misses the vertical by nothing.

    Raises
    ------
    ParameterError
        If `c` is not positive, `inertia_ratio` not between 0 and 1, or `spin_ratio` not finite.

    See Also
    --------
    required_friction : below which the contact slips in such a passage.

    Notes
    -----
    Near the upright ℓ = θ²β̇ and w3 stay what they are, and

        K θ̈ = J0 ℓ²/θ³ − m h r w3 ℓ/θ²,

    which as an equation for 1/θ against β is a harmonic oscillator under a constant force. It gives

        |Δβ| = [π + 2 atan(m h r w3 / (√(K J0) |θ̇|))] √(K/J0),   K/J0 = 1 + κc².

    Without spin that is π for a slender column: it falls to the opposite side, as if it rocked in a plane. A solid
    cylinder turns farther the flatter it is, up to √5 π for a disk; Srinivasan and Ruina (2008) describe it. A disk has
    h = 0 and so no c: its K/J0 is approached as c grows and κ falls.

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


def required_friction(c: Real, *, inertia_ratio: Real = 0.75) -> FloatArray:
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
    base at rest: when the column is let go at a small tilt, where it accelerates about the tangent of the rim; when it
    passes close to the vertical without spin, where the force runs round with the contact point; and in the planar
    impact on the other side of the base. A base that sets the column in motion from rest asks for more: its
    acceleration is c g by then, and the coefficient of friction must be c at least.

    Examples
    --------
    >>> print(required_friction([0.1, 0.2]).round(3))
    [0.075 0.15 ]
    """
    return np.asarray(below_one("inertia_ratio", inertia_ratio) * positive("c", c))
