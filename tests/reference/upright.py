"""When a motion in a plane comes back to the upright."""

import numpy as np
from scipy.integrate import DenseOutput
from scipy.optimize import brentq

# Points of a step at which a planar motion is looked at for a swing over the upright and back.
_DIP_SAMPLES = 9

# A swing shorter than this part of a step leaves the column at rest on its base.
_SMALLEST_SWING = 1e-12


def back_at_upright(dense: DenseOutput, side: float, start: float, end: float) -> float | None:
    """Return when a planar tilt first comes back to the upright from its `side` within a step, or None.

    It is `start` where the swing begins and ends within a part of the step too small to be told.
    """

    def height(tau: float) -> float:
        return side * float(dense(tau)[0])

    beyond = end if height(end) < 0.0 else _dip(dense, side, start, end)
    if beyond is None:
        return None
    candidates = start + (beyond - start) * np.concatenate([[0.0], np.geomspace(0.5, _SMALLEST_SWING, 40)])
    above = next((float(time) for time in candidates if height(float(time)) > 0.0), None)
    return start if above is None else float(brentq(height, above, beyond, xtol=4e-15 * max(1.0, beyond)))


def _dip(dense: DenseOutput, side: float, start: float, end: float) -> float | None:
    """Return the time within a step at which a planar tilt lies lowest beyond the upright, if it goes and returns."""
    tau = np.linspace(start, end, _DIP_SAMPLES)
    rate = side * dense(tau)[1]
    for i in np.flatnonzero((rate[:-1] < 0.0) & (rate[1:] > 0.0)):
        lowest = float(brentq(lambda t: side * float(dense(t)[1]), tau[i], tau[i + 1]))
        if side * float(dense(lowest)[0]) < 0.0:
            return lowest
    return None
