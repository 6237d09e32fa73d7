"""Slip of a block on a base that shakes in three directions: Newmark's sliding block, many at once.

A column with the friction coefficient μ below r/h that stands on its whole base slips as a block. With the velocity v
relative to the base, the acceleration a of the base, its horizontal part a_h and n = g + a_z,

    v̇ = −a_h − μ n v/|v|    while it slips                                                                  (1)
    v = 0                   while |a_h| ≤ μ n                                                               (2)

(N. M. Newmark, "Effects of earthquakes on dams and embankments", Géotechnique 15, 1965, in two directions.) It does not
tip: the friction T acts at the base and the inertia of the body at the height h, so the centre of pressure lies at
h T/N ≤ μ h < r from the axis, inside the base. It does not turn about its axis either. All friction of a base that
slips without rotation is antiparallel to v, for any pressure; its resultant acts at the centre of pressure, which lies
off the axis along T itself, and so has no moment about the axis. Only where n < 0 does the block lift off: the motion
is not described from there, and the result says so.

The accelerations are linear between knots. A step from t to t + δ has two stages, by the L-stable method of second
order (SDIRK, γ = 1 − 1/√2). Friction makes each stage implicit, with the solution in closed form

    v = w max(0, 1 − γ δ μ n/|w|),    w = the velocity without friction of this stage.                      (3)

So slip ends at exactly zero velocity, and slow slip, whose direction follows the load at once, needs no short steps.
Each step is compared with two of half its length. A stick ends at the root of |a_h|² = μ² n², a quadratic in time.
After the last knot a block comes to rest on a straight path, v²/(2μg) long.
"""

import math
import sys
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import Record
from stylobate.compiler.compiled import Compiled
from stylobate.compiler.programs import Bound
from stylobate.compiler.unit import ArrayArgument
from stylobate.compiler.values import NumberKind
from stylobate.errors import require_positive

Floats = npt.NDArray[np.float64]

TOLERANCE = 1e-7
"""Default error of the velocity in one step [m/s]: slips of some metres are then accurate to 0.1 mm."""

# Diagonal of the method of second order, and its weight of the first stage.
_GAMMA = 1.0 - math.sqrt(0.5)
# Limits of the change of the step, and the exponent of its error, δ³.
_LEAST, _MOST, _SAFETY, _EXPONENT = 0.1, 4.0, 0.9, 1.0 / 3.0
# Steps shorter than this [s] are accepted: they locate the end of a slip.
_SHORTEST = 1e-7
# Time in which an error of the velocity grows to one of the position [s].
_TIME = 0.1
_RESULTS = 6


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class BlockSlip:
    """Slip of blocks relative to their base, one lane each.

    Parameters
    ----------
    peak
        Largest distance from the start, shape (lanes,) [m].
    residual
        Position at the end along x and y, shape (lanes, 2) [m].
    path
        Length of the path, shape (lanes,) [m].
    duration
        Time of slip, shape (lanes,) [s].
    flies
        Whether the base falls faster than the block, n < 0, at some time: then (1) does not describe the motion, and
        the other numbers have no meaning.
    trace
        Positions at the samples of the record, shape (lanes, samples, 2) [m]; no samples unless they were asked for.
    """

    peak: Floats
    residual: Floats
    path: Floats
    duration: Floats
    flies: npt.NDArray[np.bool_]
    trace: Floats


def block_slip(
    record: Record,
    *,
    friction_coefficient: npt.ArrayLike,
    horizontal: npt.ArrayLike = 1.0,
    vertical: npt.ArrayLike = 1.0,
    gravity: float,
    traced: bool = False,
    tolerance: float = TOLERANCE,
) -> BlockSlip:
    """Compute the slip of blocks that start at rest under one record.

    Parameters
    ----------
    record
        Acceleration of the base.
    friction_coefficient
        μ of each lane, positive, shape (lanes,) or one for all.
    horizontal, vertical
        Factors of the horizontal and the vertical components, shape (lanes,) or one for all.
    gravity
        Gravitational acceleration [m/s²].
    traced
        Whether to keep the positions at the samples.
    tolerance
        Error of the velocity in one step [m/s].

    Returns
    -------
    BlockSlip
        A lane for each friction and factor, broadcast.

    Raises
    ------
    ParameterError
        If `gravity` or `tolerance` is not positive.

    Examples
    --------
    A block with μ = 0.1 on a base with the acceleration 3 m/s² for half a second (Newmark's rectangular pulse) slips by
    v²/(2 μ g) (1 − μ g/a) with v = a t:

    >>> pulse = Record(samples=[3.0, 3.0], step=0.5)
    >>> found = block_slip(pulse, friction_coefficient=0.1, gravity=10.0)
    >>> found.residual.round(6).tolist(), round(1.5**2 / 2.0 * (1.0 - 1.0 / 3.0), 6)
    ([[-0.75, 0.0]], 0.75)
    """
    given = [np.asarray(one, dtype=float) for one in (friction_coefficient, horizontal, vertical)]
    lanes = np.ascontiguousarray(np.stack(np.broadcast_arrays(*map(np.atleast_1d, given)), axis=-1))
    knots = _knots(record)
    out = np.zeros((len(lanes), _RESULTS))
    trace = np.zeros((len(lanes) * len(knots) if traced else 0, 2))
    limit, g = require_positive("tolerance", tolerance, "m/s"), require_positive("gravity", gravity, "m/s²")
    _compiled()(knots, lanes, out, trace, g, limit)
    return BlockSlip(
        peak=out[:, 0],
        residual=out[:, 1:3],
        path=out[:, 3],
        duration=out[:, 4],
        flies=out[:, 5] > 0.0,
        trace=trace.reshape(len(lanes), -1, 2),
    )


def _knots(record: Record) -> Floats:
    """Return time and accelerations of the samples from t = 0 on, shape (knots, 4)."""
    times = record.times[record.times >= 0.0]
    if record.start < 0.0 < record.end and times[0] > 0.0:
        times = np.insert(times, 0, 0.0)
    if not times.size:
        return np.zeros((1, 4))
    return np.ascontiguousarray(np.column_stack([times, record.acceleration(times)]))


class Load(NamedTuple):
    """Acceleration of the base at an instant, its rates, and the friction coefficient.

    Parameters
    ----------
    ax, ay
        Horizontal acceleration of the base [m/s²].
    n
        g + a_z [m/s²].
    ux, uy, un
        Their rates [m/s³].
    mu
        Friction coefficient.
    """

    ax: float
    ay: float
    n: float
    ux: float
    uy: float
    un: float
    mu: float


class Slip(NamedTuple):
    """Motion of a block relative to its base.

    Parameters
    ----------
    x, y, u, v
        Position [m] and velocity [m/s]; at rest both velocities are exactly zero.
    peak
        Largest squared distance from the start [m²].
    path
        Length of the path [m].
    lasted
        Time of slip [s].
    step
        Length of the next step [s].
    """

    x: float
    y: float
    u: float
    v: float
    peak: float
    path: float
    lasted: float
    step: float


def later(load: Load, time: float) -> Load:
    """Return the load after a time [s]."""
    ax, ay, n, ux, uy, un, mu = load
    return Load(ax + ux * time, ay + uy * time, n + un * time, ux, uy, un, mu)


def stopped(x: float, y: float, impulse: float) -> tuple[float, float]:
    """Reduce a velocity by the impulse of friction, to zero at most."""
    size = math.sqrt(x * x + y * y)
    left = 1.0 - impulse / size if size > impulse else 0.0
    return x * left, y * left


def slide(u: float, v: float, load: Load, h: float) -> tuple[float, float, float, float]:
    """Return the velocity after a step `h`, and the distance in it, by (3)."""
    at, rest = _GAMMA * h, h - _GAMMA * h
    first, last = later(load, at), later(load, h)
    friction = at * load.mu
    x, y = stopped(u - at * first.ax, v - at * first.ay, friction * first.n)
    k, m = (x - u) / at, (y - v) / at  # rates of the first stage
    end_x, end_y = stopped(u + rest * k - at * last.ax, v + rest * m - at * last.ay, friction * last.n)
    return end_x, end_y, rest * x + at * end_x, rest * y + at * end_y


def onset(load: Load, span: float) -> float:
    """Return the time at which the load first exceeds the friction, up to `span`; `span` if it does not."""
    ax, ay, n, ux, uy, un, mu = load
    # |a_h|² − μ² n² = a t² + 2 b t + c
    a = ux * ux + uy * uy - mu * mu * un * un
    b = ax * ux + ay * uy - mu * mu * n * un
    c = ax * ax + ay * ay - mu * mu * n * n
    square = b * b - a * c
    if c > 0.0 or (c == 0.0 and (b > 0.0 or (b == 0.0 and a > 0.0))):
        return 0.0
    if square < 0.0:
        return span
    # the root at which it rises, without cancellation
    root, found = math.sqrt(square), span
    if b > 0.0:
        found = -c / (b + root)
    elif a > 0.0:
        found = (root - b) / a
    return min(found, span)


def one_step(slip: Slip, load: Load, left: float, tolerance: float) -> tuple[float, Slip]:
    """Return the length of an accepted step of at most `left`, 0 if it is refused, and the motion after it."""
    x, y, u, v, peak, path, lasted, step = slip
    h = min(step, left)
    half = 0.5 * h
    u1, v1, dx1, dy1 = slide(u, v, load, h)
    um, vm, dxm, dym = slide(u, v, load, half)
    u2, v2, dx2, dy2 = slide(um, vm, later(load, half), half)
    dx, dy = dxm + dx2, dym + dy2
    distance = math.sqrt((dx - dx1) * (dx - dx1) + (dy - dy1) * (dy - dy1))
    speed = math.sqrt((u2 - u1) * (u2 - u1) + (v2 - v1) * (v2 - v1))
    error = max(speed, distance / _TIME) / 3.0  # of two halves of a step whose error is of third order
    factor = _MOST
    if error > 0.0:
        factor = min(_MOST, max(_LEAST, _SAFETY * (tolerance / error) ** _EXPONENT))
    if error > tolerance and h > _SHORTEST:
        return 0.0, Slip(x, y, u, v, peak, path, lasted, h * min(factor, _SAFETY))
    if h < left or factor < 1.0 or step == math.inf:
        step = max(h * factor, _SHORTEST)
    x, y = x + dx, y + dy
    peak, path = max(peak, x * x + y * y), path + math.sqrt(dx * dx + dy * dy)
    return h, Slip(x, y, u2, v2, peak, path, lasted + h, step)


def over_segment(slip: Slip, load: Load, span: float, tolerance: float) -> Slip:
    """Return the motion after a time `span` in which the load is linear."""
    done = 0.0
    while done < span:
        if slip.u == 0.0 and slip.v == 0.0:
            wait = onset(later(load, done), span - done)
            if wait >= span - done:
                break
            done += wait
        left = span - done
        h, slip = one_step(slip, later(load, done), left, tolerance)
        done = span if h >= left else done + h
    return slip


def march(knots: Floats, lanes: Floats, out: Floats, trace: Floats, gravity: float, tolerance: float) -> int:
    """Follow the block of each lane over all knots; see `block_slip`."""
    count = len(knots)
    for lane in range(len(lanes)):
        mu, horizontal, vertical = lanes[lane, 0], lanes[lane, 1], lanes[lane, 2]
        slip = Slip(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, math.inf)
        flies = 0.0
        for k in range(count):
            if len(trace) > 0:
                trace[lane * count + k, 0] = slip.x
                trace[lane * count + k, 1] = slip.y
            n = gravity + vertical * knots[k, 3]
            if n < 0.0:
                flies = 1.0
            if k == count - 1 or flies > 0.0:
                break
            span = knots[k + 1, 0] - knots[k, 0]
            ax, ay = horizontal * knots[k, 1], horizontal * knots[k, 2]
            ux, uy = (horizontal * knots[k + 1, 1] - ax) / span, (horizontal * knots[k + 1, 2] - ay) / span
            un = (gravity + vertical * knots[k + 1, 3] - n) / span
            slip = over_segment(slip, Load(ax, ay, n, ux, uy, un, mu), span, tolerance)
        # to rest after the last knot, along a straight path
        speed = math.sqrt(slip.u * slip.u + slip.v * slip.v)
        reach = 0.5 * speed / (mu * gravity)
        x, y = slip.x + reach * slip.u, slip.y + reach * slip.v
        out[lane, 0] = math.sqrt(max(slip.peak, x * x + y * y))
        out[lane, 1] = x
        out[lane, 2] = y
        out[lane, 3] = slip.path + reach * speed
        out[lane, 4] = slip.lasted + 2.0 * reach
        out[lane, 5] = flies
    return 0


@cache
def _compiled() -> Compiled:
    """Return the compiled form of `march`."""
    module = sys.modules[__name__]
    columns = 4, 3, _RESULTS, 2
    return Compiled(
        name="march",
        program=lambda: Bound(modules=(module,), names={}),
        functions={},
        arguments=(*(ArrayArgument((None, count)) for count in columns), NumberKind.FLOAT, NumberKind.FLOAT),
        model="",
        description="slip of blocks",
        brief=True,
    )
