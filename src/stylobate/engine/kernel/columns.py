"""Columns of the table of a batch (input and record of each run), and rows of the buffer of a kernel (`Lane`).

The table is one float64 array with a row for each run. A row holds, in this order: `Setup`, `EventSetup`, `Log`, the
state, `Change` if the contact of the model can change, an `Orbit` for each known orbit, the parameters of the model,
the numbers of the base motion (a `Wave` for each term, or `Tabulated`), its breaks, samples, stroboscopic samples,
looks, pairs, and the trace of the run if there is one.

Looks and pairs are records of the tilt vector that decide the outcome of a motion under a periodic base motion. Looks
follow each other after one period: those of the last periods, and an earlier group. A pair compares two states one
period apart; the pairs are spread over the second half of the run.
"""

from enum import auto
from typing import Any

import numpy as np

from stylobate.engine.kernel.bound import FromZero
from stylobate.engine.kernel.driver.events import EventSetup


class Setup(FromZero):
    """Input of a run, in dimensionless time and g."""

    END = auto()
    """Duration."""
    RTOL = auto()
    ATOL = auto()
    MOST_STEPS = auto()
    LONGEST_STEP = auto()
    SLENDERNESS = auto()
    CAPACITY = auto()
    """Maximum |a_h|/(1 + a_z) under which the column stands still."""
    REST_ENERGY = auto()
    """Rest energy ε; 0 if the column cannot come to rest."""
    REST_ENERGY_FOR_GOOD = auto()
    """Rest energy ε when the rest of the base motion can no longer uplift the column."""
    LARGEST_HORIZONTAL = auto()
    MINIMUM_VERTICAL = auto()
    MAXIMUM_VERTICAL = auto()
    TIME_SCALE = auto()
    PER_SECOND = auto()
    """Unit of time [s], and its reciprocal."""
    FREQUENCY = auto()
    """Highest angular frequency in the base motion; 0 for a base at rest."""
    PERIOD = auto()
    """Period of the base motion; 0 if it has none."""
    STROBE = auto()
    """First time at which the base motion has phase zero."""
    PERIODS = auto()
    """Number of last periods that decide the outcome."""
    BREAKS = auto()
    SAMPLES = auto()
    STROBES = auto()
    """Numbers of breaks (one column each), samples and stroboscopic samples (`NOTE` columns each) in the row."""
    LOOKS = auto()
    """Number of looks in the row, followed by `PAIRS` pairs (`NOTE` columns each); 0 if the row has neither."""
    LOOKED_BACK = auto()
    """Number of periods from the last look of the earlier group to the end of the run; 0 if there is no such group."""
    PAIR_SPACING = auto()
    """Mean number of periods from one pair to the next; 0 without pairs."""
    NOTES = auto()
    """Number of samples, stroboscopic samples, looks and pairs in the row, and of places of stroboscopic samples."""
    TRACES = auto()
    """Number of trace entries for which the row has room, behind the samples; 0 if the run keeps no trace."""
    PASSAGE_TILT = auto()
    """Distance from the vertical below which a three-dimensional passage loses energy; 0 if none does."""
    LINE_X = auto()
    LINE_Y = auto()
    """Unit vector of the line along which the base moves (and the column, in planar motion); 0, 0 if there is none.

    For a model that changes between kinds of contact: the line along which both move.
    """
    SLOPE_X = auto()
    SLOPE_Y = auto()
    SLOPE_Z = auto()
    """Contribution of an inclined plane to the base acceleration; it is in the equations, not in the base motion."""


class Wave(FromZero):
    """Numbers of one term of a harmonic base motion: Σ a cos 2π(ft + φ), in the units of `Setup`."""

    TURNS = auto()
    """Turns f per unit of time."""
    SIZE_X = auto()
    PHASE_X = auto()
    SIZE_Y = auto()
    PHASE_Y = auto()
    SIZE_Z = auto()
    PHASE_Z = auto()
    """Amplitudes a [g] and phases φ [turns]."""
    ONSET = auto()
    BEGINS = auto()
    ENDS = auto()
    """Time before which the term is zero, and interval in which it rises; only if a term has an onset or a ramp."""


class Tabulated(FromZero):
    """Numbers of a base motion that is tabulated by polynomials."""

    FACTOR = auto()
    COS = auto()
    SIN = auto()
    """Factor and rotation of the horizontal acceleration."""
    VERTICAL = auto()
    """Factor of the vertical acceleration."""
    DELAY = auto()
    """Delay [s]."""
    OFFSET_X = auto()
    OFFSET_Y = auto()
    """Constant horizontal acceleration [g], from t = 0 on."""
    FIRST = auto()
    COUNT = auto()
    """Row of the first polynomial, and number of polynomials."""


class Piece(FromZero):
    """First columns of a polynomial of a tabulated base motion; coefficients for x, y and z follow, lowest power first.

    The variable is the time from the middle of the piece over half its length.
    """

    START = auto()
    END = auto()
    """Interval [s]."""
    LARGEST_HORIZONTAL = auto()
    MINIMUM_VERTICAL = auto()
    MAXIMUM_VERTICAL = auto()
    """sup |a_h|, inf a_z and sup a_z after the start [m/s²]."""
    CONTINUED = auto()
    """1 if the next piece continues the acceleration without a jump, else 0."""
    PER_HALF = auto()
    """Reciprocal of half the length [1/s]."""


class Log(FromZero):
    """Record of a run, from which the kernel can also continue the run; follows the columns of `EventSetup`."""

    STATUS = auto()
    TIME = auto()
    STANDS = auto()
    """1 while the column stands on its base."""
    DECIDED = auto()
    """Time at which the outcome was decided."""
    STEPS = auto()
    RELEASES = auto()
    RESTS = auto()
    RELEASED_FROM_REST = auto()
    """1 if the column came to rest and was uplifted again."""
    PEAK_TILT = auto()
    PEAK_AT = auto()
    MINIMUM_TILT = auto()
    """Smallest of the tilts at which the tilt stopped falling."""
    CLOSEST_PASSAGE = auto()
    """The same for three-dimensional passages through the vertical."""
    WIDEST_LOSS = auto()
    """Largest distance from the vertical of three-dimensional passages that lost energy by an impact."""
    FIRST_AZIMUTH = auto()
    LAST_AZIMUTH = auto()
    """Continuous azimuth of the tilt vector [turns]; NaN before three-dimensional motion begins."""
    THREE_DIMENSIONAL = auto()
    """1 if the motion was three-dimensional at some time."""
    REACHED_VERTICAL = auto()
    """1 if the column passed the vertical in planar motion, or came to rest."""
    LEG_ENDS = auto()
    """End of the present polynomial of the base motion; infinite for harmonic motion."""
    NEXT_BREAK = auto()
    BREAKS_AT = auto()
    NEXT_LOOK = auto()
    LOOKS_AT = auto()
    """Index and time of the next look."""
    NEXT_PAIR = auto()
    PAIRS_AT = auto()
    """Twice the index of the next pair, plus one if its first state is recorded; time of its next state."""
    NEXT_SAMPLE = auto()
    SAMPLES_AT = auto()
    NEXT_STROBE = auto()
    STROBES_AT = auto()
    NEXT_TRACE = auto()
    """Number of the next entry of the trace."""
    LIFTS_AT = auto()
    """Time at which the base begins to fall faster than gravity; infinite if it never does."""
    FRICTION = auto()
    PIVOTING = auto()
    """Peak contact demands, while the column moves and while it stands."""
    NORMAL = auto()
    """Minimum normal force [m g]; computed with the demands if the caller requests them."""
    WATCHED = auto()
    """1 in the last periods, for which the following columns are computed."""
    LATE_MINIMUM_TILT = auto()
    """Minimum tilt in the last periods."""
    MEAN_TILT = auto()
    FORWARD_COS = auto()
    FORWARD_SIN = auto()
    BACKWARD_COS = auto()
    BACKWARD_SIN = auto()
    """Integrals over the last periods: of the tilt, and of its components that rotate with and against the forcing."""


class Lane(FromZero):
    """Rows of the buffer for a lane that has a run, behind the columns of the table; flags are 0 or 1."""

    RUN = auto()
    """Index of the run; -1 if the lane has none."""
    PIECE = auto()
    """Index of the polynomial of the base motion."""
    CONTINUED = auto()
    """Flag: the next polynomial continues this one without a jump."""
    H = auto()
    """Step to try."""
    TRIED = auto()
    """Step last tried."""
    HELD_STEP = auto()
    """Step that was held back because it overshot an event."""
    TARGET = auto()
    """`Target` at which the aimed steps are to end."""
    STOP = auto()
    """Time that the next step must not pass."""
    OTHER_STOP = auto()
    """The same for a base motion of one polynomial."""
    WANTED = auto()
    """Next step that the error allows, before it is cut at the next stop."""
    MADE = auto()
    """Step last made; 0 if it was not accepted."""
    AIMED = auto()
    """Number of steps aimed at the event ahead."""
    REJECTED = auto()
    """Flag: the error of the step is too large."""
    SIDE = auto()
    """Sign of the tilt in planar motion."""
    ATOL_NOW = auto()
    """Absolute tolerance; finer while a motion is still small."""
    GROWN = auto()
    """Tilt above which a motion is no longer small."""
    REST_TILT = auto()
    REST_SQUARE = auto()
    SLOW_SQUARE = auto()
    """Tilt and squared speeds below which the driver checks for rest."""
    NO_RETURN = auto()
    """Point of no return: tilt beyond which the model proves that the column overturns."""
    LEAST_FORCE = auto()
    """Minimum force that will hold a standing column down; negative if uplift is possible."""
    TILT = auto()
    RADIAL = auto()
    """Tilt times its rate."""
    MOMENTUM = auto()
    """Twice the area that the tilt vector sweeps per unit of time."""
    X = auto()
    Y = auto()
    VX = auto()
    VY = auto()
    """Tilt vector and its rate."""
    TURNS = auto()
    """Whole turns of the tilt vector so far."""
    LOW = auto()
    """Minimum tilt within the step."""
    SLOW = auto()
    """Flag: within the step the column may have been slow enough to come to rest."""
    PEAK = auto()
    """Flag: a peak tilt lies within the step."""
    FLAG = auto()
    """Number of reasons why the driver must handle the lane."""
    ERROR = auto()
    """Error of the step, in units of the tolerance."""
    OK = auto()
    """Flag: the error is small enough."""
    HELD = auto()
    """Flag: the error is small enough, but the step overshoots an event."""
    GO = auto()
    """Flag: the step is accepted."""
    REACHED = auto()
    """Flag: the step has reached the stop."""
    TRACE_AZIMUTH = auto()
    """Azimuth of the tilt vector in the last trace entry [turns]."""
    NEW_X = auto()
    NEW_Y = auto()
    NEW_VX = auto()
    NEW_VY = auto()
    NEW_TILT = auto()
    NEW_RADIAL = auto()
    """Tilt vector, its rate, tilt, and tilt times tilt rate at the end of the step tried."""
    PER_TURN = auto()
    """1/period of the base motion; 0 if it has none."""


class BySeries(FromZero):
    """Rows of a lane whose steps are those of Taylor series."""

    PROPOSED = auto()
    """Next step that the last coefficients allow."""
    NODE_MEAN_TILT = auto()
    NODE_FORWARD_COS = auto()
    NODE_FORWARD_SIN = auto()
    NODE_BACKWARD_COS = auto()
    NODE_BACKWARD_SIN = auto()
    """Weighted values at one of the nodes of a step, for the integrals over the last periods."""


class Watching(FromZero):
    """Rows of a lane whose run is compared with known orbits."""

    PHASE_ZERO_AT = auto()
    """Next time at which the base motion has phase zero; infinite if the run is no longer compared."""
    CONVERGED = auto()
    """Flag: the run has converged to an orbit."""


class Switching(FromZero):
    """Rows of a lane whose model changes between kinds of contact."""

    LAST_GUARD = auto()
    """Last guard of the model at the start of the step; it counts only if it falls through zero."""
    GUARD_NOW = auto()
    """The same at the place of the step where the guards were evaluated last."""
    BROKEN = auto()
    """Positive if a guard is broken within the step, or a limit is passed."""
    STIFF_LOOKS = auto()
    """Number of successive steps that stability limits."""
    STIFF_LOOK_AT = auto()
    """Number of steps at which the next check for stiffness is due."""
    STIFF_WAIT = auto()
    """Number of steps between these checks."""


class Change(FromZero):
    """Record of the changes between kinds of contact, for models that have them; follows the state."""

    SINCE = auto()
    """Time at which the present kind of contact began."""
    CHANGED_AT = auto()
    AT_ONCE = auto()
    """Time of the last contact change, and number of earlier changes at the same time."""
    SLIPS = auto()
    """Number of times that a sticking contact began to slip."""
    IMPACTS = auto()
    """Number of landings and face impacts."""
    TIME_RESTING = auto()
    TIME_SLIDING = auto()
    TIME_ROLLING = auto()
    TIME_SLIPPING = auto()
    TIME_FLYING = auto()
    """Total duration of each kind of contact without the present one, in the order of the kinds."""
    WINDOW_AT = auto()
    WINDOW_X = auto()
    WINDOW_Y = auto()
    WINDOW_TWIST = auto()
    """Begin of the last periods, and footprint and twist at that time."""
    WINDOW_SLIDING = auto()
    WINDOW_RIM = auto()
    WINDOW_FLYING = auto()
    """Durations of sliding on the base face, of rim contact and of flight up to that time."""


class Orbit(FromZero):
    """A known periodic orbit, and the approach of a run to it; follows `Change`."""

    X = auto()
    Y = auto()
    VX = auto()
    VY = auto()
    SPIN = auto()
    """State of the orbit at phase zero of the base motion; NaN if the run has no such orbit."""
    SIZE = auto()
    RATE = auto()
    """Units of the distance from the orbit: for tilts, and for rates and spin."""
    WINDOW = auto()
    FALL = auto()
    """Number m of periods in a window, and ρ^m, where ρ is the modulus of the largest multiplier."""
    DECAY = auto()
    """−ln ρ in the unit of time."""
    REPEATS = auto()
    """Maximum difference of states one period apart that counts as a repeating motion."""
    LATEST = auto()
    """Latest time at which a run must be near the orbit to repeat before its end; −∞ if it has no such orbit."""
    REACHED = auto()
    """1 if the run has converged to the orbit."""
    BEFORE = auto()
    LARGEST = auto()
    AGE = auto()
    FALLS = auto()
    """Approach to the orbit, see `loop`."""


LAGS = 8
"""Maximum number of periods of the base motion after which a motion is seen to repeat."""

EARLIER = LAGS + 2
"""Number of looks of the earlier group: two of them have looks up to `LAGS` periods before."""

PAIRS = 16
"""Maximum number of pairs."""

GOLDEN = 0.6180339887498949
"""The golden section, (√5 − 1)/2."""

ORBIT = len(Orbit)
"""Columns of a known orbit."""

EVENTS_AT = len(Setup)
"""First column of the numbers of the events."""
LOG = EVENTS_AT + len(EventSetup)
"""First column of the log."""
STATE = LOG + len(Log)
"""First column of the state."""


def pair_begins(pair: Any, spacing: Any) -> Any:
    """Return the number of periods from the start of a pair to the end of the run; for numbers and arrays.

    Each pair is within a part of the run of length `spacing`, at a place that is in step with no period: the fraction
    of the golden section times the triangular numbers (H. Weyl, "Über die Gleichverteilung von Zahlen mod. Eins",
    Math. Ann. 77, 1916).
    """
    turns = GOLDEN * (0.5 * pair * (pair + 1.0))
    return (PAIRS - 1.0 - pair) * spacing + (turns - np.floor(turns)) * (spacing - 1.0) + 1.0


SLACK = 1e-12
"""Relative tolerance when a duration is compared with a number of periods."""

TRACE_TERMS = 8
"""Number of vectors in a trace entry: the state at its start, and seven coefficients."""
TRACE_ROOM = 16
"""Number of free entries that the driver requires before it handles a lane: more than one event can write."""

SWITCHING_TRACE_ROOM = 1500
"""The same for models whose contact can change: one call can write a series of implicit steps and contact changes."""

NOTE = 5
"""Columns of a sample or stroboscopic sample: tilt vector, its rate, time. A look has its azimuth instead of a time."""


class Pair(FromZero):
    """Columns of a pair; before its second state they are those of a look."""

    TILT_CHANGE = auto()
    RATE_CHANGE = auto()
    """Difference between the two states."""
    TILT = auto()
    RATE = auto()
    """Size of the second state."""
    AZIMUTH = auto()
    """Azimuth of the first state [turns]."""


class Trace(FromZero):
    """First columns of a trace entry; the state at its start and a polynomial follow.

    An entry lasts until the next one begins. The polynomial is the dense output of DOP853 (see `stages.dense_change`)
    in the elapsed fraction of the entry: seven coefficients for each state.
    """

    KIND = auto()
    START = auto()
    LENGTH = auto()
    AZIMUTH = auto()
    END_AZIMUTH = auto()
    """Continuous azimuth of the tilt vector at both ends [turns]; only for three-dimensional motion."""
