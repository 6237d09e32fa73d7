"""Number of stroboscopic samples of the runs of a study, sufficient to identify attractors."""

import math
from dataclasses import replace

import numpy as np

from stylobate.errors import ParameterError, require_whole
from stylobate.studies.sweeps import Sweep
from stylobate.studies.sweeps.designs import whole

USUAL_STROBES = 32
"""Default number of stroboscopic samples."""

# Samples that identify an orbit of two periods: it repeats after half as many. Period one needs two samples.
_FOR_TWO_PERIODS, _FOR_ONE = 4, 2
# Tolerance for rounding of the number of periods, in periods.
_ROUNDING = 1e-9


def with_strobes(sweep: Sweep, asked: int | None) -> Sweep:
    """Return `sweep` with the number of samples `asked` for, else 32, else half of the periods of its shortest run.

    The first half of a run shorter than 32 periods serves for settling. Without a periodic base motion there are no
    samples, and only rest and overturning are identified.

    Raises
    ------
    ParameterError
        If the shortest run has fewer periods than `asked`, or fewer than 8, whose second half identifies orbits of one
        and two periods; or if `asked` is below two, which identifies nothing.
    """
    chosen = USUAL_STROBES if asked is None else require_whole("strobes", asked, least=_FOR_ONE)
    held = _whole_periods(sweep)
    if held is not None:
        needed = 2 * _FOR_TWO_PERIODS if asked is None else chosen
        if held < needed:
            remedy = "follow them longer" if asked is None else "follow them longer or ask for fewer strobes"
            message = (
                f"runs must last at least {needed} periods of the base motion to identify attractors, got {held} "
                f"(duration {_shortest(sweep):g} s); {remedy}"
            )
            raise ParameterError(message)
        chosen = chosen if held >= chosen else held // 2
    return replace(sweep, options={**sweep.options, "strobes": chosen})


def _whole_periods(sweep: Sweep) -> int | None:
    """Return the number of whole periods of the shortest run; None if the base motion has no period."""
    values = sweep.design.coordinates(whole(sweep.design))
    if not all(array.size for array in values.values()):
        return None
    if sweep.periods is not None:
        return math.floor(sweep.periods + _ROUNDING)
    if "angular_frequency" in values:
        longest: float | None = 2.0 * math.pi / float(np.min(values["angular_frequency"]))
    else:
        longest = sweep.motion.period
    return None if longest is None else math.floor(_shortest(sweep) / longest + _ROUNDING)


def _shortest(sweep: Sweep) -> float:
    values = sweep.design.coordinates(whole(sweep.design))
    if "duration" in values:
        return float(np.min(values["duration"]))
    if sweep.duration is not None:
        return sweep.duration
    assert sweep.periods is not None  # a sweep has one of these
    if "angular_frequency" in values:
        return sweep.periods * 2.0 * math.pi / float(np.max(values["angular_frequency"]))
    assert sweep.motion.period is not None  # a sweep refuses periods of a motion without one
    return sweep.periods * sweep.motion.period
