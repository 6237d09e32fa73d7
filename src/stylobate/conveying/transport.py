"""Mean transport velocity and mean rate of rotation of a column on a vibrating base."""

from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Unpack

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.base_motions import BASE_AT_REST, BaseMotion
from stylobate.conveying.contact_maps import contact_classes, lands_flat, remark_on_knife_edge
from stylobate.engine.parameters import with_parameters
from stylobate.errors import Outcome, ParameterError, UnsupportedError, require_whole
from stylobate.models import Model
from stylobate.results import OutcomeRules
from stylobate.results.outcomes import NOT_COMPUTED
from stylobate.studies.checks import require_values
from stylobate.studies.sweeps import Executor, Sweep
from stylobate.studies.sweeps.computing import Progress
from stylobate.studies.sweeps.labelled import labelled_sweep
from stylobate.studies.sweeps.quantities import OF_A_RUN
from stylobate.studies.sweeps.recipe import RunOptions

_MOST_NAMES = 2


def drift(
    model: Model,
    motion: BaseMotion,
    *,
    over: Mapping[str, npt.ArrayLike],
    periods: float = 60.0,
    late: int = 20,
    store: str | Path | None = None,
    executor: Executor | None = None,
    resume: bool = False,
    progress: Progress | None = None,
    **options: Unpack[RunOptions],
) -> xr.Dataset:
    """Compute the mean transport velocity of a column on a vibrating base, and its mean rate of rotation.

    Both are means over a whole number of last periods of the base motion.

    Parameters
    ----------
    model
        A model that changes between kinds of contact, `Sliding`.
    motion
        A periodic base motion, such as `Harmonic.oblique`.
    over
        One or two names with their values, as for `overturning_map`.
    periods
        Duration of each run in periods of its base motion.
    late
        Number of last periods over which the means are taken.
    store, executor, resume, progress, **options
        As for `overturning_map`; `late` sets the `rules`.

    Returns
    -------
    xarray.Dataset
        Of kind "drift": the runs over the names, with `mean_velocity` (axis) and `transport_speed` [m/s],
        `mean_twist_rate` [rad/s], `contact_class`, `throw_number` and all variables of ensembles. Velocities are NaN if
        the motion ended early, for example by overturning, and 0 if the column came to permanent rest. The mean
        velocity of a column that accelerates down a slope depends on the number of periods.

    Raises
    ------
    ParameterError
        If `over` does not have one or two names, `periods` does not exceed `late`, or an argument is out of range.
    UnsupportedError
        If the model does not change between kinds of contact, or the base motion has no period.

    Examples
    --------
    >>> import stylobate as sb
    >>> block = sb.Column.solid(radius=1.5, height=2.0, density=1000.0)
    >>> sloping = sb.Sliding(block, friction_coefficient=0.2, incline=0.1)
    >>> shaking = sb.Harmonic.straight(acceleration=1.0, angular_frequency=3.0)
    >>> found = sb.conveying.drift(sloping, shaking, over={"acceleration": [1.0, 3.0]}, periods=30, late=10)
    >>> found["mean_velocity"].sel(axis="x").values.round(3).tolist()    # down the slope
    [0.0, 0.388]
    """
    require_conveyor(model, motion, "drift", varied=over)
    if not isinstance(over, Mapping) or not 1 <= len(over) <= _MOST_NAMES:
        message = f'over must name one or two parameters, such as "friction_coefficient"; got {over!r}'
        raise ParameterError(message)
    late = require_whole("late", late, least=1)
    if not periods >= late + 1:
        message = f"periods must be at least one more than late, which is {late}; got {periods!r}"
        raise ParameterError(message)
    require_values("over", over)
    remark_on_knife_edge("over", model, over)
    options["rules"] = OutcomeRules(periods=late)
    sweep = Sweep.grid(model, motion, over=over, periods=periods, **options)

    def label(runs: xr.Dataset) -> xr.Dataset:
        return drift_of_runs(runs, model, motion)

    return labelled_sweep(sweep, label, store=store, executor=executor, resume=resume, progress=progress)


def require_conveyor(model: Model, motion: BaseMotion, study: str, *, varied: Collection[str] = ()) -> None:
    """Raise UnsupportedError unless the contact of the model changes and the base motion has a period."""
    if not model.switches:
        message = f"model {model.name} assumes permanent contact without slip. A {study} needs Sliding(column)."
        raise UnsupportedError(message)
    if not isinstance(motion, BaseMotion) or (motion.period is None and "angular_frequency" not in varied):
        got = "a base at rest" if motion in (None, BASE_AT_REST) else repr(motion)
        message = f"a {study} needs a periodic base motion, such as an oblique one; got {got}"
        raise UnsupportedError(message)


def throw_number_of(model: Model, motion: BaseMotion) -> float:
    """Compute the throw number: the peak downward acceleration of the base over gravity along its normal."""
    low, _ = motion.vertical_range(0.0)
    return -low / (model.column.gravity * (1.0 + model.slope[2]))


def drift_of_runs(runs: xr.Dataset, model: Model, motion: BaseMotion) -> xr.Dataset:
    """Convert `runs` of this `model` and `motion` to a drift: add speeds, classes and throw numbers."""
    # A run at permanent rest ends before its last periods: its mean velocity is zero.
    stands = (runs["outcome"] == Outcome.AT_REST) & runs["mean_twist_rate"].isnull()
    velocity = runs["mean_velocity"].where(~stands, 0.0).assign_attrs(runs["mean_velocity"].attrs)
    turning = runs["mean_twist_rate"].where(~stands, 0.0).assign_attrs(runs["mean_twist_rate"].attrs)
    speed = (velocity**2).sum("axis", skipna=False) ** 0.5
    return runs.assign(
        mean_velocity=velocity,
        mean_twist_rate=turning,
        transport_speed=speed.assign_attrs(units="m s-1", long_name="mean transport speed"),
        contact_class=contact_classes(runs),
        lands_flat=lands_flat(runs),
        throw_number=_throw_numbers(runs, model, motion),
        computed=((), int((runs["outcome"] != NOT_COMPUTED).sum()), {"units": "1", "long_name": "runs computed"}),
    ).assign_attrs(kind="drift")


def _throw_numbers(runs: xr.Dataset, model: Model, motion: BaseMotion) -> xr.DataArray:
    """Return the throw number of each run."""
    names = [str(dim) for dim in runs["outcome"].dims]
    values = np.empty(runs["outcome"].shape)
    for place in np.ndindex(*values.shape):
        chosen = {
            name: float(runs[name].to_numpy()[index])
            for name, index in zip(names, place, strict=True)
            if name not in OF_A_RUN
        }
        values[place] = throw_number_of(*with_parameters(model, motion, **chosen))
    return xr.DataArray(values, dims=names, attrs={"units": "1", "long_name": "throw number"})
