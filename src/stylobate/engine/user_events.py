"""Event functions of a user, and the location of their zeros on the dense output of a run."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np

from stylobate.base_motions import BaseMotion
from stylobate.engine.forcing import Floats, Forcing
from stylobate.engine.trajectory import Trajectory
from stylobate.errors import ParameterError, as_float, require_whole
from stylobate.models import Model
from stylobate.results import Event
from stylobate.results.response import EVENT_KINDS

# Number of points per step at which event functions are evaluated.
_SAMPLES = 5
# Points while the column stands: per half of the shortest period of the base motion, minimum, and maximum.
_PER_HALF_PERIOD, _FEWEST, _MOST = 8, 65, 100_001


@dataclass(frozen=True, slots=True)
class EventFunction:
    """Function of time and state whose zeros are events of a run.

    Parameters
    ----------
    name
        Kind of the events in `Response.events`.
    function
        Called with the time [s] and the state; returns a number that changes sign at an event, not a truth value. The
        state is a dict of the variables of `Response.data` at that time, in SI units: "tilt" and "tilt_rate" (arrays of
        x and y), "amplitude", "resting", "base_acceleration" (x, y and z), and outputs of the model such as "energy",
        "spin", "twist" and "footprint".
    direction
        Positive: only zeros at which the function rises; negative: only zeros at which it falls; 0: both.
    terminal
        Whether the event ends the run; a whole number n ends the run at the nth event.

    Notes
    -----
    Plain functions are accepted as in `scipy.integrate.solve_ivp`: they have the name `function.__name__` and the
    optional attributes `direction` and `terminal`. A function that is zero at the start has no event there. It is
    evaluated at five points of each step; two sign changes between neighbouring points are not detected. If the
    function changes its sign because an impact changes the velocities, the event is at the impact.

    Examples
    --------
    >>> import stylobate as sb
    >>> model = sb.Slender(sb.Column.dimensionless(slenderness=0.1))
    >>> half = sb.EventFunction("half", lambda time, state: state["amplitude"] - 0.025, direction=-1, terminal=True)
    >>> run = sb.simulate(model, tilt=(0.05, 0.0), duration=10.0, events=[half])
    >>> run.outcome, run.events
    (<Outcome.STOPPED: 'stopped'>, (Event(kind='half', time=0.962423...),))
    """

    name: str
    function: Callable[[float, dict[str, Any]], float]
    direction: float = 0.0
    terminal: bool | int = False

    def __post_init__(self) -> None:
        if not isinstance(self.name, str) or not self.name:
            raise ParameterError(f"name: must be a text that is not empty (got {self.name!r}). Name the event.")
        if not callable(self.function):
            raise ParameterError(
                f"function: not callable (got {self.function!r}). Provide a function of time and state."
            )
        if math.isnan(as_float("direction", self.direction)):
            raise ParameterError(
                f"direction: must be a number (got {self.direction!r}). Use 1, −1, or 0 for both directions."
            )
        require_whole("terminal", self.terminal, least=0)


def checked_events(events: Sequence[EventFunction | Callable[..., float]]) -> tuple[EventFunction, ...]:
    """Return `events` as event functions.

    Raises
    ------
    ParameterError
        If a function is not callable, or two events have the same name.
    """
    if isinstance(events, EventFunction) or not isinstance(events, Sequence):
        raise ParameterError(
            f"events: must be a list of event functions (got {events!r}). Put a single one in brackets."
        )
    checked = tuple(_checked(f"events[{place}]", one) for place, one in enumerate(events))
    taken = set(EVENT_KINDS)
    for place, one in enumerate(checked):
        if one.name in taken:
            raise ParameterError(
                f"events[{place}]: its name is taken (got {one.name!r}). Use EventFunction with another name."
            )
        taken.add(one.name)
    return checked


def _checked(where: str, given: object) -> EventFunction:
    if isinstance(given, EventFunction):
        return given
    if not callable(given):
        raise ParameterError(
            f"{where}: not callable (got {given!r}). Provide an EventFunction, or a function of time and state."
        )
    name = getattr(given, "__name__", type(given).__name__)
    return EventFunction(name, given, getattr(given, "direction", 0.0), getattr(given, "terminal", False))


class _State(dict[str, Any]):
    """State for an event function; the outputs of the model are computed at the first use of one."""

    def __init__(self, model: Model, states: Floats, acceleration: Floats, *, resting: bool) -> None:
        scale, gravity = model.time_scale, model.column.gravity
        tilt = model.tilt(states)[:, 0]
        super().__init__(
            tilt=tilt,
            tilt_rate=model.tilt_rate(states)[:, 0] / scale,
            amplitude=math.hypot(*tilt),
            resting=resting,
            base_acceleration=acceleration[:, 0] * gravity,
        )
        self._outputs = partial(model.outputs, states, acceleration, np.array([resting]))

    def __missing__(self, name: str) -> Any:
        self.update({key: output.values[0] for key, output in self._outputs().items()})
        if name not in self:
            raise ParameterError(f"events: no variable {name!r} in the state. Use one of {', '.join(self)}.")
        return self[name]


def own_events(
    functions: Sequence[EventFunction], model: Model, motion: BaseMotion, trajectory: Trajectory
) -> tuple[list[Event], float | None]:
    """Return the events of the `functions` of a user in order, and the time of an event that ends the run [s]."""
    recorder = EventRecorder(tuple(functions), model, Forcing.of(model, motion), [])
    if functions:
        resting = trajectory.resting(trajectory.starts)
        for number, (start, end, rests) in enumerate(zip(trajectory.starts, trajectory.ends, resting, strict=True)):
            states = partial(trajectory.states, stretch=number)
            ended = recorder.search(float(start), float(end), states, resting=bool(rests))
            if ended is not None:
                return recorder.events, ended * model.time_scale
    return recorder.events, None


@dataclass(slots=True)
class EventRecorder:
    """Recorder that locates the zeros of event functions step by step, and adds them to the `events` of a run."""

    functions: tuple[EventFunction, ...]
    model: Model
    forcing: Forcing
    events: list[Event]
    _counts: list[int] = field(default_factory=list)
    _before: list[float] = field(default_factory=list)

    def __post_init__(self) -> None:
        self._counts = [0] * len(self.functions)

    def search(
        self, start: float, end: float, states: Callable[[Floats], Floats], *, resting: bool = False
    ) -> float | None:
        """Record the events from `start` to `end`; return the time of an event that ends the run, or None.

        Parameters
        ----------
        start, end
            A step up to its first event of another kind, in dimensionless time.
        states
            Function that returns the states, shape (number of states, n), at n times within the step.
        resting
            Whether the column stands.
        """
        if not self.functions:
            return None
        found = []
        times = np.linspace(start, end, self._samples(end - start) if resting else _SAMPLES)
        ends = []
        for number in range(len(self.functions)):

            def value(tau: float, number: int = number) -> float:
                return self._value(number, tau, states, resting=resting)

            values = [value(tau) for tau in times.tolist()]
            before = self._before[number] if self._before else values[0]
            for low, high, old, new in zip([start, *times], times, [before, *values], values, strict=False):
                if _crosses(old, new, self.functions[number].direction):
                    found.append((_root(value, float(low), float(high)), number))
            ends.append(values[-1])
        self._before = ends
        for time, number in sorted(found):
            self.events.append(Event(self.functions[number].name, time * self.model.time_scale))
            self._counts[number] += 1
            terminal = self.functions[number].terminal
            if terminal and self._counts[number] >= terminal:
                return time
        return None

    def _samples(self, length: float) -> int:
        halves = length * self.forcing.highest_frequency / math.pi
        return min(max(math.ceil(_PER_HALF_PERIOD * halves), _FEWEST), _MOST)

    def _value(self, number: int, tau: float, states: Callable[[Floats], Floats], *, resting: bool) -> float:
        at = np.array([tau])
        state = _State(self.model, states(at), self.forcing.along(at), resting=resting)
        one = self.functions[number]
        found = one.function(tau * self.model.time_scale, state)
        if isinstance(found, bool | np.bool_):
            raise ParameterError(
                f"events: {one.name!r} must return a number (got {found}). Return a − b for a condition a > b."
            )
        value = as_float(f"events: the value of {one.name!r}", found)
        if math.isnan(value):
            raise ParameterError(
                f"events: {one.name!r} is NaN at {tau * self.model.time_scale:.6g} s. Return a number there."
            )
        return value


def _crosses(old: float, new: float, direction: float) -> bool:
    return (old < 0.0 <= new and direction >= 0.0) or (old > 0.0 >= new and direction <= 0.0)


def _root(value: Callable[[float], float], low: float, high: float) -> float:
    """Return the zero in a bracket, which has no length if an impact changes the sign."""
    if low == high:
        return low
    from scipy.optimize import brentq

    return float(brentq(value, low, high, xtol=4e-15 * max(1.0, abs(high))))
