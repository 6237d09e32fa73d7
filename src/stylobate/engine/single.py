"""Integration of one run: `simulate`."""

from collections.abc import Callable, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from stylobate.base_motions import BASE_AT_REST, BaseMotion
from stylobate.config import provenance_of_run
from stylobate.engine.contact_measures import contact_warnings
from stylobate.engine.end_of_motion import duration_of
from stylobate.engine.ensembles.options import Options
from stylobate.engine.history import history
from stylobate.engine.motion_checks import check_motion
from stylobate.engine.pace import announce, expected_steps
from stylobate.engine.run_result import run_result
from stylobate.engine.starts import Start, Turning, require_below_level, require_nouns, require_plane
from stylobate.engine.thresholds import is_rest, without_dust
from stylobate.engine.tolerances import CLOSE_PASSAGE
from stylobate.engine.user_events import EventFunction, checked_events
from stylobate.errors import ParameterError, require_positive, require_vector, require_whole, suggests_arguments
from stylobate.models import Model
from stylobate.results import OutcomeRules, Response


@suggests_arguments
def simulate(
    model: Model,
    motion: BaseMotion | None = None,
    *,
    tilt: Sequence[float] = (0.0, 0.0),
    tilt_rate: Sequence[float] = (0.0, 0.0),
    spin: float = 0.0,
    twist: float = 0.0,
    position: Sequence[float] = (0.0, 0.0),
    velocity: Sequence[float] = (0.0, 0.0, 0.0),
    clearance: float = 0.0,
    duration: float | None = None,
    friction_coefficient: float | None = None,
    rtol: float = 1e-8,
    atol: float | None = None,
    tilt_limit: float | None = None,
    rest_energy: float | None = None,
    max_steps: int = 200_000,
    samples: int | None = None,
    rules: OutcomeRules | None = None,
    recheck: bool = True,
    events: Sequence[EventFunction | Callable[[float, dict[str, Any]], float]] = (),
) -> Response:
    """Integrate one column from its initial state until its outcome is decided.

    The run is integrated by DOP853 (Hairer, Nørsett, Wanner, "Solving Ordinary Differential Equations I") between
    events: uplift, rest, overturning, the tilt limit, lift-off. If initial state and base motion lie in one vertical
    plane to 8 ulp, the run is integrated in that plane. A kernel is compiled at the first use of a model; steps,
    outcome and measures equal those of `simulate_ensemble` to the bit.

    Parameters
    ----------
    model
        Model of the column, such as `Slender(column, damping=0.1)`.
    motion
        Base motion; None for a base at rest.
    tilt
        Initial tilt vector [rad]: it points to the side where the column leans, and its length is the tilt angle.
    tilt_rate
        Initial rate of the tilt vector [rad/s].
    spin, twist
        Initial angular velocity about the axis [rad/s] and angle of rotation about it [rad], for models that have them.
    position
        Initial centre of the footprint circle in the frame of the base [m], for models that have it.
    velocity, clearance
        Initial velocity of the lowest point of the column relative to the plane [m/s], and height of this point above
        the plane [m]; for models that can slip and fly.
    duration
        Duration of the run [s]. Under a base motion that ends, such as a record, a pulse or a sine sweep, the default
        is the duration of the motion and a free-vibration tail of 20/`column.frequency_parameter`.
    friction_coefficient
        Friction coefficient of the contact; the result warns if the run needs more friction. Models that can slip have
        a number of their own.
    rtol, atol
        Local error tolerances of the integrator, relative and absolute [rad]; `atol` is 0.01 rtol c by default.
    tilt_limit
        Tilt that ends the run [rad]; none by default.
    rest_energy
        Rest energy ε: with damping, a column whose energy is below ε c² comes to rest if the base motion holds it down.
        The default is the smaller of 1e-4 and 0.015/ν², where ν is the mean dimensionless frequency of the base motion.
        If the base motion can uplift the column again, the default is at most a hundredth of the energy after uplift,
        but not below 1e-8, or 1e-5 under a record or a brief motion.
    max_steps
        Maximum number of integration steps; a longer run ends as FAILED. The log warns if more steps are expected.
    samples
        Number of samples in `data`; by default enough to draw every swing.
    rules
        Thresholds that classify a motion as rolling, rocking or modulated.
    recheck
        Repeat a run in doubt with a hundredth of the rest energy and ten times the tolerance. A run is in doubt if the
        column was uplifted again after rest and then overturned or tilted beyond half of its tipping angle, came back
        from 0.95 of its tipping angle or more, or overturned after 40/ω0 or more. If the repeated run overturns and the
        first one does not, or the reverse, the result is `uncertain`, and has a warning. A run that passed the vertical
        more than 40 times without a steady motion is repeated too; a peak tilt that changes by a tenth has a warning.
    events
        Event functions, as `EventFunction` or plain functions of time and state with the optional attributes
        `direction` and `terminal`. Their zeros are recorded in `Response.events`; a terminal one ends the run, which
        has the outcome STOPPED. Files keep the events, not the functions.

    Returns
    -------
    Response
        Outcome and history. OVERTURNED is proved by the no-return criterion of the model if it has one.

    Raises
    ------
    ParameterError
        If an argument is out of range, or there is no `duration` and the base motion does not end.

    Examples
    --------
    >>> import stylobate as sb
    >>> model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    >>> sb.simulate(model, tilt=(0.05, 0.0), duration=150.0).outcome
    <Outcome.AT_REST: 'at rest'>
    >>> shaking = sb.Harmonic.circular(acceleration=0.15, angular_frequency=0.5)
    >>> sb.simulate(model, shaking, duration=50.0).outcome
    <Outcome.OVERTURNED: 'overturned'>
    """
    require_nouns(model, motion, rules)
    moved = BASE_AT_REST if motion is None else motion
    leaning = without_dust(np.array(_pair("tilt", tilt, "rad")))
    require_below_level(leaning)
    x, y = leaning.tolist()
    start_tilt = (x, y)
    start_rate = _pair("tilt_rate", tilt_rate, "rad/s")
    at_rest = bool(is_rest(np.array(start_tilt), np.array(start_rate), model.column.slenderness, model.time_scale))
    turning = Turning.checked(model, spin, twist, position, velocity, clearance, standing=at_rest)
    if friction_coefficient is not None and model.switches:
        message = f"friction_coefficient must be given to model {model.name} itself, got {friction_coefficient!r} here"
        raise ParameterError(message)
    if friction_coefficient is not None:
        friction_coefficient = require_positive("friction_coefficient", friction_coefficient)
    duration = duration_of(duration, model, moved)
    samples = None if samples is None else require_whole("samples", samples, least=2)
    options = Options.checked(
        rtol=rtol,
        atol=atol,
        tilt_limit=tilt_limit,
        rest_energy=rest_energy,
        max_steps=max_steps,
        samples=None,
        strobes=0,
        rules=rules,
    )
    check_motion(moved, duration)
    functions = checked_events(events)
    if at_rest:
        start_tilt = start_rate = (0.0, 0.0)
    require_plane(model, moved, start_tilt, start_rate)
    announce(expected_steps(model, moved.highest_frequency * model.time_scale, duration / model.time_scale), max_steps)
    result = run_result(model, moved, options, Start(start_tilt, start_rate, duration, turning), functions)
    recorded = history(model, moved, result.trajectory, samples, friction_coefficient=friction_coefficient)
    knife_edges = contact_warnings(model, result.measures) if model.switches else ()
    changes, doubts = result.repeated() if recheck else (False, ())
    return Response(
        outcome=result.outcome,
        reason=result.reason,
        decided_at=result.decided_at,
        uncertain=result.uncertain or changes,
        planar=result.planar,
        data=recorded.data,
        events=result.events,
        warnings=(*recorded.warnings, *doubts, *knife_edges),
        thresholds={"close_passage": CLOSE_PASSAGE, **result.thresholds, **asdict(options.rules)},
        measures={**result.measures, **recorded.measures},
        provenance=provenance_of_run(
            model,
            moved,
            tilt=start_tilt,
            tilt_rate=start_rate,
            **turning.values(),
            duration=duration,
            friction_coefficient=friction_coefficient,
            rtol=options.rtol,
            atol=result.atol,
            tilt_limit=options.tilt_limit,
            rest_energy=options.rest_energy,
            max_steps=options.max_steps,
            samples=samples,
            rules=asdict(options.rules),
            recheck=bool(recheck),
        ),
        sampler=recorded.sampler,
    )


def _pair(name: str, value: Sequence[float], unit: str) -> tuple[float, float]:
    x, y = require_vector(name, value, 2, unit)
    return x, y
