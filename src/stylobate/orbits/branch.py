"""Branches of periodic orbits: continued over a parameter, and begun at a bifurcation of another branch."""

import json
import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from stylobate.cards import CardSection, Row, card
from stylobate.engine.flow.integration import FlowStatus
from stylobate.engine.parameters import present_value
from stylobate.equality import ByContent
from stylobate.errors import Interrupted, NoOrbitError, ParameterError, require_finite
from stylobate.orbits.arclength import (
    BranchEnd,
    Family,
    Floats,
    Point,
    StepControl,
    Stretch,
    control_of,
    corrected,
    enclosing,
    on_family,
    require_followed,
    trace,
)
from stylobate.orbits.bifurcations import Bifurcation, BifurcationKind, between, orbit_at, require_bifurcation
from stylobate.orbits.orbit import (
    BRANCH,
    SUPERCRITICAL,
    PeriodicOrbit,
    file_attributes,
    range_of,
    require_orbit,
    system_sections,
    write,
)
from stylobate.orbits.shooting import WHY_LOST, arcs_of, is_stable
from stylobate.parameter_quantities import attributes_of, quantity_of
from stylobate.progress import Progress, at_value, report_of, shows_progress
from stylobate.provenance import provenance_of_run
from stylobate.results.tables import to_dataframe
from stylobate.text import four_digits, plural, unit_in_text

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True, eq=False)
class Branch(ByContent):
    """A branch of periodic orbits over one parameter.

    Attributes
    ----------
    parameter
        Name of the parameter.
    path
        Points in order along the branch, including its bifurcations.
    bifurcations
        Bifurcations located on the branch, in order along it.
    ends
        Reasons why the branch ends, at its beginning and at its end.
    """

    parameter: str
    path: tuple[Point, ...]
    bifurcations: tuple[Bifurcation, ...]
    ends: tuple[BranchEnd, BranchEnd]

    def orbit(self, index: int) -> PeriodicOrbit:
        """Return the orbit of a point; negative numbers count from the end.

        Raises
        ------
        ParameterError
            If the branch has no such point.
        """
        count = len(self.path)
        if not isinstance(index, (int, np.integer)) or not -count <= index < count:
            raise ParameterError(f"index must be a whole number from {-count} to {count - 1}, got {index!r}")
        return orbit_at(self.path[index])

    def orbits_at(self, value: float) -> tuple[PeriodicOrbit, ...]:
        """Return the orbits of the branch at this value of the parameter, in order along it.

        Raises
        ------
        ParameterError
            If the value is not a finite number.
        """
        value = require_finite("value", value)
        found = list[tuple[float, Point]]()
        values = np.array([point.value for point in self.path])
        for index in np.nonzero((values[:-1] - value) * (values[1:] - value) < 0.0)[0]:
            first, second = self.path[index], self.path[index + 1]
            share = (value - first.value) / (second.value - first.value) if second.value != first.value else 0.0
            guess = first.chain.states + share * (second.chain.states - first.chain.states)
            point = on_family(first.family, guess, value)
            if isinstance(point, Point):
                found.append((int(index) + 0.5, point))
        found += [(float(index), self.path[index]) for index in np.nonzero(values == value)[0]]
        return tuple(orbit_at(point) for _, point in sorted(found, key=lambda one: one[0]))

    @cached_property
    def points(self) -> xr.Dataset:
        """The points as data over `point`: parameter, tilts [rad], multipliers, stability, turns per period."""
        orbits = [orbit_at(point) for point in self.path]
        multipliers = np.stack([point.multipliers for point in self.path])
        first = orbits[0]
        table = {
            "mean_tilt": ([orbit.mean_tilt for orbit in orbits], "rad", "mean tilt angle"),
            "minimum_tilt": ([orbit.minimum_tilt for orbit in orbits], "rad", "minimum tilt angle"),
            "peak_tilt": ([orbit.peak_tilt for orbit in orbits], "rad", "peak tilt angle"),
            "phase": ([_phase_of(orbit) for orbit in orbits], "rad", "phase of the lean to the base acceleration"),
            "turns": ([orbit.turns for orbit in orbits], "1", "turns of the contact point per period"),
        }
        data = {
            name: ("point", np.array(values), {"units": units, "long_name": long_name})
            for name, (values, units, long_name) in table.items()
        }
        return xr.Dataset(
            {
                **data,
                "stable": ("point", [is_stable(one) for one in multipliers], {"long_name": "stable"}),
                "multiplier": (
                    ("point", "multiplier_index", "part"),
                    np.stack([multipliers.real, multipliers.imag], axis=-1),
                    {"units": "1", "long_name": "Floquet multipliers"},
                ),
                "tilt": (("point", "axis"), np.stack([orbit.tilt for orbit in orbits]), {"units": "rad"}),
                "tilt_rate": (("point", "axis"), np.stack([o.tilt_rate for o in orbits]), {"units": "rad s-1"}),
                **_table_of(self.bifurcations),
            },
            coords={
                self.parameter: ("point", [point.value for point in self.path], attributes_of(self.parameter)),
                "axis": ["x", "y"],
                "part": ["real", "imaginary"],
            },
            attrs={
                "kind": "branch",
                "parameter": self.parameter,
                "periods": first.periods,
                "planar": int(first.planar),
                "ends": json.dumps([end.value for end in self.ends]),
                "provenance": json.dumps(provenance_of_run(first.model, first.motion)),
            },
        )

    def to_dataframe(self) -> "pd.DataFrame":
        """Convert the points to a table in pandas, with one row per orbit; see `results.to_dataframe`."""
        return to_dataframe(self.points)

    def save(self, path: str | Path) -> Path:
        """Write the branch to a netCDF file at `path`; `stylobate.load` reads it."""
        return write(self._data(), path)

    def _data(self) -> xr.Dataset:
        """Return the states of points and bifurcations, from which shooting recovers the branch."""
        family, found = self.path[0].family, self.bifurcations
        located = [one.point for one in found]
        shape = (len(found), *self.path[0].chain.states.shape)
        values = {
            "kind": np.array([one.kind.name for one in found], dtype=str),
            "value": np.array([one.parameter for one in found], dtype=float),
            "multiplier_real": np.array([one.multiplier.real for one in found], dtype=float),
            "multiplier_imaginary": np.array([one.multiplier.imag for one in found], dtype=float),
            "coefficient": np.array([one.coefficient for one in found], dtype=float),
            "supercritical": np.array([SUPERCRITICAL[one.supercritical] for one in found], dtype=np.int8),
        }
        vectors = {
            "critical_vector": (family.system.order, [one.critical_vector for one in found]),
            "direction": (located[0].u.size if located else 0, [one.direction for one in found]),
        }
        return xr.Dataset(
            {
                "states": (("point", "arc", "state"), np.stack([point.chain.states for point in self.path])),
                "value": ("point", [point.value for point in self.path]),
                "bifurcation_states": (
                    ("bifurcation", "arc", "state"),
                    np.array([point.chain.states for point in located]).reshape(shape),
                ),
                **{f"bifurcation_{name}": ("bifurcation", column) for name, column in values.items()},
                **{
                    f"bifurcation_{name}": (("bifurcation", f"{name}_entry"), np.array(rows).reshape(len(found), width))
                    for name, (width, rows) in vectors.items()
                },
            },
            attrs={
                **file_attributes(family.system, BRANCH, family.periods),
                "parameter": self.parameter,
                "span": family.span,
                "sense": family.sense,
                "ends": json.dumps([end.name for end in self.ends]),
            },
        )

    def __repr__(self) -> str:
        """Describe the branch in one line."""
        values = [point.value for point in self.path]
        kinds = ", ".join(f"{one.kind.value} at {four_digits(one.parameter)}" for one in self.bifurcations)
        return f"Branch({len(values)} orbits, {self.parameter} {range_of(values)}; {kinds or 'no bifurcations'})"

    def _repr_html_(self) -> str:
        """Render the card that notebooks show."""
        stable = sum(is_stable(point.multipliers) for point in self.path)
        unit = unit_in_text(quantity_of(self.parameter).unit)
        rows = [
            Row(self.parameter.replace("_", " "), f"{range_of(point.value for point in self.path)} {unit}"),
            Row("orbits", f"{len(self.path)}, {stable} of them stable"),
            Row("ends", "; ".join(end.value for end in self.ends)),
        ]
        how = {True: ", supercritical", False: ", subcritical", None: ""}
        found = [
            Row(one.kind.value, f"{four_digits(one.parameter)} {unit}{how[one.supercritical]}")
            for one in self.bifurcations
        ]
        sections = system_sections(self.path[0].family.system)
        return card("Branch of periodic orbits", [CardSection("", rows), CardSection("bifurcations", found), *sections])


def _table_of(bifurcations: tuple[Bifurcation, ...]) -> dict[str, tuple[str, list[object]]]:
    dim = "bifurcation"
    return {
        "bifurcation_kind": (dim, [one.kind.value for one in bifurcations]),
        "bifurcation_parameter": (dim, [one.parameter for one in bifurcations]),
        "bifurcation_coefficient": (dim, [one.coefficient for one in bifurcations]),
        "bifurcation_supercritical": (dim, [SUPERCRITICAL[one.supercritical] for one in bifurcations]),
        "bifurcation_mean_tilt": (dim, [one.orbit.mean_tilt for one in bifurcations]),
        "bifurcation_peak_tilt": (dim, [one.orbit.peak_tilt for one in bifurcations]),
    }


def _phase_of(orbit: PeriodicOrbit) -> float:
    """Return the phase between lean and base acceleration [rad], from their components that turn once per period.

    The result is NaN if the contact point does not turn once per period, or the acceleration has no such component.
    """
    sense = round(orbit.turns)
    if abs(sense) != 1 or orbit.planar:
        return math.nan
    samples = orbit.path.shape[1]
    phases = np.arange(samples) / samples * orbit.periods
    push = orbit.motion.acceleration(phases * orbit.period / orbit.periods)
    turning = np.exp(-2j * math.pi * sense * phases)
    lean = np.mean((orbit.path[0] + 1j * orbit.path[1]) * turning)
    base = np.mean((push[:, 0] + 1j * push[:, 1]) * turning)
    if abs(base) < 1e-12 * np.abs(push).max():
        return math.nan
    return float(sense * np.angle(lean / base))


@shows_progress("branch", at_value)
def continue_branch(
    orbit: PeriodicOrbit,
    parameter: str,
    *,
    bounds: tuple[float, float],
    both_ways: bool = True,
    control: StepControl | None = None,
    progress: Progress = None,
) -> Branch:
    """Continue a periodic orbit over one parameter, through folds, and locate its bifurcations.

    Parameters
    ----------
    orbit
        Orbit from which to begin.
    parameter
        Name of a number of column, model or motion; see `with_parameters`: angular_frequency, acceleration,
        amplitude_x, amplitude_y, phase_difference, rotation, damping, slenderness …
    bounds
        Minimum and maximum of the parameter.
    both_ways
        Whether to continue in both directions; otherwise only in the one that begins with larger values.
    control
        Length of steps, and maximum number of points in each direction.
    progress
        A function that is called with the parameter of each new point; a bar by default, False for none.

    Returns
    -------
    Branch
        `.points` (xarray) and `.bifurcations`.

    Raises
    ------
    ParameterError
        If the orbit does not lie between the bounds, the bounds are invalid, or the parameter is unknown or is `delay`,
        which changes no orbit.
    Interrupted
        On Ctrl-C; `partial` is the branch so far.

    Notes
    -----
    The method is H. B. Keller's pseudo-arclength continuation: a predictor along the tangent and Newton's method across
    it. Bifurcations are zeros of test functions, located on the branch by Brent's method.

    Examples
    --------
    >>> import stylobate as sb
    >>> model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    >>> motion = sb.Harmonic.circular(acceleration=0.065, angular_frequency=2.0)
    >>> orbit = sb.orbits.periodic_orbit(model, motion)
    >>> branch = sb.orbits.continue_branch(orbit, "angular_frequency", bounds=(1.2, 2.5))
    >>> [(one.kind.value, round(one.parameter, 8)) for one in branch.bifurcations]
    [('Neimark-Sacker', 1.39710759)]
    """
    require_orbit(orbit)
    require_followed(parameter)
    control = control_of(control)
    value = present_value(orbit.model, orbit.motion, parameter)
    low, high = enclosing(orbit.system, bounds, parameter, value)
    start = _point_of(orbit, parameter, value, high - low)
    if isinstance(start, FlowStatus):
        raise NoOrbitError(f"the continuation could not start at {parameter} = {value!r}: {WHY_LOST[start]}")
    up = np.zeros_like(start.u)
    up[-1] = 1.0
    return _branch_through(start, up, (low, high), control, _seen_by(progress), both_ways=both_ways)


def _seen_by(progress: Progress) -> Callable[[Point], None]:
    """Return a callback for points that passes their parameter to `progress`."""
    report = report_of(progress)
    return lambda point: report(point.value)


def _point_of(orbit: PeriodicOrbit, parameter: str, value: float, span: float) -> Point | FlowStatus:
    """Return the orbit as a point of its family, which covers half the orbit if the orbit has the inversion."""
    states = orbit.chain.states
    if orbit.inversion:
        family = Family(orbit.system, orbit.periods, parameter, span, sense=-1.0)
        half = arcs_of(orbit.system, orbit.state, 0.5 * orbit.periods, max(1, len(states) // 2))
        point = on_family(family, half, value)
        if isinstance(point, Point):
            return point
    return on_family(Family(orbit.system, orbit.periods, parameter, span), states, value)


def _branch_through(
    start: Point,
    direction: Floats,
    bounds: tuple[float, float],
    control: StepControl,
    seen: Callable[[Point], None] | None = None,
    *,
    both_ways: bool = True,
) -> Branch:
    """Continue the branch through a point in the sense of `direction`, and with `both_ways` against it too.

    Raises
    ------
    Interrupted
        On Ctrl-C; `partial` is the branch so far.
    """
    forward = trace(start, direction, bounds, control, seen)
    alone = forward.end in (BranchEnd.CLOSED, BranchEnd.INTERRUPTED) or not both_ways
    backward = None if alone else trace(start, -start.along(direction), bounds, control, seen)
    branch = _joined(start.family.name, forward, backward)
    if BranchEnd.INTERRUPTED in branch.ends:
        message = f"stopped after {plural(len(branch.path), 'orbit')}; `partial` is the branch so far"
        raise Interrupted(message, branch)
    return branch


def _joined(name: str, forward: Stretch, backward: Stretch | None) -> Branch:
    points, directions = list(forward.points), list(forward.directions)
    first_end: BranchEnd = BranchEnd.CLOSED if forward.end is BranchEnd.CLOSED else BranchEnd.BEGUN
    if backward is not None:
        points = [*reversed(backward.points[1:]), *points]
        directions = [*(-sense for sense in reversed(backward.directions[1:])), *directions]
        first_end = backward.end
    path, found = points[:1], list[Bifurcation]()
    for first, second, sense in zip(points, points[1:], directions, strict=False):
        located = between(first, second, sense)
        found += located
        # The path has a point at each change of stability.
        path += [*(one.point for one in located), second]
    return Branch(name, tuple(path), tuple(found), (first_end, forward.end))


# First step off the old family, in units of c, and maximum number of doublings if Newton's method falls back.
_OFF, _DOUBLINGS = 2e-3, 5


@shows_progress("branch", at_value)
def switch_branch(
    bifurcation: Bifurcation,
    *,
    bounds: tuple[float, float],
    opposite: bool = False,
    control: StepControl | None = None,
    progress: Progress = None,
) -> Branch:
    """Continue the branch that begins at, or crosses, a bifurcation.

    Parameters
    ----------
    bifurcation
        A pitchfork, a period doubling or a branch point of a branch.
    bounds
        Minimum and maximum of the parameter.
    opposite
        At a pitchfork: continue the symmetry-related branch instead.
    control, progress
        As in `continue_branch`.

    Raises
    ------
    ParameterError
        If no branch of periodic orbits begins here: at a fold or a Neimark-Sacker point.
    NoOrbitError
        If no orbit of the new branch was reached.
    Interrupted
        On Ctrl-C; `partial` is the branch so far.
    """
    require_bifurcation(bifurcation)
    control = control_of(control)
    point, old = bifurcation.point, bifurcation.point.family
    if bifurcation.kind in (BifurcationKind.FOLD, BifurcationKind.NEIMARK_SACKER):
        raise ParameterError(
            f"bifurcation must be a pitchfork, a period doubling or a branch point, got {bifurcation.kind.value}: "
            "no other family of periodic orbits begins there"
        )
    bounds = enclosing(old.system, bounds, old.name, point.value)
    periods = 2 * old.periods if bifurcation.kind is BifurcationKind.PERIOD_DOUBLING else old.periods
    family = Family(old.at(point.value), periods, old.name, bounds[1] - bounds[0])
    states = arcs_of(family.system, point.chain.states[0], periods, periods)
    units = family.units(states.size)
    sign = -1.0 if opposite else 1.0
    disturbance = _arcs_of_disturbance(family, states, sign * bifurcation.critical_vector)
    normal = np.append(disturbance.ravel(), 0.0) / units
    normal /= np.linalg.norm(normal)
    here = np.append(states.ravel(), point.value) / units
    off = _OFF
    for _ in range(_DOUBLINGS):
        found = corrected(family, here + off * normal, normal)
        # The old family meets the plane across the disturbance at zero distance.
        if not isinstance(found, FlowStatus) and abs((found[0].u - here) @ normal) > 0.5 * off:
            start = found[0]
            return _branch_through(start, normal, bounds, control, _seen_by(progress), both_ways=False)
        off *= 2.0
    raise NoOrbitError(
        f"no orbit of the branch from {old.name} = {point.value!r} was reached; give another bifurcation"
    )


def _arcs_of_disturbance(family: Family, states: np.ndarray, vector: np.ndarray) -> np.ndarray:
    """Return a disturbance of the first state, carried to the beginning of each arc."""
    carried = [vector]
    for arc in range(len(states) - 1):
        begin, end = (family.periods * k / len(states) for k in (arc, arc + 1))
        carried.append(family.system.carry(states[arc], begin, end).by_start @ carried[-1])
    return np.stack(carried)
