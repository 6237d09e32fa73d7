"""Integrals over the last periods: mean tilt, and tilt vector in frames that rotate with and against the forcing.

Few lanes are in their last periods at one time, so the driver observes each lane separately. Steps by Taylor series
are long; for these a loop runs over the nodes of Gauss's rule within the step.
"""

import math

import numpy as np

from stylobate.compiler.marks import fast, lanes
from stylobate.engine.elementary import cos_turns
from stylobate.engine.kernel.bound import ORDER, PLANAR, SERIES, R
from stylobate.engine.kernel.driver.equations import lean_of, row_state
from stylobate.engine.kernel.driver.series import series_terms
from stylobate.engine.kernel.layout import Table
from stylobate.engine.kernel.shape import NODES
from stylobate.engine.sums import polynomial

_GAUSS = np.polynomial.legendre.leggauss(NODES)  # on −1 … 1
PLACES, WEIGHTS = 0.5 + 0.5 * _GAUSS[0], 0.5 * _GAUSS[1]
OBSERVED = 5
"""Rows of the integrals: mean tilt, forward along the cosine and the sine, backward along both."""
TINY = 1e-300

Observed = tuple[float, float, float, float, float]


@fast
def observe(buf: Table, i: int) -> None:
    """Add the integrals over the step just made of the tilt, and of the tilt vector times e^{∓2πi t/T}; T: period."""
    if SERIES:
        observe_by_nodes(buf, i)
    else:
        observe_by_ends(buf, i)
    buf[R.LATE_MINIMUM_TILT, i] = min(buf[R.LATE_MINIMUM_TILT, i], buf[R.LOW, i])


def observe_by_nodes(buf: Table, i: int) -> None:
    """Integrate by Gauss's rule, with the states at its nodes from the series of the step."""
    h, w = buf[R.MADE, i], buf[R.PER_TURN, i]
    start = w * (buf[R.TIME, i] - h)
    terms = tuple(series_terms(buf, i, j) for j in range(ORDER))
    # A sum in this loop would prevent vectorisation: the products are stored and added afterwards.
    for node in lanes(NODES):
        u = PLACES[node]
        x, y, _, _ = lean_of(buf, i, tuple(polynomial(one, u * h) for one in terms))
        turns = start + w * (u * h)
        cos, sin = cos_turns(turns), cos_turns(turns - 0.25)
        weight = h * WEIGHTS[node]
        values = (math.sqrt(x * x + y * y), *rotating_components(x, y, cos, sin))
        for k in range(OBSERVED):
            buf[R.NODE_MEAN_TILT + k, node] = weight * values[k]
    for node in range(NODES):
        for k in range(OBSERVED):
            buf[R.MEAN_TILT + k, i] += buf[R.NODE_MEAN_TILT + k, node]


def rotating_components(x: float, y: float, cos: float, sin: float) -> tuple[float, float, float, float]:
    """Return the components of a vector in frames that rotate with and against the forcing."""
    return x * cos + y * sin, y * cos - x * sin, x * cos - y * sin, y * cos + x * sin


def observe_by_ends(buf: Table, i: int) -> None:
    """Integrate by the trapezoidal rule with its end correction, exact for cubics.

    The frames rotate with and against the forcing, because steady rolling is constant in one of them.
    """
    h, w = buf[R.MADE, i], buf[R.PER_TURN, i]
    start = w * (buf[R.TIME, i] - h)
    weight, correction = 0.5 * h, h * h * (1.0 / 12.0)
    values0, slopes0 = observed_at(buf, i, R.LAST_STATE, start, w)
    values1, slopes1 = observed_at(buf, i, R.STATE, start + w * h, w)
    for k in tuple(range(OBSERVED)):
        whole = weight * (values0[k] + values1[k]) + correction * (slopes0[k] - slopes1[k])
        buf[R.MEAN_TILT + k, i] += whole


def observed_at(buf: Table, i: int, row: int, turns: float, w: float) -> tuple[Observed, Observed]:
    """Return the integrands and their rates at an end of the step, whose state begins at this row."""
    x, y, vx, vy = lean_of(buf, i, row_state(buf, i, row))
    cos, sin = cos_turns(turns), cos_turns(turns - 0.25)
    turning = 6.283185307179586 * w
    tilt = math.sqrt(x * x + y * y)
    # Planar motion passes tilt zero with a nonzero rate.
    rate = buf[R.SIDE, i] * vx if PLANAR else (x * vx + y * vy) / (tilt + TINY)
    along, across, against, other = rotating_components(x, y, cos, sin)
    forward = rotating_components(vx + turning * y, vy - turning * x, cos, sin)
    backward = rotating_components(vx - turning * y, vy + turning * x, cos, sin)
    return (tilt, along, across, against, other), (rate, forward[0], forward[1], backward[2], backward[3])
