"""Exact response of a column to its base motion: branches of periodic orbits over the frequency, with bifurcations.

`stylobate response --exact` shows them.
"""

import json
import logging
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
import xarray as xr

from stylobate.base_motions import BaseMotion
from stylobate.base_motions.harmonic import as_harmonic
from stylobate.engine import with_parameters
from stylobate.engine.flow.integration import FlowStatus
from stylobate.engine.parameters import present_value
from stylobate.errors import Interrupted, NoOrbitError, ParameterError, UnsupportedError, require_whole
from stylobate.models import Model
from stylobate.orbits import (
    Bifurcation,
    BifurcationKind,
    Branch,
    BranchEnd,
    PeriodicOrbit,
    StepControl,
    continue_branch,
    periodic_orbit,
    switch_branch,
)
from stylobate.orbits.arclength import Family, Point, corrected
from stylobate.orbits.bifurcations import orbit_at
from stylobate.orbits.orbit import require_orbit, require_subject
from stylobate.orbits.shooting import arcs_of, shots
from stylobate.progress import Progress, at_value, shows_progress
from stylobate.provenance import provenance_of_run
from stylobate.results.outcomes import LOSSES, stability_of
from stylobate.results.tables import ResultTable
from stylobate.studies.checks import require_frequencies
from stylobate.studies.responses.response_curves import RESPONSE, response_curves
from stylobate.studies.study import analysis

_log = logging.getLogger("stylobate")

_TRIES = 24
# Start of the message of a search without a guess.
_ASKED = "guess must be given: "


def first_orbit(
    model: Model, motion: BaseMotion, angular_frequency: tuple[float, float], sense: int | None
) -> PeriodicOrbit:
    """Find a rolling orbit from theory, at the highest frequency of the range [rad/s] at which the search succeeds.

    Raises
    ------
    NoOrbitError
        If no orbit is found at the frequencies that were tried.
    UnsupportedError
        If theory has no rolling of this model under this motion.
    """
    low, high = angular_frequency
    reason: Exception | None = None
    for frequency in np.geomspace(high, max(low, 1e-3 * high), _TRIES):
        _log.info("searching for a first orbit at %.4g rad/s", frequency)
        changed = with_parameters(model, motion, angular_frequency=float(frequency))
        try:
            return periodic_orbit(*changed, sense=sense)
        except NoOrbitError as error:
            reason = error
        except UnsupportedError as error:
            reason_given = _unknown(model, motion) if str(error).startswith("guess must be given") else str(error)
            raise UnsupportedError(f"no orbit is known to begin with: {reason_given}") from None
    raise NoOrbitError(
        f"no orbit was found between {low!r} and {high!r} rad/s: {_sentence(reason)}. Widen the range, or "
        "increase the acceleration"
    )


def _unknown(model: Model, motion: BaseMotion) -> str:
    """Describe the model and motion without rolling in theory, and the remedy, without the long repr of a motion."""
    harmonic = as_harmonic(motion)
    if harmonic is None:
        under = f"under {type(motion).__name__} motion"
    else:
        under = "with a vertical amplitude" if harmonic.amplitude[2] != 0.0 else "under horizontal motion"
    return (
        f"theory has no steady rolling of this {model.name} model {under}; give orbits.periodic_orbit a run as guess, "
        "and follow its orbit by orbits.continue_branch"
    )


def _sentence(reason: Exception | None) -> str:
    return str(reason).removeprefix(_ASKED)


_BORN = (BifurcationKind.PITCHFORK, BifurcationKind.PERIOD_DOUBLING, BifurcationKind.BRANCH_POINT)
# Two orbits are related by symmetry if their tilts agree to this fraction of c, and the sums of their multipliers to
# this relative tolerance. Orbits are known much better, and different orbits differ by much more.
_ALIKE, _ALIKE_MULTIPLIERS = 1e-6, 1e-3
# Number of points of a known family that starts at a bifurcation.
_PROBED = 8


@dataclass(frozen=True, slots=True)
class Followed:
    """A family with its name."""

    name: str
    branch: Branch


def born(
    branch: Branch,
    bounds: tuple[float, float],
    generations: int,
    control: StepControl | None,
    progress: Progress = None,
) -> Iterator[Followed]:
    """Continue the bifurcating branches of a branch; a pair related by symmetry, or by both ends, is continued once."""
    if generations <= 0:
        return
    siblings: list[Branch] = []
    for one in branch.bifurcations:
        if one.kind not in _BORN:
            continue
        try:
            probe = switch_branch(one, bounds=bounds, control=replace(control or StepControl(), most=_PROBED))
            if any(_meet(probe, other) for other in siblings):
                continue
            whole = switch_branch(one, bounds=bounds, control=control, progress=progress)
        except NoOrbitError:
            continue
        siblings.append(whole)
        family = _from_birth_to_death(whole, one, branch.bifurcations)
        name = "asymmetric" if one.kind is BifurcationKind.PITCHFORK else f"period {family.path[0].family.periods}"
        yield Followed(f"{name}, from {one.parameter:.6g} rad/s", family)
        yield from born(family, bounds, generations - 1, control, progress)


def between_bifurcations(branch: Branch) -> Branch:
    """Return the branch with an additional orbit between any two bifurcations without one.

    Stability changes only at bifurcations: an orbit between each two shows the stability everywhere.
    """
    located = {id(one.point) for one in branch.bifurcations}
    path = list(branch.path[:1])
    for first, second in pairwise(branch.path):
        if id(first) in located and id(second) in located:
            middle = _middle(first, second)
            path += [] if middle is None else [middle]
        path.append(second)
    return replace(branch, path=tuple(path))


def _middle(first: Point, second: Point) -> Point | None:
    chord = second.u - first.u
    length = float(np.linalg.norm(chord))
    if length == 0.0:
        return None
    found = corrected(first.family, first.u + 0.5 * chord, chord / length)
    return None if isinstance(found, FlowStatus) else found[0]


def _meet(probe: Branch, other: Branch) -> bool:
    """Return whether an orbit of one family is in the other, up to a shift in time by half periods or a mirror image.

    Orbits related by such symmetries have the same tilts and multipliers.
    """
    if probe.path[0].family.periods != other.path[0].family.periods:
        return False
    for index, point in enumerate(probe.path):
        orbit = probe.orbit(index)
        scale = orbit.system.scale
        for candidate in other.orbits_at(point.value):
            tilts = (candidate.minimum_tilt - orbit.minimum_tilt, candidate.peak_tilt - orbit.peak_tilt)
            traces = complex(candidate.multipliers.sum()), complex(orbit.multipliers.sum())
            same = abs(traces[0] - traces[1]) <= _ALIKE_MULTIPLIERS * max(1.0, abs(traces[1]))
            if same and max(map(abs, tilts)) <= _ALIKE * scale:
                return True
    return False


def _from_birth_to_death(family: Branch, birth: Bifurcation, known: tuple[Bifurcation, ...]) -> Branch:
    """Return a family from the orbit of its parent branch up to the orbit at which it ends, if it ends.

    Beyond an orbit of half its length, a family repeats the same orbits, shifted by half their length.
    """
    path, found, ends = list(family.path), family.bifurcations, family.ends
    death: tuple[Point, ...] = ()
    gaps = [_halves_apart(point) for point in path] if birth.kind is BifurcationKind.PERIOD_DOUBLING else []
    last = next((k for k, (one, after) in enumerate(pairwise(gaps)) if float(one @ after) < 0.0), None)
    if last is not None:
        path = path[: last + 1]
        inside = {id(point) for point in path}
        found = tuple(one for one in found if id(one.point) in inside)
        ends = (BranchEnd.BEGUN, BranchEnd.MERGED)
    if ends[1] is BranchEnd.MERGED:
        death = _at(_nearest(path[-1], [one for one in known if one.kind is birth.kind]), family)
    return replace(family, path=(*_at(birth, family), *path, *death), bifurcations=found, ends=ends)


def _nearest(point: Point, known: list[Bifurcation]) -> Bifurcation:
    family = point.family

    def distance(one: Bifurcation) -> float:
        states = np.abs(one.state - point.chain.states[0]).max() / family.system.scale
        return float(states + abs(one.parameter - point.value) / family.span)

    return min(known, key=distance)


def _halves_apart(point: Point) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """Return the difference of an orbit from itself half its length later; zero for an orbit of half the length."""
    states = point.chain.states
    return np.asarray(states[0] - states[len(states) // 2])


def _at(bifurcation: Bifurcation, of: Branch) -> tuple[Point, ...]:
    """Return the orbit of a bifurcation as a point of the bifurcating branch; empty if that is impossible."""
    family: Family = of.path[0].family
    system = family.at(bifurcation.parameter)
    states = arcs_of(system, orbit_at(bifurcation.point).state, family.periods, len(of.path[0].chain.states))
    change = family.system.derivative(family.name, bifurcation.parameter)
    chain = shots(system, states, family.covered, sense=family.sense, change=change)
    return (Point(family, bifurcation.parameter, chain),) if chain.status is FlowStatus.DONE else ()


_AVERAGED_POINTS = 400
# Two base motions, or two models, are equal if their numbers agree to this fraction of the largest number.
_SAME, _PHASES = 1e-9, 16
_BIFURCATION_UNITS = {"angular_frequency": "rad s-1", "mean_tilt": "rad", "peak_tilt": "rad"}


def _chosen(options: Mapping[str, Any]) -> Mapping[str, Any]:
    if options["points"] is not None:
        raise ParameterError(
            f"--points: --exact chooses its own frequencies (got {options['points']}). Remove one of them."
        )
    return {}


def _tables(curves: xr.Dataset) -> list[ResultTable]:
    names = curves["branch_name"].to_numpy()
    columns = (
        curves[f"bifurcation_{name}"].to_numpy()
        for name in ("kind", "angular_frequency", "branch", "mean_tilt", "supercritical")
    )
    bifurcations = [
        [str(kind), f"{float(at):.9g} rad/s", str(names[branch]), f"{float(tilt):.6g} rad", LOSSES[int(code)]]
        for kind, at, branch, tilt, code in zip(*columns, strict=True)
    ]
    stable = [row for index, name in enumerate(names) for row in _stable_ranges(curves, index, str(name))]
    return [
        ResultTable(
            f"{curves.sizes['point']} exact orbits on {len(names)} branches; their bifurcations",
            ("bifurcation", "Ω", "branch", "mean tilt", "loss of stability"),
            bifurcations,
        ),
        ResultTable(f"where orbits are {stability_of(curves)}", ("branch", "Ω", "mean tilt"), stable),
    ]


def _stable_ranges(curves: xr.Dataset, index: int, name: str) -> Iterator[list[str]]:
    """Yield the intervals of a branch with stable orbits, from one bounding point to the other."""
    part = curves.isel(point=np.nonzero(curves["branch"].to_numpy() == index)[0])
    stable = part["stable"].to_numpy()
    edges = np.flatnonzero(np.diff(np.concatenate([[False], stable, [False]]).astype(int)))
    for first, last in zip(edges[::2], edges[1::2] - 1, strict=True):
        # The points next to an interval are the bifurcations that bound it.
        ends = part.isel(point=[max(first - 1, 0), min(last + 1, stable.size - 1)])
        low, high = sorted(map(float, ends["angular_frequency"]))
        least, most = sorted(map(float, ends["mean_tilt"]))
        yield [name, f"{low:.6g} to {high:.6g} rad/s", f"{least:.5g} to {most:.5g} rad"]


@analysis(
    replace(
        RESPONSE,
        arguments=lambda config, _: {"angular_frequency": config.angular_frequency_range},
        chosen=_chosen,
        instead=None,
        tables=_tables,
    )
)
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
        raise Interrupted("interrupted; `partial` has the branches so far", result()) from None
    return result()


def _require_of(orbit: PeriodicOrbit, model: Model, motion: BaseMotion, bounds: tuple[float, float]) -> None:
    """Raise ParameterError unless the orbit has this model and motion, with any frequency within the bounds."""
    require_orbit(orbit)
    numbers, own = ((*one.parameters, one.column.slenderness, one.time_scale) for one in (model, orbit.model))
    if type(orbit.model) is not type(model) or not np.allclose(own, numbers, rtol=_SAME, atol=0.0):
        raise ParameterError(f"orbit must be one of the model {model!r}, got one of {orbit.model!r}")
    frequency = present_value(orbit.model, orbit.motion, "angular_frequency")
    if not bounds[0] <= frequency <= bounds[1]:
        raise ParameterError(f"angular_frequency must enclose that of the orbit, {frequency!r} rad/s, got {bounds!r}")
    _, at = with_parameters(model, motion, angular_frequency=frequency)
    times = np.arange(_PHASES) / _PHASES * float(orbit.motion.period or 1.0)
    wanted, given = (one.acceleration(times) for one in (at, orbit.motion))
    if np.abs(wanted - given).max() > _SAME * np.abs(wanted).max():
        raise ParameterError(
            f"orbit must be an orbit under {motion!r} at any frequency, got one under {orbit.motion!r}"
        )


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
