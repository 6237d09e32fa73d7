"""Find periodic orbits, from a guess, a run, random states, or steady rolling by theory.

An elliptic motion is the sum of two circular motions of opposite sense. Steady rolling under one circular motion is
known exactly; the continuation adds the other motion step by step.
"""

import cmath
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from stylobate import theory
from stylobate.base_motions import BaseMotion, Harmonic
from stylobate.base_motions.harmonic import as_harmonic
from stylobate.column import Column
from stylobate.engine.flow.integration import FlowStatus
from stylobate.engine.flow.periodic import PeriodicSystem, plane_of, require_periodic
from stylobate.engine.forcing import common_line
from stylobate.errors import NoOrbitError, ParameterError, UnsupportedError, as_numbers, require_positive, require_whole
from stylobate.models import Model
from stylobate.models.model import ClosedForm, RollingLaw, closed_form_of
from stylobate.orbits.orbit import PeriodicOrbit, require_subject
from stylobate.orbits.shooting import Shots, arcs_of, closed, damped, newton_step, shots
from stylobate.results import Run
from stylobate.results.random_numbers import Rng, seed_of

Floats = npt.NDArray[np.float64]


def rolling_form_of(model: Model) -> ClosedForm | None:
    """Return the closed form of the steady rolling without slip of `model`, or None."""
    form = closed_form_of(model)
    return None if form is None or form.law is RollingLaw.SLIPPING else form


def steady_rolling_of(
    form: ClosedForm, column: Column, nu: float, acceleration: float, branch: str = "upper"
) -> tuple[float, float, float]:
    """Return tilt [rad], phase to the base acceleration [rad] and spin [ω0] of steady rolling; NaN without it.

    Parameters
    ----------
    form
        Result of `rolling_form_of` for a model that meets its requirement.
    column
        The column.
    nu
        Frequency of the base [ω0], which moves anticlockwise.
    acceleration
        Acceleration of the base [g].
    branch
        "upper" or "lower"; at finite tilt "upper" is the stable branch or, if none is, that of the phase nearest to 0.
        For slender rolling only the upper branch is known.
    """
    c, eta, zeta = column.slenderness, form.eta, form.zeta
    shape = {"inertia_ratio": column.inertia_ratio, "axial_ratio": column.axial_ratio}
    if form.law is RollingLaw.SLENDER:
        steady = theory.steady_rolling(nu, acceleration, c=c, eta=eta)
        chosen = steady.upper if branch == "upper" else steady.lower
        return float(chosen.amplitude), float(chosen.phase), 0.0
    if form.law is RollingLaw.FREE_TWIST:
        free = theory.free_twist_rolling(nu, acceleration, c=c, eta=eta, zeta=zeta, **shape)
        return float(free.amplitude), float(free.phase), float(free.spin)
    if form.law is RollingLaw.WOBBLING:
        found = theory.wobbling_rolling(nu, acceleration, c=c, eta=eta, **shape)
    else:
        found = theory.full_rolling(nu, acceleration, c=c, eta=eta, zeta=zeta, **shape)
    index = _index_of(found.phase, found.stable, found.exists, branch)
    if index is None:
        return math.nan, math.nan, math.nan
    return float(found.amplitude[index]), float(found.phase[index]), float(found.spin[index])


def _index_of(
    phase: npt.NDArray[np.float64], stable: npt.NDArray[np.bool_], exists: npt.NDArray[np.bool_], branch: str
) -> int | None:
    """Return the index of a branch: upper, the stable one or that of the phase nearest to 0; lower, the farthest."""
    order = sorted(np.flatnonzero(exists).tolist(), key=lambda index: (not stable[index], abs(phase[index])))
    if branch == "upper":
        return order[0] if order else None
    return max(order[1:], key=lambda index: abs(phase[index]), default=None)


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


def _rolling_by_theory(model: Model, motion: BaseMotion, sense: int | None) -> Floats:
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
        raise UnsupportedError(
            f"{_GIVE}: steady rolling has a closed form under horizontal Harmonic motion only, got {motion!r}"
        )
    _require_sense(sense)
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
                raise NoOrbitError(
                    f"{_GIVE}: rolling in the sense {sense:+d} was continued from its circle only up to {done:.3g} of "
                    "the circle of opposite sense"
                )
            continue
        done, state = part, opened
    return state


def _form_of(model: Model) -> ClosedForm:
    """Return the closed form of the steady rolling of a model, or raise UnsupportedError without one."""
    form = rolling_form_of(model)
    if form is None:
        raise UnsupportedError(
            f"{_GIVE}: {type(model).__name__} states no closed form of steady rolling for its equations"
        )
    if form.requires is not None:
        name, value = form.requires
        raise UnsupportedError(
            f"{_GIVE}: {name} must be {value!r} for the closed form of steady rolling, got {getattr(model, name)!r}"
        )
    return form


def _require_sense(sense: int | None) -> None:
    """Raise ParameterError unless `sense` is a sense of rolling, or None."""
    if sense not in (1, -1, None):
        raise ParameterError(f"sense must be +1, -1 or None, got {sense!r}")


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
        raise NoOrbitError(
            "guess must be given: theory has no steady rolling in this sense at angular_frequency = "
            f"{motion.angular_frequency!r} rad/s"
        )
    azimuth = cmath.phase(part) + sense * psi
    x, y = amplitude * math.cos(azimuth), amplitude * math.sin(azimuth)
    rate = sense * nu
    state = np.array(model.start((x, y), (0.0, 0.0)), dtype=float)
    state[2:4] = -rate * y, rate * x
    if model.spin_state is not None:
        state[model.spin_state] = sense * spin
    return state


_LEAN = 4
# Two orbits are the same if their states differ by less than this fraction of c, at one of their possible phases.
_SAME = 1e-6
_DEFLATED_STEPS = 40
_CLOSE = 1e-10
# Tilt and tilt rate below this fraction of c count as zero.
_STANDING = 1e-12


def periodic_orbit(
    model: Model,
    motion: BaseMotion,
    *,
    guess: npt.ArrayLike | Run | None = None,
    periods: int = 1,
    arcs: int | None = None,
    sense: int | None = None,
    rtol: float = 1e-12,
) -> PeriodicOrbit:
    """Find a periodic orbit by shooting: Newton's method from a guess.

    The derivatives of the flow are those of the variational equations, exact to the tolerance. They jump (saltation)
    at a passage through the vertical, which only planar motion can have.

    Parameters
    ----------
    model
        The column; its equations must allow derivatives, see `Model.jacobian`.
    motion
        A base motion that is periodic from t = 0.
    guess
        Tilt vector [rad] and its rate [rad/s] at t = 0: x, y, ẋ, ẏ, then the spin [rad/s] if the model has one and it
        is not 0. Or a run: its state when it last passed the phase of t = 0 is used. Or None for steady rolling by
        theory (horizontal Harmonic motion): the closed form for one of the two circular components of the motion is
        continued while the other component is added.
    periods
        Length of the orbit in periods of the base motion. If the orbit repeats sooner, its minimal period is returned.
    arcs
        Number of shooting segments, one per period by default. Use more for very unstable orbits.
    sense
        Sense of rolling of the guess by theory, +1 or −1; by default that of the larger circular component.
    rtol
        Relative tolerance of the flow.

    Raises
    ------
    NoOrbitError
        If no orbit is reached.
    ParameterError
        If an argument is out of range.
    UnsupportedError
        If the motion is not periodic, or the model's equations cannot be differentiated.

    Notes
    -----
    A guess that lies in the vertical plane of a straight base motion leads to a planar orbit.

    Examples
    --------
    >>> import stylobate as sb
    >>> model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    >>> motion = sb.Harmonic.straight(acceleration=0.04, angular_frequency=2.0)
    >>> orbit = sb.orbits.periodic_orbit(model, motion)
    >>> orbit.stable, orbit.turns
    (True, 1.0)
    """
    periods = require_whole("periods", periods, least=1)
    arcs = periods if arcs is None else require_whole("arcs", arcs, least=1)
    rtol = require_positive("rtol", rtol)
    _require_sense(sense)
    require_subject(model, motion)
    require_periodic(motion)
    if guess is None:
        state, line = _rolling_by_theory(model, motion, sense), None
    else:
        lean = _of_run(guess, model, motion) if isinstance(guess, Run) else _checked(guess, model)
        _require_moving(model, lean)
        state, line = _start(model, motion, lean)
    system = PeriodicSystem(model, motion, line, rtol)
    chain = closed(system, arcs_of(system, state, periods, arcs), periods)
    return _shortest(PeriodicOrbit(model, motion, periods, chain, line, rtol))


def _require_moving(model: Model, lean: Floats) -> None:
    """Raise NoOrbitError if the column stands upright at the guess and does not move."""
    size = np.hypot(*lean[:2]), np.hypot(*lean[2:_LEAN]) * model.time_scale
    if max(size) < _STANDING * model.column.slenderness:
        raise NoOrbitError(
            "no periodic orbit was reached: at the guess the column stands upright and does not move, which is not an "
            "orbit. Give a tilt or a tilt rate of the motion, or a run that still moves."
        )


def _start(model: Model, motion: BaseMotion, lean: Floats) -> tuple[Floats, tuple[float, float] | None]:
    """Return the state in units of the model, and the line of its plane if state and base motion are planar."""
    state = np.array(model.start(tuple(lean[:2]), tuple(lean[2:_LEAN])), dtype=float)
    if model.spin_state is not None and lean.size > _LEAN:
        state[model.spin_state] = lean[_LEAN] * model.time_scale
    line = plane_of(model, motion, state)
    if line is None:
        return state, None
    scaled = lean[:_LEAN] * np.array([1.0, 1.0, model.time_scale, model.time_scale])
    return np.array([scaled[:2] @ line, scaled[2:] @ line]), line


def periodic_orbits(
    model: Model,
    motion: BaseMotion,
    *,
    over: Mapping[str, Sequence[float]] | None = None,
    count: int = 32,
    rng: Rng = 0,
    periods: int = 1,
    rtol: float = 1e-12,
) -> tuple[PeriodicOrbit, ...]:
    """Search for periodic orbits, stable and unstable, from random initial conditions.

    Orbits found before are deflated: they repel Newton's method, so that coexisting orbits are found (P. E. Farrell,
    Á. Birkisson, S. W. Funke, "Deflation techniques for finding distinct solutions of nonlinear partial differential
    equations", SIAM J. Sci. Comput. 37 (2015)). Under a straight base motion the mirror image of an orbit is an orbit
    too, and is returned with it.

    Parameters
    ----------
    model, motion
        The column and its periodic base motion.
    over
        Ranges of the initial conditions: tilt_x, tilt_y [rad], tilt_rate_x, tilt_rate_y [rad/s]. By default tilts
        within c and rates within c at the frequency of the base motion, or c in units of the model if that is larger.
    count, rng
        Number of initial conditions; seed or numpy.random.Generator.
    periods
        Maximum length of the orbits in periods of the base motion; all its divisors are searched too.
    rtol
        Relative tolerance of the flow.

    Returns
    -------
    tuple
        Each orbit once, sorted by length, then by maximum tilt. Other orbits may exist: this is a search, not a proof.
    """
    require_subject(model, motion)
    periods = require_whole("periods", periods, least=1)
    count = require_whole("count", count, least=1)
    rtol = require_positive("rtol", rtol)
    system = PeriodicSystem(model, motion, None, rtol)
    low, high = np.transpose(_ranges(system, over))
    starts = np.random.default_rng(seed_of(rng)).uniform(low, high, size=(count, _LEAN))
    found: list[PeriodicOrbit] = []
    known: list[Floats] = []
    for length in (divisor for divisor in range(1, periods + 1) if periods % divisor == 0):
        for lean in starts:
            state = np.array(model.start(tuple(lean[:2]), tuple(lean[2:])), dtype=float)
            chain = _deflated(system, state, length, known)
            if chain is None:
                continue
            orbit = _shortest(PeriodicOrbit(model, motion, length, chain, None, rtol))
            for one in (orbit, _mirrored(orbit)):
                if one is not None and not _is_known(one.state, known, system.scale):
                    found.append(one)
                    known.extend(one.states(one.periods).T)
    # Symmetry-related orbits have the same tilts up to rounding: they stay in the order of the search.
    same = _SAME * system.scale
    return tuple(sorted(found, key=lambda orbit: (orbit.periods, round(orbit.peak_tilt / same))))


def _deflated(system: PeriodicSystem, state: Floats, periods: int, known: Sequence[Floats]) -> Shots | None:
    """Return the orbit that the deflated method finds, or None."""
    chain = shots(system, state[np.newaxis], periods)
    if chain.status is not FlowStatus.DONE:
        return None
    for _ in range(_DEFLATED_STEPS):
        step = newton_step(chain)
        if step is None:
            return None
        following = damped(system, chain, _repelled(step, chain.states, known, system.scale), periods)
        if following is None:
            return None
        close = np.abs(step).max() <= _CLOSE * np.abs(chain.states).max()
        chain = following
        if close:
            return None if _is_known(chain.states[0], known, system.scale) else chain
    return None


def _is_known(state: Floats, known: Sequence[Floats], scale: float) -> bool:
    return any(np.abs(state - other).max() <= _SAME * scale for other in known)


def _mirrored(orbit: PeriodicOrbit) -> PeriodicOrbit | None:
    """Return the mirror image of an orbit under a straight base motion; None for other motions or without an orbit."""
    line = common_line(*orbit.motion.directions())
    if line is None:
        return None
    # Twice the component along the line, minus the vector.
    tilt, rate = (2.0 * (vector @ line) * np.array(line) - vector for vector in (orbit.tilt, orbit.tilt_rate))
    state = np.array(orbit.model.start(tuple(tilt), tuple(rate)), dtype=float)
    try:
        guess = arcs_of(orbit.system, state, orbit.periods, len(orbit.chain.states))
        chain = closed(orbit.system, guess, orbit.periods)
    except NoOrbitError:
        return None
    return replace(orbit, chain=chain)


def _repelled(step: Floats, states: Floats, known: Sequence[Floats], scale: float) -> Floats:
    """Return Newton's step for the residual times Π(1 + 1/|x − x_k|²), with x in units of c."""
    if not known:
        return step
    apart = (states[0] - np.stack(known)) / scale
    square = np.sum(apart**2, axis=1) + 1e-300
    # d ln(1 + 1/s)/ds = −1/(s(s + 1))
    growth = -2.0 * (apart @ step[0]) / scale / (square * (square + 1.0))
    factor = 1.0 - float(growth.sum())
    return step / factor if abs(factor) > 1e-3 else step  # noqa: PLR2004  if singular, a plain step


def _shortest(orbit: PeriodicOrbit) -> PeriodicOrbit:
    """Return the orbit with its minimal period."""
    for periods in range(1, orbit.periods):
        if orbit.periods % periods == 0:
            flow = orbit.system.carry(orbit.state, 0.0, float(periods))
            if flow.status is FlowStatus.DONE and np.abs(flow.end - orbit.state).max() <= _SAME * orbit.system.scale:
                arcs = max(1, round(len(orbit.chain.states) * periods / orbit.periods))
                chain = closed(orbit.system, arcs_of(orbit.system, orbit.state, periods, arcs), periods)
                return replace(orbit, periods=periods, chain=chain)
    return orbit


def _ranges(system: PeriodicSystem, over: Mapping[str, Sequence[float]] | None) -> list[tuple[float, float]]:
    scale, time = system.scale, system.model.time_scale
    frequency = 2.0 * math.pi / system.numbers.period
    rate = scale * max(1.0, min(frequency, 1.0 / frequency)) / time
    ranges = {
        "tilt_x": (-scale, scale),
        "tilt_y": (-scale, scale),
        "tilt_rate_x": (-rate, rate),
        "tilt_rate_y": (-rate, rate),
    }
    for name, values in (over or {}).items():
        if name not in ranges:
            raise ParameterError(f"over: {name} is not known here; known are {', '.join(ranges)}")
        try:
            low, high = (float(value) for value in values)
        except (TypeError, ValueError):
            low = high = math.nan
        if not (math.isfinite(low) and math.isfinite(high) and low <= high):
            raise ParameterError(f"over: {name} must be a range low ≤ high, got {values!r}")
        ranges[name] = (low, high)
    return list(ranges.values())


def _checked(guess: npt.ArrayLike, model: Model) -> Floats:
    guess = as_numbers("guess", guess)
    try:
        lean = np.asarray(guess, dtype=float)
    except (TypeError, ValueError):
        lean = np.empty(0)
    sizes = ((_LEAN,),) if model.spin_state is None else ((_LEAN,), (_LEAN + 1,))
    if lean.shape not in sizes or not np.all(np.isfinite(lean)):
        spin = "" if model.spin_state is None else ", and perhaps the spin [rad/s]"
        raise ParameterError(
            f"guess must be four numbers, tilt x, y [rad] and their rates [rad/s]{spin}, got {guess!r}"
        )
    return lean


def _of_run(run: Run, model: Model, motion: BaseMotion) -> Floats:
    period = motion.period
    time = run.data["time"].to_numpy()
    if period is None or time[-1] < period:
        raise ParameterError(
            f"guess: the run must last at least one period of the base motion, but ends at {time[-1]:.6g} s"
        )
    whole = math.floor(time[-1] / period * (1.0 + 1e-12)) * period
    at = run.sample(min(whole, time[-1])) if run.sampler is not None else run.data.interp(time=[whole], method="cubic")
    names = ["tilt", "tilt_rate"] + (["spin"] if model.spin_state is not None and "spin" in at else [])
    return np.concatenate([at[name].to_numpy().ravel() for name in names])
