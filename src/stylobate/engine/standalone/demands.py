"""Peak contact demands of a single run, in the language of the compiler; see `engine.history.Demands`."""

import math
from enum import auto
from typing import Any

import numpy as np
import numpy.typing as npt

from stylobate.engine.kernel.bound import FromZero
from stylobate.engine.kernel.columns import LOG, Log, Setup, Trace
from stylobate.engine.kernel.driver.events import TraceKind
from stylobate.engine.standalone.bases import last_begun
from stylobate.engine.standalone.runs import Base, loads, states_at
from stylobate.engine.tolerances import SAMPLES_PER_PERIOD

Row = npt.NDArray[np.float64]


class Demand(FromZero):
    """Contact demands of a run; NaN for a model without contact forces."""

    FRICTION = auto()
    PIVOTING = auto()
    """Peak friction over the normal force, and peak moment over normal force and radius."""
    NORMAL = auto()
    """Minimum normal force over the weight."""
    LIFTS = auto()
    SLIPS = auto()
    """First times at which the contact would pull, and at which friction exceeds that of the base [s]; NaN if never."""


_LOADS = 3
_PER_STEP = 16
"""Times in each step of a run."""
_MOST = 20_000
"""Times while the column stands, at most."""
_NARROWINGS, _PARTS = 4, 40
"""Successively narrower intervals about a peak, and the equal parts of each."""
_NEARLY = 0.8
"""Peaks of the known times are refined from this fraction of the largest one on."""
_HALVINGS = 50


def demands(entries: Row, model: Any, base: Base, row: Row, friction: Any, out: Row) -> None:
    """Set the contact demands of a run.

    Parameters
    ----------
    entries
        Entries of its trace that are not events, shape (n, columns).
    model, base
        Model and base motion.
    row
        Row of the run after its end.
    friction
        Friction coefficient of the base; infinite without one.
    out
        Numbers of `Demand`.
    """
    for k in range(len(Demand)):
        out[k] = math.nan
    if model.contact is None or model.guards is not None:
        return
    end = row[LOG + Log.TIME]
    here, peaks, last, rising = np.zeros(_LOADS), np.zeros(_LOADS), np.zeros(_LOADS), np.zeros(_LOADS)
    for load in range(_LOADS):
        peaks[load] = last[load] = -math.inf
    earlier: Any = 0.0
    before: Any = 0.0
    for at in range(len(entries)):
        first = entries[at, Trace.START]
        until = entries[at + 1, Trace.START] if at + 1 < len(entries) else end
        parts = _parts(entries[at], row, until - first)
        for k in range(parts + 1):
            tau = min(first + k * ((until - first) / parts), until)
            _set_loads(entries, at, model, base, row, tau, here)
            for load in range(_LOADS):
                now = here[load]
                peaked = rising[load] > 0.0 and now < last[load] and last[load] > _nearly(peaks[load])
                peaks[load] = max(peaks[load], now)
                if peaked and last[load] < math.inf:
                    peaks[load] = _refined(entries, model, base, row, load, (earlier, tau), peaks[load])
                rising[load] = 1.0 if now > last[load] else rising[load] * (1.0 if now == last[load] else 0.0)
                last[load] = now
            _note(entries, model, base, row, (before, tau), here, friction, out)
            earlier, before = before, tau
    out[Demand.FRICTION], out[Demand.PIVOTING], out[Demand.NORMAL] = peaks[0], peaks[1], -peaks[2]


def _nearly(peak: Any) -> Any:
    """Return the value from which on a peak may turn out to be the largest."""
    return peak - (1.0 - _NEARLY) * abs(peak)


def _parts(entry: Row, row: Row, length: Any) -> Any:
    """Return the number of equal parts of an entry of the trace."""
    if entry[Trace.KIND] != TraceKind.STAND:
        return _PER_STEP
    return max(1, min(math.ceil(length * row[Setup.FREQUENCY] * SAMPLES_PER_PERIOD / (2.0 * math.pi)), _MOST))


def _set_loads(entries: Row, at: Any, model: Any, base: Base, row: Row, tau: Any, here: Row) -> None:
    """Set friction, moment and the reversed normal force at a time within an entry."""
    states = states_at(entries[at], model, row, tau)
    normal, friction, moment = loads(entries[at], model, states, base.acceleration(tau * model.time_scale))
    here[0], here[1], here[2] = friction, moment, -normal


def _entry_at(entries: Row, tau: Any) -> Any:
    """Return the number of the entry that holds a time."""
    return last_begun(entries, Trace.START, 0, len(entries) - 1, tau)


def _refined(entries: Row, model: Any, base: Base, row: Row, load: Any, between: tuple[Any, Any], peak: Any) -> Any:
    """Return the larger one of a peak and the largest load between two times, about a peak of the known times."""
    here, (low, high) = np.zeros(_LOADS), between
    for _ in range(_NARROWINGS):
        top, highest = low, -math.inf
        step = (high - low) / _PARTS
        for k in range(_PARTS + 1):
            tau = min(low + k * step, between[1])
            _set_loads(entries, _entry_at(entries, tau), model, base, row, tau, here)
            if here[load] > highest:
                top, highest = tau, here[load]
        peak = max(peak, highest)
        low, high = max(top - step, between[0]), min(top + step, between[1])
    return peak


def _note(
    entries: Row, model: Any, base: Base, row: Row, between: tuple[Any, Any], here: Row, friction: Any, out: Row
) -> None:
    """Set the first times beyond the limits, if they lie between two times."""
    lifts = math.isnan(out[Demand.LIFTS]) and here[2] > 0.0
    slips = math.isnan(out[Demand.SLIPS]) and here[0] > friction
    if lifts:
        out[Demand.LIFTS] = _first(entries, model, base, row, between, 2, 0.0, here) * model.time_scale
    if slips:
        out[Demand.SLIPS] = _first(entries, model, base, row, between, 0, friction, here) * model.time_scale


def _first(
    entries: Row, model: Any, base: Base, row: Row, between: tuple[Any, Any], load: Any, limit: Any, here: Row
) -> Any:
    """Return the time at which a load exceeds a limit, by bisection."""
    low, high = between
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        _set_loads(entries, _entry_at(entries, middle), model, base, row, middle, here)
        if here[load] > limit:
            high = middle
        else:
            low = middle
    return high
