"""Poincaré sections: states of columns once per period of the base motion."""

import json
import warnings
from typing import Unpack

import numpy as np
import xarray as xr

from stylobate.base_motions import BaseMotion
from stylobate.engine import simulate_ensemble
from stylobate.engine.ensembles.runs import ArrayLike
from stylobate.errors import EndedEarlyWarning, Outcome, ParameterError, UnsupportedError, require_whole
from stylobate.models import Model
from stylobate.orbits.orbit import require_subject
from stylobate.progress import Progress, shows_progress
from stylobate.results.outcomes import NOT_COMPUTED
from stylobate.run_arguments import Accuracy
from stylobate.text import plural

_FOLLOWED = ("outcome", "decided_at", "uncertain")


@shows_progress("Poincaré section")
def poincare_section(
    model: Model,
    motion: BaseMotion,
    *,
    tilt: ArrayLike,
    tilt_rate: ArrayLike = (0.0, 0.0),
    periods: int = 1000,
    skip: int = 200,
    threads: int | None = None,
    progress: Progress = None,
    **options: Unpack[Accuracy],
) -> xr.Dataset:
    """Compute Poincaré sections: states once per period, when the base motion has the phase of t = 0.

    A periodic orbit gives as many points as it has periods, a quasi-periodic motion fills closed curves, and a chaotic
    motion a set of fractal dimension.

    Parameters
    ----------
    model, motion
        The column and its base motion, periodic from t = 0.
    tilt, tilt_rate
        Initial conditions [rad], [rad/s]: shape (2,), (n, 2), or DataArrays, as in `simulate_ensemble`.
    periods
        Duration of the runs in periods.
    skip
        Number of periods at the beginning to leave out, while the motion settles.
    threads, progress
        As in `simulate_ensemble`.
    **options
        Accuracy of the runs as in `simulate_ensemble`; by default `rtol` is 1e-10, and `max_steps` grows with the
        number of periods.

    Returns
    -------
    xarray.Dataset
        Of kind "Poincaré section", over `run` (or the dimensions of the initial conditions) and `period`, the number of
        periods since t = 0, from `skip` to `periods`: `section_tilt` [rad] and `section_tilt_rate` [rad/s] along
        `axis`, NaN after a column has overturned or come to rest for good. For each run also `outcome`, `decided_at`
        [s], `uncertain`.

    Warns
    -----
    EndedEarlyWarning
        If columns overturned, or their runs ended early in another way; the message names outcome and time.

    Raises
    ------
    ParameterError
        If an argument is out of range.
    UnsupportedError
        If the base motion is not periodic from t = 0.

    Examples
    --------
    >>> import stylobate as sb
    >>> model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    >>> motion = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8)
    >>> start = sb.studies.steady_start(model, motion)
    >>> section = sb.studies.poincare_section(model, motion, **start, periods=20, skip=10)
    >>> bool(section["section_tilt"].std("period").max() < 1e-8)
    True
    """
    require_subject(model, motion)
    skip = require_whole("skip", skip, least=0)
    periods = require_whole("periods", periods, least=1)
    if skip > periods:
        raise ParameterError(f"skip must be at most periods ({periods}), got {skip}")
    if motion.period is None or motion.breaks:
        raise UnsupportedError(
            f"poincare_section needs a base motion that is periodic from t = 0, without ramp or delay; got {motion!r}"
        )
    points = periods - skip + 1
    # Samples at equal times, one per period, without those of the skipped periods. Stroboscopic samples have phase
    # zero of the base motion, which is t = 0 only for a start phase of zero.
    accuracy: Accuracy = {"rtol": 1e-10, "max_steps": _most_steps(periods), **options}
    runs = simulate_ensemble(
        model,
        motion,
        tilt=tilt,
        tilt_rate=tilt_rate,
        duration=periods * motion.period,
        samples=periods + 1,
        threads=threads,
        progress=progress,
        **accuracy,
    )
    late = runs.isel(sample=slice(periods + 1 - points, None)).rename(sample="period")
    names = {"sampled_tilt": "section_tilt", "sampled_tilt_rate": "section_tilt_rate"}
    section = late[[*names, *_FOLLOWED]].rename(names).assign_coords(period=np.arange(skip, periods + 1))
    section["period"].attrs = {"long_name": "periods of the base motion since t = 0", "units": "1"}
    section["section_tilt"].attrs["long_name"] = "tilt vector once per period"
    section["section_tilt_rate"].attrs["long_name"] = "rate of the tilt vector once per period"
    remark_on_ends(runs, "poincare_section", "Their states are NaN afterwards. Start on a motion that lasts")
    given = json.loads(runs.attrs["provenance"])
    provenance = {**given, "periods": periods, "skip": skip}
    return section.assign_attrs(kind="Poincaré section", provenance=json.dumps(provenance))


_LASTING = {Outcome.AT_REST, Outcome.ROCKING, Outcome.ROLLING, Outcome.MODULATED, Outcome.STILL_MOVING}
_LASTING |= {Outcome.SURVIVED, Outcome.SLID, Outcome.PERIODIC, Outcome.APERIODIC}


def remark_on_ends(runs: xr.Dataset, where: str, remedy: str) -> None:
    """Warn of runs that ended early: how many had each outcome, and when the first one ended [s]."""
    outcomes, times = runs["outcome"].to_numpy().ravel(), runs["end_time"].to_numpy().ravel()
    parts = []
    for code in np.unique(outcomes[~np.isin(outcomes, [*_LASTING, NOT_COMPUTED])]):
        of = outcomes == code
        when = f"{'at' if of.sum() == 1 else 'the first at'} t = {times[of].min():.4g} s"
        parts.append(f"{of.sum()} {Outcome(int(code)).label}, {when}")
    if parts:
        message = f"{where}: runs ended early (got {'; '.join(parts)}, of {plural(outcomes.size, 'run')}). {remedy}."
        warnings.warn(message, EndedEarlyWarning, stacklevel=4)


# Maximum steps per period; a column that rocks near rest needs many.
_STEPS_A_PERIOD, _LEAST_STEPS = 1000, 200_000


def _most_steps(periods: int) -> int:
    return max(_LEAST_STEPS, _STEPS_A_PERIOD * periods)
