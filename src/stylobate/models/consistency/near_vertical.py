"""Checks of a model near the vertical: departure, rest, passage and loss."""

from collections.abc import Iterator

import numpy as np

from stylobate.models.consistency.samples import Subject
from stylobate.models.model import Push

_LAPSE = 1e-3  # after uplift, in the time of the model
_CLOSE = 0.05  # maximum relative difference of series and equations
_NEAR = 1e-6  # tilts near the vertical [c]


def problems_of_departure(subject: Subject) -> Iterator[str]:
    """Yield a line if `departure` does not follow `rates` shortly after uplift by a push that turns."""
    model, c = subject.model, subject.slenderness
    if model.departure is None:
        return
    push = Push((0.6, 0.8), 1.2 * c, 0.2 * c, 0.1 * c, 0.0 if model.planar_only else 0.5)

    def state(elapsed: float) -> np.ndarray:
        assert model.departure is not None
        return np.array(model.departure(push, elapsed, *subject.numbers), dtype=float)

    slope = (state(1.001 * _LAPSE) - state(0.999 * _LAPSE)) / (0.002 * _LAPSE)
    size, turned = push.acceleration + push.excess_rate * _LAPSE, push.turning_rate * _LAPSE
    ux = push.direction[0] * np.cos(turned) - push.direction[1] * np.sin(turned)
    uy = push.direction[1] * np.cos(turned) + push.direction[0] * np.sin(turned)
    expected = subject.rates(tuple(state(_LAPSE).tolist()), (-size * ux, -size * uy, 0.0))
    if np.abs(slope - expected).max() > _CLOSE * push.excess:
        worst = int(np.argmax(np.abs(slope - expected)))
        yield (
            f"departure: does not follow rates{subject.origin('departure')} (rate of {model.state_names[worst]} "
            f"{slope[worst]:.4g} after uplift, not {expected[worst]:.4g}). Define departure for these rates, or set "
            "departure = None."
        )


def problems_of_rest(subject: Subject) -> Iterator[str]:
    """Yield a line if `rest_energy` grows near the vertical although the base is at rest."""
    model, c = subject.model, subject.slenderness
    if model.rest_energy is None or not model.comes_to_rest:
        return
    tilt, step = _NEAR * c, 0.01 * _NEAR
    for rate in (0.1 * c, -0.1 * c):
        state = subject.state((tilt, 0.0), (rate, 0.0))
        acceleration = float(subject.tilt_acceleration(state, (0.0, 0.0, 0.0))[0])
        here, there = (
            model.rest_energy(tilt + t * rate, abs(rate + t * acceleration), 0.0, *subject.numbers)
            for t in (-step, step)
        )
        gained = (there - here) / (2.0 * step)
        if gained > 1e-3 * c * abs(rate):
            yield (
                f"rest_energy: grows in free motion near the vertical{subject.origin('rest_energy')} (by {gained:.3g} "
                "per unit of time). Define rest_energy for these rates, or set rest_energy = None."
            )
            return


def problems_of_loss(subject: Subject) -> Iterator[str]:
    """Yield a line if `impact_map` adds speed, or moves the column."""
    model = subject.model
    if model.impact_map is None or not model.loss_tilt > 0.0:
        return
    for state in subject.random_states(6):
        before, after = (
            np.array(model.tilt_of(*one, *subject.numbers), dtype=float)
            for one in (state, model.impact_map(*state, *subject.numbers))
        )
        if np.any(before[:2] != after[:2]) or np.hypot(*after[2:]) > np.hypot(*before[2:]) * (1.0 + 1e-12):
            yield (
                f"impact_map: moves the column or makes it faster{subject.origin('impact_map')} (rate from "
                f"{np.hypot(*before[2:]):.4g} to {np.hypot(*after[2:]):.4g}). Define impact_map for these "
                "parameters, or set impact_map = None."
            )
            return


def loss_of_speed(subject: Subject) -> str:
    """Return the claim of `impact_map`; "" for a model without loss."""
    return "moves nothing and adds no speed" if subject.model.loss_tilt > 0.0 else ""


def problems_of_passage(subject: Subject) -> Iterator[str]:
    """Yield a line if the end of `passage` differs from that of `rates`, on a close passage of the vertical."""
    from scipy.integrate import solve_ivp

    model, c = subject.model, subject.slenderness
    if model.passage is None:
        return
    far, offset, speed = 1e-4 * c, 1e-6 * c, 0.5 * c
    state, push = subject.state((-far, offset), (speed, 0.0)), (0.3 * c, 0.2 * c, 0.1)
    elapsed, end = model.passage(*state, *push, *subject.numbers)
    found = solve_ivp(
        lambda _, y: subject.rates(tuple(y), push), (0.0, elapsed), state, method="DOP853", rtol=1e-10, atol=1e-13 * c
    ).y[:, -1]
    tilts = np.array([model.tilt_of(*one, *subject.numbers) for one in (end, found)], dtype=float)
    error = np.abs(tilts[0] - tilts[1])
    if error[:2].max() > _CLOSE * far or error[2:].max() > _CLOSE * speed:
        yield (
            f"passage: ends in another state than rates{subject.origin('passage')} (relative error of the tilt rate "
            f"{error[2:].max() / speed:.2g}). Define passage for these rates, or set passage = None."
        )
