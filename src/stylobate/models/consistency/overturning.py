"""Checks of the claims of a model about overturning: the point of no return, and the energy of its balance."""

from collections.abc import Iterator
from itertools import product

import numpy as np

from stylobate.models.consistency.samples import Subject
from stylobate.models.inheritance import belongs_to_equations
from stylobate.models.model import Balance

_BEYOND = 1e-4  # relative distance beyond the point of no return
_ROUNDING = 1e-6
_HIGHEST = 1.5  # tilt of a random state [rad]
_NO_GAIN = 1e-4  # in m g h c² per unit of time, above the error of the differences


def problems_of_no_return(subject: Subject) -> Iterator[str]:
    """Yield a line if a tilt beyond `no_return_tilt` that stops growing falls back.

    Every point of no return rests on this proof: when the rate Ȧ of the tilt A vanishes beyond it, Ä ≥ 0 under every
    push within the bounds, so that Ȧ never changes sign there.
    """
    model, c = subject.model, subject.slenderness
    if model.no_return_tilt is None:
        return
    random = subject.generator()
    for largest, least in ((0.0, 0.0), (0.6 * c, 0.0), (2.0 * c, -0.3)):
        limit = float(model.no_return_tilt(largest, least, *subject.numbers))
        top = 0.5 * np.pi  # where the column lies
        if not limit * (1.0 + _BEYOND) < top:
            continue
        inside = np.array([0.0, 0.03, 0.1, 0.3, 0.6, 0.9] if subject.thorough else [0.0, 0.1, 0.9])
        tilts = limit * (1.0 + _BEYOND) + (top - limit * (1.0 + _BEYOND)) * inside
        headings = (0.0,) if model.planar_only else (0.0, random.uniform(0.5, 6.0))
        around = (0.0,) if model.planar_only else (0.0, 2.0 * c)
        for tilt, turn, heading, vertical in product(tilts.tolist(), around, headings, {least, 0.0}):
            azimuth = random.uniform(0.0, 2.0 * np.pi)
            u, n = (np.cos(azimuth), np.sin(azimuth)), (-np.sin(azimuth), np.cos(azimuth))
            push = (largest * np.cos(azimuth + heading), largest * np.sin(azimuth + heading), vertical)
            state = subject.state((tilt * u[0], tilt * u[1]), (turn * n[0], turn * n[1]))
            growth = float(np.dot(u, subject.tilt_acceleration(state, push))) + turn * turn / tilt
            if growth < -_ROUNDING * (c + largest):
                yield (
                    f"no_return_tilt: is not a point of no return{subject.origin('no_return_tilt')} "
                    f"(beyond {limit:.4g} rad, at {tilt:.4g} rad, the tilt is accelerated by {growth:.3g}). "
                    "Define it for these rates, return math.inf without a proof, or set no_return_tilt = None."
                )
                return


def problems_of_balance(subject: Subject) -> Iterator[str]:
    """Yield a line if the `balance` of a model does not prevent overturning.

    The proof that a column cannot overturn any more is: free motion only loses energy, and every state at the tilt of
    the balance has at least the energy of the balance.
    """
    model = subject.model
    if model.balance is None or not belongs_to_equations(type(model), "balance", "energy"):
        return
    balance, scale = model.balance, model.column.base_inertia / model.time_scale**2 * subject.slenderness**2
    beside = [subject.beside(state, subject.rates(state)) for state in _below(subject, balance)]
    if beside:
        before, after, lapses = zip(*beside, strict=True)
        gained = float(((_energies(subject, *after) - _energies(subject, *before)) / lapses).max())
        if gained > _NO_GAIN * scale:
            yield (
                f"energy: grows in free motion (by {gained / scale:.3g} m g h c² per unit of time). Define energy for "
                "these rates, or set balance = None."
            )
            return
    energy = float(_energies(subject, *_at_its_tilt(subject, balance)).min()) if balance.tilt < np.inf else np.inf
    if energy < balance.energy * (1.0 - _ROUNDING):
        yield (
            f"balance: a column at the tilt {balance.tilt:.4g} rad can have less than the energy of the balance "
            f"({energy:.4g} J, not {balance.energy:.4g} J). Define balance for these rates, or set balance = None."
        )


def balance_of(subject: Subject) -> str:
    """Return whether the balance prevents overturning."""
    if belongs_to_equations(type(subject.model), "balance", "energy"):
        return "free motion with less energy and tilt cannot overturn"
    return f"not used{subject.origin('balance')} because the equations are replaced"


def _at_its_tilt(subject: Subject, balance: Balance) -> Iterator[tuple[float, ...]]:
    """Yield random states at the tilt of the balance."""
    random, c = subject.generator(), subject.slenderness
    for _ in range(40 if subject.thorough else 6):
        azimuth = random.uniform(0.0, 2.0 * np.pi)
        rate = c * random.uniform(-1.0, 1.0, 2)
        tilt = (balance.tilt * np.cos(azimuth), balance.tilt * np.sin(azimuth))
        yield subject.state(tilt, (float(rate[0]), float(rate[1])), random.uniform(-1.0, 1.0))


def _below(subject: Subject, balance: Balance) -> list[tuple[float, ...]]:
    """Return random states with less tilt and energy than the balance."""
    random, c, states = subject.generator(), subject.slenderness, []
    for _ in range(100 if subject.thorough else 12):
        lean, heading, size, speed = random.uniform([0.0, 0.0, 0.05, 0.0], [2.0 * np.pi, 2.0 * np.pi, 0.95, 1.0])
        along = lean if subject.model.planar_only else heading
        size *= min(balance.tilt, _HIGHEST)
        tilt = (size * np.cos(lean), size * np.sin(lean))
        rate = (speed * c * np.cos(along), speed * c * np.sin(along))
        states.append(subject.state(tilt, rate, random.uniform(-0.5, 0.5)))
    lower = _energies(subject, *states) < balance.energy
    return [state for state, kept in zip(states, lower, strict=True) if kept]


def _energies(subject: Subject, *states: tuple[float, ...]) -> np.ndarray:
    found = subject.model.energy(np.array(states).T)
    assert found is not None
    return found
