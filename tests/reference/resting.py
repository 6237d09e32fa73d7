"""The column at rest on its base: when the motion releases it, and how it departs."""

import math

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from stylobate.engine.starts import cannot_depart
from stylobate.engine.tolerances import SAMPLES_PER_PERIOD
from stylobate.models import Model
from stylobate.models.model import Push

from .forcing import Floats, Forcing
from .pieces import Piece

# Samples looked at together.
_BLOCK = 4096

# So many common periods show what a motion that repeats does, whatever the phase at which they begin.
_PERIODS = 2.0

# What counts as the same moment [samples].
_MOMENT = 1e-6

# Time after release, in units of the fastest time scale, at which the departure series hands over to the integrator:
# its error there is of the order of the fourth power.
_DEPARTURE = 1e-3


def stays_for_good(model: Model, forcing: Forcing, since: float) -> bool:
    """Return whether nothing from `since` on can release a column at rest."""
    weight = 1.0 + forcing.minimum_vertical(since)
    return weight > 0.0 and forcing.peak_horizontal(since) <= model.rest_capacity * weight


def release_time(model: Model, forcing: Forcing, start: float, end: float) -> float | None:
    """Return the first time in [start, end) at which |a_h| exceeds the rest capacity, or None.

    The acceleration is sampled 64 times in its shortest period; between samples every peak that a parabola through
    three of them brings near the limit is refined.
    """
    if stays_for_good(model, forcing, start):
        return None
    frequency = forcing.highest_frequency
    spacing = 2.0 * math.pi / (frequency * SAMPLES_PER_PERIOD) if frequency > 0.0 else end - start
    # An excess that is gone a moment later is the rounding of the instant at which the column came to rest.
    moment = start + _MOMENT * spacing
    if _excess(model, forcing, start) > 0.0:
        if _excess(model, forcing, moment) > 0.0:
            return start
        start = moment
    for stop in forcing.stops(end):
        while start < stop:
            block_end = min(stop, start + _BLOCK * spacing)
            count = max(3, math.ceil((block_end - start) / spacing) + 1)
            found = _first_crossing(model, forcing, np.linspace(start, block_end, count))
            if found is not None:
                return found if found < end else None
            # Blocks share two samples, so that a peak at a seam is seen.
            start = stop if block_end == stop else block_end - spacing
    return None


def release_within(model: Model, forcing: Forcing, start: float, end: float, steps: int) -> tuple[float | None, bool]:
    """Return when the base motion releases the column, and whether all of [start, end) has been looked at.

    So many periods of the base motion are looked at as a run may take `steps`: a column that moves takes two in each.
    A motion that repeats within these, its ramp and other breaks over, is known for good.
    """
    if not forcing.highest_frequency > 0.0 or stays_for_good(model, forcing, start):
        return release_time(model, forcing, start, end), True
    seen = start + steps * 2.0 * math.pi / forcing.highest_frequency
    if end <= seen:
        return release_time(model, forcing, start, end), True
    begun = max((start, *forcing.stops(end)[:-1]))
    period = math.inf if forcing.motion.period is None else forcing.motion.period / forcing.time_scale
    repeats = begun + _PERIODS * period < seen
    found = release_time(model, forcing, start, begun + _PERIODS * period if repeats else seen)
    return found, repeats or found is not None


def departure_lapse(forcing: Forcing) -> float:
    """Return how long after a release the series of a departure hands over to the integrator."""
    return _DEPARTURE / (1.0 + forcing.highest_frequency)


def departure(model: Model, forcing: Forcing, time: float) -> tuple[float, tuple[float, ...]]:
    """Return a time shortly after release at `time`, and the state there.

    The state is the model's series about the upright, so that the integrator starts where the lean has a direction.
    """
    elapsed = departure_lapse(forcing)
    apart = elapsed * (2.0 / 3.0)  # the series takes mean rates over two thirds
    now, later = forcing.along(np.array([time, time + apart])).T
    capacity = model.column.slenderness
    here, there = math.hypot(now[0], now[1]), math.hypot(later[0], later[1])
    excess = max(here - capacity * (1.0 + now[2]), 0.0)
    push = Push(
        direction=(-now[0] / here, -now[1] / here),
        acceleration=here,
        excess=excess,
        excess_rate=(there - capacity * (1.0 + later[2]) - excess) / apart,
        turning_rate=math.atan2(now[0] * later[1] - now[1] * later[0], now[0] * later[0] + now[1] * later[1]) / apart,
    )
    if model.departure is None:
        raise cannot_depart(model)
    return time + elapsed, model.departure(push, elapsed, *model.parameters)


def rest_piece(held: tuple[float, ...], start: float, end: float) -> Piece:
    """Return the column standing in the state `held` from `start` to `end`."""

    def states(tau: Floats) -> Floats:
        return np.repeat(np.array(held)[:, np.newaxis], tau.size, axis=1)

    nothing = np.empty(0)
    return Piece(start, end, states, resting=True, nodes=nothing, azimuths=nothing)


def _excess(model: Model, forcing: Forcing, tau: float) -> float:
    ax, ay, az = forcing.at(tau)
    return math.hypot(ax, ay) - model.rest_capacity * (1.0 + az)


def _first_crossing(model: Model, forcing: Forcing, tau: Floats) -> float | None:
    ax, ay, az = forcing.along(tau)
    excess = np.hypot(ax, ay) - model.rest_capacity * (1.0 + az)
    above = np.flatnonzero(excess > 0.0)
    first_above = int(above[0]) if above.size else tau.size
    for peak in _peaks_near_limit(excess[: first_above + 1]):
        best = minimize_scalar(
            lambda t: -_excess(model, forcing, t),
            bounds=(tau[peak - 1], tau[peak + 1]),
            method="bounded",
            options={"xatol": 1e-12 * max(1.0, float(tau[peak]))},
        )
        if -best.fun > 0.0:
            return _root(model, forcing, float(tau[peak - 1]), float(best.x))
    if first_above == tau.size:
        return None
    return (
        float(tau[0])
        if first_above == 0
        else _root(model, forcing, *map(float, tau[first_above - 1 : first_above + 1]))
    )


def _peaks_near_limit(excess: Floats) -> list[int]:
    # A parabola through three samples; a peak counts if it would pass the limit with twice the rise it shows.
    before, here, after = excess[:-2], excess[1:-1], excess[2:]
    curvature = before - 2.0 * here + after
    with np.errstate(divide="ignore", invalid="ignore"):
        rise = np.where(curvature < 0.0, -((after - before) ** 2) / (8.0 * curvature), 0.0)
    is_peak = (here >= before) & (here >= after) & (curvature < 0.0) & (here + 2.0 * rise - curvature > 0.0)
    return [int(i) + 1 for i in np.flatnonzero(is_peak)]


def _root(model: Model, forcing: Forcing, below: float, above: float) -> float:
    if _excess(model, forcing, below) >= 0.0:
        return below
    exactly = 1e-15 * max(1.0, above)
    root = float(brentq(lambda t: _excess(model, forcing, t), below, above, xtol=exactly))
    # Where the base motion jumps the root found may lie before the jump.
    return root if _excess(model, forcing, root) >= 0.0 else min(above, root + 4.0 * exactly)
