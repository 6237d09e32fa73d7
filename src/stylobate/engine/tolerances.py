"""Numbers that single runs and ensembles share, so that both decide alike."""

import math

OVERTURNED_TILT = math.pi / 2.0
"""Tilt that counts as overturned where no rigorous criterion exists [rad]."""

RTOL_RANGE = (1e-13, 1e-2)
"""Relative tolerances that can be asked for."""
ATOL_SHARE = 0.01
"""The usual absolute tolerance is this part of rtol × c."""

PARALLEL_ULP = 8.0
"""Vectors parallel but for so many units of rounding lie in one plane."""
FIRST_STEP_OFF = 1e-13
"""A motion out of a plane that begins exactly at the upright begins this far from it [units of c], along its speed."""
CLOSE_PASSAGE = 1e-8
"""A run that passes the upright closer than this [units of c] is uncertain."""

PASSAGE_FROM = 1e-6
"""Nearer to the upright than this [units of the smaller of c and the speed] …"""
PASSAGE_OFFSET = 1e-9
"""… and with the path leading past it at less than this [units of c], it is passed in closed form."""
SLIP_SHARE = 1e-3
"""While a contact slips the absolute tolerance of the slip is this part of the usual one."""
SLIP_TURNS = 10.0
"""Where slip along a heading ends, slip across it of more than so many tolerances is a slip that has turned."""
SLIP_SHORTER = 0.9
"""The step in which it turned is made again, over this part of the way to where it ended along its heading."""
SWINGS_APART = 5.0
"""How small a part of the force on a column near rest may change during one hop: one over this."""
STILL = 1e-5
"""A column of less energy than this [c²] that nothing to come can release is at rest however its force may change."""

DEPARTURE = 1e-3
"""Time after a release, in units of the fastest time scale, at which the series of a departure hands over."""

SAMPLES_PER_PERIOD = 64
"""Samples to the shortest period of the base motion by which releases and loads of a standing column are sought."""
