"""Checks of the tilt along the equations: its rate, and its side under an acceleration of the base."""

from collections.abc import Iterator

import numpy as np

from stylobate.models.consistency.samples import Subject
from stylobate.models.consistency.signatures import not_numbers

_AGREE = 1e-5  # relative, above the error of the differences
_IGNORED = 1e-9  # response to the base that counts as none
_DIRECTIONS = {
    "x": (1.0, 0.0),
    "y": (0.0, 1.0),
    "(x + y)/√2": (0.5**0.5, 0.5**0.5),
    "(y − x)/√2": (-(0.5**0.5), 0.5**0.5),
}


def problems_of_tilt_rate(subject: Subject) -> Iterator[str]:
    """Yield a line if the rate of the tilt that `tilt_of` returns is not the derivative of its tilt along `rates`.

    A state at which one of the two returns a number that is not finite is a line of its own.
    """
    c = subject.slenderness
    for state in subject.random_states(40 if subject.thorough else 4):
        push = (0.2 * c, -0.1 * c, 0.1)
        lean, change = subject.lean(state), subject.tilt_change(state, push)
        if not (np.isfinite(change).all() and np.isfinite(lean).all()):
            rates, at = subject.rates(state, push), subject.described(state, push)
            name, results = ("tilt_of", lean) if np.isfinite(rates).all() else ("rates", rates)
            yield not_numbers(subject, name, len(results), tuple(results.tolist()), at)
            return
        rate, found = lean[2:], change[:2]
        error = np.abs(found - rate)
        if error.max() > _AGREE * (c + np.hypot(*rate)):
            axis = int(np.argmax(error))
            yield (
                f"rates: the tilt along {'xy'[axis]} changes at another rate than tilt_of returns"
                f"{subject.origin('tilt_of')} (by {found[axis]:.4g} per unit of time, not {rate[axis]:.4g}, at "
                f"{subject.described(state, push)}). Return the rate of each state at its place in rates."
            )
            return


def problems_of_push(subject: Subject) -> Iterator[str]:
    """Yield a line if the base pushes the column to the wrong side.

    The base acts on the rim, and the centre of mass lags behind: an acceleration of the base along û accelerates the
    tilt along −û.
    """
    responses, c = _responses(subject), subject.slenderness
    if not _acts(responses):
        return
    for along, (response, _) in responses.items():
        if response > 0.0:
            yield (
                "rates: the column leans with the acceleration of the base instead of against it (a base "
                f"acceleration of {0.1 * c:.4g} g along {along} changes the tilt acceleration by "
                f"{0.1 * c * response:+.4g}, at a tilt of {subject.halfway:.4g} rad). Reverse the sign of this term, "
                "such as −ax for +ax."
            )
            return
        if not response:
            yield (
                f"rates: the base does not act along {along} although it acts along other directions (a base "
                f"acceleration of {0.1 * c:.4g} g along {along} changes the tilt acceleration by 0 along it, at a tilt "
                f"of {subject.halfway:.4g} rad). Add the term of ax to the rate of vx, and of ay to that of vy."
            )
            return


def problems_of_lift(subject: Subject) -> Iterator[str]:
    """Yield a line if an upward acceleration of the base accelerates a small tilt away from the vertical."""
    lifted = _response_to_lift(subject)
    if lifted > 0.0:
        yield (
            "rates: an upward acceleration of the base reduces the weight of the column (a base acceleration of 0.1 g "
            f"changes the tilt acceleration by {0.1 * lifted:+.4g}, at a tilt of {subject.halfway:.4g} rad). Multiply "
            "the terms of the weight by 1 + az."
        )


def lean_under_push(subject: Subject) -> str:
    """Return the side to which the column leans if the base accelerates."""
    if not _acts(_responses(subject)):
        return "the acceleration of the base does not act on the column"
    return "if the base accelerates to +x, the column leans to −x"


def weight_under_lift(subject: Subject) -> str:
    """Return the change of the weight if the base accelerates upwards."""
    change = "the weight grows" if _response_to_lift(subject) else "nothing changes"
    return f"if the base accelerates upwards, {change}"


def _responses(subject: Subject) -> dict[str, tuple[float, float]]:
    """Return the tilt acceleration along and across a direction, per base acceleration along it, by direction."""
    c, tilt, found = subject.slenderness, subject.halfway, {}
    for name, (ux, uy) in _DIRECTIONS.items():
        state = subject.state((tilt * ux, tilt * uy), (0.0, 0.0))
        back, ahead = (subject.tilt_acceleration(state, (a * ux, a * uy, 0.0)).tolist() for a in (-0.1 * c, 0.1 * c))
        x, y = ((after - before) / (0.2 * c) for before, after in zip(back, ahead, strict=True))
        found[name] = _noted(ux * x + uy * y), _noted(ux * y - uy * x)
    return found


def _noted(response: float) -> float:
    return response if abs(response) > _IGNORED else 0.0


def _acts(responses: dict[str, tuple[float, float]]) -> bool:
    """Return whether the base acts on the column in some direction."""
    return any(any(response) for response in responses.values())


def _response_to_lift(subject: Subject) -> float:
    """Return the tilt acceleration per upward base acceleration, at half of the tipping angle; 0 if negligible."""
    c = subject.slenderness
    state = subject.state((subject.halfway, 0.0), (0.0, 0.0))
    down, up = (float(subject.tilt_acceleration(state, (0.0, 0.0, a))[0]) for a in (-0.1, 0.1))
    return c * _noted((up - down) / (0.2 * c))
