"""The last periods of a run under a periodic base motion: their measures, and the ground of the outcome.

The functions are in the language of the compiler, and read the row of a run. They compare the looks of the last periods
with each other, and the pairs, which are spread over the second half of the run; see `columns`.
"""

import math
import sys
from enum import IntEnum, auto
from functools import cache
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from stylobate.compiler.compiled import Compiled
from stylobate.compiler.programs import Bound
from stylobate.compiler.unit import ArrayArgument
from stylobate.engine.kernel import columns
from stylobate.engine.kernel.bound import FromZero
from stylobate.engine.kernel.columns import (
    EARLIER,
    LAGS,
    LOG,
    NOTE,
    PAIRS,
    SLACK,
    Log,
    Pair,
    Setup,
    pair_begins,
)
from stylobate.engine.kernel.driver import events
from stylobate.engine.kernel.driver.events import RunStatus

Floats = npt.NDArray[np.float64]

# Maximum difference in turns between motion and forcing, for rolling at the mean rate.
_LESS_THAN_ONE_TURN, _ONE_TURN = 0.5, 1.0
# A motion nears an orbit of several periods if it returns to this fraction of the distance of successive states …
_NEAR = 0.1
# … and to this fraction of its returns a quarter of the run before. Returns of a stationary motion scatter less.
_NEARER = 0.25
# Distances of states in units of the motion below this are rounding errors.
_ROUNDING = 1e-12
# Number of looks that are compared in each of the two groups.
_FEW = EARLIER - LAGS


class Ground(IntEnum):
    """Ground of an outcome that the last periods decide."""

    NO_PERIOD = 0
    SHORT = 1
    ROLLS = 2
    ROCKS = 3
    REPEATS = 4
    SHORT_FOR_STEADY = 5
    SETTLES = 6
    GROWS = 7
    NEARS_ORBIT = 8
    NEARLY_REPEATS = 9
    DRIFTS = 10
    MODULATED = 11
    APERIODIC = 12


class Late(FromZero):
    """Measures of the last n periods of a run; NaN if they were not completed, or are not needed for the outcome."""

    GROUND = auto()
    """`Ground` of the outcome of a run that moves at its end."""
    SPAN = auto()
    """Length of the last periods."""
    TURNED = auto()
    """Change of the azimuth of the tilt vector [turns]."""
    MEAN_TILT = auto()
    MINIMUM_TILT = auto()
    """Mean and minimum tilt [rad]."""
    HELD = auto()
    """Number of whole periods of the run."""
    BACK = auto()
    """Number of periods from the end of the run to the end of the earlier group of looks; 0 without this group."""
    REPEATS_AFTER = auto()
    """Smallest number of periods after which the run repeats; 0 if there is none."""
    NEAREST = auto()
    """Number of periods, from 2, after which the run returns most closely."""
    CHANGE_SLOPE = auto()
    CHANGE_ERROR = auto()
    CHANGE_WINDOW = auto()
    """Trend of the logarithm of the distances of states one period apart: per period, standard error, window."""
    LAG_SLOPE = auto()
    LAG_ERROR = auto()
    LAG_WINDOW = auto()
    """Trend of the azimuth relative to the forcing [turns]."""
    LAG_RANGE = auto()
    """Range of the same [turns]."""
    RETURNS = auto()
    """Maximum distance of the states in the last n periods from those 1, 2, … `LAGS` periods before.

    It is a fraction of the peak tilt or rate; one column for each number of periods.
    """


RETURNS_LATEST = Late.RETURNS + LAGS
RETURNS_BEFORE = RETURNS_LATEST + LAGS
"""The same for the last few periods, and for as many periods of the earlier group; NaN if there is none."""
LATE_COLUMNS = RETURNS_BEFORE + LAGS


class Rules(NamedTuple):
    """The numbers of `OutcomeRules`; `steady_periods` are those from which a motion can be classified."""

    periods: Any
    steady_periods: Any
    frequency_tolerance: Any
    repeat_tolerance: Any
    rest_tilt: Any
    settled_tolerance: Any
    sampling_errors: Any
    modulation_floor: Any


class Scale(NamedTuple):
    """Units of the tilts and of the rates of a motion; infinite for what is always zero."""

    tilt: Any
    rate: Any


def late_of_rows(table: Floats, planar: Floats, numbers: Floats, looks_at: Floats, out: Floats) -> None:
    """Set the measures of the last periods of runs.

    Parameters
    ----------
    table
        Rows of the runs.
    planar
        For each run 1 if it ended with motion in a plane, else 0.
    numbers
        The `Rules`.
    looks_at
        Column of the first look, shape (1,).
    out
        A row with the columns of `Late` for each run.
    """
    rules, first = Rules(*numbers), int(looks_at[0])
    for k in range(len(table)):
        late_of_row(table[k], planar[k], rules, first, out[k])


@cache
def late_program() -> Compiled:
    """Return the compiled form of `late_of_rows`."""
    module = sys.modules[__name__]
    rows = ArrayArgument((None, None))
    return Compiled(
        name="late_of_rows",
        program=lambda: Bound(modules=(module,), names={}, imported=(columns, events)),
        functions={},
        arguments=(
            rows,
            ArrayArgument((None,)),
            ArrayArgument((len(Rules._fields),)),
            ArrayArgument((1,)),
            ArrayArgument((None, LATE_COLUMNS)),
        ),
        model="",
        description="last periods of runs",
        brief=True,
    )


def late_of_row(row: Floats, planar: float, rules: Rules, first: int, out: Floats) -> None:
    """Set the measures of the last periods of one run; the looks begin at column `first`."""
    for column in range(LATE_COLUMNS):
        out[column] = math.nan
    out[Late.REPEATS_AFTER] = 0.0
    period, n = row[Setup.PERIOD], int(rules.periods)
    if period <= 0.0:
        out[Late.GROUND] = Ground.NO_PERIOD
        return
    end = row[Setup.END] * (1.0 + SLACK)
    if row[LOG + Log.STATUS] != RunStatus.STOPPED or end < (n + 1) * period:
        out[Late.GROUND] = Ground.SHORT
        return
    span, last = n * period, first + NOTE * (EARLIER + LAGS + n)
    mean_tilt, held = row[LOG + Log.MEAN_TILT] / span, math.floor(end / period)
    turned = 0.0 if planar > 0.0 else row[last + NOTE - 1] - row[first + NOTE * (EARLIER + LAGS) + NOTE - 1]
    out[Late.SPAN], out[Late.TURNED], out[Late.MEAN_TILT], out[Late.HELD] = span, turned, mean_tilt, held
    out[Late.BACK] = row[Setup.LOOKED_BACK]
    out[Late.MINIMUM_TILT] = row[LOG + Log.LATE_MINIMUM_TILT]
    tilt, rate = _peaks(row, first, n)
    scale = _scale(tilt, rate, mean_tilt, period)
    after_one = _return(row, last, n, 1, scale)
    if tilt == 0.0 and rate == 0.0:
        after_one = math.inf  # the motion between the looks is unknown
    out[Late.RETURNS] = after_one
    steady = held >= rules.steady_periods
    pairs = last + NOTE
    if steady and not after_one < rules.repeat_tolerance:
        _trend_of_change(row, pairs, held, scale, out)
    settled = not _exceeds(out, Late.CHANGE_SLOPE, math.log1p(rules.settled_tolerance), rules)
    if settled and after_one >= rules.modulation_floor and (steady or _repeats(row, last, scale, rules)):
        _compare_over_several(row, first, last, n, held, scale, out)
        _trend_of_lag(row, pairs, held, turned, out)
    _set_returns(rules, out)
    out[Late.GROUND] = _ground(rules, out[Late.MINIMUM_TILT] / row[Setup.SLENDERNESS], out)


def _peaks(row: Floats, first: int, n: int) -> tuple[float, float]:
    """Return the peaks of tilt and rate at the last looks."""
    tilt = rate = 0.0
    for k in range(EARLIER + LAGS, EARLIER + LAGS + n + 1):
        at = first + NOTE * k
        tilt = max(tilt, row[at] * row[at] + row[at + 1] * row[at + 1])
        rate = max(rate, row[at + 2] * row[at + 2] + row[at + 3] * row[at + 3])
    return math.sqrt(tilt), math.sqrt(rate)


def _scale(tilt: float, rate: float, mean_tilt: float, period: float) -> Scale:
    """Return the units of a motion: its peaks at the looks, at least those of the mean tilt.

    All looks may fall on passages through the vertical, or on turning points.
    """
    tilt, rate = max(tilt, mean_tilt), max(rate, mean_tilt * (2.0 * math.pi / period))
    return Scale(tilt if tilt > 0.0 else math.inf, rate if rate > 0.0 else math.inf)


def _return(row: Floats, last: int, count: int, lag: int, scale: Scale) -> float:
    """Return the maximum distance of the `count` looks up to the one at column `last` from those `lag` looks before."""
    tilt = rate = 0.0
    for k in range(count):
        at = last - NOTE * k
        before = at - NOTE * lag
        x, y = row[at] - row[before], row[at + 1] - row[before + 1]
        vx, vy = row[at + 2] - row[before + 2], row[at + 3] - row[before + 3]
        tilt, rate = max(tilt, x * x + y * y), max(rate, vx * vx + vy * vy)
    distance: float = max(math.sqrt(tilt) / scale.tilt, math.sqrt(rate) / scale.rate)
    return distance


def _repeats(row: Floats, last: int, scale: Scale, rules: Rules) -> bool:
    """Return whether the last look is within the tolerance of one several periods before."""
    found = False
    for lag in range(2, LAGS + 1):
        found = found or _return(row, last, 1, lag, scale) < rules.repeat_tolerance
    return found


def _compare_over_several(row: Floats, first: int, last: int, n: int, held: float, scale: Scale, out: Floats) -> None:
    """Compare states over several periods, at the end of the run and a quarter of it before."""
    back, earlier = row[Setup.LOOKED_BACK], first + NOTE * (EARLIER - 1)
    for lag in range(1, LAGS + 1):
        if lag > 1 and held >= n + lag:
            out[Late.RETURNS + lag - 1] = _return(row, last, n, lag, scale)
        out[RETURNS_LATEST + lag - 1] = _return(row, last, _FEW, lag, scale)
        if back != 0.0:
            out[RETURNS_BEFORE + lag - 1] = _return(row, earlier, _FEW, lag, scale)


def _place(pair: int, spacing: float) -> float:
    """Return the place of a pair in periods before the end of the run, negative."""
    begins: float = pair_begins(float(pair), spacing)
    return -begins


def _trend_of_change(row: Floats, pairs: int, held: float, scale: Scale, out: Floats) -> None:
    """Set the trend of the distances of states one period apart."""
    places, values = np.zeros(PAIRS), np.zeros(PAIRS)
    for k in range(PAIRS):
        at = pairs + NOTE * k
        apart = max(row[at + Pair.TILT_CHANGE] / scale.tilt, row[at + Pair.RATE_CHANGE] / scale.rate)
        places[k], values[k] = _place(k, row[Setup.PAIR_SPACING]), math.log(max(apart, _ROUNDING))
    _trend(places, values, held, out, Late.CHANGE_SLOPE)


def _trend_of_lag(row: Floats, pairs: int, held: float, turned: float, out: Floats) -> None:
    """Set the trend and the range of the azimuth relative to the forcing."""
    places, values = np.zeros(PAIRS), np.zeros(PAIRS)
    sense = 0.0 if turned == 0.0 else math.copysign(1.0, turned)
    most, least = -math.inf, math.inf
    for k in range(PAIRS):
        places[k] = _place(k, row[Setup.PAIR_SPACING])
        values[k] = row[pairs + NOTE * k + Pair.AZIMUTH] - sense * places[k]
        if places[k] >= -held:
            most, least = max(most, values[k]), min(least, values[k])
    _trend(places, values, held, out, Late.LAG_SLOPE)
    out[Late.LAG_RANGE] = most - least


def _trend(places: Floats, values: Floats, held: float, out: Floats, at: int) -> None:
    """Set slope, standard error and window of the values at places within the run, by least squares."""
    count = mean_x = mean_y = 0.0
    window = 0.0
    for k in range(PAIRS):
        if places[k] >= -held:
            count, mean_x, mean_y = count + 1.0, mean_x + places[k], mean_y + values[k]
            window = max(window, -places[k])
    mean_x, mean_y = mean_x / max(count, 1.0), mean_y / max(count, 1.0)
    xx = xy = yy = 0.0
    for k in range(PAIRS):
        if places[k] >= -held:
            x, y = places[k] - mean_x, values[k] - mean_y
            xx, xy, yy = xx + x * x, xy + x * y, yy + y * y
    out[at] = slope = xy / xx
    out[at + 1] = np.sqrt(max(yy - slope * slope * xx, 0.0) / xx / (count - 2.0))
    out[at + 2] = window


def _exceeds(out: Floats, at: int, bound: float, rules: Rules) -> bool:
    """Return whether the change over the window of a trend is above `bound` and above some standard errors."""
    slope, error, window = out[at], out[at + 1], out[at + 2]
    change, scatter = abs(slope) * window, rules.sampling_errors * error * window
    return bool(change > bound and change > scatter)


def _set_returns(rules: Rules, out: Floats) -> None:
    """Set the number of periods after which the run repeats, and that after which it returns most closely.

    A run that repeats after several periods must not nearly repeat before: a transient does.
    """
    after, nearest, apart = 0, 2, True
    for lag in range(1, LAGS + 1):
        distance = out[Late.RETURNS + lag - 1]
        if after == 0 and apart and distance < rules.repeat_tolerance:
            after = lag
        if distance < rules.modulation_floor:
            apart = False
        best = out[Late.RETURNS + nearest - 1]
        if lag > 1 and (distance < best or (math.isnan(best) and not math.isnan(distance))):
            nearest = lag
    out[Late.REPEATS_AFTER], out[Late.NEAREST] = after, nearest


def _ground(rules: Rules, minimum_tilt: float, out: Floats) -> int:  # noqa: PLR0911  one for each ground
    """Return the ground of the outcome; the minimum tilt is in units of c."""
    n, after, turned = rules.periods, out[Late.REPEATS_AFTER], abs(out[Late.TURNED])
    off, tilted = abs(turned / n - 1.0), minimum_tilt > rules.rest_tilt
    if after == 1.0 and tilted and off < rules.frequency_tolerance:
        return Ground.ROLLS
    if after == 1.0 and turned < rules.frequency_tolerance * n:
        return Ground.ROCKS
    if after > 0.0:
        return Ground.REPEATS
    if out[Late.HELD] < rules.steady_periods:
        return Ground.SHORT_FOR_STEADY
    if _exceeds(out, Late.CHANGE_SLOPE, math.log1p(rules.settled_tolerance), rules):
        return Ground.SETTLES if out[Late.CHANGE_SLOPE] < 0.0 else Ground.GROWS
    if _nears_orbit(rules, out):
        return Ground.NEARS_ORBIT
    if out[Late.RETURNS] < rules.modulation_floor:
        return Ground.NEARLY_REPEATS
    if not (tilted and off * n < _LESS_THAN_ONE_TURN and out[Late.LAG_RANGE] < _ONE_TURN):
        return Ground.APERIODIC
    drifts = _exceeds(out, Late.LAG_SLOPE, rules.frequency_tolerance * out[Late.LAG_WINDOW], rules)
    return Ground.DRIFTS if drifts else Ground.MODULATED


def _nears_orbit(rules: Rules, out: Floats) -> bool:
    """Return whether the run approaches an orbit of several periods."""
    at = int(out[Late.NEAREST]) - 1
    latest, before = out[RETURNS_LATEST + at], out[RETURNS_BEFORE + at]
    approaches = latest < _NEAR * out[RETURNS_LATEST] and not latest > _NEARER * before
    return approaches or out[Late.RETURNS + at] < rules.modulation_floor
