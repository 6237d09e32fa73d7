"""Check of `comes_to_rest` against the energy that the equations dissipate."""

from collections.abc import Iterator

import numpy as np

from stylobate.models.consistency.samples import Subject

_ROUNDING = 1e-9  # change of the tilt acceleration that counts as none [c]
_STATES = ((0.2, 0.1), (0.6, 0.5), (1.4, 1.0))  # tilt, in half tipping angles, and rate [c]


def problems_of_coming_to_rest(subject: Subject) -> Iterator[str]:
    """Yield a line if `comes_to_rest` contradicts the dissipation of planar free motion.

    A motion without dissipation can be reversed: the tilt acceleration is the same for the rates +α̇ and −α̇. The
    difference of the two is the dissipation. It removes energy if it opposes the rate.
    """
    model = subject.model
    states = _STATES if subject.thorough else _STATES[::2]
    losses = {motion: _loss(subject, *motion) for motion in states}
    motion, loss = max(losses.items(), key=lambda one: one[1])
    tilt, rate = motion[0] * subject.halfway, motion[1] * subject.slenderness
    where = f"at a tilt of {tilt:.4g} rad with the rate {rate:.4g}"
    if not model.comes_to_rest and model.rest_energy is not None and min(losses.values()) > 0.0:
        yield (
            f"comes_to_rest: is False although rates lose energy in free motion{subject.origin('comes_to_rest')} (they "
            f"slow the column by {loss:.4g} per unit of time, not 0, {where}). Return True for these numbers, or set "
            "rest_energy = None."
        )
    if model.comes_to_rest and not loss > 0.0 and not _impacts_lose(subject):
        yield (
            f"comes_to_rest: is True although rates lose no energy in free motion{subject.origin('comes_to_rest')} "
            f"(they slow the column by {loss:.4g} per unit of time, {where}{_of_impacts(subject)}). Return False for "
            "these numbers, or define the loss in rates or impact_map."
        )


def _impacts_lose(subject: Subject) -> bool:
    """Return whether a passage near the vertical can lose speed."""
    model = subject.model
    if model.impact_map is None or not model.loss_tilt > 0.0:
        return False
    return any(
        np.hypot(*subject.lean(tuple(model.impact_map(*state, *subject.numbers)))[2:])
        < np.hypot(*subject.lean(state)[2:]) * (1.0 - _ROUNDING)
        for state in subject.random_states(6)
    )


def _of_impacts(subject: Subject) -> str:
    """Return the reason why impacts lose nothing, for a message."""
    if not subject.model.loss_tilt > 0.0:
        return ""
    return "; impact_map is missing" if subject.model.impact_map is None else "; impact_map takes no speed"


def dissipation(subject: Subject) -> str:
    """Return whether free motion comes to rest."""
    if subject.model.comes_to_rest:
        return "True, and free motion or its impacts lose energy"
    return "False, and free motion loses no energy" if subject.model.rest_energy is not None else ""


def _loss(subject: Subject, size: float, speed: float) -> float:
    """Return the deceleration of the tilt by dissipation, 0 if negligible; negative if energy is gained."""
    c, azimuth = subject.slenderness, 0.6
    u = np.array([np.cos(azimuth), np.sin(azimuth)])
    tilt, rate = size * subject.halfway * u, speed * c * u
    ahead, back = (
        float(np.dot(u, subject.tilt_acceleration(subject.state(tuple(tilt), tuple(v)), (0.0, 0.0, 0.0))))
        for v in (rate, -rate)
    )
    loss = 0.5 * (back - ahead)
    return loss if abs(loss) > _ROUNDING * c else 0.0
