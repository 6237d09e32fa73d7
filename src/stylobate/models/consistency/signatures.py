"""Number of arguments and of results of each function of a model."""

import inspect
from collections.abc import Callable, Iterator, Sequence
from functools import cache
from typing import Any

from stylobate.models.consistency.samples import Subject
from stylobate.models.inheritance import owner_of
from stylobate.models.model import Push

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


def problems_of_signatures(subject: Subject) -> Iterator[str]:
    """Yield a line for each function that does not take the numbers with which it is called."""
    for name in (*_BEHIND_STATE, *_WITHOUT_STATE):
        function = getattr(subject.model, name)
        if function is None:
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
    """Yield a line for each function that returns a wrong number of results."""
    model, numbers = subject.model, subject.numbers
    states = len(model.state_names)
    state = subject.random_states(1)[0]
    if len(state) != states:
        yield f"start: returns {len(state)} numbers for {states} states. Return one for each of `state_names`."
        return
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
        if name == "passage":
            found = found[1]  # the first result is the duration
        if len(found) != length:
            yield (
                f"{name}: returns {len(found)} numbers{subject.origin(name)} where {length} are needed. "
                f"Define it for the states {', '.join(model.state_names)}."
            )
    if model.planar_rates is not None and model.from_plane is None:
        yield "from_plane: missing beside planar_rates. Define it, or set planar_rates = None."
