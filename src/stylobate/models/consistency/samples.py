"""A model under examination: random states, and the members, arguments and results of its functions."""

import inspect
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from types import MethodType
from typing import Any

import numpy as np
import numpy.typing as npt

from stylobate.models.model import Model, Push, owner_of

Floats = npt.NDArray[np.float64]

# Half the step of central differences, in the time of the model; the error is of second order.
_STEP = 1e-4

# Peak tilt of a random state [rad], and peak tilt and rate in units of c.
_TOP, _TIMES_C = 1.2, 3.0


@dataclass(frozen=True, slots=True)
class Subject:
    """A model under examination, with its numbers.

    Parameters
    ----------
    model
        The model.
    thorough
        Whether to take many samples, and to report functions that raise.
    """

    model: Model
    numbers: tuple[float, ...]
    thorough: bool

    @property
    def slenderness(self) -> float:
        """c = r/h of the column, the scale of tilts."""
        return self.model.column.slenderness

    @property
    def halfway(self) -> float:
        """Half of the tipping angle [rad]: the weight returns the column from this tilt."""
        return 0.5 * self.model.column.tipping_angle

    def generator(self) -> "np.random.Generator":
        """Return a random generator with a fixed seed."""
        return np.random.default_rng(20)

    def state(self, tilt: tuple[float, float], rate: tuple[float, float], spin: float = 0.0) -> tuple[float, ...]:
        """Return the state with a tilt vector [rad], its rate and a spin in the time of the model."""
        scale, index = self.model.time_scale, self.model.spin_state
        begun = self.model.start(tilt, (rate[0] / scale, rate[1] / scale))
        return tuple(float(spin if i == index and spin else value) for i, value in enumerate(begun))

    def random_states(self, count: int) -> list[tuple[float, ...]]:
        """Return states of random tilts and rates of the order of c, with spin if the model has it."""
        random, c = self.generator(), self.slenderness
        found = []
        for _ in range(count):
            size = min(_TOP, c * random.uniform(0.05, _TIMES_C))
            lean, heading, speed = *random.uniform(0.0, 2.0 * np.pi, 2), c * random.uniform(0.0, _TIMES_C)
            if self.model.planar_only:
                heading = lean
            tilt = (size * np.cos(lean), size * np.sin(lean))
            found.append(
                self.state(tilt, (speed * np.cos(heading), speed * np.sin(heading)), random.uniform(-1.0, 1.0))
            )
        return found

    def rates(self, state: tuple[float, ...], push: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> np.ndarray:
        """Return the rates of a state under an acceleration of the base [g]."""
        return np.array(self.model.rates(*state, *push, *self.numbers), dtype=float)

    def beside(self, state: tuple[float, ...], rates: np.ndarray) -> tuple[tuple[float, ...], tuple[float, ...], float]:
        """Return the states a short time before and after `state`, and the time between them."""
        here = np.array(state)
        return tuple((here - _STEP * rates).tolist()), tuple((here + _STEP * rates).tolist()), 2.0 * _STEP

    def tilt_change(self, state: tuple[float, ...], push: tuple[float, float, float]) -> Floats:
        """Return the derivatives of the four results of `tilt_of` along `rates`."""
        before, after, lapse = self.beside(state, self.rates(state, push))
        found: Floats = (self.lean(after) - self.lean(before)) / lapse
        return found

    def tilt_acceleration(self, state: tuple[float, ...], push: tuple[float, float, float]) -> Floats:
        """Return the second derivative of the tilt vector."""
        return self.tilt_change(state, push)[2:]

    def lean(self, state: tuple[float, ...]) -> Floats:
        """Return the tilt vector and its rate, as `tilt_of` gives them."""
        return np.array(self.model.tilt_of(*state, *self.numbers), dtype=float)

    def described(self, state: tuple[float, ...], push: tuple[float, float, float] | None = None) -> str:
        """Return a state, and the acceleration of the base, for a message."""
        named = ", ".join(f"{name} = {value:.4g}" for name, value in zip(self.model.state_names, state, strict=True))
        return named if push is None else f"{named}, base acceleration {', '.join(f'{a:.4g}' for a in push)} g"

    def origin(self, name: str) -> str:
        """Return ", inherited from Slender," for a member that the class of the model does not state itself."""
        owner = owner_of(type(self.model), name)
        return "" if owner is type(self.model) else f", inherited from {owner.__name__},"


_PUSH = 3  # accelerations of the base

# Number of arguments between the states, or without states, and the parameters.
_WITHOUT_STATE = {"planar_rates": 5, "from_plane": 4, "rest_energy": 3, "no_return_tilt": 2, "departure": 2}
_BEHIND_STATE = {
    "rates": _PUSH,
    "contact": _PUSH,
    "jacobian": _PUSH,
    "passage": _PUSH,
    "tilt_of": 0,
    "carried_rates": 0,
    "impact_map": 0,
    "project": 0,
    "at_rest": 0,
    "guards": _PUSH + 2,
    "reset_map": 1 + 2 * _PUSH + 2,
}


_REQUIRED = {
    "rates": "Define it as a static method that returns the rate of each state",
    "tilt_of": "Define it as a static method that returns x, y, vx, vy",
    "name": "State a short text, as in name = 'own'",
    "state_names": "State a name for each state, as in state_names = ('tilt_x', 'tilt_y', …)",
}


def problems_of_members(subject: Subject) -> Iterator[str]:
    """Yield a line for each member that every model needs and that is missing or no name."""
    model = subject.model
    for name, remedy in _REQUIRED.items():
        if getattr(model, name, None) is None:
            yield f"{name}: missing. {remedy}."
    if not isinstance(getattr(model, "name", ""), str):
        yield f"name: must be a text (got {model.name!r}). {_REQUIRED['name']}."
    names: Any = getattr(model, "state_names", ())
    if not isinstance(names, tuple | list) or not all(isinstance(name, str) for name in names):
        yield f"state_names: must be a tuple of texts (got {names!r}). {_REQUIRED['state_names']}."
    elif len(set(names)) < len(names):
        yield f"state_names: the names of two states are equal (got {names!r}). Give each state a name of its own."
    if any(map(math.isnan, subject.numbers)):
        yield f"parameters: must not contain NaN (got {subject.numbers!r}). Return a number for each."


def problems_of_signatures(subject: Subject) -> Iterator[str]:
    """Yield a line for each function that is not static, or does not take the numbers with which it is called."""
    for name in (*_BEHIND_STATE, *_WITHOUT_STATE):
        function = getattr(subject.model, name)
        if function is None:
            continue
        if isinstance(function, MethodType) and function.__self__ is subject.model:
            yield f"{name}: must be a static method (got an instance method). Put @staticmethod above it."
            continue
        takes, given = _positions(function), _given(subject, name)
        if takes is None or takes[0] <= given <= takes[1]:
            continue
        most = f"{takes[0]:g}" if takes[0] == takes[1] else f"{takes[0]:g} to {takes[1]:g}"
        yield (
            f"{name}: takes {most} numbers{subject.origin(name)} but is called with {given}, "
            f"{len(subject.numbers)} of them parameters. {_remedy(subject, name)}."
        )


def _given(subject: Subject, name: str) -> int:
    if name in _WITHOUT_STATE:
        return _WITHOUT_STATE[name] + len(subject.numbers)
    return len(subject.model.state_names) + _BEHIND_STATE[name] + len(subject.numbers)


@cache
def _positions(function: Callable[..., Any]) -> tuple[float, float] | None:
    """Return the minimum and maximum number of positional arguments of a function; None if unknown."""
    try:
        arguments = inspect.signature(getattr(function, "py_func", function)).parameters.values()
    except (TypeError, ValueError):
        return None
    places = [a for a in arguments if a.kind in (a.POSITIONAL_ONLY, a.POSITIONAL_OR_KEYWORD)]
    many = any(a.kind is a.VAR_POSITIONAL for a in arguments)
    return sum(a.default is a.empty for a in places), float("inf") if many else len(places)


def _remedy(subject: Subject, name: str) -> str:
    own = owner_of(type(subject.model), name) is type(subject.model)
    do = "Give it" if own else "Define it with"
    alone = "" if name in ("rates", "tilt_of") else f", or set {name} = None"
    return f"{do} an argument for each of `parameters`{alone}"


def problems_of_lengths(subject: Subject) -> Iterator[str]:
    """Yield a line for each function that returns a wrong number of results, or results that are no numbers."""
    model, numbers = subject.model, subject.numbers
    states = len(model.state_names)
    problem = _problem_of_start(subject)
    if problem:
        yield problem
        return
    state = subject.random_states(1)[0]
    zero = (0.0,) * _PUSH
    push = Push((1.0, 0.0), subject.slenderness, 0.0, 1.0, 0.0)
    calls: Sequence[tuple[str, int, tuple[Any, ...]]] = (
        ("rates", states, (*state, *zero)),
        ("tilt_of", 4, state),
        ("contact", 3, (*state, *zero)),
        ("carried_rates", len(model.carried_names), state),
        ("impact_map", states, state),
        ("at_rest", states, state),
        ("departure", states, (push, 1e-3)),
        ("passage", states, (*state, *zero)),
        ("planar_rates", 2, (subject.slenderness, 0.0, 1.0, *zero[:2])),
        ("guards", len(model.guard_names), (*state, *zero, 1e-4, 1e-9)),
        *((("from_plane", states, (subject.slenderness, 0.0, 1.0, 0.0)),) if model.planar_rates is not None else ()),
    )
    for name, length, arguments in calls:
        function = getattr(model, name)
        if function is None:
            continue
        found = function(*arguments, *numbers)
        if name == "passage" and isinstance(found, tuple) and len(found) == 2:  # noqa: PLR2004
            found = found[1]  # the first result is the duration
        at = subject.described(state) if arguments[:states] == state else f"the arguments {arguments}"
        if not _are_numbers(found):
            yield not_numbers(subject, name, length, found, at)
        elif len(found) != length:
            yield (
                f"{name}: returns {len(found)} numbers{subject.origin(name)} where {length} are needed. "
                f"Define it for the states {', '.join(model.state_names)}."
            )
    if model.planar_rates is not None and model.from_plane is None:
        yield "from_plane: missing beside planar_rates. Define it, or set planar_rates = None."


def _problem_of_start(subject: Subject) -> str:
    """Return the line of a `start` that returns no state; "" for one that does."""
    model, c = subject.model, subject.slenderness
    tilt, rate = (0.3 * c, 0.0), (0.1 * c, 0.0)
    made, states = model.start(tilt, rate), len(model.state_names)
    if not _are_numbers(made):
        return not_numbers(subject, "start", states, made, f"the tilt {_shown(tilt)} and the rate {_shown(rate)}")
    if len(made) != states:
        return f"start: returns {len(made)} numbers for {states} states. Return one for each of `state_names`."
    return ""


def _are_numbers(found: Any) -> bool:
    """Return whether the result of a function is a sequence of real numbers without NaN."""
    if not isinstance(found, Sequence | np.ndarray) or isinstance(found, str):
        return False
    try:
        return not any(math.isnan(number + 0.0) for number in found)
    except (TypeError, ValueError):
        return False


def not_numbers(subject: Subject, name: str, length: int, found: Any, at: str) -> str:
    """Return the line of a function that returns something else than numbers."""
    return (
        f"{name}: must return {length} finite numbers{subject.origin(name)} (got {_shown(found)} at {at}). Return a "
        f"tuple of {length} real, finite numbers at each state."
    )


def _shown(found: Any) -> str:
    if not isinstance(found, Sequence | np.ndarray) or isinstance(found, str):
        return repr(found)
    return f"({', '.join(f'{one:.4g}' if isinstance(one, int | float | complex) else repr(one) for one in found)})"
