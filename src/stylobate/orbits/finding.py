"""Search for periodic orbits from a guess, from theory, from a run, or from random initial conditions."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import BaseMotion
from stylobate.engine.flow.integration import Status
from stylobate.engine.flow.periodic import PeriodicSystem, plane_of, require_periodic
from stylobate.engine.forcing import common_line
from stylobate.errors import NoOrbitError, ParameterError, as_numbers, require_positive, require_whole
from stylobate.models import Model
from stylobate.orbits.arguments import require_subject
from stylobate.orbits.opening import require_sense, rolling_by_theory
from stylobate.orbits.orbit import PeriodicOrbit
from stylobate.orbits.shooting import Shots, arcs_of, closed, damped, newton_step, shots
from stylobate.results import Response
from stylobate.results.random_numbers import Rng, seed_of

Floats = npt.NDArray[np.float64]

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
    guess: npt.ArrayLike | Response | None = None,
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
    require_sense(sense)
    require_subject(model, motion)
    require_periodic(motion)
    if guess is None:
        state, line = rolling_by_theory(model, motion, sense), None
    else:
        lean = _of_run(guess, model, motion) if isinstance(guess, Response) else _checked(guess, model)
        _require_moving(model, lean)
        state, line = _start(model, motion, lean)
    system = PeriodicSystem(model, motion, line, rtol)
    chain = closed(system, arcs_of(system, state, periods, arcs), periods)
    return _shortest(PeriodicOrbit(model, motion, periods, chain, line, rtol))


def _require_moving(model: Model, lean: Floats) -> None:
    """Raise NoOrbitError if the column stands upright at the guess and does not move."""
    size = np.hypot(*lean[:2]), np.hypot(*lean[2:_LEAN]) * model.time_scale
    if max(size) < _STANDING * model.column.slenderness:
        message = (
            "no periodic orbit was reached: at the guess the column stands upright and does not move, which is not an "
            "orbit. Give a tilt or a tilt rate of the motion, or a run that still moves."
        )
        raise NoOrbitError(message)


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
    if chain.status is not Status.DONE:
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
            if flow.status is Status.DONE and np.abs(flow.end - orbit.state).max() <= _SAME * orbit.system.scale:
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
            message = f"over: {name} is not known here; known are {', '.join(ranges)}"
            raise ParameterError(message)
        try:
            low, high = (float(value) for value in values)
        except (TypeError, ValueError):
            low = high = math.nan
        if not (math.isfinite(low) and math.isfinite(high) and low <= high):
            message = f"over: {name} must be a range low ≤ high, got {values!r}"
            raise ParameterError(message)
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
        message = f"guess must be four numbers, tilt x, y [rad] and their rates [rad/s]{spin}, got {guess!r}"
        raise ParameterError(message)
    return lean


def _of_run(run: Response, model: Model, motion: BaseMotion) -> Floats:
    period = motion.period
    time = run.data["time"].to_numpy()
    if period is None or time[-1] < period:
        message = f"guess: the run must last at least one period of the base motion, but ends at {time[-1]:.6g} s"
        raise ParameterError(message)
    whole = math.floor(time[-1] / period * (1.0 + 1e-12)) * period
    at = run.sample(min(whole, time[-1])) if run.sampler is not None else run.data.interp(time=[whole], method="cubic")
    names = ["tilt", "tilt_rate"] + (["spin"] if model.spin_state is not None and "spin" in at else [])
    return np.concatenate([at[name].to_numpy().ravel() for name in names])
