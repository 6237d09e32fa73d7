"""Names for the columns of the table of a batch: what a kernel reads of a run and notes; and of its buffer, `Lane`.

The table is one float64 array with a row for each run. A row holds `Setup`, then `Log`, two windows, the looks of a
period, the state, `Change` where the model knows it, an `Orbit` for each that is known, the model's parameters, the
numbers of the base motion, its breaks, samples, strobes, and the trace of the run where one is kept.
"""

from enum import IntEnum, auto


class _FromZero(IntEnum):
    @staticmethod
    def _generate_next_value_(name: str, start: int, count: int, last_values: list[int]) -> int:
        del name, start, last_values
        return count


class Setup(_FromZero):
    """What a kernel reads of a run, in dimensionless time and g."""

    END = auto()
    """Duration."""
    RTOL = auto()
    ATOL = auto()
    MOST_STEPS = auto()
    LONGEST_STEP = auto()
    SLENDERNESS = auto()
    CAPACITY = auto()
    """|a_h|/(1 + a_z) up to which the column stays."""
    TILT_LIMIT = auto()
    OVERTURNED_TILT = auto()
    """What counts as overturned where the model proves nothing."""
    REST_ENERGY = auto()
    """ε; 0 where the column cannot come to rest."""
    REST_ENERGY_FOR_GOOD = auto()
    """ε once nothing to come can release the column again."""
    LARGEST_HORIZONTAL = auto()
    MINIMUM_VERTICAL = auto()
    MAXIMUM_VERTICAL = auto()
    TIME_SCALE = auto()
    """Unit of time [s]."""
    FREQUENCY = auto()
    """The highest in the base motion [rad]; 0 for a base at rest."""
    PERIOD = auto()
    """Of the base motion; 0 where there is none."""
    STROBE = auto()
    """First time at which the base motion has phase zero."""
    PERIODS = auto()
    """How many of the last periods decide the outcome."""
    BREAKS = auto()
    SAMPLES = auto()
    STROBES = auto()
    """How many columns of breaks, and sets of five columns of samples and strobes, the row of the run has."""
    TRACES = auto()
    """How many entries of a trace, in columns behind these, it has room for; 0 where none is kept."""
    PASSAGE_TILT = auto()
    """Minimum tilt below which a passage of the upright out of a plane loses energy; 0 where none does."""
    LINE_X = auto()
    LINE_Y = auto()
    """Unit vector of the line along which the base moves or, in a plane, the column too; 0, 0 without one."""
    SLOPE_X = auto()
    SLOPE_Y = auto()
    SLOPE_Z = auto()
    """What an inclined plane adds to the acceleration of the base; it is in the equations, but not in the motion."""


class Log(_FromZero):
    """What a kernel notes of a run, from which it can also take the run up again; behind the columns of `Setup`."""

    STATUS = auto()
    TIME = auto()
    STANDS = auto()
    """1 while the column stands on its base."""
    DECIDED = auto()
    """When its outcome was decided."""
    STEPS = auto()
    RELEASES = auto()
    RESTS = auto()
    RELEASED_FROM_REST = auto()
    """1 once it came to rest and was released again."""
    PEAK_TILT = auto()
    LARGEST_AT = auto()
    MINIMUM_TILT = auto()
    """Where the tilt stopped falling."""
    LEAST_PASSAGE = auto()
    """The same out of a plane."""
    FIRST_AZIMUTH = auto()
    LAST_AZIMUTH = auto()
    """Of the lean, followed round [turns]; NaN before it leans out of a plane."""
    IN_SPACE = auto()
    """1 once it moved out of a plane."""
    TOUCHED_UPRIGHT = auto()
    """1 once it passed the upright in a plane, or came to rest."""
    LEG_ENDS = auto()
    """When the polynomial ends that describes the base motion now; infinite for harmonic motion."""
    NEXT_BREAK = auto()
    BREAKS_AT = auto()
    NEXT_LOOK = auto()
    LOOKS_AT = auto()
    """Index and time of the next look in the last periods, which decide the outcome."""
    NEXT_SAMPLE = auto()
    SAMPLES_AT = auto()
    NEXT_STROBE = auto()
    STROBES_AT = auto()
    NEXT_TRACE = auto()
    """Number of the next entry of the trace."""
    LIFTS_AT = auto()
    """When the base begins to drop away; infinite if never."""
    FRICTION = auto()
    PIVOTING = auto()
    """Largest demands on the contact, while the column moves and while it stands."""
    NORMAL = auto()
    """Minimum normal force [m g]; followed with the demands where they are asked for."""
    WATCHED = auto()
    """1 in the last periods, in which the following are taken."""
    LATE_LEAST = auto()
    """Minimum tilt in them."""
    MEAN_TILT = auto()
    FORWARD_COS = auto()
    FORWARD_SIN = auto()
    BACKWARD_COS = auto()
    BACKWARD_SIN = auto()
    """Integrals over the last periods: of the tilt, and of its parts that turn with the forcing and against it."""


class Lane(_FromZero):
    """What a lane keeps in the buffer while it has a run, behind the columns of the table; flags are 0 or 1."""

    RUN = auto()
    """Index of the run; -1 where it has none."""
    PIECE = auto()
    """Number of the polynomial of the base motion."""
    H = auto()
    """Step to try."""
    TRIED = auto()
    """Step last tried."""
    HELD_STEP = auto()
    """Step that an event held back."""
    BY_TILT = auto()
    """Flag: the event aimed at is met where the tilt reaches its bound, else where it grows; -1 at a lossy passage."""
    STOP = auto()
    """Time that the next step must not pass."""
    WANTED = auto()
    """Next step as the error allows it, before stops cut it."""
    MADE = auto()
    """Step last made; 0 where it was not taken."""
    AIMED = auto()
    """How many steps have been aimed at an event ahead."""
    REJECTED = auto()
    """Flag of a step with too large an error."""
    SIDE = auto()
    """In a plane: sign of the tilt."""
    ATOL_NOW = auto()
    """Absolute tolerance, finer while a motion is still small."""
    GROWN = auto()
    """Tilt at which a motion is no longer small."""
    REST_TILT = auto()
    REST_SQUARE = auto()
    SLOW_SQUARE = auto()
    """Tilt and squares of speed below which rest is looked for."""
    NO_RETURN = auto()
    """Tilt beyond which the model proves that the column overturns."""
    TILT = auto()
    RADIAL = auto()
    """Tilt times its rate."""
    MOMENTUM = auto()
    """Twice the area that the lean sweeps per unit of time."""
    X = auto()
    Y = auto()
    VX = auto()
    VY = auto()
    """Lean and its rate."""
    TURNS = auto()
    """Whole turns of the lean so far."""
    LOW = auto()
    """Minimum tilt within the step."""
    SLOW = auto()
    """Flag: it may have been slow enough within the step to come to rest."""
    PEAK = auto()
    """Flag: a peak tilt lies within the step."""
    FLAG = auto()
    """Not 0 where the driver must look at the lane."""
    ERROR = auto()
    """Of the step, in units of the tolerance."""
    OK = auto()
    """Flag: the error is small enough."""
    HELD = auto()
    """Flag: but the step goes beyond an event."""
    GO = auto()
    """Flag: the step is taken."""
    REACHED = auto()
    """Flag: it has reached the stop."""
    TRACE_AZIMUTH = auto()
    """Of the lean, as the trace last noted it [turns]."""
    NEW_X = auto()
    NEW_Y = auto()
    NEW_VX = auto()
    NEW_VY = auto()
    NEW_TILT = auto()
    NEW_RADIAL = auto()
    """The same at the end of the step tried."""
    PER_TURN = auto()
    """1/period of the base motion; 0 where it has none."""


class Change(_FromZero):
    """What is noted of the changes between kinds of contact, of models that know them; behind the state."""

    SINCE = auto()
    """When the present kind of contact began."""
    CHANGED_AT = auto()
    AT_ONCE = auto()
    """When the contact changed last, and how often before at the same moment."""
    SLIPS = auto()
    """How often a contact that held gave way."""
    IMPACTS = auto()
    """Landings, and strokes of the base."""
    TIME_RESTING = auto()
    TIME_SLIDING = auto()
    TIME_ROLLING = auto()
    TIME_SLIPPING = auto()
    TIME_FLYING = auto()
    """How long each kind of contact lasted, the present one left out; numbered as the kinds are."""
    WINDOW_AT = auto()
    WINDOW_X = auto()
    WINDOW_Y = auto()
    WINDOW_TWIST = auto()
    """When the last periods began, and footprint and twist then."""
    WINDOW_SLIDING = auto()
    WINDOW_RIM = auto()
    WINDOW_FLYING = auto()
    """How long the base had slid by then, the rim touched, and nothing."""


class Orbit(_FromZero):
    """A periodic orbit that is known beforehand, and the approach of a run to it; behind `Change`."""

    X = auto()
    Y = auto()
    VX = auto()
    VY = auto()
    SPIN = auto()
    """Its state at phase zero of the base motion; NaN where the run has no such orbit."""
    SIZE = auto()
    RATE = auto()
    """Units of distances from it: of tilts, and of rates and spin."""
    WINDOW = auto()
    FALL = auto()
    """Periods m of a window, and ρ^m, the largest multiplier having the modulus ρ."""
    DECAY = auto()
    """−ln ρ in the unit of time."""
    REPEATS = auto()
    """Largest difference of states one period apart of a motion that repeats."""
    LATEST = auto()
    """When the run must be near it to repeat in time; −∞ where it has no such orbit."""
    REACHED = auto()
    """1 once the run has converged to it."""
    BEFORE = auto()
    LARGEST = auto()
    AGE = auto()
    FALLS = auto()
    """The approach to it, see `convergence.Approach`."""


class Window(_FromZero):
    """What is noted of a window of some periods, at equal looks."""

    TILT_CHANGE = auto()
    RATE_CHANGE = auto()
    """Largest difference of a component to one period before."""
    TILT_SIZE = auto()
    RATE_SIZE = auto()
    LAG_FORWARD = auto()
    LAG_BACKWARD = auto()
    """Sums of the azimuth behind a forcing that turns anticlockwise or clockwise [turns]."""
    FIRST_AZIMUTH = auto()
    LAST_AZIMUTH = auto()


LOOKS = 2
"""Looks to a period in the windows."""

ORBIT = len(Orbit)
"""Columns of a known orbit."""

LOG = len(Setup)
"""First column of the log."""
BEFORE = LOG + len(Log)
"""First column of the window before the last one."""
LATE = BEFORE + len(Window)
"""First column of the window of the last periods."""
LAST_LOOKS = LATE + len(Window)
"""First column of the leans at the looks of the last period."""
STATE = LAST_LOOKS + 4 * LOOKS
"""First column of the state."""

SLACK = 1e-12
"""A run is as long as a number of periods to this part."""

TRACE_TERMS = 8
"""Vectors of an entry of a trace: the state at its start, and seven coefficients."""
TRACE_ROOM = 16
"""Entries that must be free before a lane is dealt with: that is more than are made at once."""

SWITCHING_TRACE_ROOM = 1500
"""The same where kinds of contact change: a stretch of implicit steps, and changes at one moment, are made at once."""

NOTE = 5
"""Columns of a sample or a strobe: tilt x and y, their rates, time."""


class Trace(_FromZero):
    """What the columns of an entry of a trace hold; behind them stand the state at its start and a polynomial.

    An entry lasts until the next one begins. The polynomial is that of the dense output of DOP853, see `dense_source`,
    in the share of the entry's length that is over: seven coefficients, each of all states.
    """

    KIND = auto()
    START = auto()
    LENGTH = auto()
    AZIMUTH = auto()
    END_AZIMUTH = auto()
    """Of the lean at both ends, followed round [turns]; out of a plane."""


class TraceKind(_FromZero):
    """What an entry of a trace is: a stretch of motion, or an event."""

    STEP = auto()
    PLANE_STEP = auto()
    """A step in a vertical plane: its state is tilt and rate."""
    LEAP = auto()
    """A short time passed in closed form."""
    STAND = auto()
    """The column stands on its base."""
    RELEASE = auto()
    REST = auto()
    IMPACT = auto()
    PASSAGE = auto()
    """Events: only their time, START, has a meaning."""
    CONTACT = auto()
    """The event that ends a kind of contact: behind it the number of its guard, and the kinds before and after."""


class Status(_FromZero):
    """How a run stands with its kernel."""

    WAITING = auto()
    STOPPED = auto()
    """Its time was up."""
    RESTED = auto()
    OVERTURNED = auto()
    LIMIT = auto()
    LIFTED = auto()
    STEP_LIMIT = auto()
    STEP_TOO_SMALL = auto()
    UNSEEN = auto()
    """It stood for as many periods of the base motion as its steps allow to search, and there are more."""
    CANNOT_DEPART = auto()
    """It was released from rest, and its model does not say how it departs."""
    TO_PLANE = auto()
    """It was released from rest by a motion along a line: the kernel of plane motion takes it on."""
    ENDLESS = auto()
    """Its contact changed without end."""
    JAMMED = auto()
    """Its contact can neither stick nor slip nor open."""
    CONVERGED = auto()
    """It has converged to a known orbit, see `convergence`."""
