"""How runs begin: their lines, their states of motion, and their columns of `Setup`.

All numbers may be arrays over runs; the functions are in the language of the compiler as well, for a single run.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from stylobate.engine.forcing import is_rest, rest_energy_for_good, usual_rest_energy
from stylobate.engine.kernel.columns import EARLIER, LAGS, PAIRS, SLACK, Setup
from stylobate.engine.tolerances import ATOL_SHARE, FIRST_STEP_OFF, PARALLEL_ULP
from stylobate.engine.verdict import steady_periods
from stylobate.results import OutcomeRules

Vector = tuple[Any, Any]
"""x and y."""

_EPS = float(np.finfo(float).eps)


def common_line(vectors: Sequence[Vector]) -> Vector:
    """Return the unit vector that is parallel to all `vectors`, to 8 ulp.

    The result is (0, 0) if there is none or if all vectors are zero; zero vectors are parallel to any line.
    """
    length: Any = 0.0
    x: Any = 0.0
    y: Any = 0.0
    for vector in vectors:
        size = np.hypot(vector[0], vector[1])
        longer = size > length
        x, y, length = np.where(longer, vector[0], x), np.where(longer, vector[1], y), np.where(longer, size, length)
    moves = length > 0.0
    x, y = (
        np.where(moves, x, 0.0) / np.where(moves, length, 1.0),
        np.where(moves, y, 0.0) / np.where(moves, length, 1.0),
    )
    fits: Any = moves
    for vector in vectors:
        aside = abs(x * vector[1] - y * vector[0])
        fits = fits & (aside <= PARALLEL_ULP * _EPS * np.hypot(vector[0], vector[1]))
    return np.where(fits, x, 0.0), np.where(fits, y, 0.0)


class Beginning(NamedTuple):
    """State of motion at the start, in the unit of time of the model.

    Parameters
    ----------
    tilt, rate
        Tilt vector and its rate; zero if they are at rest up to rounding.
    lean
        Tilt vector for the state: a little off the vertical for three-dimensional motion that starts from it.
    stands
        Whether the column stands.
    planar
        Whether the motion is planar.
    line
        Line of planar motion, or the line along which the base moves; (0, 0) if there is none.
    in_a_plane
        Whether start and base motion lie in one vertical plane.
    """

    tilt: Vector
    rate: Vector
    lean: Vector
    stands: Any
    planar: Any
    line: Vector
    in_a_plane: Any


def beginning(
    tilt: Vector,
    tilt_rate: Vector,
    spin: Any,
    time_scale: Any,
    slenderness: Any,
    directions: Sequence[Vector],
    *,
    has_plane: bool,
) -> Beginning:
    """Return the beginning of runs with this tilt [rad], tilt rate [rad/s] and spin.

    Parameters
    ----------
    tilt, tilt_rate, spin
        Initial conditions.
    time_scale, slenderness
        Unit of time [s], and c.
    directions
        Horizontal vectors that span the base motion.
    has_plane
        Whether the model describes planar motion by equations of its own.
    """
    moves = np.where(is_rest(tilt, tilt_rate, slenderness, time_scale), 0.0, 1.0)
    x, y = tilt[0] * moves, tilt[1] * moves
    vx, vy = tilt_rate[0] * moves * time_scale, tilt_rate[1] * moves * time_scale
    leans, turns = (x != 0.0) | (y != 0.0), (vx != 0.0) | (vy != 0.0)
    stands = ~(leans | turns)
    base = common_line(directions)
    line = common_line(((x, y), (vx, vy), *directions))
    lies = (line[0] != 0.0) | (line[1] != 0.0)
    planar = lies & has_plane & (spin == 0.0)
    still: Any = stands
    for direction in directions:
        still = still & ~((direction[0] != 0.0) | (direction[1] != 0.0))
    upright = ~leans & ~stands & ~planar
    speed = np.where(upright, np.hypot(vx, vy), 1.0)
    off = FIRST_STEP_OFF * slenderness
    return Beginning(
        tilt=(x, y),
        rate=(vx, vy),
        lean=(np.where(upright, off * vx / speed, x), np.where(upright, off * vy / speed, y)),
        stands=stands,
        planar=planar,
        line=(np.where(planar, line[0], base[0]), np.where(planar, line[1], base[1])),
        in_a_plane=lies | still,
    )


def line_of_switching(
    begun: Beginning, directions: Sequence[Vector], slope: Sequence[Any], velocity: Vector, spin: Any
) -> Vector:
    """Return the line of a run of a model that changes between kinds of contact; (0, 0) if there is none.

    It is that of start and base motion, if there is no spin, and if slope of the plane and slip also lie along it.
    """
    line = common_line((begun.tilt, begun.rate, *directions))
    common = common_line((line, (slope[0], slope[1]), velocity))
    keeps = ((line[0] != 0.0) | (line[1] != 0.0)) & ((common[0] != 0.0) | (common[1] != 0.0)) & (spin == 0.0)
    return np.where(keeps, line[0], 0.0), np.where(keeps, line[1], 0.0)


def periods_of(end: Any, period: Any) -> Any:
    """Return the number of periods of the base motion in runs of this duration; 0 without a period."""
    repeats = period > 0.0
    return np.where(repeats, end * (1.0 + SLACK) / np.where(repeats, period, 1.0), 0.0)


# Minimum mean number of periods from one pair to the next: pairs meet all phases of the base motion and do not overlap.
_LEAST_SPACING = 1.5
# Fraction of a run over which pairs are spread, and fraction between the two groups of looks. Periods too long for one
# run are then resolved by a longer one.
_PAIRED, _BETWEEN = 0.5, 0.25


def looks_needed(end: Any, period: Any, rules: OutcomeRules) -> Any:
    """Return whether runs of this duration are long enough for an outcome by their last periods."""
    return periods_of(end, period) >= rules.periods + 1.0


def number_of_looks(rules: OutcomeRules) -> int:
    """Return the number of looks in the row of a run that needs them."""
    return EARLIER + rules.periods + LAGS + 1


def fill_looks(row: Any, end: Any, period: Any, rules: OutcomeRules) -> None:
    """Set the times of looks and pairs in a row, or in the columns of rows."""
    held = periods_of(end, period)
    back = np.maximum(rules.periods + LAGS + 1.0, np.floor(_BETWEEN * held))
    steady = held >= steady_periods(rules)
    row[Setup.LOOKED_BACK] = np.where(steady & (held >= back + EARLIER - 1.0), back, 0.0)
    spacing = np.maximum((_PAIRED * held - 1.0) / (PAIRS - 1.0), _LEAST_SPACING)
    row[Setup.PAIR_SPACING] = np.where(steady, spacing, 0.0)


class Bounds(NamedTuple):
    """Frequencies [per unit of time] and accelerations [g] of a base motion, on which rest depends."""

    frequency: Any
    mean_frequency: Any
    least_rest_energy: Any
    period: Any
    phase: Any
    largest: Any
    minimum_vertical: Any
    maximum_vertical: Any


class Body(NamedTuple):
    """Numbers of a model on which rest depends, with its unit of time [s]."""

    time_scale: Any
    slenderness: Any
    capacity: Any
    comes_to_rest: Any
    loss_tilt: Any
    slope: Sequence[Any]


def fill_setup(
    row: Any,
    body: Body,
    bounds: Bounds,
    duration: Any,
    rules: OutcomeRules,
    *,
    rtol: float,
    atol: float | None,
    rest_energy: float | None,
    max_steps: float,
    rest_share: float = 1.0,
    passage_share: float = 1.0,
) -> None:
    """Set the columns of `Setup` that depend on model, base motion and tolerances, in a row or in the columns of rows.

    `rest_share` and `passage_share` are factors, see `Plan`.
    """
    scale = body.time_scale
    row[Setup.END] = duration / scale
    row[Setup.RTOL] = rtol
    row[Setup.ATOL] = ATOL_SHARE * rtol * body.slenderness if atol is None else atol
    row[Setup.MOST_STEPS] = max_steps
    # Half the shortest period, so that no step misses the forcing.
    moves = bounds.frequency > 0.0
    row[Setup.LONGEST_STEP] = np.where(moves, np.pi / np.where(moves, bounds.frequency, 1.0), np.inf)
    row[Setup.SLENDERNESS] = body.slenderness
    row[Setup.CAPACITY] = body.capacity
    usual = usual_rest_energy(
        bounds.mean_frequency,
        bounds.largest,
        bounds.minimum_vertical,
        body.capacity,
        least=bounds.least_rest_energy,
    )
    energy = usual if rest_energy is None else rest_energy
    for_good = rest_energy_for_good(bounds.mean_frequency) if rest_energy is None else rest_energy
    row[Setup.REST_ENERGY] = np.where(body.comes_to_rest, rest_share * energy, 0.0)
    row[Setup.REST_ENERGY_FOR_GOOD] = np.where(body.comes_to_rest, for_good, 0.0)
    row[Setup.LARGEST_HORIZONTAL] = bounds.largest
    row[Setup.MINIMUM_VERTICAL] = bounds.minimum_vertical
    row[Setup.MAXIMUM_VERTICAL] = bounds.maximum_vertical
    row[Setup.TIME_SCALE] = scale
    row[Setup.PER_SECOND] = 1.0 / scale
    row[Setup.FREQUENCY] = bounds.frequency
    row[Setup.PERIOD] = bounds.period
    row[Setup.STROBE] = (-bounds.phase - np.floor(-bounds.phase)) * bounds.period
    row[Setup.PERIODS] = rules.periods
    row[Setup.PASSAGE_TILT] = passage_share * body.loss_tilt
    row[Setup.SLOPE_X] = body.slope[0]
    row[Setup.SLOPE_Y] = body.slope[1]
    row[Setup.SLOPE_Z] = body.slope[2]
