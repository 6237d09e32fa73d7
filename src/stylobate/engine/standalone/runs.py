"""One run in the language of the compiler, from the numbers of its case to its outcome: a page computes it so.

Kernels, beginnings and last periods are those of all runs; here they are called for one row.
"""

import math
from enum import auto
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from stylobate.engine.ensembles.beginnings import (
    Body,
    Vector,
    beginning,
    fill_looks,
    fill_setup,
    line_of_switching,
    looks_needed,
    number_of_looks,
)
from stylobate.engine.ensembles.late import Ground, Late, late_of_row
from stylobate.engine.forcing import coarse
from stylobate.engine.kernel.bound import FromZero
from stylobate.engine.kernel.columns import EVENTS_AT, LOG, PAIRS, SLACK, STATE, TRACE_TERMS, Log, Setup, Trace
from stylobate.engine.kernel.driver.events import EventSetup, RunStatus, TraceKind
from stylobate.engine.standalone.bases import COURSE, AtRest, Polynomials, Waves
from stylobate.engine.tolerances import CLOSE_PASSAGE, OVERTURNED_TILT
from stylobate.engine.trajectory import ANTIDERIVATIVES, NODES
from stylobate.engine.verdict import duration_needed, in_doubt, numbers_of_rules, outcome_on
from stylobate.errors import Outcome
from stylobate.models.contact import per_normal_force
from stylobate.results import OutcomeRules

Row = npt.NDArray[np.float64]

Base = AtRest | Waves | Polynomials


class Given(NamedTuple):
    """Initial conditions of a run and its length, in SI units."""

    tilt_x: Any
    tilt_y: Any
    tilt_rate_x: Any
    tilt_rate_y: Any
    spin: Any
    twist: Any
    position_x: Any
    position_y: Any
    velocity_x: Any
    velocity_y: Any
    velocity_z: Any
    clearance: Any
    duration: Any


_RULES = OutcomeRules()
_NUMBERS_OF_RULES = numbers_of_rules(_RULES)


class Accuracy(NamedTuple):
    """Relative tolerance, step limit and trace entries of a run, and the factors of its thresholds, see `Plan`."""

    rtol: Any
    max_steps: Any
    traces: Any
    rest_share: Any
    passage_share: Any


class Layout(NamedTuple):
    """Columns of a row that depend on the model; see `Shape`."""

    parameters_at: int
    motion_at: int
    notes_at: int


def begin(row: Row, model: Any, base: Base, given: Given, accuracy: Accuracy, layout: Layout) -> tuple[Any, Any]:
    """Fill the row of a run; return whether its motion is planar, and whether the row has looks and pairs.

    Parameters
    ----------
    row
        Row with room for the looks, the pairs and the trace.
    model, base
        Model and base motion.
    given, accuracy
        Start and duration, and tolerances.
    layout
        Layout of the row.
    """
    scale, gravity = model.time_scale, model.column.gravity
    clear(row)
    bounds = base.bounds(scale, gravity)
    slenderness = model.column.slenderness
    body = Body(scale, slenderness, model.rest_capacity, model.comes_to_rest, model.loss_tilt, model.slope)
    fill_setup(
        row,
        body,
        bounds,
        given.duration,
        _RULES,
        rtol=accuracy.rtol,
        atol=None,
        rest_energy=None,
        max_steps=accuracy.max_steps,
        rest_share=accuracy.rest_share,
        passage_share=accuracy.passage_share,
    )
    end = given.duration / scale
    looks = looks_needed(end, bounds.period, _RULES)
    row[Setup.LOOKS] = number_of_looks(_RULES) if looks else 0
    row[Setup.NOTES] = number_of_looks(_RULES) + PAIRS if looks else 0
    fill_looks(row, end, bounds.period, _RULES)
    row[Setup.TRACES] = accuracy.traces
    row[EVENTS_AT + EventSetup.TILT_LIMIT] = math.inf
    row[EVENTS_AT + EventSetup.OVERTURNED_TILT] = OVERTURNED_TILT
    parameters = model.parameters
    for k in range(len(parameters)):
        row[layout.parameters_at + k] = parameters[k]
    base.fill(row, layout.motion_at, scale, gravity)
    return _set_start(row, model, base.directions(), given), looks


def clear(row: Row) -> None:
    """Set a row to that of a run that has not begun."""
    for column in range(len(row)):
        row[column] = 0.0
    row[LOG + Log.FIRST_AZIMUTH] = row[LOG + Log.LAST_AZIMUTH] = math.nan
    row[LOG + Log.MINIMUM_TILT] = row[LOG + Log.CLOSEST_PASSAGE] = row[LOG + Log.NORMAL] = math.inf


def _set_start(row: Row, model: Any, directions: tuple[Vector, ...], given: Given) -> Any:
    """Set state and line of a run; return whether its motion is planar."""
    scale, slenderness = model.time_scale, model.column.slenderness
    begun = beginning(
        (given.tilt_x, given.tilt_y),
        (given.tilt_rate_x, given.tilt_rate_y),
        given.spin,
        scale,
        slenderness,
        (*directions, (0.0, 0.0)),
        has_plane=model.planar_rates is not None,
    )
    line = begun.line
    if model.guards is not None:
        line = line_of_switching(begun, directions, model.slope, (0.0, 0.0), given.spin)
    row[Setup.LINE_X], row[Setup.LINE_Y] = line
    stands = 1.0 if begun.stands else 0.0
    row[LOG + Log.STANDS] = row[LOG + Log.REACHED_VERTICAL] = stands
    states = model.start(begun.lean, (given.tilt_rate_x * (1.0 - stands), given.tilt_rate_y * (1.0 - stands)))
    for k in range(len(states)):
        row[STATE + k] = states[k]
    if model.spin_state is not None:
        row[STATE + model.spin_state] = given.spin * scale
    if (
        model.guards is not None and begun.stands
    ):  # a standing column begins as sliding; the reset map decides its contact
        row[STATE + len(states) - 1] = model.contact_kinds.SLIDING
    if begun.planar:
        row[STATE] = begun.tilt[0] * begun.line[0] + begun.tilt[1] * begun.line[1]
        row[STATE + 1] = begun.rate[0] * begun.line[0] + begun.rate[1] * begun.line[1]
    return begun.planar


_OTHERS = -1
_OUTCOME_OF_STATUS = tuple(_OTHERS if one.outcome is None else int(one.outcome) for one in RunStatus)
_OUTCOME_OF_GROUND = tuple(int(outcome_on(ground)) for ground in Ground)


class Verdict(FromZero):
    """What is known of a run at its end; the numbers of `Late` follow."""

    OUTCOME = auto()
    UNCERTAIN = auto()
    """1 if rounding or the rest threshold could alter the outcome."""
    IN_DOUBT = auto()
    """1 if finer thresholds or another tolerance could alter the outcome."""
    TILT_X = auto()
    TILT_Y = auto()
    TILT_RATE_X = auto()
    TILT_RATE_Y = auto()
    """Tilt vector at the end [rad] and its rate [rad/s]."""
    TURNS = auto()
    """Turns of the contact point round the rim."""
    NEEDED = auto()
    """Duration that suffices for an outcome of a run that moves at its end [s]; 0 if it is decided."""
    BASE_LEFT = auto()
    """Time from the end of the run to that of the base motion [s]; negative after it."""
    ENERGY_SHARE = auto()
    """Energy at the end over that required to overturn, see `energy_over_balance`."""


def judge(row: Row, model: Any, base: Base, planar: Any, layout: Layout, out: Row) -> None:
    """Set the numbers of `Verdict` and of `Late` of a run that has ended; `planar` is 1 if it ended in a plane."""
    late = out[len(Verdict) :]
    late_of_row(row, planar, _NUMBERS_OF_RULES, layout.notes_at, late)
    status = int(row[LOG + Log.STATUS])
    outcome = _OUTCOME_OF_GROUND[int(late[Late.GROUND])]
    if row[LOG + Log.STANDS] > 0.0:
        outcome = int(Outcome.AT_REST)
    ended = _OUTCOME_OF_STATUS[status]
    if ended != _OTHERS:
        outcome = ended
    end, share = row[LOG + Log.TIME] * row[Setup.TIME_SCALE], _energy_share(row, model, planar)
    out[Verdict.BASE_LEFT], out[Verdict.ENERGY_SHARE] = base.duration - end, share
    moves = row[LOG + Log.STANDS] == 0.0 and status == int(RunStatus.STOPPED)
    if moves and base.duration > 0.0 and end * (1.0 + SLACK) >= base.duration and share < 1.0:
        outcome = int(Outcome.SURVIVED)
    out[Verdict.OUTCOME] = outcome
    fell = outcome in (int(Outcome.OVERTURNED), int(Outcome.LIMIT_REACHED))
    failed = outcome == int(Outcome.FAILED)
    uplifted = row[LOG + Log.RELEASED_FROM_REST] > 0.0
    rough = coarse(
        row[Setup.REST_ENERGY],
        row[Setup.FREQUENCY],
        row[Setup.LARGEST_HORIZONTAL],
        row[Setup.MINIMUM_VERTICAL],
        row[Setup.CAPACITY],
    )
    close = row[LOG + Log.CLOSEST_PASSAGE] < CLOSE_PASSAGE * row[Setup.SLENDERNESS]
    out[Verdict.UNCERTAIN] = close or failed or (uplifted and rough)
    doubtful = in_doubt(
        overturned=fell,
        decided=row[LOG + Log.DECIDED],
        peak_tilt=row[LOG + Log.PEAK_TILT],
        released_again=uplifted,
        widest_loss=row[LOG + Log.WIDEST_LOSS],
        passage_tilt=row[Setup.PASSAGE_TILT],
        slenderness=row[Setup.SLENDERNESS],
    )
    out[Verdict.IN_DOUBT] = doubtful and not failed
    lean = _end_lean(row, model, planar)
    per_second = row[Setup.PER_SECOND]
    out[Verdict.TILT_X], out[Verdict.TILT_Y] = lean[0], lean[1]
    out[Verdict.TILT_RATE_X], out[Verdict.TILT_RATE_Y] = lean[2] * per_second, lean[3] * per_second
    turns = row[LOG + Log.LAST_AZIMUTH] - row[LOG + Log.FIRST_AZIMUTH]
    out[Verdict.TURNS] = 0.0 if math.isnan(turns) else turns
    goes_on = outcome == int(Outcome.STILL_MOVING) and status == int(RunStatus.STOPPED) and row[Setup.PERIOD] > 0.0
    out[Verdict.NEEDED] = 0.0
    if goes_on:
        out[Verdict.NEEDED] = duration_needed(late, _RULES, row[Setup.PERIOD] * row[Setup.TIME_SCALE])


def _energy_share(row: Row, model: Any, planar: Any) -> Any:
    """Return the energy at the end of a run over that required to overturn; see `energy_over_balance`."""
    balance = model.balance
    if balance is None:
        return math.inf
    states = tuple(row[STATE + k] for k in range(len(model.state_names)))
    if model.from_plane is not None and planar > 0.0:
        line = (row[Setup.LINE_X], row[Setup.LINE_Y])
        states = _as_floats(model.from_plane(states[0], states[1], *line, *model.parameters))
    x, y, _, _ = model.tilt_of(*states, *model.parameters)
    share = model.energy(states) / balance.energy if balance.energy > 0.0 else math.inf
    return share if np.hypot(x, y) < balance.tilt else math.inf


def _end_lean(row: Row, model: Any, planar: Any) -> tuple[Any, Any, Any, Any]:
    """Return the tilt vector at the end and its rate, in the time of the model."""
    if row[LOG + Log.STANDS] > 0.0:
        return 0.0, 0.0, 0.0, 0.0
    if planar > 0.0:
        x, y = row[Setup.LINE_X], row[Setup.LINE_Y]
        tilt, rate = row[STATE], row[STATE + 1]
        return tilt * x, tilt * y, rate * x, rate * y
    states = tuple(row[STATE + k] for k in range(len(model.state_names)))
    a, b, c, d = model.tilt_of(*states, *model.parameters)
    return a, b, c, d


def to_plane(row: Row, model: Any) -> None:
    """Replace the three-dimensional state of a run by tilt and rate along its line, for the kernel in a plane."""
    states = tuple(row[STATE + k] for k in range(len(model.state_names)))
    x, y, vx, vy = model.tilt_of(*states, *model.parameters)
    row[STATE] = x * row[Setup.LINE_X] + y * row[Setup.LINE_Y]
    row[STATE + 1] = vx * row[Setup.LINE_X] + vy * row[Setup.LINE_Y]
    row[LOG + Log.STATUS] = RunStatus.WAITING


class Sample(FromZero):
    """Numbers of a run at one time, in SI units."""

    TIME = auto()
    TILT_X = auto()
    TILT_Y = auto()
    TILT_RATE_X = auto()
    TILT_RATE_Y = auto()
    AZIMUTH = auto()
    """Continuous azimuth of the lean [rad]; NaN while the column stands upright."""
    RESTING = auto()
    """1 while the column stands on its base."""
    SPIN = auto()
    TWIST = auto()
    FOOTPRINT_X = auto()
    FOOTPRINT_Y = auto()
    BASE_X = auto()
    BASE_Y = auto()
    BASE_Z = auto()
    """Displacement of the base [m]."""
    ACCELERATION_X = auto()
    ACCELERATION_Y = auto()
    ACCELERATION_Z = auto()
    """Acceleration of the base [m/s²]."""
    NORMAL = auto()
    """Normal force over the weight."""
    FRICTION = auto()
    PIVOTING = auto()
    """Friction force over the normal force, and moment about the vertical over normal force and radius."""


def sampled(entries: Row, model: Any, base: Base, row: Row, given: Given, out: Row) -> None:
    """Set the samples of a run at given times.

    Parameters
    ----------
    entries
        Entries of its trace that are not events, shape (n, columns).
    model, base
        Model and base motion.
    row, given
        Row of the run after its end, and its start.
    out
        A row for each sample, with the columns of `Sample`; the times stand in it and do not fall.
    """
    scale, end = model.time_scale, row[LOG + Log.TIME]
    carried, here, course = np.zeros(3), np.zeros(3), np.zeros(COURSE)
    base.begin(course)
    carried[0], carried[1], carried[2] = given.twist, given.position_x, given.position_y
    at = 0
    for k in range(len(out)):
        time = out[k, Sample.TIME]
        tau = min(time / scale, end)
        while at + 1 < len(entries) and entries[at + 1, Trace.START] <= tau:
            length = entries[at + 1, Trace.START] - entries[at, Trace.START]
            _carry(entries[at], model, length, carried)
            at = at + 1
        for j in range(3):
            here[j] = carried[j]
        _carry(entries[at], model, tau - entries[at, Trace.START], here)
        base.set_sample(time, course, out[k, Sample.BASE_X :], out[k, Sample.ACCELERATION_X :])
        _set_sample(entries[at], model, row, time, tau, here, out[k])


def _carry(entry: Row, model: Any, elapsed: Any, carried: Row) -> None:
    """Add what twist and footprint gain in the first part of an entry of the trace."""
    if model.carried_rates is None:
        return
    kind, length = entry[Trace.KIND], entry[Trace.LENGTH]
    share = elapsed / length
    radius = model.column.radius
    if kind == TraceKind.ANALYTICAL_STEP:
        rates = model.carried_rates(*_states(entry, model, 0.0), *model.parameters)
        carried[0] += rates[0] * elapsed
        carried[1] += rates[1] * elapsed * radius
        carried[2] += rates[2] * elapsed * radius
    if kind == TraceKind.STEP:
        for node in range(len(NODES)):
            rates = model.carried_rates(*_states(entry, model, NODES[node]), *model.parameters)
            weight = 0.0
            for power in range(len(NODES)):
                weight = (weight + ANTIDERIVATIVES[node, len(NODES) - power]) * share
            gained = length * (weight + ANTIDERIVATIVES[node, 0])
            carried[0] += rates[0] * gained
            carried[1] += rates[1] * gained * radius
            carried[2] += rates[2] * gained * radius


def _states(entry: Row, model: Any, share: Any) -> tuple[Any, ...]:
    """Return the states within an entry of the trace, at a share of its length."""
    return tuple(_polynomial(entry, k, len(model.state_names), share) for k in range(len(model.state_names)))


def _polynomial(entry: Row, state: int, states: int, share: Any) -> Any:
    """Return a state within an entry of the trace; see `trajectory`."""
    change, first = 0.0, len(Trace) + state
    for place in range(TRACE_TERMS - 1):
        power = TRACE_TERMS - 1 - place
        change = (change + entry[first + power * max(states, 2)]) * (share if power % 2 == 1 else 1.0 - share)
    return entry[first] + change


def _set_sample(entry: Row, model: Any, row: Row, time: Any, tau: Any, carried: Row, out: Row) -> None:
    """Set the numbers of a sample besides those of the base."""
    scale = model.time_scale
    states = states_at(entry, model, row, tau)
    x, y, vx, vy = model.tilt_of(*states, *model.parameters)
    out[Sample.TIME], out[Sample.TILT_X], out[Sample.TILT_Y] = time, x, y
    out[Sample.TILT_RATE_X], out[Sample.TILT_RATE_Y] = vx / scale, vy / scale
    out[Sample.RESTING] = _rests(entry, model, states)
    out[Sample.AZIMUTH] = _azimuth(entry, x, y)
    out[Sample.SPIN] = math.nan if model.spin_state is None else states[model.spin_state or 0] / scale
    out[Sample.TWIST], out[Sample.FOOTPRINT_X], out[Sample.FOOTPRINT_Y] = carried[0], carried[1], carried[2]
    normal, friction, moment = math.nan, math.nan, math.nan
    if model.contact is not None and model.guards is None:
        acceleration = (out[Sample.ACCELERATION_X], out[Sample.ACCELERATION_Y], out[Sample.ACCELERATION_Z])
        normal, friction, moment = loads(entry, model, states, acceleration)
    out[Sample.NORMAL], out[Sample.FRICTION], out[Sample.PIVOTING] = normal, friction, moment


def states_at(entry: Row, model: Any, row: Row, tau: Any) -> tuple[Any, ...]:
    """Return the three-dimensional states at a time within an entry of the trace."""
    states = _states(entry, model, (tau - entry[Trace.START]) / entry[Trace.LENGTH])
    if model.from_plane is not None and entry[Trace.KIND] == TraceKind.PLANE_STEP:
        line = (row[Setup.LINE_X], row[Setup.LINE_Y])
        states = _as_floats(model.from_plane(states[0], states[1], *line, *model.parameters))
    return states


def _rests(entry: Row, model: Any, states: tuple[Any, ...]) -> Any:
    """Return whether the column stands on its base."""
    stands = entry[Trace.KIND] == TraceKind.STAND
    return stands if model.guards is None else stands or states[len(states) - 1] <= 1.0


def loads(entry: Row, model: Any, states: tuple[Any, ...], acceleration: tuple[Any, Any, Any]) -> tuple[Any, Any, Any]:
    """Return normal force over the weight, friction over it, and moment over it and the radius; see `contact_loads`.

    Parameters
    ----------
    entry
        Entry of the trace.
    model, states
        Model with `contact`, and its states.
    acceleration
        Of the base [m/s²].
    """
    ax, ay, az = (one / model.column.gravity for one in acceleration)
    normal, friction, moment = model.contact(*states, ax, ay, az, *model.parameters)
    if entry[Trace.KIND] == TraceKind.STAND:
        normal, friction, moment = 1.0 + az, np.hypot(ax, ay), 0.0
    return normal, _over(friction, normal), _over(moment, normal)


def _over(force: Any, normal: Any) -> Any:
    return per_normal_force(force, normal)


def _as_floats(states: tuple[Any, ...]) -> tuple[Any, ...]:
    return tuple(float(state) for state in states)


def _azimuth(entry: Row, x: Any, y: Any) -> Any:
    """Return the continuous azimuth of a tilt vector within an entry [rad]; NaN for an upright column."""
    if entry[Trace.KIND] == TraceKind.STAND or (x == 0.0 and y == 0.0):
        return math.nan
    here = math.atan2(y, x) / (2.0 * math.pi)
    middle = 0.5 * (entry[Trace.AZIMUTH] + entry[Trace.END_AZIMUTH])
    turns = 0.0 if entry[Trace.KIND] == TraceKind.PLANE_STEP else np.rint(middle - here)
    return 2.0 * math.pi * (here + turns)
