"""Frequency response with exact periodic orbits, beside that of theory."""

import json
from collections.abc import Callable, Iterator

import numpy as np
import xarray as xr

from stylobate.errors import NoOrbitError, ParameterError, UnsupportedError
from stylobate.models import Model
from stylobate.motions import BaseMotion
from stylobate.orbits import Branch, Kind, PeriodicOrbit, StepControl, continue_branch, switch_branch
from stylobate.spec import provenance_of_run
from stylobate.studies.first_orbit import first_orbit
from stylobate.studies.response_curves import response_curves

_AVERAGED_POINTS = 400
_BORN = (Kind.PITCHFORK, Kind.PERIOD_DOUBLING, Kind.BRANCH_POINT)


def exact_response(
    model: Model,
    motion: BaseMotion,
    *,
    angular_frequency: tuple[float, float],
    orbit: PeriodicOrbit | None = None,
    sense: int | None = None,
    generations: int = 1,
    control: StepControl | None = None,
    progress: Callable[[float], None] | None = None,
) -> xr.Dataset:
    """Return exact rolling against the frequency of the base motion: tilts, phase, stability, bifurcations.

    Parameters
    ----------
    model, motion
        The column and a harmonic base motion; its acceleration is kept, its frequency replaced.
    angular_frequency
        Lowest and highest frequency [rad/s].
    orbit
        Where to begin; by default rolling by theory, at the highest frequency at which it is found.
    sense
        Of rolling, +1 or −1, for the orbit by theory.
    generations
        How many times families that are born at pitchforks and period doublings are followed: 0 for none.
    control
        Length of steps along the families.
    progress
        Called with the frequency of each new orbit.

    Returns
    -------
    xarray.Dataset
        Over `point`: `angular_frequency`, `mean_tilt`, `least_tilt`, `largest_tilt`, `phase` [rad], `stable`,
        multipliers, and `branch`, the family of each. Over `branch_index`: name, length in periods, ends. Over
        `bifurcation`: kind, frequency, branch, mean tilt, coefficient, and `bifurcation_soft` (1 soft, 0 hard, −1 not
        decided). Where theory knows rolling, its curves over `averaged_frequency`, exact for circular motion.

    Raises
    ------
    ParameterError
        If the range is none.
    NoOrbitError
        If no orbit was found to begin with.

    Examples
    --------
    >>> import stylobate as sb
    >>> model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    >>> motion = sb.Harmonic.straight(acceleration=0.04, angular_frequency=1.0)
    >>> curves = sb.studies.exact_response(model, motion, angular_frequency=(1.0, 3.0), generations=0)
    >>> curves["bifurcation_kind"].item(), round(curves["bifurcation_angular_frequency"].item(), 6)
    ('pitchfork', 1.087672)
    """
    low, high = (float(number) for number in angular_frequency)
    if not 0.0 < low < high < np.inf:
        message = f"angular_frequency must rise from above zero, got {low!r} to {high!r} rad/s"
        raise ParameterError(message)
    if orbit is None:
        orbit = first_orbit(model, motion, (low, high), sense)
    main = continue_branch(orbit, "angular_frequency", bounds=(low, high), control=control, progress=progress)
    families = [("rolling" if orbit.turns != 0.0 else "periodic", main)]
    families += list(_born(main, (low, high), generations, control))
    found = _joined(families)
    found = found.assign(_by_theory(model, motion, low, high, 1 if orbit.turns >= 0.0 else -1))
    return found.assign_attrs(
        kind="exact response",
        sense=float(orbit.turns),
        provenance=json.dumps(provenance_of_run(model, orbit.motion)),
    )


def _born(
    branch: Branch, bounds: tuple[float, float], generations: int, control: StepControl | None
) -> Iterator[tuple[str, Branch]]:
    """Follow what is born on a branch, once for each pair of mirror images."""
    if generations <= 0:
        return
    for one in branch.bifurcations:
        if one.kind not in _BORN:
            continue
        try:
            family = switch_branch(one, bounds=bounds, control=control)
        except NoOrbitError:
            continue
        periods = family.path[0].family.periods
        name = "asymmetric" if one.kind is Kind.PITCHFORK else f"period {periods}"
        yield f"{name}, from {one.parameter:.6g} rad/s", family
        yield from _born(family, bounds, generations - 1, control)


def _joined(families: list[tuple[str, Branch]]) -> xr.Dataset:
    points, tables = [], []
    for index, (_, branch) in enumerate(families):
        data = branch.points
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
    joined["bifurcation_angular_frequency"].attrs["units"] = "rad s-1"
    joined["angular_frequency"].attrs["units"] = "rad s-1"
    return joined.assign(
        branch_name=("branch_index", [name for name, _ in families]),
        branch_periods=("branch_index", [branch.path[0].family.periods for _, branch in families]),
        branch_end=("branch_index", ["; ".join(end.value for end in branch.ends) for _, branch in families]),
    )


def _by_theory(model: Model, motion: BaseMotion, low: float, high: float, sense: int) -> dict[str, object]:
    """Return the curves of theory for rolling in this sense, nothing where it has none."""
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
