"""Integration of one run: `simulate`."""

from collections.abc import Callable, Sequence
from dataclasses import asdict
from typing import Any, Unpack

import numpy as np

from stylobate.base_motions import BASE_AT_REST, BaseMotion
from stylobate.engine.contact_measures import contact_warnings
from stylobate.engine.end_of_motion import duration_of
from stylobate.engine.history import history
from stylobate.engine.motion_checks import check_motion
from stylobate.engine.pace import announce, expected_steps
from stylobate.engine.run_result import run_result
from stylobate.engine.starts import Start, Turning, require_below_level, require_nouns, require_plane
from stylobate.engine.thresholds import is_rest, without_dust
from stylobate.engine.tolerances import CLOSE_PASSAGE
from stylobate.engine.user_events import EventFunction, checked_events
from stylobate.errors import ParameterError, require_vector
from stylobate.models import Model
from stylobate.provenance import provenance_of_run
from stylobate.results import OutcomeRules, Response
from stylobate.run_arguments import Accuracy, SingleRun, arguments_of, checked_options, takes


@takes(SingleRun)
def simulate(
    model: Model,
    motion: BaseMotion | None = None,
    *,
    events: Sequence[EventFunction | Callable[[float, dict[str, Any]], float]] = (),
    **run: Unpack[SingleRun],
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
    **run
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
    require_nouns(model, motion)
    moved = BASE_AT_REST if motion is None else motion
    leaning = without_dust(np.array(_pair("tilt", run["tilt"], "rad")))
    require_below_level(leaning)
    x, y = leaning.tolist()
    start_tilt = (x, y)
    start_rate = _pair("tilt_rate", run["tilt_rate"], "rad/s")
    at_rest = bool(is_rest(np.array(start_tilt), np.array(start_rate), model.column.slenderness, model.time_scale))
    turning = Turning.checked(model, run, standing=at_rest)
    friction_coefficient = arguments_of(SingleRun)["friction_coefficient"].checked(run["friction_coefficient"])
    if friction_coefficient is not None and model.switches:
        message = f"friction_coefficient must be given to model {model.name} itself, got {friction_coefficient!r} here"
        raise ParameterError(message)
    duration = duration_of(run["duration"], model, moved)
    samples = arguments_of(SingleRun)["samples"].checked(run["samples"])
    options = checked_options({**run, "samples": None, "recheck": False})
    rules = options["rules"] or OutcomeRules()
    check_motion(moved, duration)
    functions = checked_events(events)
    if at_rest:
        start_tilt = start_rate = (0.0, 0.0)
    require_plane(model, moved, start_tilt, start_rate)
    announce(
        expected_steps(model, moved.highest_frequency * model.time_scale, duration / model.time_scale),
        options["max_steps"],
    )
    result = run_result(model, moved, options, Start(start_tilt, start_rate, duration, turning), functions)
    recorded = history(model, moved, result.trajectory, samples, friction_coefficient=friction_coefficient)
    knife_edges = contact_warnings(model, result.measures) if model.switches else ()
    changes, doubts = result.repeated() if run["recheck"] else (False, ())
    return Response(
        outcome=result.outcome,
        reason=result.reason,
        decided_at=result.decided_at,
        uncertain=result.uncertain or changes,
        planar=result.planar,
        data=recorded.data,
        events=result.events,
        warnings=(*recorded.warnings, *doubts, *knife_edges),
        thresholds={"close_passage": CLOSE_PASSAGE, **result.thresholds, **asdict(rules)},
        measures={**result.measures, **recorded.measures},
        provenance=provenance_of_run(
            model,
            moved,
            tilt=start_tilt,
            tilt_rate=start_rate,
            **turning.values(),
            duration=duration,
            friction_coefficient=friction_coefficient,
            **{name: options[name] for name in Accuracy.__annotations__},  # type: ignore[literal-required]
            samples=samples,
            recheck=bool(run["recheck"]),
        )
        | {"atol": result.atol, "rules": asdict(rules)},
        sampler=recorded.sampler,
    )


def _pair(name: str, value: Sequence[float], unit: str) -> tuple[float, float]:
    x, y = require_vector(name, value, 2, unit)
    return x, y
