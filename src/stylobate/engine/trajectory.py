"""Trajectory of one run: a polynomial for each step, from the trace of its kernel; zeros of event functions on it."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import Any

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import BaseMotion
from stylobate.compiler.compiled import over_rows
from stylobate.engine.forcing import Forcing
from stylobate.engine.kernel.columns import TRACE_TERMS, Trace
from stylobate.engine.kernel.driver.events import TraceKind
from stylobate.errors import ParameterError, as_float, require_whole
from stylobate.models import Model
from stylobate.results import Event
from stylobate.results.run import EVENT_KINDS

Floats = npt.NDArray[np.float64]

# Nodes of Gauss's rule in each step, for the integration of passive states.
NODES = 0.5 + 0.5 * np.polynomial.legendre.leggauss(8)[0]
# Row k holds the antiderivative of the polynomial that is 1 at node k and 0 at the other nodes, by powers of u.
ANTIDERIVATIVES = np.array(
    [
        np.polynomial.Polynomial.fit(NODES, row, len(NODES) - 1, domain=(0.0, 1.0), window=(0.0, 1.0)).integ().coef
        for row in np.eye(len(NODES))
    ]
)


@dataclass(frozen=True)
class Trajectory:
    """Motion of a run from its start to its end, as a function of dimensionless time.

    Parameters
    ----------
    model
        Model of the column.
    stretches
        Entries of the trace that are not events, shape (n, columns).
    line
        Unit vector of the line of planar motion.
    carried
        Initial passive states.
    end
        End of the run.
    """

    model: Model
    stretches: Floats
    line: tuple[float, float]
    carried: tuple[float, ...]
    end: float

    @property
    def steps(self) -> int:
        """Number of integration steps."""
        return int(np.isin(self._kinds, (TraceKind.STEP, TraceKind.PLANE_STEP)).sum())

    @property
    def half_turns(self) -> int:
        """Number of half turns of the contact point round the rim; each passage near the vertical is about one."""
        turned = self.stretches[:, Trace.END_AZIMUTH] - self.stretches[:, Trace.AZIMUTH]
        return round(2.0 * float(np.abs(turned[self._kinds == TraceKind.STEP]).sum()))

    @property
    def starts(self) -> Floats:
        """Start of each stretch."""
        return self.stretches[:, Trace.START]

    @property
    def ends(self) -> Floats:
        """End of each stretch, the start of the next one."""
        return np.append(self.starts[1:], self.end)

    @cached_property
    def on_base(self) -> npt.NDArray[np.bool_]:
        """Whether the column stands on its base, at rest or sliding, in each stretch."""
        stands = np.asarray(self._kinds == TraceKind.STAND)
        return stands | (self.contacts <= 1) if self.model.switches else stands

    @property
    def contacts(self) -> npt.NDArray[np.int8]:
        """Kind of contact in each stretch, for a model that changes between kinds of contact."""
        return np.asarray(self._terms[0, len(self.model.state_names) - 1], dtype=np.int8)

    @property
    def standing(self) -> list[tuple[float, float]]:
        """Start and end of each interval in which the column stands on its base."""
        stands = self._kinds == TraceKind.STAND
        return list(zip(self.starts[stands].tolist(), self.ends[stands].tolist(), strict=True))

    def until(self, end: float) -> "Trajectory":
        """Return the motion up to an earlier `end`."""
        begun = self.starts < end
        return replace(self, stretches=self.stretches[begun] if begun.any() else self.stretches[:1], end=end)

    def states(self, tau: Floats, stretch: int | None = None) -> Floats:
        """Return the states, shape (number of states, n), at times between the start and the end.

        At the time of an impact the velocities are those after the impact, or those of the stretch with the index
        `stretch`.
        """
        states = self.own_states(tau, stretch)
        if not self.carried:
            return states
        return np.concatenate([states, self._carried_at(self._which(tau, stretch), tau)])

    def own_states(self, tau: Floats, stretch: int | None = None) -> Floats:
        """Return the states that the equations determine, without passive ones; as `states` does."""
        which = self._which(tau, stretch)
        return self._lifted(self._within(which, self._share(which, tau)), which)

    def _which(self, tau: Floats, stretch: int | None) -> npt.NDArray[np.intp]:
        return self._at(tau) if stretch is None else np.full(tau.shape, stretch)

    def resting(self, tau: Floats) -> npt.NDArray[np.bool_]:
        """Return whether the column stands on its base, shape (n,)."""
        return np.asarray(self.on_base[self._at(tau)])

    def azimuth(self, tau: Floats, tilt: Floats) -> Floats:
        """Return the continuous azimuth [rad] of the `tilt` vectors, shape (2, n), at `tau`.

        The azimuth is NaN if the column stands upright; in planar motion it is not continuous.
        """
        which = self._at(tau)
        x, y = tilt
        here = np.arctan2(y, x) / (2.0 * np.pi)
        # Within a stretch the tilt vector rotates in one direction by less than a turn.
        middle = 0.5 * (self.stretches[:, Trace.AZIMUTH] + self.stretches[:, Trace.END_AZIMUTH])[which]
        kinds = self._kinds[which]
        turns = np.where(kinds == TraceKind.PLANE_STEP, 0.0, np.round(middle - here))
        known = (kinds != TraceKind.STAND) & (np.hypot(x, y) > 0.0)
        return np.where(known, 2.0 * np.pi * (here + turns), np.nan)

    @property
    def _kinds(self) -> Floats:
        return self.stretches[:, Trace.KIND]

    @cached_property
    def _terms(self) -> Floats:
        """States at the starts, and coefficients, shape (8, number of states, n), contiguous for fast selection."""
        terms = self.stretches[:, len(Trace) :].reshape(len(self.stretches), TRACE_TERMS, -1)
        return np.ascontiguousarray(terms.transpose(1, 2, 0))

    def _at(self, tau: Floats) -> npt.NDArray[np.intp]:
        return np.clip(np.searchsorted(self.starts, tau, side="right") - 1, 0, None)

    def _share(self, which: npt.NDArray[np.intp], tau: Floats) -> Floats:
        return np.asarray((tau - self.starts[which]) / self.stretches[which, Trace.LENGTH])

    def _within(self, which: npt.NDArray[np.intp], share: Floats) -> Floats:
        """Return the values of the polynomials of these stretches: states, or tilt and rate for planar motion."""
        return _polynomial([np.take(terms, which, axis=1) for terms in self._terms], share)

    def _lifted(self, states: Floats, which: npt.NDArray[np.intp]) -> Floats:
        """Return the states of the model from the `states` of these stretches."""
        planar = self._kinds[which] == TraceKind.PLANE_STEP
        if not planar.any():
            return states[: len(self.model.state_names)]
        assert self.model.from_plane is not None
        lifted = self.model.from_plane(states[0], states[1], *self.line, *self.model.parameters)
        count = len(self.model.state_names)
        return np.where(planar, np.stack(np.broadcast_arrays(*lifted)), states[:count])

    def _carried_at(self, which: npt.NDArray[np.intp], tau: Floats) -> Floats:
        begun, terms = self._carried
        gained = _polynomials(terms, which, self._share(which, tau))
        return np.asarray(np.take(begun, which, axis=1) + self.stretches[which, Trace.LENGTH] * gained)

    @cached_property
    def _carried(self) -> tuple[Floats, Floats]:
        """Passive states at the start of each stretch (c, n), and their increments by powers of the share (p, c, n)."""
        assert self.model.carried_rates is not None
        count, carried = len(self.stretches), len(self.carried)
        terms = np.zeros((len(NODES) + 1, carried, count))
        steps = np.flatnonzero(self._kinds == TraceKind.STEP)
        if steps.size:
            states = _polynomial(self._terms[:, :, steps, np.newaxis], NODES)
            rates = self._carried_rates(states.reshape(len(states), -1).T).reshape(steps.size, len(NODES), carried)
            terms[..., steps] = np.einsum("nkc,kp->pcn", rates, ANTIDERIVATIVES)
        analytical = np.flatnonzero(self._kinds == TraceKind.ANALYTICAL_STEP)
        if analytical.size:
            terms[1][:, analytical] = self._carried_rates(self._terms[0][:, analytical].T).T
        each = np.arange(count)
        gained = _polynomials(terms, each, self._share(each, self.ends)) * self.stretches[:, Trace.LENGTH]
        before = np.cumsum(np.hstack([np.zeros((carried, 1)), gained[:, :-1]]), axis=1)
        return np.array(self.carried)[:, np.newaxis] + before, terms

    def _carried_rates(self, states: Floats) -> Floats:
        assert self.model.carried_rates is not None
        parameters = np.broadcast_to(self.model.parameters, (len(states), len(self.model.parameters)))
        rows = np.hstack([states[:, : len(self.model.state_names)], parameters])
        return over_rows(self.model.carried_rates, rows, name=self.model.name)


def _polynomial(terms: Floats | Sequence[Floats], share: Floats) -> Floats:
    """Return the values at `share` of the polynomial of a step with these terms, of any shape.

    E. Hairer, S. P. Nørsett, G. Wanner, "Solving Ordinary Differential Equations I", 2nd ed., section II.6.
    """
    change = np.zeros(np.broadcast_shapes(terms[0].shape, share.shape))
    for power in reversed(range(1, TRACE_TERMS)):
        change += terms[power]
        change *= share if power % 2 else 1.0 - share
    return np.asarray(terms[0] + change)


def _polynomials(terms: Floats, which: npt.NDArray[np.intp], share: Floats) -> Floats:
    """Return the values at `share` of the polynomials with these indices, coefficients of shape (powers, c, n)."""
    value = np.zeros((terms.shape[1], which.size))
    for coefficients in reversed(terms):
        value *= share
        value += np.take(coefficients, which, axis=1)
    return value


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
        Kind of the events in `Run.events`.
    function
        Called with the time [s] and the state; returns a number that changes sign at an event, not a truth value. The
        state is a dict of the variables of `Run.data` at that time, in SI units: "tilt" and "tilt_rate" (arrays of
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
