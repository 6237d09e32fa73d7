"""Check of `closed_form` against the equations: the steady rolling that it describes must solve them."""

from collections.abc import Callable, Iterator, Mapping
from math import isfinite

import numpy as np

from stylobate.column import Column
from stylobate.models.closed_form import ClosedForm, RollingLaw
from stylobate.models.consistency.samples import Floats, Subject
from stylobate.models.inheritance import closed_form_of
from stylobate.models.model import Model
from stylobate.models.rolling import Rolling
from stylobate.models.slender import Slender
from stylobate.models.slender_rolling import SlenderRolling
from stylobate.models.wobbling import Wobbling

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
