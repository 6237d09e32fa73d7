"""Basin fractions along a parameter: random initial conditions, and attractors matched between successive values."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Unpack

import numpy as np
import numpy.typing as npt
import xarray as xr
from scipy.optimize import linear_sum_assignment

from stylobate.base_motions import BASE_AT_REST, BaseMotion
from stylobate.engine import with_parameters
from stylobate.errors import MOST_RUNS, require_whole
from stylobate.models import Model
from stylobate.parameter_quantities import attributes_of
from stylobate.results.outcomes import NOT_COMPUTED
from stylobate.results.random_numbers import Rng
from stylobate.studies.checks import SYSTEM_STARTS, one_parameter, require_starts
from stylobate.studies.maps.attractor_search import (
    KINDS,
    NOT_SETTLED,
    REMEDY,
    Attractor,
    AttractorRules,
    FoundAttractors,
    OrbitScales,
    cycle_distance,
    find_attractors,
    with_strobes,
)
from stylobate.studies.maps.attractors import attractor_table, rule_attributes
from stylobate.studies.proportions import fraction_interval, require_confidence
from stylobate.studies.study import StudyArguments, described, study
from stylobate.studies.sweeps import Sweep
from stylobate.studies.sweeps.designs import Box, whole
from stylobate.studies.sweeps.running import Label


@dataclass(frozen=True, slots=True)
class Branches:
    """Branches of attractors along a parameter: the `last` attractor of each branch, and the branches by attractor.

    `places` holds, for each value of the parameter, the index of the branch of each attractor.
    """

    last: tuple[Attractor, ...]
    places: tuple[tuple[int, ...], ...]


def follow_branches(along: Sequence[Sequence[Attractor]], tolerance: float) -> Branches:
    """Match the attractors at successive values of a parameter to branches.

    Attractors are matched to the last attractors of branches of the same kind and period, so that the sum of the
    distances of their dimensionless stroboscopic samples is minimal. An attractor that is farther from every branch
    than the `tolerance`, or left over, begins a branch; a branch that reappears keeps its index. Attractors without a
    period are matched by their kind alone: one sample of many does not locate them.

    Parameters
    ----------
    along
        The attractors at each value, in the order of the parameter.
    tolerance
        Maximum distance between the dimensionless stroboscopic samples of an orbit and of its branch.

    Returns
    -------
    Branches
        Branches by kind and period, then in the order of their appearance.
    """
    last: list[Attractor] = []
    places = [_matched(attractors, last, tolerance) for attractors in along]
    order = sorted(range(len(last)), key=lambda branch: (KINDS.index(last[branch].kind), last[branch].period, branch))
    place = {branch: new for new, branch in enumerate(order)}
    return Branches(
        tuple(last[branch] for branch in order), tuple(tuple(place[branch] for branch in row) for row in places)
    )


def _matched(attractors: Sequence[Attractor], last: list[Attractor], tolerance: float) -> list[int]:
    """Return the branch of each of `attractors`, and record the attractors in `last`."""
    chosen = [-1] * len(attractors)
    distances = np.array([[_distance(found, branch, tolerance) for branch in last] for found in attractors])
    if distances.size:
        for place, branch in zip(*linear_sum_assignment(distances), strict=True):
            if distances[place, branch] < _APART:
                chosen[int(place)] = int(branch)
    for i, found in enumerate(attractors):
        if chosen[i] < 0:
            chosen[i] = len(last)
            last.append(found)
        else:
            last[chosen[i]] = found
    return chosen


# Replaces an infinite distance, which the assignment does not accept; states are of order one.
_APART = 1e9


def _distance(found: Attractor, branch: Attractor, tolerance: float) -> float:
    if (found.kind, found.period) != (branch.kind, branch.period):
        return _APART
    if not found.period:
        return 0.0
    distance = float(cycle_distance(found.states[np.newaxis], branch.states)[0])
    return distance if distance < tolerance else _APART


@study("basin fractions")
def basin_fractions(
    model: Model,
    motion: BaseMotion | None = None,
    *,
    along: Mapping[str, npt.ArrayLike],
    over: Mapping[str, Sequence[float]],
    count: int,
    rng: Rng = 0,
    attractor_rules: AttractorRules | None = None,
    confidence: float = 0.95,
    **run: Unpack[StudyArguments],
) -> tuple[Sweep, Label]:
    """Compute basin fractions along one parameter, from random initial conditions.

    The initial conditions are the same at every value of the parameter, so differences between values reflect the
    basins more than the sample. Attractors of successive values are matched by kind, period and distance. An orbit that
    jumps farther than `branch_tolerance` of the rules is listed as a different one.

    Parameters
    ----------
    model, motion
        The column and its base motion.
    along
        One parameter of the column, the model or the base motion, with its values in order.
    over
        Range of each initial condition that varies: tilt_x, tilt_y [rad], tilt_rate_x, tilt_rate_y [rad/s],
        start_phase [rad].
    count, rng
        Number of initial conditions, drawn uniformly; seed or numpy.random.Generator.
    attractor_rules
        Tolerances by which attractors are identified.
    confidence
        Confidence level of each interval by itself. Intervals at successive values are correlated.
    **run

    Returns
    -------
    xarray.Dataset
        Of kind "basin fractions", over the parameter and `attractor_index`: `count`, `fraction` of the runs computed
        with `fraction_low` and `fraction_high` (counting none, and all, of the unsettled runs towards it); `present` is
        True if the attractor was found, and then `mean_tilt` [rad] and the stroboscopic samples are known. Over the
        parameter `unsettled` and `computed` count runs. "Not settled" is listed last.

    Raises
    ------
    ParameterError
        If `along` does not have exactly one name, a name in `over` is not an initial condition, an argument is out of
        range, or runs are too short for the stroboscopic samples.
    """
    require_starts("over", over)
    name, values = one_parameter(model, along, over)
    starts = Box.of(over, require_whole("count", count, least=1, most=MOST_RUNS), rng)
    points = {start: np.tile(drawn, values.size) for start, drawn in starts.values(whole(starts)).items()}
    at = {name: np.repeat(values, starts.count), **points}
    sweep = Sweep.points(model, motion, at=at, **described(run))
    label = partial(
        fractions_along,
        name=name,
        scales=[scales_at(model, motion, name, float(value)) for value in values],
        rules=attractor_rules or AttractorRules(),
        confidence=require_confidence(confidence),
    )
    return with_strobes(sweep, run["strobes"] or None), label


def fractions_along(
    runs: xr.Dataset, *, name: str, scales: Sequence[OrbitScales], rules: AttractorRules, confidence: float
) -> xr.Dataset:
    """Return the basin fractions of `runs`, which form one block for each value of the parameter `name`.

    Parameters
    ----------
    runs
        Runs over `run`, with the coordinate `name`.
    scales
        Units of the stroboscopic samples at each value.
    """
    count = runs.sizes["run"] // max(len(scales), 1)
    blocks = [runs.isel(run=slice(i * count, (i + 1) * count)) for i in range(len(scales))]
    found = [find_attractors(block, unit, rules).listed() for block, unit in zip(blocks, scales, strict=True)]
    branches = follow_branches([one.attractors for one in found], rules.branch_tolerance)
    values = runs[name].to_numpy()[::count]
    return (
        xr.merge(
            [
                _fractions(name, found, branches, confidence),
                _states(name, found, branches, scales),
                attractor_table(branches.last, scales[-1]).drop_vars(["attractor_tilt", "attractor_tilt_rate"]),
            ],
            combine_attrs="drop",
        )
        .assign_coords({name: (name, values, attributes_of(name))})
        .assign_attrs({**runs.attrs, **rule_attributes(rules, confidence), "kind": "basin fractions", "starts": count})
    )


def _fractions(name: str, found: Sequence[FoundAttractors], branches: Branches, confidence: float) -> xr.Dataset:
    count = np.zeros((len(found), len(branches.last)), dtype=np.int64)
    present = np.zeros(count.shape, dtype=bool)
    for i, (one, places) in enumerate(zip(found, branches.places, strict=True)):
        present[i, list(places)] = True
        count[i, list(places)] = [np.count_nonzero(one.labels == label) for label in range(len(places))]
    computed = np.array([np.count_nonzero(one.labels != NOT_COMPUTED) for one in found])
    rest = np.array([branch.kind == NOT_SETTLED for branch in branches.last], dtype=bool)
    unsettled = count[:, rest].sum(axis=1)
    known = computed[:, np.newaxis] > 0
    total = np.maximum(computed, 1)[:, np.newaxis]
    unknown = np.where(rest, 0, unsettled[:, np.newaxis])
    low, high = fraction_interval(count, unknown, total, confidence=confidence)
    dims, interval = (name, "attractor_index"), f"end of its {100.0 * confidence:g} % interval"
    return xr.Dataset(
        {
            "count": (dims, count, {"units": "1", "long_name": "runs that reach it"}),
            "present": (dims, present, {"long_name": "found at this value"}),
            "fraction": (dims, np.where(known, count / total, np.nan), {"units": "1", "long_name": "basin fraction"}),
            "fraction_low": (dims, np.where(known, low, np.nan), {"units": "1", "long_name": f"lower {interval}"}),
            "fraction_high": (dims, np.where(known, high, np.nan), {"units": "1", "long_name": f"upper {interval}"}),
            "unsettled": (
                name,
                unsettled,
                {"units": "1", "long_name": "runs that have not settled", "comment": REMEDY},
            ),
            "computed": (name, computed, {"units": "1", "long_name": "runs computed"}),
        }
    )


def _states(
    name: str, found: Sequence[FoundAttractors], branches: Branches, scales: Sequence[OrbitScales]
) -> xr.Dataset:
    points = max([1, *(branch.period for branch in branches.last)])
    tilt = np.full((len(found), len(branches.last), points, 2), np.nan)
    tilt_rate, mean_tilt = tilt.copy(), tilt[:, :, 0, 0].copy()
    for i, (one, places) in enumerate(zip(found, branches.places, strict=True)):
        for attractor, branch in zip(one.attractors, places, strict=True):
            states = len(attractor.states)
            tilt[i, branch, :states], tilt_rate[i, branch, :states] = scales[i].vectors(attractor.states)
            mean_tilt[i, branch] = attractor.mean_tilt
    along, dims = (name, "attractor_index"), (name, "attractor_index", "orbit_point", "axis")
    return xr.Dataset(
        {
            "mean_tilt": (along, mean_tilt, {"units": "rad", "long_name": "mean tilt"}),
            "attractor_tilt": (dims, tilt, {"units": "rad", "long_name": "stroboscopic tilt"}),
            "attractor_tilt_rate": (dims, tilt_rate, {"units": "rad s-1", "long_name": "stroboscopic tilt rate"}),
        }
    )


def scales_at(model: Model, motion: BaseMotion | None, name: str, value: float) -> OrbitScales:
    """Return the units of stroboscopic samples at this `value` of the parameter `name`."""
    if name in SYSTEM_STARTS or name == "duration":
        return OrbitScales.of(model, motion)
    return OrbitScales.of(*with_parameters(model, BASE_AT_REST if motion is None else motion, **{name: value}))
