"""Rules that decide the outcome of a run from its last periods, and their reasons."""

import math
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
import numpy.typing as npt

from stylobate.engine.kernel.columns import SLACK
from stylobate.errors import Outcome
from stylobate.results import OutcomeRules

# Maximum difference in turns between motion and forcing over the last periods, for rolling at the mean rate.
_LESS_THAN_ONE_TURN = 0.5


class Ground(IntEnum):
    """Ground of an outcome that the last periods decide."""

    NO_PERIOD = 0
    SHORT = 1
    ROLLS = 2
    ROCKS = 3
    SHORT_FOR_MODULATION = 4
    DRIFTS = 5
    MODULATED = 6
    NOT_SETTLED = 7
    UNSTEADY = 8


_VERDICTS = {
    Ground.NO_PERIOD: (Outcome.STILL_MOVING, "it moved to the end of the run"),
    Ground.SHORT: (
        Outcome.STILL_MOVING,
        "the run is shorter than the {more} periods of the base motion that show a steady motion; "
        "set duration to at least {steady:.4g} s",
    ),
    Ground.ROLLS: (Outcome.ROLLING, "it rolled once round in each of the last {n} periods and repeats"),
    Ground.ROCKS: (
        Outcome.ROCKING,
        "it repeats over the last {n} periods, and the contact point does not travel round",
    ),
    Ground.SHORT_FOR_MODULATION: (
        Outcome.STILL_MOVING,
        "the run is shorter than the {twice} periods of the base motion that show modulation; "
        "set duration to at least {modulated:.4g} s",
    ),
    Ground.DRIFTS: (Outcome.STILL_MOVING, "its last {both} periods show no steady motion"),
    Ground.MODULATED: (Outcome.MODULATED, "it rolls at the mean rate of the base motion, its tilt modulated"),
    Ground.NOT_SETTLED: (
        Outcome.STILL_MOVING,
        "it rolls at the mean rate of the base motion and has not settled; follow it longer",
    ),
    Ground.UNSTEADY: (Outcome.STILL_MOVING, "its last {n} periods show no steady motion"),
}


def outcome_on(ground: Ground) -> Outcome:
    """Return the outcome of a ground."""
    return _VERDICTS[ground][0]


@dataclass(frozen=True, slots=True)
class Evidence:
    """Measures of the last n periods of runs; numbers or arrays of one shape.

    Parameters
    ----------
    turned
        Change of the azimuth of the tilt vector [turns].
    minimum_tilt
        Minimum tilt [units of c].
    repetition
        Maximum difference of states one period apart, over the peak tilt or rate.
    repetition_before
        The same over the n periods before; NaN if the run is too short.
    drift
        Change of the mean lag behind the forcing from the n periods before to the last n periods [turns].
    """

    turned: npt.ArrayLike
    minimum_tilt: npt.ArrayLike
    repetition: npt.ArrayLike
    repetition_before: npt.ArrayLike
    drift: npt.ArrayLike


def grounds(evidence: Evidence, rules: OutcomeRules) -> npt.NDArray[np.int8]:
    """Return the `Ground` of the outcome of each run."""
    n = rules.periods
    turned, repetition = np.abs(evidence.turned), np.asarray(evidence.repetition)
    before = np.asarray(evidence.repetition_before)
    off = np.abs(turned / n - 1.0)
    tilted = np.asarray(evidence.minimum_tilt) > rules.rest_tilt
    repeats = repetition < rules.repeat_tolerance
    follows = tilted & (off * n < _LESS_THAN_ONE_TURN) & ~repeats
    with np.errstate(divide="ignore", invalid="ignore"):
        settled = np.abs(repetition / before - 1.0) < rules.settled_tolerance
    chosen = np.select(
        [
            repeats & tilted & (off < rules.frequency_tolerance),
            repeats & (turned < rules.frequency_tolerance * n),
            follows & np.isnan(before),
            follows & ~(np.asarray(evidence.drift) / n < rules.frequency_tolerance),
            follows & settled & (repetition > rules.modulation_floor),
            follows,
        ],
        [
            Ground.ROLLS,
            Ground.ROCKS,
            Ground.SHORT_FOR_MODULATION,
            Ground.DRIFTS,
            Ground.MODULATED,
            Ground.NOT_SETTLED,
        ],
        Ground.UNSTEADY,
    )
    return chosen.astype(np.int8)


def reason_on(ground: Ground, n: int, period: float) -> str:
    """Return the reason of a ground; `n` is the number of last periods, `period` the period of the base motion [s]."""
    needed = {"steady": _rounded_up((n + 1) * period), "modulated": _rounded_up((2 * n + 1) * period)}
    return _VERDICTS[ground][1].format(n=n, more=n + 1, both=2 * n, twice=2 * n + 1, **needed)


def _rounded_up(value: float) -> float:
    """Round a number that is not negative up to four digits.

    >>> _rounded_up(43.98229715), _rounded_up(0.0)
    (43.99, 0.0)
    """
    if value == 0.0:
        return 0.0
    digits = 3 - math.floor(math.log10(value))
    return math.ceil(value * 10.0**digits * (1.0 - SLACK)) / 10.0**digits
