"""Overturning maps: outcomes over any two parameters."""

from collections.abc import Mapping
from pathlib import Path
from typing import Unpack

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.base_motions import BaseMotion
from stylobate.engine.parameters import own_numbers
from stylobate.errors import Outcome, ParameterError
from stylobate.models import Model
from stylobate.progress import Progress, shows_progress
from stylobate.results.outcomes import NOT_COMPUTED
from stylobate.run_arguments import RunOptions
from stylobate.studies.checks import require_values
from stylobate.studies.sweeps import Executor, Sweep
from stylobate.studies.sweeps.labelled import labelled_sweep

_PLANE = 2


@shows_progress("map")
def overturning_map(
    model: Model,
    motion: BaseMotion | None = None,
    *,
    over: Mapping[str, npt.ArrayLike],
    duration: float | None = None,
    periods: float | None = None,
    store: str | Path | None = None,
    executor: Executor | None = None,
    resume: bool = False,
    progress: Progress = None,
    **options: Unpack[RunOptions],
) -> xr.Dataset:
    """Compute the outcome of a column over two parameters, from rest or a given initial state.

    Parameters
    ----------
    model, motion
        The column and its base motion. The quantities in `over` replace their values.
    over
        Two names with their values: parameters of the column, the model or the base motion, such as
        angular_frequency [rad/s], acceleration [m/s²], start_phase [rad], damping, size; or components of the initial
        condition, tilt_x, tilt_y [rad], tilt_rate_x, tilt_rate_y [rad/s].
    duration, periods
        Duration of each run [s], or its number of periods of the base motion.
    store, executor, resume, progress
        As in `run_sweep`.
    **options
        Arguments of all runs: tilt [rad] and tilt_rate [rad/s] (initial condition, by default at rest), rtol, rules …
        With `end_converged=True` runs on a circularly moving base end early once they have converged to steady rolling,
        which the model must state in closed form; see "End converged runs early" on the page on ensembles.

    Returns
    -------
    xarray.Dataset
        Of kind "overturning map". Over the two names: `outcome`, `decided_at`, `uncertain` and all variables of
        `simulate_ensemble`. Over `outcome_name`: `count` and `share` of the runs computed. `computed` counts the runs.

    Raises
    ------
    ParameterError
        If `over` does not have two names with at least one value each, or an argument is out of range.

    Examples
    --------
    >>> import stylobate as sb
    >>> model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    >>> motion = sb.Harmonic.circular(acceleration=0.15, angular_frequency=1.0)
    >>> over = {"angular_frequency": [0.5, 6.0], "acceleration": [0.09, 0.15]}
    >>> found = sb.studies.overturning_map(model, motion, over=over, periods=30.0)
    >>> found["share"].sel(outcome_name=["at rest", "overturned"]).values
    array([0.5 , 0.25])
    """
    if not isinstance(over, Mapping) or len(over) != _PLANE:
        message = f'over must name two parameters, such as "angular_frequency" and "acceleration"; got {over!r}'
        raise ParameterError(message)
    require_values("over", over, own_numbers(model, motion))
    sweep = Sweep.grid(model, motion, over=over, duration=duration, periods=periods, **options)
    return labelled_sweep(sweep, outcome_shares, store=store, executor=executor, resume=resume, progress=progress)


def outcome_shares(runs: xr.Dataset) -> xr.Dataset:
    """Return `runs` as an overturning map: with the count and share of each outcome."""
    codes = runs["outcome"].to_numpy()
    count = np.array([np.count_nonzero(codes == outcome) for outcome in Outcome], dtype=np.int64)
    computed = int(np.count_nonzero(codes != NOT_COMPUTED))
    return runs.assign(
        count=("outcome_name", count, {"units": "1", "long_name": "runs with this outcome"}),
        share=("outcome_name", count / max(computed, 1), {"units": "1", "long_name": "share of the runs computed"}),
        computed=((), computed, {"units": "1", "long_name": "runs computed"}),
        outcome_name=np.array([outcome.label for outcome in Outcome]),
    ).assign_attrs(kind="overturning map")
