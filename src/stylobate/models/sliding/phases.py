"""Kinds of contact with the plane, the state vector, and the numbers of the model."""

from enum import IntEnum
from typing import NamedTuple


class Contact(IntEnum):
    """How the column meets the plane: the value of the last state."""

    RESTING = 0
    """It stands on its base, which does not move on the plane."""
    SLIDING = 1
    """It stands on its base, which slides or turns on the plane."""
    ROLLING = 2
    """The lowest point of its rim touches and does not slip; a patch of contact does not turn either."""
    SLIPPING = 3
    """That point slips, or the patch turns."""
    FLYING = 4
    """Nothing touches."""
    JAMMED = 5
    """It can neither stick nor slip nor open: Painlevé's paradox, which ends a run."""


RESTING, SLIDING, ROLLING, SLIPPING, FLYING, JAMMED = map(float, Contact)
"""The same as the numbers that a state holds."""


class State(NamedTuple):
    """What is integrated, in units of h and 1/ω0.

    Parameters
    ----------
    tilt_x, tilt_y, tilt_rate_x, tilt_rate_y
        θ(cos β, sin β) and its rate.
    spin, twist
        Angular velocity about the axis, and χ.
    footprint_x, footprint_y
        Centre of the circle in which the base would stand if it were tilted back over its contact point [h].
    velocity_x, velocity_y
        While something touches, of the point of the body that touches, on its base the centre; in the air, of the
        centre of mass: relative to the plane.
    rise, rise_rate
        Height of the centre of mass above that of a standing column, followed in the air.
    heading_x, heading_y, heading_z
        Unit vector of the slip (v_x, v_y, ε ω_z) where the step began: friction acts against the sense of slip along
        it, so that slip which ends is followed smoothly to the instant at which it does.
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
        Coefficients of friction while it slips, and up to which it does not.
    patch
        ε/r, radius of the contact of the rim.
    normal_restitution
        e_n of impacts.
    passage_tilt
        Minimum tilt below which a passage of the upright is a stroke of the base on the plane [rad].
    slope_x, slope_y, relief
        What an inclined plane adds to the base acceleration [g].
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
    passage_tilt: float
    slope_x: float
    slope_y: float
    relief: float
