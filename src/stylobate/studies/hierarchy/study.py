"""Comparison of all models of the hierarchy in one case: the effect of each assumption."""

import json
import math
from collections.abc import Mapping, Sequence
from typing import Any, Unpack

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.base_motions import BASE_AT_REST, BaseMotion
from stylobate.column import Column
from stylobate.errors import ParameterError, as_numbers, require_finite, require_positive, require_vector, require_whole
from stylobate.models import Rolling
from stylobate.models.declared import dissipation_of
from stylobate.models.model import require_column
from stylobate.provenance import provenance_of_run
from stylobate.results import Response
from stylobate.results.outcomes import outcome_attributes
from stylobate.run_arguments import Accuracy
from stylobate.studies.hierarchy.models import Case, HierarchyArguments
from stylobate.studies.hierarchy.runs import Course, Floats, largest_distance

# Number of times at which models are compared, unless the user requests histories of another length.
_TIMES = 2001

_OF_SIMULATE = tuple(Accuracy.__annotations__)


def model_hierarchy(
    column: Column,
    motion: BaseMotion | None = None,
    *,
    tilt: Sequence[float] = (0.0, 0.0),
    tilt_rate: Sequence[float] = (0.0, 0.0),
    spin: float = 0.0,
    duration: float,
    slenderness: npt.ArrayLike | None = None,
    friction_coefficient: float | None = None,
    reference: str = Rolling.name,
    samples: int | None = None,
    **arguments: Unpack[HierarchyArguments],
) -> xr.Dataset:
    """Run one case with every model of the hierarchy and compare the results.

    The models are slender, slender rolling, wobbling and rolling; if initial conditions and base motion are planar,
    also planar rocking.

    Parameters
    ----------
    column, motion
        The column and its base motion; None is a base at rest.
    tilt, tilt_rate, spin
        Initial conditions [rad], [rad/s], [rad/s]; models without spin ignore `spin`.
    duration
        Duration of each run [s].
    slenderness
        Slendernesses to which the case is scaled, shape (n,): tilt, tilt rate and base motion proportional to c, radius
        by `Column.with_slenderness`. For small tilts all these cases are equivalent.
    friction_coefficient
        Friction coefficient of the contact; runs warn if they need more.
    reference
        The model from which differences are computed.
    samples
        Number of samples of the histories in the result; none by default.
    **arguments
        Dissipation parameters: damping η of all models; spin_damping ζ of the models with free axial rotation. Models
        at finite tilt also have rolling_resistance, a lever arm in radii, and restitution e at a passage near the
        vertical, by default Housner's in planar rocking and 1 elsewhere. Arguments of `simulate`: rtol, atol,
        tilt_limit, rest_energy, max_steps, rules.

    Returns
    -------
    xarray.Dataset
        Of kind "model hierarchy", over `model`, and over `slenderness` if it is given: `outcome`, `uncertain`,
        `peak_tilt`, `mean_late_tilt`, `mean_late_spin` (over the last fifth of the run; NaN if the run ended before, or
        has no spin), peak contact demands, `minimum_normal_force` over weight, `steps`, `warnings`; differences from
        the `reference`; `deviation` (model, other_model), the maximum distance of the tilt vectors while both runs last
        [rad]. Two or more slendernesses also give `deviation_order`, the power of c with which `deviation`/c falls;
        `samples` also gives the histories `amplitude` [rad] and `spin` [rad/s] over `time`.

    Raises
    ------
    ParameterError
        If an argument is out of range, or there is no such model.

    Examples
    --------
    >>> import stylobate as sb
    >>> column = sb.Column.dimensionless(slenderness=0.1)
    >>> motion = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8)
    >>> start = {"tilt": (0.04, 0.0), "tilt_rate": (0.0, 0.07), "duration": 80.0}
    >>> found = sb.studies.model_hierarchy(column, motion, damping=0.1, spin_damping=0.1, **start)
    >>> print((found["mean_late_tilt"] / 0.1).round(3).to_series().to_string(header=False))
    slender            0.388
    slender rolling    0.193
    wobbling           0.388
    rolling            0.193
    """
    shared = dissipation_of(Rolling)
    strange = [name for name in arguments if name not in (*_OF_SIMULATE, *shared)]
    if strange:
        known = ", ".join((*shared, *_OF_SIMULATE))
        message = f"{strange[0]} is no argument of model_hierarchy. Besides those of its signature use {known}."
        raise ParameterError(message)
    moved = BASE_AT_REST if motion is None else motion
    given: dict[str, Any] = {**arguments}
    dissipation = {name: given.pop(name) for name in shared if name in given}
    case = _case(column, moved, dissipation, tilt, tilt_rate, spin)
    duration = require_positive("duration", duration, "s")
    models = [model.name for model in case.models()]
    if reference not in models:
        message = f"reference must be a model of this case, {', '.join(models)}; got {reference!r}"
        raise ParameterError(message)
    time = np.linspace(0.0, duration, _TIMES if samples is None else require_whole("samples", samples, least=2))

    def compared(one: Case) -> xr.Dataset:
        runs = [one.run(model, duration, friction_coefficient, given) for model in one.models()]
        return _compared(one, runs, time, duration)

    if slenderness is None:
        found = compared(case)
    else:
        scales = _slendernesses(slenderness)
        found = xr.concat([compared(one) for one in _scaled(case, scales)], dim="slenderness")
        found = found.assign_coords(slenderness=("slenderness", scales, {"units": "1", "long_name": "slenderness"}))
        found = _with_order(found) if scales.size > 1 else found
    found = _with_differences(found, reference)
    if samples is None:
        found = found.drop_vars(["amplitude", "spin", "time"])
    provenance = provenance_of_run(
        case.models()[models.index(reference)],
        moved,
        tilt=case.tilt,
        tilt_rate=case.tilt_rate,
        spin=case.spin,
        duration=duration,
        friction_coefficient=friction_coefficient,
        restitution=dissipation.get("restitution"),
        slenderness=None if slenderness is None else np.asarray(slenderness, dtype=float).tolist(),
        **{name: value for name, value in given.items() if name != "rules"},
    )
    attributes = {"kind": "model hierarchy", "reference": reference, "column_slenderness": column.slenderness}
    if friction_coefficient is not None:
        attributes["friction_coefficient"] = friction_coefficient
    return found.assign_attrs(**attributes, provenance=json.dumps(provenance))


def _case(
    column: Column,
    motion: BaseMotion,
    dissipation: Mapping[str, float | None],
    tilt: Sequence[float],
    tilt_rate: Sequence[float],
    spin: float,
) -> Case:
    require_column(column)
    if not isinstance(motion, BaseMotion):
        message = f"motion must be a base motion such as Harmonic.circular(...) or None, got {motion!r}"
        raise ParameterError(message)
    x, y = require_vector("tilt", tilt, 2, "rad")
    vx, vy = require_vector("tilt_rate", tilt_rate, 2, "rad/s")
    return Case(
        column=column,
        motion=motion,
        dissipation=dissipation,
        tilt=(x, y),
        tilt_rate=(vx, vy),
        spin=require_finite("spin", spin, "rad/s"),
    )


def _slendernesses(given: npt.ArrayLike) -> Floats:
    values = np.atleast_1d(np.asarray(as_numbers("slenderness", given), dtype=float))
    if values.ndim != 1 or not values.size or not np.all(np.isfinite(values) & (values > 0.0)):
        message = f"slenderness must be a list of positive numbers, got {given!r}"
        raise ParameterError(message)
    return values


def _scaled(case: Case, slendernesses: Floats) -> list[Case]:
    """Return the case at each slenderness; raise ParameterError if it would start beyond a tilt of π/2."""
    found = []
    for c in slendernesses:
        try:
            one = case.scaled_to(float(c))
        except ParameterError as error:
            message = f"the column cannot be scaled to slenderness {c:.6g}: {error}"
            raise ParameterError(message) from None
        found.append(one)
        if math.hypot(*one.tilt) >= 0.5 * math.pi:
            message = (
                f"tilt {case.tilt!r} rad at slenderness {case.column.slenderness:.6g} becomes "
                f"({one.tilt[0]:.6g}, {one.tilt[1]:.6g}) rad at slenderness {c:.6g}, and must be below π/2 in length. "
                "Scale to a smaller slenderness, or tilt less"
            )
            raise ParameterError(message)
    return found


_MEASURES = {
    "peak_tilt": ("rad", "peak tilt angle"),
    "mean_late_tilt": ("rad", "mean tilt angle over the last fifth of the run"),
    "mean_late_spin": ("rad s-1", "mean spin over the last fifth of the run"),
    "peak_friction_demand": ("1", "peak friction force over normal force"),
    "peak_pivoting_demand": ("1", "peak moment about the vertical over normal force and radius"),
    "minimum_normal_force": ("1", "minimum normal force over weight"),
    "decided_at": ("s", "time at which the outcome was decided"),
    "steps": ("1", "integration steps"),
}
_DIFFERENT = ("peak_tilt", "mean_late_tilt", "peak_friction_demand", "peak_pivoting_demand")


def _compared(case: Case, runs: Sequence[Response], time: Floats, duration: float) -> xr.Dataset:
    """Summarise the `runs` of all models of a case."""
    courses = [Course(run, duration) for run in runs]
    rows = [
        {**run.measures, "decided_at": run.decided_at, **course.late_means(case.motion)}
        for run, course in zip(runs, courses, strict=True)
    ]
    histories = [course.history(time) for course in courses]
    tilt = xr.DataArray([tilt for tilt, _ in histories], dims=("model", "time", "axis"))
    variables: dict[str, Any] = {
        name: ("model", [one.get(name, np.nan) for one in rows], {"units": units, "long_name": long_name})
        for name, (units, long_name) in _MEASURES.items()
    }
    models = [model.name for model in case.models()]
    deviation = [[largest_distance(one, other) for other in tilt] for one in tilt]
    return xr.Dataset(
        {
            "outcome": ("model", np.array([run.outcome for run in runs], np.int8), outcome_attributes()),
            "uncertain": ("model", [run.uncertain for run in runs], {"long_name": "uncertain"}),
            **variables,
            "warnings": ("model", ["; ".join(run.warnings) for run in runs], {"long_name": "warnings"}),
            "deviation": (
                ("model", "other_model"),
                deviation,
                {"units": "rad", "long_name": "maximum distance of the tilt vectors"},
            ),
            "amplitude": (
                ("model", "time"),
                np.hypot(tilt[..., 0], tilt[..., 1]).data,
                {"units": "rad", "long_name": "tilt angle"},
            ),
            "spin": (("model", "time"), [spin for _, spin in histories], {"units": "rad s-1", "long_name": "spin"}),
        },
        coords={"model": models, "other_model": models, "time": ("time", time, {"units": "s", "long_name": "time"})},
    )


def _with_order(found: xr.Dataset) -> xr.Dataset:
    """Add the power of c with which the deviation over c falls, by least squares; NaN without a deviation."""
    c = found["slenderness"].to_numpy()
    relative = (found["deviation"] / found["slenderness"]).transpose("slenderness", ...).to_numpy()
    with np.errstate(divide="ignore", invalid="ignore"):
        logarithm = np.log(np.where(relative > 0.0, relative, np.nan))
    offset = np.log(c) - np.log(c).mean()
    slope = (offset[:, None, None] * logarithm).sum(axis=0) / (offset**2).sum()
    about = {"units": "1", "long_name": "power of the slenderness with which the deviation over it falls"}
    return found.assign(deviation_order=(("model", "other_model"), slope, about))


def _with_differences(found: xr.Dataset, reference: str) -> xr.Dataset:
    base = found.sel(model=reference)
    added = {}
    for name in _DIFFERENT:
        difference = found[name] - base[name].drop_vars("model")
        about = {**found[name].attrs, "long_name": f"{found[name].attrs['long_name']}, less that of {reference}"}
        added[f"{name}_difference"] = difference.assign_attrs(about)
    return found.assign(added)
