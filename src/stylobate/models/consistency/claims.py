"""Checks of what a model claims: near the vertical, on overturning and rest, and by its closed form."""

from collections.abc import Callable, Iterator, Mapping
from itertools import product
from math import isfinite

import numpy as np

from stylobate.column import Column
from stylobate.models.consistency.samples import Floats, Subject
from stylobate.models.model import Balance, ClosedForm, Model, Push, RollingLaw, belongs_to_equations, closed_form_of
from stylobate.models.rolling import Rolling
from stylobate.models.slender import Slender
from stylobate.models.slender_rolling import SlenderRolling
from stylobate.models.wobbling import Wobbling

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


_BEYOND = 1e-4  # relative distance beyond the point of no return
_TOLERANCE = 1e-6
_HIGHEST_RANDOM = 1.5  # tilt of a random state [rad]
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
            if growth < -_TOLERANCE * (c + largest):
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
    if energy < balance.energy * (1.0 - _TOLERANCE):
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
        size *= min(balance.tilt, _HIGHEST_RANDOM)
        tilt = (size * np.cos(lean), size * np.sin(lean))
        rate = (speed * c * np.cos(along), speed * c * np.sin(along))
        states.append(subject.state(tilt, rate, random.uniform(-0.5, 0.5)))
    lower = _energies(subject, *states) < balance.energy
    return [state for state, kept in zip(states, lower, strict=True) if kept]


def _energies(subject: Subject, *states: tuple[float, ...]) -> np.ndarray:
    found = subject.model.energy(np.array(states).T)
    assert found is not None
    return found


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


_AGREE = 1e-6  # relative, above the error of the differences
_SOLVED = 1e-9
_HIGHEST = 1.0  # tilt [rad]
_MOTIONS = ((0.3, 1.5), (0.8, 3.0))  # tilt [c] and angular frequency [ω0]

# The model whose equations each closed form solves. Rolling with slip has no single set of equations.
_SOLUTION_OF: Mapping[RollingLaw, Callable[[Column, ClosedForm], Model]] = {
    RollingLaw.SLENDER: lambda column, form: Slender(column, damping=form.eta),
    RollingLaw.FREE_TWIST: lambda column, form: SlenderRolling(column, damping=form.eta, spin_damping=form.zeta),
    RollingLaw.WOBBLING: lambda column, form: Wobbling(column, damping=form.eta),
    RollingLaw.FULL: lambda column, form: (
        Rolling(column, damping=form.eta, spin_damping=form.zeta)
        if isfinite(form.zeta)
        else Wobbling(column, damping=form.eta, constraint="rubber")
    ),
}


def problems_of_closed_form(subject: Subject) -> Iterator[str]:
    """Yield a line if the steady rolling of `closed_form` does not solve `rates`.

    Steady rolling turns with the base: its tilt acceleration is −ν² times the tilt, and its spin is constant. This
    determines the acceleration of the base that a tilt and a frequency require, and the spin.
    """
    form = closed_form_of(subject.model)
    if form is None or form.requires or form.law not in _SOLUTION_OF:
        return
    solved = _SOLUTION_OF[form.law](subject.model.column, form)
    if subject.model.rates is solved.rates and subject.numbers == solved.parameters:
        return
    reference = Subject(solved, solved.parameters, thorough=False)
    for size, frequency in _MOTIONS:
        tilt = min(size * subject.slenderness, _HIGHEST)
        required = _required(reference, tilt, frequency)
        if required is None:
            continue
        left = _residual(subject, tilt, frequency, required)
        scale = frequency**2 * tilt + float(np.abs(required[:2]).max()) + subject.slenderness
        if np.abs(left).max() > _AGREE * scale:
            worst, value = int(np.argmax(np.abs(left))), -(frequency**2) * tilt
            what = ("tilt acceleration along the tilt", "tilt acceleration across the tilt", "rate of the spin")[worst]
            expected = (value, 0.0, 0.0)[worst]
            yield (
                f"closed_form: its steady rolling does not solve rates{subject.origin('closed_form')} ({what} "
                f"{expected + left[worst]:.4g}, not {expected:.4g}, at a tilt of {tilt:.4g} rad that turns at "
                f"{frequency:g} ω0, by theory.{form.law.value}). Define closed_form for these rates, or return None."
            )
            return


def steady_rolling(subject: Subject) -> str:
    """Return the closed form that was compared."""
    form = closed_form_of(subject.model)
    if form is None:
        replaced = subject.model.closed_form is not None
        return f"not used{subject.origin('closed_form')} because the equations are replaced" if replaced else ""
    if form.requires:
        return f"not compared, because it requires {form.requires[0]} = {form.requires[1]!r}"
    return f"theory.{form.law.value} solves rates" if form.law in _SOLUTION_OF else ""


def _required(reference: Subject, tilt: float, frequency: float) -> Floats | None:
    """Return the base acceleration along and across the tilt [g] and the spin of steady rolling, or None."""
    zero = _residual(reference, tilt, frequency, np.zeros(3))
    slopes = np.stack([_residual(reference, tilt, frequency, unit) - zero for unit in np.eye(3)], axis=1)
    found = np.array(np.linalg.lstsq(slopes, -zero, rcond=None)[0], dtype=float)
    left = _residual(reference, tilt, frequency, found)
    return found if np.abs(left).max() <= _SOLVED * (1.0 + frequency**2 * tilt) else None


def _residual(subject: Subject, tilt: float, frequency: float, required: Floats) -> Floats:
    """Return the excess of the tilt acceleration, along and across the tilt, and of the rate of the spin."""
    u, n = np.array([0.8, 0.6]), np.array([-0.6, 0.8])
    along, across, spin = required.tolist()
    state = subject.state(tuple(tilt * u), tuple(frequency * tilt * n), spin)
    push = (*(along * u + across * n).tolist(), 0.0)
    acceleration, index = subject.tilt_acceleration(state, push), subject.model.spin_state
    spun = 0.0 if index is None else float(subject.rates(state, push)[index])
    return np.array([np.dot(u, acceleration) + frequency**2 * tilt, np.dot(n, acceleration), spun])
