"""Tolerances and thresholds of the integration, the same for single runs and ensembles."""

import math

OVERTURNED_TILT = math.pi / 2.0
"""Tilt that counts as overturned if no rigorous criterion exists [rad]."""

ATOL_SHARE = 0.01
"""Default absolute tolerance, as a fraction of rtol × c."""

PARALLEL_ULP = 8.0
"""Vectors whose directions differ by less than this [ulp] are parallel."""
FIRST_STEP_OFF = 1e-13
"""Initial tilt [units of c] along the velocity for three-dimensional motion that starts from the vertical."""
CLOSE_PASSAGE = 1e-8
"""A run that passes the vertical closer than this [units of c] is uncertain."""

PASSAGE_FROM = 1e-6
"""Tilt below which a passage through the vertical can be an analytical step [units of the smaller of c and speed]."""
PASSAGE_OFFSET = 1e-9
"""Maximum distance from the vertical at which the path of an analytical step passes [units of c]."""
PLANAR_OFFSET = 1e-11
"""Distance from the vertical below which a column moves in a plane, up to rounding that has grown [units of c]."""
SLIP_SHARE = 1e-3
"""Factor of the absolute tolerance for the slip velocity while a contact slips."""
SLIP_TURNS = 10.0
"""Slip across its direction of more than this [tolerances] at the end of slip along it is slip that has turned."""
SLIP_SHORTER = 0.9
"""Factor of the time to the end of slip along its direction, for the repeated step of slip that has turned."""
SWINGS_APART = 5.0
"""Inverse of the fraction by which the force on a column near rest may change during one swing."""
STILL = 1e-5
"""Energy [c²] below which a column is at rest, whatever the change of its force, if uplift is no longer possible."""

CHATTER = 1e-2
"""Fraction of the rest energy below which a column with lossy passages stands, even if uplift follows at once."""

DEPARTURE = 1e-3
"""Duration of the series solution after uplift, in units of the fastest time scale."""
SHORTEST_DEPARTURE = 0.01
"""Minimum of this duration, as a fraction of it, if a break of the base motion follows."""
FINEST_SHARE = 1e-6
"""Minimum absolute tolerance of a motion that is still small, as a fraction of the absolute tolerance."""

SAMPLES_PER_PERIOD = 64
"""Samples per shortest period of the base motion, for the search for uplift and for loads of a standing column."""
