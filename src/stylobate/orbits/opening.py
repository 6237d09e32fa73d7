"""Steady rolling by theory, continued from a circular base motion to an elliptic or a straight one.

An elliptic motion is the sum of two circular motions of opposite sense. Steady rolling under one circular motion is
known exactly; the continuation adds the other motion step by step.
"""

import cmath
import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import BaseMotion, Harmonic, as_harmonic
from stylobate.engine.flow.periodic import PeriodicSystem
from stylobate.errors import NoOrbitError, ParameterError, UnsupportedError
from stylobate.models import Model
from stylobate.models.closed_form import ClosedForm
from stylobate.orbits.orbit import PeriodicOrbit
from stylobate.orbits.shooting import closed
from stylobate.orbits.steady import rolling_form_of, steady_rolling_of

Floats = npt.NDArray[np.float64]

_FIRST_PART, _LEAST_PART = 0.25, 1e-3
_NO_PART = 1e-12
_GIVE = "guess must be given, such as a run that has settled"


@dataclass(frozen=True, slots=True)
class _Circles:
    """A horizontal harmonic motion x + iy = P e^{iΩt} + Q e^{−iΩt}."""

    forward: complex
    backward: complex
    angular_frequency: float

    @classmethod
    def of(cls, motion: Harmonic) -> "_Circles":
        x, y = (
            cmath.rect(amplitude, motion.start_phase + phase)
            for amplitude, phase in zip(motion.amplitude[:2], motion.phase[:2], strict=True)
        )
        return cls(0.5 * (x + 1j * y), 0.5 * (x.conjugate() + 1j * y.conjugate()), motion.angular_frequency)

    def motion(self, part: float, sense: int) -> Harmonic:
        """Return the motion with the circle against `sense` reduced to the fraction `part`."""
        forward = self.forward * (1.0 if sense > 0 else part)
        backward = self.backward * (part if sense > 0 else 1.0)
        x, y = forward + backward.conjugate(), -1j * (forward - backward.conjugate())
        return Harmonic(
            amplitude=(abs(x), abs(y), 0.0),
            phase=(cmath.phase(x), cmath.phase(y), 0.0),
            angular_frequency=self.angular_frequency,
        )


def rolling_by_theory(model: Model, motion: BaseMotion, sense: int | None) -> Floats:
    """Return the state at t = 0 of rolling with the base motion in this sense, in units of the model.

    The default sense is that of the larger of the two circles, anticlockwise if they are equal.

    Raises
    ------
    UnsupportedError
        If the model states no closed form of steady rolling, a parameter of the model lies outside the closed form, or
        the motion is not a horizontal Harmonic.
    NoOrbitError
        If theory has no such motion, or the continuation to this base motion fails.
    """
    form = _form_of(model)
    harmonic = as_harmonic(motion)
    if harmonic is None or harmonic.amplitude[2] != 0.0:
        message = f"{_GIVE}: steady rolling has a closed form under horizontal Harmonic motion only, got {motion!r}"
        raise UnsupportedError(message)
    require_sense(sense)
    circles = _Circles.of(harmonic)
    if sense is None:
        larger = abs(circles.backward) > (1.0 + _NO_PART) * abs(circles.forward)
        sense = -1 if larger else 1
    along, against = circles.forward, circles.backward
    if sense < 0:
        along, against = against, along
    state = _on_the_circle(model, form, harmonic, along, sense)
    if abs(against) <= _NO_PART * abs(along):
        return state
    done, step = 0.0, _FIRST_PART
    while done < 1.0:
        part = min(done + step, 1.0)
        opened = _rolling(model, circles.motion(part, sense), state, sense)
        if opened is None:
            step *= 0.5
            if step < _LEAST_PART:
                message = (
                    f"{_GIVE}: rolling in the sense {sense:+d} was continued from its circle only up to {done:.3g} of "
                    "the circle of opposite sense"
                )
                raise NoOrbitError(message)
            continue
        done, state = part, opened
    return state


def _form_of(model: Model) -> ClosedForm:
    """Return the closed form of the steady rolling of a model, or raise UnsupportedError without one."""
    form = rolling_form_of(model)
    if form is None:
        message = f"{_GIVE}: {type(model).__name__} states no closed form of steady rolling for its equations"
        raise UnsupportedError(message)
    if form.requires is not None:
        name, value = form.requires
        message = (
            f"{_GIVE}: {name} must be {value!r} for the closed form of steady rolling, got {getattr(model, name)!r}"
        )
        raise UnsupportedError(message)
    return form


def require_sense(sense: int | None) -> None:
    """Raise ParameterError unless `sense` is a sense of rolling, or None."""
    if sense not in (1, -1, None):
        message = f"sense must be +1, -1 or None, got {sense!r}"
        raise ParameterError(message)


def _rolling(model: Model, motion: Harmonic, guess: Floats, sense: int) -> Floats | None:
    """Return the orbit that Newton's method finds from `guess` if the orbit rolls in this sense, or None."""
    try:
        chain = closed(PeriodicSystem(model, motion), guess[np.newaxis], 1)
    except NoOrbitError:
        return None
    return chain.states[0] if PeriodicOrbit(model, motion, 1, chain).turns == sense else None


def _on_the_circle(model: Model, form: ClosedForm, motion: Harmonic, part: complex, sense: int) -> Floats:
    nu = motion.angular_frequency / model.column.frequency_scale
    amplitude, psi, spin = steady_rolling_of(form, model.column, nu, abs(part) / model.column.gravity)
    if not amplitude > 0.0:
        message = (
            "guess must be given: theory has no steady rolling in this sense at angular_frequency = "
            f"{motion.angular_frequency!r} rad/s"
        )
        raise NoOrbitError(message)
    azimuth = cmath.phase(part) + sense * psi
    x, y = amplitude * math.cos(azimuth), amplitude * math.sin(azimuth)
    rate = sense * nu
    state = np.array(model.start((x, y), (0.0, 0.0)), dtype=float)
    state[2:4] = -rate * y, rate * x
    if model.spin_state is not None:
        state[model.spin_state] = sense * spin
    return state
