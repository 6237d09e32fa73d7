"""Basins of attraction: the attractor of each initial condition, on a grid or from a random sample."""

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Unpack

import numpy.typing as npt
import xarray as xr

from stylobate.base_motions import BASE_AT_REST, BaseMotion
from stylobate.errors import MOST_RUNS, ParameterError, require_whole
from stylobate.models import Model
from stylobate.orbits import PeriodicOrbit
from stylobate.progress import Progress, shows_progress
from stylobate.results.random_numbers import Rng
from stylobate.run_arguments import RunOptions
from stylobate.studies.checks import require_starts, require_values
from stylobate.studies.known_rolling import known_orbit_of
from stylobate.studies.maps.attractors import label_attractors
from stylobate.studies.maps.stroboscopic import AttractorRules
from stylobate.studies.maps.stroboscopic_count import with_strobes
from stylobate.studies.sweeps import Executor, Sweep
from stylobate.studies.sweeps.labelled import labelled_sweep

_PLANE = 2


@shows_progress("basins")
def basins(
    model: Model,
    motion: BaseMotion | None = None,
    *,
    over: Mapping[str, npt.ArrayLike],
    count: int | None = None,
    rng: Rng = 0,
    duration: float | None = None,
    periods: float | None = None,
    attractor_rules: AttractorRules | None = None,
    confidence: float = 0.95,
    orbits: Sequence[PeriodicOrbit] = (),
    store: str | Path | None = None,
    executor: Executor | None = None,
    resume: bool = False,
    progress: Progress = None,
    **options: Unpack[RunOptions],
) -> xr.Dataset:
    """Compute basins of attraction, on a grid of two initial conditions or from a random sample.

    Parameters
    ----------
    model, motion
        The column and its base motion, the same for all runs.
    over
        Initial conditions that vary: tilt_x, tilt_y [rad], tilt_rate_x, tilt_rate_y [rad/s], start_phase [rad].
        Without `count`, two names with their values make a grid. With `count`, any number of names with their ranges
        (low, high).
    count, rng
        Number of random initial conditions, drawn uniformly in the ranges; seed or numpy.random.Generator.
    duration, periods
        Duration of each run [s], or its number of periods of the base motion.
    attractor_rules
        Tolerances by which attractors are identified.
    confidence
        Confidence level of the intervals of the fractions.
    orbits
        Stable periodic orbits of one period of the base motion, from `stylobate.orbits.periodic_orbit`. Runs that
        converge to one of them end early; see "End converged runs early" on the page on ensembles.
    store, executor, resume, progress
        As in `run_sweep`.
    **options
        Arguments of all runs: tilt, tilt_rate (the components that do not vary), rtol, rules, strobes (by default 32,
        or half of the periods of a shorter run) … With `end_converged=True`, steady rolling in closed form under
        circular base motion also counts as a known orbit.

    Returns
    -------
    xarray.Dataset
        Of kind "basins", as `label_attractors` describes it: the runs with their `attractor`, and the table of
        attractors with the fraction of runs that reach each.

    Raises
    ------
    ParameterError
        If an argument is out of range, a name in `over` is not an initial condition, a grid does not have two names
        with at least one value each, or runs are too short for the stroboscopic samples.

    Examples
    --------
    >>> import stylobate as sb
    >>> model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    >>> found = sb.studies.basins(model, over={"tilt_x": [-0.06, 0.06, 0.12], "tilt_y": [0.0, 0.03]}, duration=200.0)
    >>> found["attractor_name"].values.tolist(), found["count"].values.tolist()
    (['at rest', 'overturned'], [4, 2])
    """
    require_starts("over", over)
    if orbits:
        options["known_orbits"] = [known_orbit_of(orbit, model, motion or BASE_AT_REST) for orbit in orbits]
    if count is not None:
        ranges: Mapping[str, Sequence[float]] = over  # type: ignore[assignment]  # the sweep refuses invalid ranges
        sweep = Sweep.random(
            model,
            motion,
            over=ranges,
            count=require_whole("count", count, least=1, most=MOST_RUNS),
            rng=rng,
            duration=duration,
            periods=periods,
            **options,
        )
    elif len(over) == _PLANE:
        require_values("over", over)
        sweep = Sweep.grid(model, motion, over=over, duration=duration, periods=periods, **options)
    else:
        message = f"over must name two starts with their values, or give count for random ones; got {', '.join(over)}"
        raise ParameterError(message)
    label = partial(_basins_of, model=model, motion=motion, rules=attractor_rules, confidence=confidence)
    sweep = with_strobes(sweep, options.get("strobes"))
    return labelled_sweep(sweep, label, store=store, executor=executor, resume=resume, progress=progress)


def _basins_of(
    runs: xr.Dataset, model: Model, motion: BaseMotion | None, rules: AttractorRules | None, confidence: float
) -> xr.Dataset:
    labelled = label_attractors(runs, model, motion, rules=rules, confidence=confidence)
    return labelled.assign_attrs(kind="basins")
