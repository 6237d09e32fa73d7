"""Kinds of contact with the plane, the state vector, and the numbers of the model."""

from enum import IntEnum
from typing import NamedTuple


class Contact(IntEnum):
    """Kind of contact between column and plane: the value of the last state."""

    RESTING = 0
    """The column stands on its base, which does not move on the plane."""
    SLIDING = 1
    """The column stands on its base, which slides or turns on the plane."""
    ROLLING = 2
    """The lowest point of the rim touches and does not slip; a patch of contact does not turn either."""
    SLIPPING = 3
    """The lowest point of the rim touches and slips, or the patch turns."""
    FLYING = 4
    """The column is in the air."""
    JAMMED = 5
    """The contact can neither stick nor slip nor open: Painlevé's paradox, which ends a run."""


RESTING, SLIDING, ROLLING, SLIPPING, FLYING, JAMMED = map(float, Contact)
"""The kinds of contact as the numbers in a state."""


class State(NamedTuple):
    """The integrated state, in units of h and 1/ω0.

    Parameters
    ----------
    tilt_x, tilt_y, tilt_rate_x, tilt_rate_y
        θ(cos β, sin β) and its rate.
    spin, twist
        Angular velocity about the axis, and χ.
    footprint_x, footprint_y
        Centre of the circle in which the base would stand if it were tilted back over its contact point [h].
    velocity_x, velocity_y
        Velocity relative to the plane: of the contact point on the rim, of the centre of a standing base, or of the
        centre of mass in the air.
    rise, rise_rate
        Height of the centre of mass above that of a standing column, used in the air only.
    heading_x, heading_y, heading_z
        Unit vector of the slip (v_x, v_y, ε ω_z) at the start of the step. Friction acts against the sense of slip
        along it, so that the equations are smooth up to the instant at which slip ends.
    contact
        A `Contact`.
    """

    tilt_x: float
    tilt_y: float
    tilt_rate_x: float
    tilt_rate_y: float
    spin: float
    twist: float
    footprint_x: float
    footprint_y: float
    velocity_x: float
    velocity_y: float
    rise: float
    rise_rate: float
    heading_x: float
    heading_y: float
    heading_z: float
    contact: float


class Numbers(NamedTuple):
    """The parameters of the model, dimensionless.

    Parameters
    ----------
    c, eta, zeta, kappa, axial, resistance
        As for `Rolling`: c, η, ζ, κ, i_a and δ/r.
    kinetic, static
        Kinetic and static coefficients of friction.
    patch
        ε/r, radius of the contact of the rim.
    normal_restitution
        e_n of impacts.
    slope_x, slope_y, relief
        Terms that an inclined plane adds to the base acceleration [g].
    """

    c: float
    eta: float
    zeta: float
    kappa: float
    axial: float
    resistance: float
    kinetic: float
    static: float
    patch: float
    normal_restitution: float
    slope_x: float
    slope_y: float
    relief: float
