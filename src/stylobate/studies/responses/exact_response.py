"""Frequency response with exact periodic orbits, compared with theory."""

import json
from collections.abc import Sequence

import numpy as np
import xarray as xr

from stylobate.base_motions import BaseMotion
from stylobate.engine import with_parameters
from stylobate.engine.parameters import present_value
from stylobate.errors import Interrupted, ParameterError, UnsupportedError, require_whole
from stylobate.models import Model
from stylobate.orbits import PeriodicOrbit, StepControl, continue_branch
from stylobate.orbits.orbit import require_orbit, require_subject
from stylobate.progress import Progress, at_value, shows_progress
from stylobate.provenance import provenance_of_run
from stylobate.studies.ranges import require_frequencies
from stylobate.studies.responses.first_orbit import first_orbit
from stylobate.studies.responses.orbit_families import Followed, between_bifurcations, born
from stylobate.studies.responses.response_curves import response_curves

_AVERAGED_POINTS = 400
# Two base motions, or two models, are equal if their numbers agree to this fraction of the largest number.
_SAME, _PHASES = 1e-9, 16
_BIFURCATION_UNITS = {"angular_frequency": "rad s-1", "mean_tilt": "rad", "peak_tilt": "rad"}


@shows_progress("response", at_value)
def exact_response(
    model: Model,
    motion: BaseMotion,
    *,
    angular_frequency: tuple[float, float],
    orbit: PeriodicOrbit | None = None,
    sense: int | None = None,
    generations: int = 1,
    control: StepControl | None = None,
    progress: Progress = None,
) -> xr.Dataset:
    """Compute the exact frequency response of rolling: tilts, phase, stability and bifurcations.

    Parameters
    ----------
    model, motion
        The column and a harmonic base motion; its acceleration is kept, its frequency replaced.
    angular_frequency
        Lowest and highest frequency [rad/s].
    orbit
        Orbit from which to begin, of this model under this motion at a frequency within the range. By default rolling
        by theory, at the highest frequency at which it is found.
    sense
        Sense of rolling, +1 or −1, for the orbit by theory.
    generations
        Number of successive switches to branches that begin at pitchforks and period doublings; 0 for none.
    control
        Length of steps along the branches.
    progress
        A function that is called with the frequency of each new orbit; a bar by default, False for none.

    Returns
    -------
    xarray.Dataset
        Over `point`: `angular_frequency`, `mean_tilt`, `minimum_tilt`, `peak_tilt`, `phase` [rad], `stable` (of a
        planar orbit: within its plane; without damping: neutrally), multipliers, and the `branch` of each. A
        bifurcation is a point of its branch, and is not marked stable. Over `branch_index`: name, length in periods,
        ends. Over `bifurcation`: kind, frequency, branch, mean tilt, coefficient, and `bifurcation_supercritical` (1
        supercritical, 0 subcritical, −1 not decided). If theory has a solution, its curves over `averaged_frequency`,
        exact for circular motion.

    Raises
    ------
    ParameterError
        If the range is invalid, or `orbit` belongs to another model or base motion.
    NoOrbitError
        If no orbit was found to begin with.
    Interrupted
        On Ctrl-C; `partial` has the branches so far.

    Examples
    --------
    >>> import stylobate as sb
    >>> model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    >>> motion = sb.Harmonic.straight(acceleration=0.04, angular_frequency=1.0)
    >>> curves = sb.studies.exact_response(model, motion, angular_frequency=(1.0, 3.0), generations=0)
    >>> curves["bifurcation_kind"].item(), round(curves["bifurcation_angular_frequency"].item(), 6)
    ('pitchfork', 1.087672)
    """
    low, high = require_frequencies(angular_frequency)
    generations = require_whole("generations", generations, least=0)
    require_subject(model, motion)
    if orbit is None:
        orbit = first_orbit(model, motion, (low, high), sense)
    else:
        _require_of(orbit, model, motion, (low, high))
    families, turns, planar = list[Followed](), orbit.turns, orbit.planar
    provenance = json.dumps(provenance_of_run(model, orbit.motion))

    def result() -> xr.Dataset:
        found = _joined(families)
        if turns != 0.0:
            found = found.assign(_by_theory(model, motion, low, high, 1 if turns > 0.0 else -1))
        return found.assign_attrs(
            kind="exact response",
            sense=float(turns),
            planar=int(planar),
            friction=int(model.comes_to_rest),
            provenance=provenance,
        )

    name = "rolling" if turns != 0.0 else "periodic"
    try:
        main = continue_branch(orbit, "angular_frequency", bounds=(low, high), control=control, progress=progress)
        families.append(Followed(name, main))
        families += born(main, (low, high), generations, control, progress)  # one by one
    except KeyboardInterrupt as stop:
        if not families and isinstance(stop, Interrupted):
            families.append(Followed(name, stop.partial))
        if not families:
            raise
        message = "interrupted; `partial` has the branches so far"
        raise Interrupted(message, result()) from None
    return result()


def _require_of(orbit: PeriodicOrbit, model: Model, motion: BaseMotion, bounds: tuple[float, float]) -> None:
    """Raise ParameterError unless the orbit has this model and motion, with any frequency within the bounds."""
    require_orbit(orbit)
    numbers, own = ((*one.parameters, one.column.slenderness, one.time_scale) for one in (model, orbit.model))
    if type(orbit.model) is not type(model) or not np.allclose(own, numbers, rtol=_SAME, atol=0.0):
        message = f"orbit must be one of the model {model!r}, got one of {orbit.model!r}"
        raise ParameterError(message)
    frequency = present_value(orbit.model, orbit.motion, "angular_frequency")
    if not bounds[0] <= frequency <= bounds[1]:
        message = f"angular_frequency must enclose that of the orbit, {frequency!r} rad/s, got {bounds!r}"
        raise ParameterError(message)
    _, at = with_parameters(model, motion, angular_frequency=frequency)
    times = np.arange(_PHASES) / _PHASES * float(orbit.motion.period or 1.0)
    wanted, given = (one.acceleration(times) for one in (at, orbit.motion))
    if np.abs(wanted - given).max() > _SAME * np.abs(wanted).max():
        message = f"orbit must be an orbit under {motion!r} at any frequency, got one under {orbit.motion!r}"
        raise ParameterError(message)


def _joined(families: Sequence[Followed]) -> xr.Dataset:
    points, tables = [], []
    places = [one.parameter for family in families for one in family.branch.bifurcations]
    for index, family in enumerate(families):
        branch = between_bifurcations(family.branch)
        data = branch.points
        # At a bifurcation, only rounding decides.
        located = np.isin([point.value for point in branch.path], places)
        data["stable"] = data["stable"] & ~xr.DataArray(located, dims="point")
        table = data[[name for name in data.data_vars if str(name).startswith("bifurcation_")]]
        table = table.rename(bifurcation_parameter="bifurcation_angular_frequency")
        tables.append(table.assign(bifurcation_branch=("bifurcation", [index] * table.sizes["bifurcation"])))
        own = data.drop_vars([name for name in data.data_vars if str(name).startswith("bifurcation_")])
        points.append(own.assign(branch=("point", [index] * own.sizes["point"])))
    joined = xr.concat(
        points, dim="point", combine_attrs="drop", data_vars="minimal", coords="minimal", compat="equals"
    )
    bifurcations = xr.concat(
        tables, dim="bifurcation", combine_attrs="drop", data_vars="minimal", coords="minimal", compat="override"
    )
    for name, column in bifurcations.data_vars.items():
        joined[name] = ("bifurcation", column.to_numpy(), column.attrs)
    for name, variable in points[0].data_vars.items():
        joined[name].attrs.update(variable.attrs)
    for name, units in _BIFURCATION_UNITS.items():
        joined[f"bifurcation_{name}"].attrs["units"] = units
    joined["angular_frequency"].attrs["units"] = "rad s-1"
    return joined.assign(
        branch_name=("branch_index", [one.name for one in families]),
        branch_periods=("branch_index", [one.branch.path[0].family.periods for one in families]),
        branch_end=("branch_index", ["; ".join(end.value for end in one.branch.ends) for one in families]),
    )


def _by_theory(model: Model, motion: BaseMotion, low: float, high: float, sense: int) -> dict[str, object]:
    """Return the curves of theory for rolling in this sense; empty if there are none."""
    try:
        curves = response_curves(model, motion, angular_frequency=np.linspace(low, high, _AVERAGED_POINTS))
    except (UnsupportedError, ParameterError):
        return {}
    name = "anticlockwise" if sense > 0 else "clockwise"
    if name not in curves["sense"]:
        return {}
    own = curves.sel(sense=name)
    dims = ("averaged_branch", "averaged_frequency")
    return {
        "averaged_frequency": ("averaged_frequency", curves["angular_frequency"].to_numpy(), {"units": "rad s-1"}),
        "averaged_branch": ("averaged_branch", curves["branch"].to_numpy()),
        **{
            f"averaged_{field}": (dims, own[field].to_numpy(), own[field].attrs)
            for field in ("amplitude", "phase", "stable")
        },
        "averaged_critical_frequency": ((), float(own["critical_frequency"]), {"units": "rad s-1"}),
        "averaged_is_exact": ((), not curves.attrs["averaged"]),
    }
